//! Where the robot's feet go: planted where the human's stand, and never through the ground.
//!
//! Separate because it is what retargeting by directions alone gets wrong. In stance a foot is a
//! rigid plate that rolls over its heel edge or its toe edge without slipping; its place is the one
//! that changes the directions' own path least. Between stances the correction goes from the one to
//! the next without a step in speed, and the sole is lifted where it would scuff. The pelvis is
//! carried so high that standing feet reach the ground, and no higher than the legs reach.

use crate::capture::Side;
use crate::contact::{Contact, stances};
use crate::signal;
use g1::links::{SOLE_CORNERS, SOLE_DEPTH};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// The frames that directions alone lead to: where feet and hips are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Free {
    /// The feet in the world, by [`Side::index`].
    pub feet: [Isometry3<f64>; 2],
    /// The hip roll joints in the world, m.
    pub hips: [Vector3<f64>; 2],
}

/// What the second pass is to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// How much the pelvis is raised in each frame, m.
    pub raise: Vec<f64>,
    /// Where the feet are in each frame.
    pub feet: Vec<[Isometry3<f64>; 2]>,
    /// Stances that were locked.
    pub stances: usize,
    /// Farthest that locking moved a foot over the ground, m.
    pub moved: f64,
    /// Most that the pelvis was lowered because a leg did not reach, m.
    pub lowered: f64,
}

/// Height of the sole in the middle of swing, at least, m.
const CLEARANCE: f64 = 0.015;
/// Hip roll joint to ankle pitch joint of a nearly straight leg, m, and ankle pitch above ankle roll.
const REACH: f64 = 0.6075;
const ANKLE: f64 = 0.0176;
/// Gaussian over the pelvis' height correction, frames.
const RAISE_SMOOTHING: f64 = 3.0;
/// A correction with a slope needs a gap of at most this many frames: longer ones would swing out.
const SLOPED_GAP: usize = 30;

/// Plans the feet of a clip.
pub fn plan(free: &[Free], contacts: &[Contact]) -> Plan {
    let standing = Side::BOTH.map(|side| stances(contacts, side));
    let soles = Side::BOTH.map(|side| standing_soles(free, side, &standing[side.index()]));
    let mut raise = raised(free, &soles);
    let mut plan = Plan {
        raise: Vec::new(),
        feet: vec![[Isometry3::identity(); 2]; free.len()],
        stances: standing.iter().map(Vec::len).sum(),
        moved: 0.0,
        lowered: 0.0,
    };
    for side in Side::BOTH {
        let s = side.index();
        let (path, moved) = foot_path(free, side, &raise, &standing[s], &soles[s]);
        plan.moved = plan.moved.max(moved);
        for (feet, foot) in plan.feet.iter_mut().zip(path) {
            feet[s] = foot;
        }
    }
    let excess: Vec<f64> = (0..free.len())
        .map(|i| {
            let too_far = |s: usize| beyond_reach(&free[i].hips[s], raise[i], &plan.feet[i][s]);
            too_far(0).max(too_far(1))
        })
        .collect();
    for (raise, lower) in raise.iter_mut().zip(signal::envelope(&excess, 3)) {
        *raise -= lower;
        plan.lowered = plan.lowered.max(lower);
    }
    plan.raise = raise;
    plan
}

/// Orientation of a standing foot (level across, yaw held) and the way of its ankle relative to the
/// first frame of the stance; `None` where it does not stand.
fn standing_soles(
    free: &[Free],
    side: Side,
    stances: &[(usize, usize)],
) -> Vec<Option<Isometry3<f64>>> {
    let mut soles = vec![None; free.len()];
    for &(first, end) in stances {
        let toes: Vec<Vector3<f64>> = free[first..end]
            .iter()
            .map(|f| f.feet[side.index()].rotation * Vector3::x())
            .collect();
        let ahead: Vector3<f64> = toes.iter().sum();
        let yaw = ahead.y.atan2(ahead.x);
        let turn = |toe: &Vector3<f64>| {
            let forward = toe.x * yaw.cos() + toe.y * yaw.sin();
            UnitQuaternion::from_euler_angles(0.0, (-toe.z).atan2(forward), yaw)
        };
        let mut way = Vector3::zeros();
        let mut before: Option<UnitQuaternion<f64>> = None;
        for (i, toe) in toes.iter().enumerate() {
            let now = turn(toe);
            if let Some(before) = before {
                let edge = edge(pitch(&before) + pitch(&now));
                way += before * edge - now * edge;
            }
            let height = -lowest(&now);
            let ankle = Vector3::new(way.x, way.y, height);
            soles[first + i] = Some(Isometry3::from_parts(ankle.into(), now));
            before = Some(now);
        }
    }
    soles
}

/// The middle of the sole's edge over which a foot of this pitch (toe down positive) rolls.
fn edge(pitch: f64) -> Vector3<f64> {
    let corner = SOLE_CORNERS[if pitch > 0.0 { 2 } else { 0 }];
    Vector3::new(corner[0], 0.0, -SOLE_DEPTH)
}

fn pitch(turn: &UnitQuaternion<f64>) -> f64 {
    -(turn * Vector3::x()).z
}

/// Height of the lowest corner of the sole above the ankle, m (negative).
fn lowest(turn: &UnitQuaternion<f64>) -> f64 {
    SOLE_CORNERS
        .iter()
        .map(|&corner| (turn * Vector3::from(corner)).z)
        .fold(f64::INFINITY, f64::min)
}

