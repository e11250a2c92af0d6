//! A standing sole: a rigid plate that rolls over its heel edge or its toe edge without slipping.
//!
//! Separate because it is the geometry of a foot on the ground alone.

use g1::links::{SOLE_CORNERS, SOLE_DEPTH};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// Below about this pitch a standing foot is laid flat, rad: a plate that tips from edge to edge would
/// throw its ankle up and down.
const FLAT: f64 = 0.08;
/// From this pitch on a foot stands on an edge, rad.
const TIPPED: f64 = 0.25;

/// The frames of a foot in a stance whose toe points so, in the world, m: level across, yaw held,
/// lowest on the ground, and where the first frame's ankle is at the origin.
pub(crate) fn rolling(toes: &[Vector3<f64>]) -> Vec<Isometry3<f64>> {
    let ahead: Vector3<f64> = toes.iter().sum();
    let yaw = ahead.y.atan2(ahead.x);
    let mut way = Vector3::zeros();
    let mut before: Option<UnitQuaternion<f64>> = None;
    toes.iter()
        .map(|toe| {
            let forward = toe.x * yaw.cos() + toe.y * yaw.sin();
            let pitch = laid((-toe.z).atan2(forward));
            let now = UnitQuaternion::from_euler_angles(0.0, pitch, yaw);
            if let Some(before) = before {
                let edge = edge(pitch_of(&before) + pitch_of(&now));
                way += before * edge - now * edge;
            }
            before = Some(now);
            let ankle = Vector3::new(way.x, way.y, -lowest(&now));
            Isometry3::from_parts(ankle.into(), now)
        })
        .collect()
}

/// Height of the lowest corner of the sole above the ankle, m (negative).
pub(crate) fn lowest(turn: &UnitQuaternion<f64>) -> f64 {
    SOLE_CORNERS
        .iter()
        .map(|&corner| (turn * Vector3::from(corner)).z)
        .fold(f64::INFINITY, f64::min)
}

/// The point of a standing foot that has its place, in its own frame, m: the middle of the edge on which
/// it is tipped, the ankle of a flat one.
pub(crate) fn pivot(turn: &UnitQuaternion<f64>) -> Vector3<f64> {
    edge(pitch_of(turn)) * tipped(turn)
}

/// How far a standing foot is on an edge alone, from 0 (flat) to 1.
pub(crate) fn tipped(turn: &UnitQuaternion<f64>) -> f64 {
    let u = ((pitch_of(turn).abs() - FLAT) / (TIPPED - FLAT)).clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}

/// A pitch with what is small laid flat, smoothly: the height of the ankle over the edge then has no
/// kink where heel and toe change.
fn laid(pitch: f64) -> f64 {
    pitch.powi(3) / (pitch * pitch + FLAT * FLAT)
}

/// The middle of the sole's edge over which a foot of this pitch (toe down positive) rolls.
fn edge(pitch: f64) -> Vector3<f64> {
    let corner = SOLE_CORNERS[if pitch > 0.0 { 2 } else { 0 }];
    Vector3::new(corner[0], 0.0, -SOLE_DEPTH)
}

fn pitch_of(turn: &UnitQuaternion<f64>) -> f64 {
    -(turn * Vector3::x()).z
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pitches_are_laid_flat_and_large_ones_kept() {
        assert_eq!(laid(0.0), 0.0);
        // 0.01³/(0.01² + 0.08²) = 1e-6/6.5e-3
        assert!((laid(0.01) - 1e-6 / 6.5e-3).abs() < 1e-12);
        // 0.8³/(0.8² + 0.08²) = 0.8/1.01
        assert!((laid(-0.8) + 0.8 / 1.01).abs() < 1e-12);
    }

    #[test]
    fn a_foot_that_rises_over_its_toe_keeps_the_toe_in_place() {
        let toes: Vec<Vector3<f64>> = (0..10)
            .map(|i| 0.1 * f64::from(i))
            .map(|pitch| Vector3::new(pitch.cos(), 0.0, -pitch.sin()))
            .collect();
        for foot in rolling(&toes) {
            let toe = foot * nalgebra::Point3::new(0.12, 0.0, -SOLE_DEPTH);
            assert!(
                (toe - nalgebra::Point3::new(0.12, 0.0, 0.0)).norm() < 1e-9,
                "{toe}"
            );
        }
    }
}
