//! The built-in reference motion of the G1, computed, not recorded: standing; walking ahead and
//! backward, sideways, on curves, on the spot; running; starting and stopping.
//!
//! Separate from imported motion because it needs no file: published gait curves are bent until the
//! feet stay where they stand (see `gait/stride.rs`).
//!
//! Every gait goes along one velocity: forward, lateral, yaw rate. What the tests measure over a grid
//! of them (forward −0.6–1.8 m/s, running 1.8–2.7; lateral up to ±0.4 m/s, turning up to ±1 rad/s, both
//! together up to 0.2 m/s and 0.5 rad/s): root mean square slip of a standing foot, height of the sole
//! in the middle of swing, distance between the soles, distance of a joint to its limit, and joint
//! speed as a share of the motor's; the worst of all clips of a kind.
//!
//! | clips | number | slip, m/s | clearance, cm | soles apart, cm | to a limit, rad | motor |
//! | --- | --- | --- | --- | --- | --- | --- |
//! | walk straight | 6 | 0.085 | 4.1 | 12.0 | 0.144 | 0.61 |
//! | walk backward | 2 | 0.055 | 4.2 | 12.0 | 0.143 | 0.27 |
//! | walk turning | 24 | 0.098 | 4.0 | 9.8 | 0.050 | 0.69 |
//! | walk aside | 24 | 0.091 | 3.9 | 8.9 | 0.018 | 0.62 |
//! | walk both | 16 | 0.093 | 4.1 | 9.3 | 0.017 | 0.65 |
//! | run straight | 3 | 0.049 | 5.0 | 11.0 | 0.167 | 1.09 |
//! | run turning | 9 | 0.052 | 5.0 | 10.4 | 0.006 | 1.09 |
//! | run aside | 9 | 0.058 | 5.0 | 8.3 | 0.127 | 1.10 |
//! | run both | 6 | 0.050 | 5.0 | 9.6 | 0.027 | 1.10 |
//! | start straight | 3 | 0.053 | 4.1 | 12.0 | 0.144 | 0.38 |
//! | start backward | 1 | 0.034 | 4.2 | 12.9 | 0.144 | 0.19 |
//! | start turning | 12 | 0.054 | 4.1 | 13.6 | 0.084 | 0.31 |
//! | start aside | 12 | 0.046 | 4.1 | 9.5 | 0.033 | 0.47 |
//! | start both | 8 | 0.023 | 4.2 | 11.9 | 0.021 | 0.35 |
//! | stop straight | 3 | 0.040 | 4.1 | 12.0 | 0.144 | 0.33 |
//! | stop backward | 1 | 0.032 | 4.3 | 13.0 | 0.144 | 0.23 |
//! | stop turning | 12 | 0.076 | 4.1 | 13.1 | 0.095 | 0.39 |
//! | stop aside | 12 | 0.076 | 4.0 | 9.5 | 0.023 | 0.34 |
//! | stop both | 8 | 0.080 | 4.1 | 11.7 | 0.018 | 0.36 |
//!
//! The least distances to a limit are the ankles' roll, 0.26 rad to either side, and what they forbid
//! is not made: full speed aside with a full turn, and both in a fast walk or run.

mod bounce;
mod foot;
mod foothold;
mod g1_fits;
mod harmonics;
mod leg;
mod normative;
mod run;
mod stride;
mod transition;
mod walk;
mod way;

#[cfg(test)]
mod checks;

use crate::clip::{Clip, FRAME_SECONDS};
use g1::mirror::mirror_state;
use g1::{JOINT_TABLE, RobotState};
use nalgebra::Vector3;
use std::ops::RangeInclusive;
use stride::{Pose, Stride};

pub use crate::velocity::Velocity;

/// Forward speeds that can be walked, started to and stopped from, m/s; negative is backward.
pub const WALKING_SPEEDS: RangeInclusive<f64> = -0.6..=1.8;
/// Forward speeds that can be run, m/s.
pub const RUNNING_SPEEDS: RangeInclusive<f64> = 1.8..=2.7;
/// Speeds to the left at which any gait can go, m/s.
pub const LATERAL_SPEEDS: RangeInclusive<f64> = -0.4..=0.4;
/// Rates at which any gait can turn to the left, rad/s.
pub const YAW_RATES: RangeInclusive<f64> = -1.0..=1.0;

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

/// Walking at a velocity, or straight ahead at a speed in m/s; 0 is stepping on the spot.
///
/// `None` outside [`WALKING_SPEEDS`], [`LATERAL_SPEEDS`] or [`YAW_RATES`], and where a joint would
/// leave its range: a fast walk on a tight curve.
pub fn walk(velocity: impl Into<Velocity>) -> Option<Clip> {
    let velocity = velocity.into();
    let (stride, strides) = walking(velocity)?;
    let seconds = strides as f64 * stride.way.period;
    let frames = frames(&stride, (seconds / FRAME_SECONDS).round() as usize)?;
    Some(clip("walk", velocity, frames, true))
}