/// How much the pelvis must rise so that the standing foot which asks for less reaches the ground.
fn raised(free: &[Free], soles: &[Vec<Option<Isometry3<f64>>>; 2]) -> Vec<f64> {
    let asked: Vec<Option<f64>> = (0..free.len())
        .map(|i| {
            let need = |s: usize| {
                soles[s][i].map(|sole| sole.translation.z - free[i].feet[s].translation.z)
            };
            [need(0), need(1)].into_iter().flatten().reduce(f64::min)
        })
        .collect();
    let mut lows: Vec<f64> = free
        .iter()
        .flat_map(|f| f.feet)
        .map(|foot| -(foot.translation.z + lowest(&foot.rotation)))
        .collect();
    // A clip in which no foot ever stands: the lowest twentieth touches the ground.
    let otherwise = signal::quantile(&mut lows, 0.95);
    signal::gaussian(&signal::filled(&asked, otherwise), RAISE_SMOOTHING)
}

/// The path of a foot, and how far locking moved it at most.
fn foot_path(
    free: &[Free],
    side: Side,
    raise: &[f64],
    stances: &[(usize, usize)],
    soles: &[Option<Isometry3<f64>>],
) -> (Vec<Isometry3<f64>>, f64) {
    let place =
        |i: usize| free[i].feet[side.index()].translation.vector + Vector3::new(0.0, 0.0, raise[i]);
    let turn = |i: usize| free[i].feet[side.index()].rotation;
    // Six series: the correction of place, then of orientation as a rotation vector.
    let mut correction: [Vec<Option<f64>>; 6] = std::array::from_fn(|_| vec![None; free.len()]);
    let mut moved: f64 = 0.0;
    for &(first, end) in stances {
        let sole = |i: usize| soles[i].expect("a stance has soles");
        let mut anchor: Vector3<f64> = (first..end)
            .map(|i| place(i) - sole(i).translation.vector)
            .sum::<Vector3<f64>>()
            / (end - first) as f64;
        anchor.z = 0.0; // the ground
        (first..end).for_each(|i| {
            let shift = anchor + sole(i).translation.vector - place(i);
            let twist = (sole(i).rotation * turn(i).inverse()).scaled_axis();
            moved = moved.max(shift.xy().norm());
            for axis in 0..3 {
                correction[axis][i] = Some(shift[axis]);
                correction[axis + 3][i] = Some(twist[axis]);
            }
        });
    }
    let correction = correction.map(|series| bridged(&series));
    let vector = |i: usize, from: usize| Vector3::from_fn(|axis, _| correction[from + axis][i]);
    let mut path: Vec<Isometry3<f64>> = (0..free.len())
        .map(|i| {
            let rotation = UnitQuaternion::from_scaled_axis(vector(i, 3)) * turn(i);
            Isometry3::from_parts(Translation3::from(place(i) + vector(i, 0)), rotation)
        })
        .collect();
    lift_swings(&mut path, soles);
    (path, moved)
}

/// Lifts what would scuff between stances, most in the middle.
fn lift_swings(path: &mut [Isometry3<f64>], soles: &[Option<Isometry3<f64>>]) {
    let mut first = 0;
    while first < path.len() {
        let length = soles[first..].iter().take_while(|s| s.is_none()).count();
        for (i, foot) in path[first..first + length].iter_mut().enumerate() {
            let arch = (PI * (i + 1) as f64 / (length + 1) as f64).sin().powi(2);
            let low = foot.translation.z + lowest(&foot.rotation);
            let (needed, width) = (CLEARANCE * arch, 0.01 * arch);
            // The larger of both, rounded where they cross.
            let high = 0.5 * (low + needed + ((low - needed).powi(2) + width * width).sqrt());
            foot.translation.z += high - low;
        }
        first += length.max(1);
    }
}

/// How much lower the hip must be for the ankle to be within reach, m.
fn beyond_reach(hip: &Vector3<f64>, raise: f64, foot: &Isometry3<f64>) -> f64 {
    let ankle = foot.translation.vector + foot.rotation * Vector3::new(0.0, 0.0, ANKLE);
    let away = (hip - ankle).xy().norm();
    let reach = (REACH * REACH - away * away).max(0.0).sqrt();
    (hip.z + raise - ankle.z - reach).max(0.0)
}

/// Gaps filled by cubics that continue the slopes on both sides; ends held.
fn bridged(series: &[Option<f64>]) -> Vec<f64> {
    let slope = |i: usize, j: usize| match (series[i], series[j]) {
        (Some(a), Some(b)) => b - a,
        _ => 0.0,
    };
    let mut out = signal::filled(series, 0.0);
    let mut i = 0;
    while i < series.len() {
        let length = series[i..].iter().take_while(|v| v.is_none()).count();
        let (before, after) = (i.checked_sub(1), i + length);
        if let (Some(a), true, 1..=SLOPED_GAP) = (before, after < series.len(), length) {
            let span = (after - a) as f64;
            let da = a.checked_sub(1).map_or(0.0, |earlier| slope(earlier, a)) * span;
            let db = if after + 1 < series.len() {
                slope(after, after + 1) * span
            } else {
                0.0
            };
            for k in a + 1..after {
                out[k] = cubic((k - a) as f64 / span, out[a], da, out[after], db);
            }
        } else if let (Some(a), true) = (before, after < series.len()) {
            let span = (after - a) as f64;
            for k in a + 1..after {
                out[k] = cubic((k - a) as f64 / span, out[a], 0.0, out[after], 0.0);
            }
        }
        i += length.max(1);
    }
    out
}

/// Cubic with values a, b and slopes da, db at u = 0 and u = 1.
fn cubic(u: f64, a: f64, da: f64, b: f64, db: f64) -> f64 {
    let (u2, u3) = (u * u, u * u * u);
    a * (2.0 * u3 - 3.0 * u2 + 1.0)
        + da * (u3 - 2.0 * u2 + u)
        + b * (3.0 * u2 - 2.0 * u3)
        + db * (u3 - u2)
}

#[cfg(test)]
mod tests;
