//! Frames per second: what the user says, what the file states, and what holds if they differ.
//!
//! Separate because a wrong rate is a motion at a wrong speed, which nothing after this would notice;
//! so it is decided in one place for every format.

use super::Options;
use super::file::File;
use crate::error::MotionError;
use std::path::Path;

/// Rates that differ by a smaller share are the same, rounded: 1/0.033 s and 30, 29.97 and 30. Film and
/// video, 24 and 25, are not.
const ROUNDING: f64 = 0.02;
/// Rates that differ by a larger share are worth a word.
const NOTICED: f64 = 1e-3;

/// Whether two rates are the same but for rounding.
pub(super) fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs().min(b.abs())
}

/// Whether two rates differ by more than what is worth a word.
pub(super) fn differ(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() > NOTICED
}

/// The rate that a file's name states, as in `walk_60Hz.csv`, `walk-29.97fps.csv` or `walk_fps30.csv`; `None` if it states
/// none, or two. Less than 10 is a cadence and no rate of frames.
pub(super) fn in_name(path: &Path) -> Option<f64> {
    let name = path.file_name()?.to_string_lossy().to_lowercase();
    let mut rates: Vec<f64> = Vec::new();
    for unit in ["hz", "fps"] {
        for (at, _) in name.match_indices(unit) {
            let (before, after) = (&name[..at], &name[at + unit.len()..]);
            let between = |c: char| matches!(c, '_' | '-' | ' ' | '=');
            let letter = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
            let digit = |c: char| c.is_ascii_digit() || c == '.';
            let number = if !letter(after.chars().next()) {
                let before = before.strip_suffix(between).unwrap_or(before);
                &before[before.trim_end_matches(digit).len()..]
            } else {
                ""
            };
            let number = if number.is_empty() && !letter(before.chars().next_back()) {
                let after = after.strip_prefix(between).unwrap_or(after);
                let rest = after.trim_start_matches(digit);
                &after[..after.len() - rest.len()]
            } else {
                number
            };
            rates.extend(number.trim_matches('.').parse::<f64>());
        }
    }
    rates.retain(|fps| (10.0..=10_000.0).contains(fps));
    let first = *rates.first()?;
    rates.iter().all(|fps| *fps == first).then_some(first)
}

/// A rate in at most three decimals.
pub(super) fn shown(fps: f64) -> String {
    format!("{}", (1000.0 * fps).round() / 1000.0)
}

