//! Clips as lines of a table.
//!
//! Separate because import, inspect and check show the same columns.

use motion::Quality;

/// Heading of [`line()`].
pub(super) const HEADING: &str = "\
clip                              s    m/s    slip  below  duty  flight  peak  limits
                                               m/s     mm               motor";

/// A clip's figures: duration, speed, slip of standing feet (median), deepest sole, share of time that
/// a foot stands, share of flight, greatest joint speed over its motor's, joints beyond limits.
pub(super) fn line(name: &str, quality: &Quality) -> String {
    let shown: String = if name.chars().count() > 26 {
        let tail: String = name.chars().skip(name.chars().count() - 25).collect();
        format!("…{tail}")
    } else {
        name.to_owned()
    };
    let shown = wording::line(&shown);
    format!(
        "{shown:<26} {:8.2} {:6.2}  {:6.3}  {:5.1}  {:4.2}  {:6.2}  {:4.2}  {:>6}",
        quality.seconds,
        quality.speed,
        quality.slip,
        1000.0 * quality.penetration,
        (quality.duty[0] + quality.duty[1]) / 2.0,
        quality.flight,
        quality.peak_speed,
        quality.beyond_limits.len(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_keep_their_places() {
        let quality = Quality::of(&motion::gait::walk(1.0).unwrap());
        let short = line("walk", &quality);
        let long = line(
            &"a very long name of a clip from some folder".repeat(2),
            &quality,
        );
        assert_eq!(short.chars().count(), long.chars().count());
        assert!(short.contains(" 1.00 "), "{short}");
        // Every number ends where its heading does, and every unit under the heading that it belongs to.
        let ends = |line: &str| -> Vec<usize> {
            let letters: Vec<char> = line.chars().chain([' ']).collect();
            let ends = |i: &usize| letters[*i] != ' ' && letters[i + 1] == ' ';
            (0..letters.len() - 1).filter(ends).collect()
        };
        let lines: Vec<Vec<usize>> = HEADING.lines().map(ends).collect();
        assert_eq!(lines[0][1..], ends(&short)[1..], "{HEADING}\n{short}");
        // Slip in metres a second, depth in millimetres, the peak in shares of the motor's.
        assert_eq!(
            lines[1],
            [3, 4, 7].map(|column| lines[0][column]),
            "{HEADING}"
        );
    }
}
