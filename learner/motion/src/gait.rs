//! The built-in reference motion: standing, walking and running of the G1, computed, not recorded.
//!
//! Separate from imported motion because it needs no file: published gait curves are bent until the
//! feet stay where they stand (see `gait/stride.rs`).

mod foot;
mod g1_fits;
mod harmonics;
mod leg;
mod normative;
mod run;
mod stride;
mod walk;

#[cfg(test)]
mod checks;

use crate::clip::{Clip, FRAME_SECONDS};
use g1::RobotState;
use nalgebra::Vector3;
use std::ops::RangeInclusive;
use stride::{Pose, Stride};

/// Speeds that can be walked, m/s.
pub const WALKING_SPEEDS: RangeInclusive<f64> = 0.4..=1.8;
/// Speeds that can be run, m/s.
pub const RUNNING_SPEEDS: RangeInclusive<f64> = 1.8..=2.7;

/// One second of standing still in the default pose.
pub fn stand() -> Clip {
    Clip {
        name: "stand".into(),
        frames: vec![RobotState::standing(); 50],
        cyclic: true,
        command: [0.0; 3],
        weight: 1.0,
    }
}

/// Walking straight ahead at a speed, m/s; `None` outside [`WALKING_SPEEDS`].
pub fn walk(speed: f64) -> Option<Clip> {
    if !WALKING_SPEEDS.contains(&speed) {
        return None;
    }
    let (period, strides) = whole_frames(normative::walking_period(speed));
    clip("walk", &walk::walk(speed, period)?, strides)
}

/// Running straight ahead at a speed, m/s; `None` outside [`RUNNING_SPEEDS`].
pub fn run(speed: f64) -> Option<Clip> {
    if !RUNNING_SPEEDS.contains(&speed) {
        return None;
    }
    let (period, strides) = whole_frames(normative::running_period(speed));
    clip("run", &run::run(speed, period)?, strides)
}

/// The stride's duration (s) changed a little, so that a few strides last a whole number of
/// frames, and how many strides that takes.
fn whole_frames(period: f64) -> (f64, usize) {
    let rounded = |strides: usize| {
        let frames = (period * strides as f64 / FRAME_SECONDS).round();
        frames * FRAME_SECONDS / strides as f64
    };
    let misfit = |strides: usize| (rounded(strides) - period).abs();
    let strides = (2..=4).fold(1, |best, n| if misfit(n) < misfit(best) { n } else { best });
    (rounded(strides), strides)
}

fn clip(gait: &str, stride: &Stride, strides: usize) -> Option<Clip> {
    let count = (stride.period * strides as f64 / FRAME_SECONDS).round() as usize;
    let frames: Option<Vec<_>> = (0..count)
        .map(|i| frame(stride, i as f64 * FRAME_SECONDS))
        .collect();
    Some(Clip {
        name: format!("{gait} {:.2} m/s", stride.speed),
        frames: frames?,
        cyclic: true,
        command: [stride.speed as f32, 0.0, 0.0],
        weight: 1.0,
    })
}

/// The state at a time, its velocities by central differences of the continuous motion.
fn frame(stride: &Stride, time: f64) -> Option<RobotState> {
    const H: f64 = 1e-3;
    let (behind, now, ahead) = (
        stride.pose(time - H)?,
        stride.pose(time)?,
        stride.pose(time + H)?,
    );
    let rate = |a: f64, b: f64| ((b - a) / (2.0 * H)) as f32;
    let travel = |pose: &Pose| pose.base.translation.vector;
    let turn = ahead.base.rotation * behind.base.rotation.inverse();
    let velocity: Vector3<f64> = (travel(&ahead) - travel(&behind)) / (2.0 * H);
    let spin: Vector3<f64> = turn.scaled_axis() / (2.0 * H);
    Some(RobotState {
        position: travel(&now).cast(),
        orientation: now.base.rotation.cast(),
        linear_velocity: velocity.cast(),
        angular_velocity: spin.cast(),
        joint_positions: now.joints.map(|q| q as f32),
        joint_velocities: std::array::from_fn(|j| rate(behind.joints[j], ahead.joints[j])),
    })
}
