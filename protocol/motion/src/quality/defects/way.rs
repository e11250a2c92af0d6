//! Robots that face away from where they go.
//!
//! Separate because a name decides: whoever walks backward on purpose says so.

use super::super::Feet;
use super::super::defect::{Defect, Frames, Kind, Severity};
use crate::clip::{Clip, FRAME_SECONDS};
use nalgebra::Vector2;

/// Speed below which a robot goes nowhere, m/s: stepping on the spot sways by less.
const MOVES: f64 = 0.15;
/// Mean speeds are over a second: half a stride or more.
const HALF_WINDOW: usize = 25;
/// Cosine between facing and going, beyond which it goes back: 120°. Steps aside are at 90°.
const BEHIND: f64 = -0.5;
/// Share of the moving frames, and of all frames, that make a clip one that goes back.
const OF_MOVING: f64 = 0.5;
const OF_ALL: f64 = 0.25;

/// A step farther than this, m in a frame, is a teleport and no travel: 12.5 m/s.
const TELEPORT: f64 = 0.25;

/// Toes, or the pelvis, that point behind the direction of travel.
pub(super) fn backward(clip: &Clip, feet: &[Feet]) -> Option<Defect> {
    let frames = &clip.frames;
    let last = frames.len() - 1;
    // The way up to each frame.
    let mut ways = vec![Vector2::zeros()];
    for pair in frames.windows(2) {
        let step: Vector2<f64> = (pair[1].position - pair[0].position).xy().cast();
        let step = if step.norm() > TELEPORT {
            Vector2::zeros()
        } else {
            step
        };
        ways.push(ways[ways.len() - 1] + step);
    }
    let (mut moving, mut bad) = (0, Vec::new());
    for i in 0..=last {
        let (a, b) = (i.saturating_sub(HALF_WINDOW), (i + HALF_WINDOW).min(last));
        if a == b {
            continue;
        }
        let velocity = (ways[b] - ways[a]) / ((b - a) as f64 * FRAME_SECONDS);
        let speed = velocity.norm();
        if speed < MOVES {
            continue;
        }
        moving += 1;
        let behind = |facing: Vector2<f64>| facing.dot(&velocity) < BEHIND * facing.norm() * speed;
        let pelvis = frames[i].orientation * nalgebra::Vector3::x();
        let toes = feet[i].toes.map(|toe| behind(toe.xy().cast()));
        if behind(pelvis.xy().cast()) || toes == [true; 2] {
            bad.push((i, speed));
        }
    }
    let share = bad.len() as f64 / f64::max(moving as f64, 1.0);
    if share <= OF_MOVING || (bad.len() as f64) <= OF_ALL * frames.len() as f64 {
        return None;
    }
    let speed = bad.iter().map(|(_, speed)| speed).sum::<f64>() / bad.len() as f64;
    let (frames, value) = (Frames::of(&bad)?, (speed, "m/s"));
    let says = format!(
        "toes or pelvis point behind the direction of travel in {:.0} % of moving frames, at {speed:.2} m/s",
        100.0 * share
    );
    Some(if says_so(&clip.name) {
        let says = format!("{says}, as its name says");
        Defect {
            remedy: "nothing is to be done if that is meant",
            ..Defect::new(Kind::Backward, Severity::Odd, frames, value, &says)
        }
    } else {
        Defect::new(Kind::Backward, Severity::Unfit, frames, value, &says)
    })
}

/// Whether a name says that the motion goes back: "walk_backward", "BackStep", "bwd", "walk_-0.50".
fn says_so(name: &str) -> bool {
    let lower = name.to_lowercase();
    if ["backw", "bwd", "revers", "retreat"]
        .iter()
        .any(|word| lower.contains(word))
    {
        return true;
    }
    // Words end where letters do, or where a capital follows a small letter.
    let mut words = String::new();
    let mut before = ' ';
    for c in name.chars() {
        if before.is_lowercase() && c.is_uppercase() {
            words.push(' ');
        }
        words.push(if c.is_alphabetic() { c } else { ' ' });
        before = c;
    }
    let back = words
        .split_whitespace()
        .any(|word| word.eq_ignore_ascii_case("back"));
    // A minus sign before a number, and not between two parts of a date or a count.
    let signed = name
        .as_bytes()
        .windows(3)
        .any(|w| !w[0].is_ascii_alphanumeric() && w[1] == b'-' && w[2].is_ascii_digit());
    back || signed
}

#[cfg(test)]
mod tests {
    use super::says_so;

    #[test]
    fn names_that_say_backward() {
        for name in [
            "walk_backward",
            "WalkBackwards01",
            "07_back",
            "StepBack",
            "run-bwd",
            "walk_-0.50",
            "walk -0.50 m/s",
        ] {
            assert!(says_so(name), "{name}");
        }
        for name in [
            "02_01",
            "backpack",
            "2026-05-01",
            "walk_0.50",
            "lefthanded",
            "",
            "-",
        ] {
            assert!(!says_so(name), "{name}");
        }
    }
}
