//! The rate of a table: what comments state and what a column of times says.
//!
//! Separate because a table may state its rate more than once, and then must do so alike.

use super::Line;
use crate::error::MotionError;
use crate::import::file::File;
use crate::import::rate::{agree, differ, shown};

/// A rate and where the table states it.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::import) struct Stated {
    pub(super) fps: f64,
    pub(super) place: String,
}

/// The one rate that a table states, if it states any; under a user's word that stands above the file's,
/// the first that contradicts it. Of those that differ by rounding the first is taken, which is said.
///
/// # Errors
/// Two that differ.
pub(super) fn one(
    file: &File<'_>,
    stated: &[Stated],
    above: Option<f64>,
    decisions: &mut Vec<String>,
) -> Result<Option<f64>, MotionError> {
    let first = stated.first();
    if let Some(above) = above {
        let other = stated.iter().find(|s| !agree(s.fps, above)).or(first);
        return Ok(other.map(|stated| stated.fps));
    }
    let Some(a) = first else {
        return Ok(None);
    };
    for b in &stated[1..] {
        let (f, g) = (shown(a.fps), shown(b.fps));
        if !agree(a.fps, b.fps) {
            return Err(file.unusable(
                &format!(
                    "states two rates: {f} frames a second in {}, {g} in {}",
                    a.place, b.place
                ),
                "remove the wrong one, or import it with --fps and --force-fps",
            ));
        }
        if differ(a.fps, b.fps) {
            decisions.push(format!(
                "{f} frames a second as {} states; passed over: {g} in {}, the same but for rounding",
                a.place, b.place
            ));
        }
    }
    Ok(Some(a.fps))
}

/// The rates that comments state: `# fps = 50`, `# frame rate: 50 Hz`, `# dt = 0.02 s`.
///
/// # Errors
/// Such a statement without a number.
pub(super) fn in_comments(file: &File<'_>, text: &str) -> Result<Vec<Stated>, MotionError> {
    let mut found = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let Some(comment) = line.trim().strip_prefix('#') else {
            continue;
        };
        let Some((key, value)) = statement(comment) else {
            continue;
        };
        let key = key.to_lowercase().replace([' ', '_', '-'], "");
        let seconds = matches!(key.as_str(), "dt" | "frametime" | "timestep");
        if !seconds && !matches!(key.as_str(), "fps" | "framerate" | "framespersecond") {
            continue;
        }
        let shown: String = comment.trim().chars().take(40).collect();
        let Some(value) = number(value, seconds) else {
            let problem = format!("{shown:?} says no rate");
            return Err(file.line(i + 1, problem, "write # fps = 50, or remove the line"));
        };
        found.push(Stated {
            fps: if seconds { 1.0 / value } else { value },
            place: format!("line {} ({shown})", i + 1),
        });
    }
    Ok(found)
}

/// Key and value of a comment: `fps = 50`, `fps: 50`, or `fps 50`.
fn statement(comment: &str) -> Option<(&str, &str)> {
    let comment = comment.trim();
    let (key, value) = match comment.split_once(['=', ':']) {
        Some(parts) => parts,
        None => comment
            .split_once(char::is_whitespace)
            .filter(|(_, value)| value.trim().starts_with(|c: char| c.is_ascii_digit()))?,
    };
    Some((key.trim(), value.trim()))
}

/// The number that a value begins with, in Hz or s; `None` if it is none or of another unit.
fn number(value: &str, seconds: bool) -> Option<f64> {
    let word = |text: &str| {
        let end = text.find(|c: char| c.is_whitespace() || ",;()".contains(c));
        text[..end.unwrap_or(text.len())].to_lowercase()
    };
    let first = word(value);
    let digits = first.trim_end_matches(|c: char| c.is_alphabetic());
    let unit = if digits.len() < first.len() {
        first[digits.len()..].to_owned()
    } else {
        word(value[first.len().min(value.len())..].trim_start())
    };
    let scale = match (seconds, unit.as_str()) {
        (true, "ms") => 1e-3,
        (true, "hz" | "fps") | (false, "s" | "ms") => return None,
        _ => 1.0,
    };
    let number = digits.parse::<f64>().ok()? * scale;
    number.is_finite().then_some(number)
}

/// The rate that a column of times has, which must step evenly; `None` of fewer than two times.
///
/// Counters of frames pass here too: a gap in them is a gap.
///
/// # Errors
/// The first time that comes too early or too late.
pub(super) fn of_times(
    times: &[(Line<'_>, f64)],
    column: usize,
) -> Result<Option<Stated>, MotionError> {
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1].1 - pair[0].1).collect();
    let (Some((_, first)), Some((_, last))) = (times.first(), times.last()) else {
        return Ok(None);
    };
    if steps.is_empty() {
        return Ok(None);
    }
    let usual = retarget::signal::median(&mut steps.clone());
    let slack = 0.02 * usual.abs() + rounding(times, column, usual);
    let uneven = steps
        .iter()
        .position(|step| (step - usual).abs() > slack || *step <= 0.0);
    if let Some(i) = uneven {
        let (line, time) = &times[i + 1];
        let problem = format!(
            "time {time} comes {:.6} after the line before, {usual:.6} elsewhere",
            steps[i]
        );
        return Err(line.error(
            None,
            problem,
            "frames must be evenly spaced; resample or cut the file",
        ));
    }
    // Over the whole file: single steps of times in milliseconds are rounded.
    let mean = (last - first) / steps.len() as f64;
    Ok(Some(Stated {
        fps: 1.0 / mean,
        place: format!("the column of times (steps of {mean:.6} s)"),
    }))
}

/// What rounding may change in a step: a unit of the last digit that is written, if steps are at least
/// four of it (30 Hz in milliseconds steps by 0.033 and 0.034).
fn rounding(times: &[(Line<'_>, f64)], column: usize, usual: f64) -> f64 {
    let decimals = |line: &Line<'_>| {
        let cell = line.cells().nth(column).unwrap_or("");
        cell.split_once('.').map_or(0, |(_, digits)| digits.len())
    };
    let most = times.iter().map(|(line, _)| decimals(line)).max();
    let unit = 0.1f64.powi(most.unwrap_or(0) as i32);
    if unit <= 0.25 * usual { unit } else { 0.0 }
}
