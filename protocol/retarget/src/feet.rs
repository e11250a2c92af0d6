//! Where the robot's feet go: planted where the human's stand, and never through the ground.
//!
//! Separate because it is what retargeting by directions alone gets wrong. In stance a foot is a
//! rigid plate that rolls over its heel edge or its toe edge without slipping; its place is the one
//! that changes the directions' own path least. Between stances the correction goes from the one to
//! the next without a step in speed, and the sole is lifted where it would scuff.

use crate::capture::Side;
use crate::contact::{Contact, stances};
use crate::posture::{Free, Soles};
use crate::{pelvis, signal, sole};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// Where a foot shall be in a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foothold {
    /// Its frame in the world.
    pub frame: Isometry3<f64>,
    /// How firmly it is to be there: 1 in stance, less and less in swing, down to 0.
    pub firm: f64,
    /// The point of it that has its place, in its own frame, m: the edge over which it rolls, or its ankle.
    pub pivot: Vector3<f64>,
    /// How far it stands on an edge alone, 0 to 1: its pitch is then its own.
    pub tipped: f64,
    /// Height that its sole is to have at least, m.
    pub clearance: f64,
}

/// What the second pass is to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// How much the pelvis is moved in each frame, m.
    pub shift: Vec<Vector3<f64>>,
    /// Where the feet shall be in each frame.
    pub feet: Vec<[Foothold; 2]>,
    /// Stances that were locked.
    pub stances: usize,
    /// Farthest that locking moved a foot over the ground, m.
    pub moved: f64,
    /// Most that the pelvis was lowered because a leg did not reach, m.
    pub lowered: f64,
    /// Farthest that a foot is kept from its place because the leg does not reach all the same, m.
    pub unreached: f64,
}

/// Height of the sole in the middle of swing, at least, m.
const CLEARANCE: f64 = 0.015;
/// A correction with a slope needs a gap of at most this many frames: longer ones would swing out.
const SLOPED_GAP: usize = 30;
/// Frames after and before a stance in which a swinging foot is not yet, or no longer, free of its place.
const RELEASE: (f64, f64) = (3.0, 6.0);

/// Plans the feet of a clip.
pub fn plan(free: &[Free], contacts: &[Contact]) -> Plan {
    let standing = Side::BOTH.map(|side| stances(contacts, side));
    let soles = Side::BOTH.map(|side| planted(free, side, &standing[side.index()]));
    let carried = pelvis::carry(free, &soles);
    let paths = Side::BOTH.map(|side| path(free, side, &carried.shift, &soles[side.index()]));
    let (paths, unreached) = reached(free, &carried.shift, paths);
    let moved = (0..2).flat_map(|s| {
        let gap = move |(sole, free): (&Option<Isometry3<f64>>, &Free)| {
            let place = free.feet[s].translation.vector;
            sole.map_or(0.0, |sole| (sole.translation.vector - place).xy().norm())
        };
        soles[s].iter().zip(free).map(gap)
    });
    Plan {
        feet: (0..free.len())
            .map(|i| [paths[0][i], paths[1][i]])
            .collect(),
        stances: standing.iter().map(Vec::len).sum(),
        moved: moved.fold(0.0, f64::max),
        lowered: carried.lowered,
        unreached,
        shift: carried.shift,
    }
}

/// The paths with every foot within its leg's reach, and the farthest that one was moved for it.
fn reached(
    free: &[Free],
    shift: &[Vector3<f64>],
    mut paths: [Vec<Foothold>; 2],
) -> ([Vec<Foothold>; 2], f64) {
    let mut most: f64 = 0.0;
    for (s, path) in paths.iter_mut().enumerate() {
        for ((foot, free), shift) in path.iter_mut().zip(free).zip(shift) {
            let back = pelvis::overreach(&(free.hips[s] + shift), &foot.frame);
            foot.frame.translation.vector += back;
            if foot.firm == 1.0 {
                most = most.max(back.norm());
            }
        }
    }
    (paths, most)
}

