//! Puts a robot's motion on the ground.
//!
//! Separate because a file's floor is anywhere: solvers keep feet some millimetres above it, recorders
//! begin at the pelvis.

use super::Row;
use super::leg::{LEGS, base};
use crate::clip::FRAME_SECONDS;
use g1::kinematics::{forward, lowest_foot_point, sole_points};
use nalgebra::Point3;
use retarget::{Floor, signal};

/// A sole stands whose lowest corner is slower than this, m/s, or than this share of the robot's own
/// speed: feet of files slip.
const SLOW: f64 = 0.3;
const SLOW_SHARE: f64 = 0.15;
/// And no higher than this above where slow soles are lowest, m: a foot that is held up does not stand.
const LOW: f64 = 0.06;
/// Fewer soles than this (a foot for a tenth of a second) say nothing of the ground.
const ENOUGH: usize = 5;
/// A sole that is no deeper than this below the ground is on it, m: lifting it too would lift the robot off
/// the soles that stand, which are not all at the same height either.
const ON_GROUND: f64 = 0.003;
/// Less than this is not worth a word, m.
const NOTICED: f64 = 1e-4;
/// Frames over which lifting is smoothed, to both sides.
const REACH: usize = 1;

/// Moves rows at 50 Hz up or down as a whole until the middle one of the soles that stand is on the ground,
/// then lifts what is deeper than [`ON_GROUND`] still, smoothly. One shift for all keeps the flight of a run.
///
/// Gives how uneven the ground under the soles that stand was before: lifting hides it.
pub(super) fn put(rows: &mut [Row], decisions: &mut Vec<String>) -> Option<Floor> {
    let pairs = slow_soles(rows);
    let uneven = Floor::of(&pairs.iter().map(Pair::ground).collect::<Vec<_>>());
    let mut standing = standing(&pairs);
    let (floor, told) = if standing.len() < ENOUGH {
        let mut lowest: Vec<f64> = rows.iter().map(lowest).collect();
        let tenth = signal::quantile(&mut lowest, 0.1);
        (tenth, "a tenth of the frames: no sole stands".to_owned())
    } else {
        let count = standing.len();
        let told = format!("the median of the soles that stand ({count})");
        (signal::median(&mut standing), told)
    };
    for row in rows.iter_mut() {
        row.position.z -= floor;
    }
    let sinking = |row: &Row| (-lowest(row) - ON_GROUND).max(0.0);
    let sinking: Vec<f64> = rows.iter().map(sinking).collect();
    let lift = signal::envelope(&sinking, REACH);
    for (row, lift) in rows.iter_mut().zip(&lift) {
        row.position.z += lift;
    }
    let most = lift.into_iter().fold(0.0, f64::max);
    if floor.abs().max(most) < NOTICED {
        return uneven;
    }
    decisions.push(format!(
        "ground: moved by {:+.1} mm, by {told}; lifted by up to {:.1} mm where a sole sank",
        -1000.0 * floor,
        1000.0 * most
    ));
    uneven
}

/// The soles between two frames.
struct Pair {
    /// Heights of the lowest corners of the soles that are slow, m.
    slow: Vec<f64>,
    /// Height of the lower sole, slow or not, m.
    lower: f64,
}

impl Pair {
    /// The lowest sole that stands, unless it is held up.
    fn ground(&self) -> Option<f64> {
        let standing = self.slow.iter().copied();
        standing
            .filter(|height| *height < self.lower + LOW)
            .reduce(f64::min)
    }
}

/// The soles between all frames.
fn slow_soles(rows: &[Row]) -> Vec<Pair> {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Vec::new();
    };
    let seconds = FRAME_SECONDS * (rows.len() - 1) as f64;
    let speed = (last.position - first.position).xy().norm() / seconds.max(FRAME_SECONDS);
    let slow = SLOW.max(SLOW_SHARE * speed);
    let soles: Vec<[[Point3<f64>; 4]; 2]> = rows.iter().map(soles).collect();
    let of = |pair: &[[[Point3<f64>; 4]; 2]]| {
        let mut found = Pair {
            slow: Vec::new(),
            lower: f64::INFINITY,
        };
        for (a, b) in pair[0].iter().zip(&pair[1]) {
            let height = |k: usize| (a[k].z + b[k].z) / 2.0;
            let bearing = (0..4).min_by(|&j, &k| height(j).total_cmp(&height(k)));
            let Some(k) = bearing else { continue };
            found.lower = found.lower.min(height(k));
            if (b[k] - a[k]).norm() / FRAME_SECONDS < slow {
                found.slow.push(height(k));
            }
        }
        found
    };
    soles.windows(2).map(of).collect()
}

/// Heights of the lowest corners of soles that stand, between frames, m.
fn standing(pairs: &[Pair]) -> Vec<f64> {
    let mut heights: Vec<f64> = pairs.iter().flat_map(|pair| pair.slow.clone()).collect();
    let lowest = signal::quantile(&mut heights, 0.05);
    heights.retain(|height| *height < lowest + LOW);
    heights
}

fn soles(row: &Row) -> [[Point3<f64>; 4]; 2] {
    let bodies = forward(&base(row), &row.joints);
    LEGS.map(|(_, foot)| sole_points(&bodies, foot))
}

/// Height of the lowest corner of both soles, m.
fn lowest(row: &Row) -> f64 {
    lowest_foot_point(&forward(&base(row), &row.joints))
}

#[cfg(test)]
#[path = "ground_tests.rs"]
mod tests;