/// Running at a velocity, or straight ahead at a speed in m/s; `None` outside [`RUNNING_SPEEDS`] and
/// as in [`walk`].
pub fn run(velocity: impl Into<Velocity>) -> Option<Clip> {
    let velocity = velocity.into();
    if !within(&velocity, RUNNING_SPEEDS) {
        return None;
    }
    let (period, strides) = whole_frames(&velocity, normative::running_period(velocity.forward));
    let stride = run::run(velocity, period)?;
    let seconds = strides as f64 * period;
    let frames = frames(&stride, (seconds / FRAME_SECONDS).round() as usize)?;
    Some(clip("run", velocity, frames, true))
}

/// From standing to walking at a velocity, within about a stride; its command is that velocity.
/// `None` as in [`walk`].
pub fn start(velocity: impl Into<Velocity>) -> Option<Clip> {
    let velocity = velocity.into();
    transition(velocity, transition::start, |frames| {
        clip("start", velocity, frames, false)
    })
}

/// From walking at a velocity to standing, within about a stride; its command is to stand.
/// `None` as in [`walk`].
pub fn stop(velocity: impl Into<Velocity>) -> Option<Clip> {
    let velocity = velocity.into();
    transition(velocity, transition::stop, |frames| Clip {
        command: [0.0; 3],
        ..clip("stop", velocity, frames, false)
    })
}

fn transition(
    velocity: Velocity,
    change: impl Fn(Stride) -> Option<(Stride, f64)>,
    clip: impl Fn(Vec<RobotState>) -> Clip,
) -> Option<Clip> {
    // The right foot goes first and comes last, which keeps the feet apart in turns to the left (run
    // back in time, to the right); the other turns are their mirror images.
    let sense = if velocity.forward < 0.0 { -1.0 } else { 1.0 };
    let (turn, aside) = (sense * velocity.yaw_rate, sense * velocity.lateral);
    let reflected = turn < 0.0 || turn == 0.0 && aside < 0.0;
    let seen = if reflected {
        velocity.mirrored()
    } else {
        velocity
    };
    let (stride, seconds) = change(walking(seen)?.0)?;
    let mut frames = frames(&stride, (seconds / FRAME_SECONDS).round() as usize)?;
    if reflected {
        frames = frames.iter().map(mirror_state).collect();
    }
    Some(clip(frames))
}

fn within(velocity: &Velocity, speeds: RangeInclusive<f64>) -> bool {
    speeds.contains(&velocity.forward)
        && LATERAL_SPEEDS.contains(&velocity.lateral)
        && YAW_RATES.contains(&velocity.yaw_rate)
}

/// The walk at a velocity, and how many strides of it last whole frames.
fn walking(velocity: Velocity) -> Option<(Stride, usize)> {
    if !within(&velocity, WALKING_SPEEDS) {
        return None;
    }
    let reversed = velocity.forward < 0.0;
    // A walk backward is a walk run back in time.
    let seen = if reversed {
        velocity.reversed()
    } else {
        velocity
    };
    let (period, strides) = whole_frames(&velocity, walk::period(&seen));
    let stride = walk::walk(seen, period, velocity.forward)?;
    Some((Stride { reversed, ..stride }, strides))
}

/// The stride's duration (s) changed a little, so that a few strides last a whole number of
/// frames, and how many strides that takes.
fn whole_frames(velocity: &Velocity, period: f64) -> (f64, usize) {
    if *velocity != Velocity::from(velocity.forward) {
        // The sides differ, so each is to be seen often: four strides and an odd number of frames
        // show a foot at four times as many phases as one stride does.
        const STRIDES: usize = 4;
        let pairs = (period * STRIDES as f64 / FRAME_SECONDS / 2.0).floor();
        let frames = 2.0 * pairs + 1.0;
        return (frames * FRAME_SECONDS / STRIDES as f64, STRIDES);
    }
    let rounded = |strides: usize| {
        let frames = (period * strides as f64 / FRAME_SECONDS).round();
        frames * FRAME_SECONDS / strides as f64
    };
    let misfit = |strides: usize| (rounded(strides) - period).abs();
    let strides = (2..=4).fold(1, |best, n| if misfit(n) < misfit(best) { n } else { best });
    (rounded(strides), strides)
}

fn clip(gait: &str, velocity: Velocity, frames: Vec<RobotState>, cyclic: bool) -> Clip {
    Clip {
        name: format!("{gait} {velocity}"),
        frames,
        cyclic,
        command: velocity.command(),
        weight: 1.0,
    }
}

/// Successive frames from time 0; `None` if a joint leaves its range or outruns its motor.
fn frames(stride: &Stride, count: usize) -> Option<Vec<RobotState>> {
    (0..count)
        .map(|i| frame(stride, i as f64 * FRAME_SECONDS).filter(possible))
        .collect()
}

fn possible(frame: &RobotState) -> bool {
    // The knee of a run at 2.7 m/s reaches 21.3 of 20 rad/s.
    const OVERSPEED: f64 = 1.1;
    JOINT_TABLE.iter().enumerate().all(|(j, joint)| {
        (joint.lower..=joint.upper).contains(&f64::from(frame.joint_positions[j]))
            && f64::from(frame.joint_velocities[j].abs()) <= OVERSPEED * joint.velocity_limit
    })
}

/// The state at a time, its velocities by central differences of the continuous motion.
fn frame(stride: &Stride, time: f64) -> Option<RobotState> {
    const H: f64 = 2e-4;
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
