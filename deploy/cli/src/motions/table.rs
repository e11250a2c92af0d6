//! Clips as lines of a table.
//!
//! Separate because import, inspect and check show the same columns.

use motion::Quality;

/// Heading of [`line()`].
pub(super) const HEADING: &str = "\
clip                              s    m/s    slip  below  duty  flight  peak  limits
                                              m/s     mm                motor";

/// A clip's figures: duration, speed, slip of standing feet (median), deepest sole, share of time that
/// a foot stands, share of flight, greatest joint speed over its motor's, joints beyond limits.
pub(super) fn line(name: &str, quality: &Quality) -> String {
    let shown: String = if name.chars().count() > 26 {
        let tail: String = name.chars().skip(name.chars().count() - 25).collect();
        format!("…{tail}")
    } else {
        name.to_owned()
    };
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
    }
}
