//! When a human's feet stand.
//!
//! Separate because a capture does not say it and everything about slipping depends on it. A foot
//! stands where its toe or its ankle is low and slow; a heel that strikes and a toe that pushes off
//! count, since then the other end moves.

use crate::capture::{Capture, Landmark, Side};
use crate::signal;

/// Whether the feet stand in a frame, by [`Side::index`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Contact {
    /// Any part of the foot is on the ground.
    pub stands: [bool; 2],
    /// Ankle and toe are both still: the sole is flat.
    pub flat: [bool; 2],
}

/// A leg of this length is low at [`LOW`] and slow at [`SLOW`].
const USUAL_LEG: f64 = 0.85;
/// Height above where the point is at its lowest, m.
const LOW: f64 = 0.06;
/// Speed, m/s, or this share of the speed of travel: markers of runners swing more.
const SLOW: f64 = 0.3;
const SLOW_SHARE: f64 = 0.15;
/// A foot that stands or swings for less than this many frames (40 ms) does not.
const SHORTEST: usize = 2;

/// The contacts of a capture.
pub fn detect(capture: &Capture) -> Vec<Contact> {
    let size = capture.leg_length() / USUAL_LEG;
    let slow = (SLOW * size).max(SLOW_SHARE * capture.travel_speed());
    let mut contacts = vec![Contact::default(); capture.frames.len()];
    for side in Side::BOTH {
        let [toe, ankle] =
            [Landmark::Toe, Landmark::Ankle].map(|l| still(capture, side, l, slow, LOW * size));
        let mut stands: Vec<bool> = toe.iter().zip(&ankle).map(|(a, b)| *a || *b).collect();
        without_short_runs(&mut stands, false);
        without_short_runs(&mut stands, true);
        for (i, contact) in contacts.iter_mut().enumerate() {
            contact.stands[side.index()] = stands[i];
            contact.flat[side.index()] = toe[i] && ankle[i];
        }
    }
    contacts
}

/// The runs of frames in which a foot stands: first frame, and one past the last.
pub fn stances(contacts: &[Contact], side: Side) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut start = None;
    for (i, contact) in contacts.iter().enumerate() {
        match (contact.stands[side.index()], start) {
            (true, None) => start = Some(i),
            (false, Some(first)) => {
                runs.push((first, i));
                start = None;
            }
            _ => {}
        }
    }
    runs.extend(start.map(|first| (first, contacts.len())));
    runs
}

/// Height of the lowest toe that is slow in each frame, m, at whatever height the ground is there; `None` where no toe is
/// slow and nearly as low as the lower one.
pub(crate) fn standing_toes(capture: &Capture) -> Vec<Option<f64>> {
    let size = capture.leg_length() / USUAL_LEG;
    let slow = (SLOW * size).max(SLOW_SHARE * capture.travel_speed());
    let frames = &capture.frames;
    let last = frames.len().saturating_sub(1);
    let toe = |i: usize, side| frames[i].of(side, Landmark::Toe);
    (0..frames.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            let lower = Side::BOTH.map(|side| toe(i, side).z);
            let lower = lower[0].min(lower[1]);
            let stands = |side: &Side| {
                let way = (toe(b, *side) - toe(a, *side)).norm();
                let speed = way * capture.fps / (b - a).max(1) as f64;
                speed < slow && toe(i, *side).z < lower + LOW * size
            };
            let standing = Side::BOTH.into_iter().filter(stands);
            standing.map(|side| toe(i, side).z).reduce(f64::min)
        })
        .collect()
}

/// Where a point is low and slow.
fn still(capture: &Capture, side: Side, landmark: Landmark, slow: f64, low: f64) -> Vec<bool> {
    let points: Vec<_> = capture
        .frames
        .iter()
        .map(|f| f.of(side, landmark))
        .collect();
    let mut heights: Vec<f64> = points.iter().map(|p| p.z).collect();
    let floor = signal::quantile(&mut heights, 0.05);
    let last = points.len().saturating_sub(1);
    (0..points.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            let speed = (points[b] - points[a]).norm() * capture.fps / (b - a).max(1) as f64;
            speed < slow && points[i].z < floor + low
        })
        .collect()
}

/// Turns runs of `value` that are too short into the opposite, except at the ends.
fn without_short_runs(values: &mut [bool], value: bool) {
    let mut start = 0;
    while start < values.len() {
        let length = values[start..]
            .iter()
            .take_while(|&&v| v == values[start])
            .count();
        let inside = start > 0 && start + length < values.len();
        if values[start] == value && inside && length < SHORTEST {
            values[start..start + length].fill(!value);
        }
        start += length;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::puppet;

    #[test]
    fn the_puppets_feet_stand_when_it_plants_them() {
        let capture = puppet::walking(50.0, 3.3);
        let contacts = detect(&capture);
        for side in Side::BOTH {
            let share = contacts.iter().filter(|c| c.stands[side.index()]).count() as f64
                / contacts.len() as f64;
            assert!((share - puppet::STANCE).abs() < 0.08, "{side:?}: {share}");
            assert!(stances(&contacts, side).len() >= 3);
        }
        // A walk never flies.
        assert!(contacts.iter().all(|c| c.stands[0] || c.stands[1]));
    }

    #[test]
    fn a_floor_that_rises_under_the_feet_is_measured() {
        let by = |slope: f64| {
            let mut capture = puppet::walking(50.0, 3.3);
            let last = capture.frames.len() - 1;
            for (i, frame) in capture.frames.iter_mut().enumerate() {
                for point in &mut frame.0 {
                    point.z += slope * i as f64 / last as f64;
                }
            }
            crate::Floor::of(&standing_toes(&capture)).unwrap().by
        };
        assert!(by(0.0) < 0.01, "{}", by(0.0));
        // 20 cm over 3.3 s, less up to half a second at either end.
        assert!((0.13..0.21).contains(&by(0.2)), "{}", by(0.2));
        assert!((0.13..0.21).contains(&by(-0.2)), "{}", by(-0.2));
    }

    #[test]
    fn flicker_is_not_a_step() {
        let mut values = [true, true, true, false, true, true, false, false];
        without_short_runs(&mut values, false);
        assert_eq!(values, [true, true, true, true, true, true, false, false]);
    }

    #[test]
    fn runs_are_half_open() {
        let stands = |left| Contact {
            stands: [left, false],
            flat: [false; 2],
        };
        let contacts = [true, true, false, true].map(stands);
        assert_eq!(stances(&contacts, Side::Left), [(0, 2), (3, 4)]);
        assert!(stances(&contacts, Side::Right).is_empty());
    }
}
