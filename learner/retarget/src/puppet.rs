//! A stick figure whose walk is known, for tests.

use crate::capture::{Capture, Landmark, Landmarks, Side};
use nalgebra::{Point3, Vector3};
use std::f64::consts::{PI, TAU};

/// Thigh and shin together, m.
pub(crate) const LEG: f64 = 0.84;
/// m/s along x.
pub(crate) const SPEED: f64 = 1.1;
/// Share of the stride that a foot stands.
pub(crate) const STANCE: f64 = 0.6;
const PERIOD: f64 = 1.1;
const HIP_HEIGHT: f64 = 0.80;
const ANKLE_HEIGHT: f64 = 0.08;

/// Walks along x: feet planted exactly in stance, shoulders above hips, arms against legs.
pub(crate) fn walking(fps: f64, seconds: f64) -> Capture {
    let count = (fps * seconds).round() as usize + 1;
    let frames = (0..count).map(|i| frame(i as f64 / fps)).collect();
    Capture { fps, frames }
}

fn frame(time: f64) -> Landmarks {
    let mut points = [Point3::origin(); crate::LANDMARKS];
    for side in Side::BOTH {
        let left = if side == Side::Left { 1.0 } else { -1.0 };
        let cycle = time / PERIOD + if side == Side::Left { 0.0 } else { 0.5 };
        let hip = Point3::new(SPEED * time, 0.1 * left, HIP_HEIGHT);
        let (ankle, pitch) = foot(cycle, cycle * PERIOD - time, 0.1 * left);
        let swing = 0.3 * (TAU * cycle).cos();
        let shoulder = Point3::new(hip.x, 0.2 * left, HIP_HEIGHT + 0.5);
        let elbow = shoulder + 0.28 * Vector3::new((-swing).sin(), 0.1 * left, -swing.cos());
        let wrist = elbow + 0.25 * Vector3::new((0.4 - swing).sin(), 0.0, -(0.4 - swing).cos());
        let toe = ankle + Vector3::new(0.13 * pitch.cos(), 0.0, -0.07 - 0.13 * pitch.sin());
        for (landmark, point) in Landmark::ALL.into_iter().zip([
            hip,
            knee(hip, ankle),
            ankle,
            toe,
            shoulder,
            elbow,
            wrist,
        ]) {
            points[Landmarks::index(side, landmark)] = point;
        }
    }
    Landmarks(points)
}

/// Ankle and pitch (toe down) at a phase that counts strides; `shift` is the time between the
/// phase's clock and the body's.
fn foot(cycle: f64, shift: f64, y: f64) -> (Point3<f64>, f64) {
    let (stride, phase) = (SPEED * PERIOD, cycle.rem_euclid(1.0));
    // Half of stance is ahead of the hip, half behind.
    let planted = (cycle.floor() + STANCE / 2.0) * stride - SPEED * shift;
    if phase < STANCE {
        return (Point3::new(planted, y, ANKLE_HEIGHT), 0.0);
    }
    let u = (phase - STANCE) / (1.0 - STANCE);
    let way = u * u * (3.0 - 2.0 * u);
    let lift = (PI * u).sin().powi(2);
    let ankle = Point3::new(planted + stride * way, y, ANKLE_HEIGHT + 0.1 * lift);
    (ankle, 0.4 * lift)
}

/// The knee of a leg of two equal bones, bent forward.
fn knee(hip: Point3<f64>, ankle: Point3<f64>) -> Point3<f64> {
    let line = ankle - hip;
    let bend = ((LEG / 2.0).powi(2) - line.norm_squared() / 4.0).sqrt();
    let forward = Vector3::y().cross(&line).normalize();
    hip + line / 2.0 - forward * bend
}