/// Where a foot stands: it rolls over its edges in the place that moves its own path least.
fn planted(free: &[Free], side: Side, stances: &[(usize, usize)]) -> Soles {
    let s = side.index();
    let mut soles = vec![None; free.len()];
    for &(first, end) in stances {
        let toes: Vec<Vector3<f64>> = free[first..end]
            .iter()
            .map(|f| f.feet[s].rotation * Vector3::x())
            .collect();
        let rolling = sole::rolling(&toes);
        let mut anchor: Vector3<f64> = rolling
            .iter()
            .zip(&free[first..end])
            .map(|(sole, free)| free.feet[s].translation.vector - sole.translation.vector)
            .sum::<Vector3<f64>>()
            / (end - first) as f64;
        anchor.z = 0.0; // the ground
        for (sole, mut foot) in soles[first..end].iter_mut().zip(rolling) {
            foot.translation.vector += anchor;
            *sole = Some(foot);
        }
    }
    soles
}

/// What the frames of a foot's path say of how it is held.
fn held(path: &[Isometry3<f64>], soles: &Soles) -> Vec<Foothold> {
    let mut feet: Vec<Foothold> = path
        .iter()
        .zip(soles)
        .map(|(&frame, sole)| Foothold {
            frame,
            firm: if sole.is_some() { 1.0 } else { 0.0 },
            pivot: sole.map_or_else(Vector3::zeros, |sole| sole::pivot(&sole.rotation)),
            tipped: sole.map_or(0.0, |sole| sole::tipped(&sole.rotation)),
            clearance: 0.0,
        })
        .collect();
    for (first, end) in swings(soles) {
        // What the stance beside it has fades on both sides.
        let (before, after) = (
            first.checked_sub(1),
            Some(end).filter(|&end| end < path.len()),
        );
        for i in first..end {
            let fade = |from: usize, within: f64| (1.0 - i.abs_diff(from) as f64 / within, from);
            let ends = [
                before.map(|b| fade(b, RELEASE.0)),
                after.map(|a| fade(a, RELEASE.1)),
            ];
            let nearest = ends
                .into_iter()
                .flatten()
                .max_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((firm, from)) = nearest.filter(|(firm, _)| *firm > 0.0) {
                let stance = feet[from];
                feet[i].firm = firm;
                feet[i].pivot = stance.pivot * firm;
                feet[i].tipped = stance.tipped;
            }
            feet[i].clearance = CLEARANCE * arch(i - first, end - first);
        }
    }
    feet
}

/// The runs of frames in which a foot does not stand: first frame, and one past the last.
fn swings(soles: &Soles) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut first = 0;
    while first < soles.len() {
        let length = soles[first..].iter().take_while(|s| s.is_none()).count();
        if length > 0 {
            runs.push((first, first + length));
        }
        first += length.max(1);
    }
    runs
}

/// From 0 at both ends of a swing to 1 in its middle.
fn arch(i: usize, length: usize) -> f64 {
    (PI * (i + 1) as f64 / (length + 1) as f64).sin().powi(2)
}

/// The path of a foot: on its soles, and between them where the pelvis carries it, corrected from the
/// one to the next.
fn path(free: &[Free], side: Side, shift: &[Vector3<f64>], soles: &Soles) -> Vec<Foothold> {
    let place = |i: usize| free[i].feet[side.index()].translation.vector + shift[i];
    let turn = |i: usize| free[i].feet[side.index()].rotation;
    // Six series: the correction of place, then of orientation as a rotation vector.
    let mut correction: [Vec<Option<f64>>; 6] = std::array::from_fn(|_| vec![None; free.len()]);
    for (i, sole) in soles.iter().enumerate() {
        if let Some(sole) = sole {
            let gap = sole.translation.vector - place(i);
            let twist = (sole.rotation * turn(i).inverse()).scaled_axis();
            for axis in 0..3 {
                correction[axis][i] = Some(gap[axis]);
                correction[axis + 3][i] = Some(twist[axis]);
            }
        }
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
    held(&path, soles)
}

/// Lifts what would scuff between stances, most in the middle.
fn lift_swings(path: &mut [Isometry3<f64>], soles: &Soles) {
    for (first, end) in swings(soles) {
        for (i, foot) in path[first..end].iter_mut().enumerate() {
            let low = foot.translation.z + sole::lowest(&foot.rotation);
            let arch = arch(i, end - first);
            let (needed, width) = (CLEARANCE * arch, 0.01 * arch);
            // The larger of both, rounded where they cross.
            let high = 0.5 * (low + needed + ((low - needed).powi(2) + width * width).sqrt());
            foot.translation.z += high - low;
        }
    }
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