/// The rate of a file that states `stated`, or if it states none its name, under what the user says.
///
/// # Errors
/// No rate at all, one that no motion has, or a user's that contradicts the file's.
pub(super) fn decide(
    file: &File<'_>,
    options: &Options,
    stated: Option<f64>,
    decisions: &mut Vec<String>,
) -> Result<f64, MotionError> {
    let named = in_name(file.path).filter(|_| stated.is_none());
    let where_to = if named.is_some() { " in its name" } else { "" };
    if let (None, Some(named)) = (options.fps, named) {
        decisions.push(format!(
            "{} frames a second, as the file's name says",
            shown(named)
        ));
    }
    let stated = stated.or(named);
    if let (Some(given), Some(stated)) = (options.fps, stated) {
        let of_file = shown(stated);
        if !agree(given, stated) {
            if !options.force_fps {
                let factor = given / stated;
                return Err(file.unusable(
                    &format!(
                        "states {of_file} frames a second{where_to}, not {given}: at {given} its motion \
                         would be {factor:.2} times as fast"
                    ),
                    "leave fps (--fps) away; if the file is wrong, import it with --fps and \
                     --force-fps",
                ));
            }
            decisions.push(format!(
                "{given} frames a second by --force-fps, against the {of_file} that the file states{where_to}"
            ));
        } else if differ(given, stated) {
            decisions.push(format!(
                "{given} frames a second as given; the file states {of_file}{where_to}, the same but for rounding"
            ));
        }
    }
    match options.fps.or(stated) {
        Some(fps) if (1.0..=10_000.0).contains(&fps) => Ok(fps),
        Some(fps) => Err(file.unusable(
            &format!("has a rate of {fps} frames a second"),
            "give one from 1 to 10000: fps = …, on the command line --fps",
        )),
        None => Err(file.unusable(
            "does not say its frames per second",
            "say them: fps = 30, on the command line --fps 30 (Unitree's tables have 30)",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn decided(given: Option<f64>, stated: Option<f64>, force: bool) -> Result<f64, String> {
        let file = File {
            path: Path::new("walk.bvh"),
            bytes: b"",
        };
        let options = Options {
            fps: given,
            force_fps: force,
            ..Options::default()
        };
        let mut decisions = Vec::new();
        let fps = decide(&file, &options, stated, &mut decisions).map_err(|e| e.to_string())?;
        let odd = given.zip(stated).is_some_and(|(a, b)| a != b);
        assert_eq!(decisions.len(), usize::from(odd), "{decisions:?}");
        Ok(fps)
    }

    #[test]
    fn one_rate_is_taken_and_two_must_agree() {
        assert_eq!(decided(Some(30.0), None, false), Ok(30.0));
        assert_eq!(decided(None, Some(120.0), false), Ok(120.0));
        assert_eq!(decided(Some(30.0), Some(30.0), false), Ok(30.0));
        // A frame time of 0.033 s is 30.303 a second; 29.97 is what video calls 30.
        assert_eq!(decided(Some(30.0), Some(1.0 / 0.033), false), Ok(30.0));
        assert_eq!(decided(Some(30.0), Some(29.97), false), Ok(30.0));
        for (given, stated, times) in [
            (30.0, 50.0, "0.60 times"),
            (120.0, 30.0, "4.00 times"),
            (25.0, 24.0, "1.04 times"),
            (50.0, 60.0, "0.83 times"),
            (30.0, f64::NAN, "NaN times"),
            (30.0, 0.0, "inf times"),
        ] {
            let message = decided(Some(given), Some(stated), false).unwrap_err();
            for part in ["walk.bvh", times, "--fps", "--force-fps"] {
                assert!(message.contains(part), "{part:?} is not in {message:?}");
            }
            assert_eq!(decided(Some(given), Some(stated), true), Ok(given));
        }
    }

    #[test]
    fn a_rate_in_the_name_is_stated() {
        for (name, expected) in [
            ("walk_60Hz.csv", Some(60.0)),
            ("walk_30fps.csv", Some(30.0)),
            ("g1_v2_500Hz.csv.gz", Some(500.0)),
            ("walk 29.97 FPS take 2.csv", Some(29.97)),
            ("120hz.bvh", Some(120.0)),
            ("walk_fps50.csv", Some(50.0)),
            ("walk_60.csv", None),
            ("cadence_2Hz.csv", None),
            ("30fps_of_120fps.csv", None),
            ("walk_60hzx.csv", None),
            ("chatz3.csv", None),
        ] {
            assert_eq!(in_name(Path::new(name)), expected, "{name}");
        }
        let decided = |given, stated| {
            let file = File {
                path: Path::new("walk_60Hz.csv"),
                bytes: b"",
            };
            let options = Options {
                fps: given,
                ..Options::default()
            };
            let mut decisions = Vec::new();
            let fps = decide(&file, &options, stated, &mut decisions);
            (fps.map_err(|e| e.to_string()), decisions)
        };
        let (fps, told) = decided(None, None);
        assert_eq!(fps, Ok(60.0));
        assert_eq!(told, ["60 frames a second, as the file's name says"]);
        let message = decided(Some(30.0), None).0.unwrap_err();
        assert!(
            message.contains("states 60 frames a second in its name, not 30"),
            "{message}"
        );
        assert_eq!(decided(Some(60.0), None), (Ok(60.0), Vec::new()));
        // What the file itself says stands.
        assert_eq!(decided(None, Some(50.0)), (Ok(50.0), Vec::new()));
    }

    #[test]
    fn rates_are_shown_in_few_digits() {
        assert_eq!(shown(1.0 / 0.02), "50");
        assert_eq!(shown(1.0 / 0.033), "30.303");
    }

    #[test]
    fn no_rate_or_an_impossible_one_is_refused() {
        assert!(decided(None, None, false).unwrap_err().contains("--fps 30"));
        for fps in [0.0, -30.0, 0.5, 20_000.0, f64::NAN, f64::INFINITY] {
            assert!(decided(Some(fps), None, false).is_err(), "{fps}");
            assert!(decided(None, Some(fps), true).is_err(), "{fps}");
        }
    }
}
