//! How good a clip is: what a robot would feel of it.
//!
//! Separate because imported, built-in and mirrored clips are measured alike, and because a training
//! run cannot be better than this.

mod account;
mod defect;
mod defects;
mod tracking;

pub use account::Account;
pub use defect::{Defect, Frames, Kind, Severity, line, paragraph, severity};
pub use defects::{Examination, defects};
pub(crate) use defects::{all, of_source};
pub use tracking::Tracking;

use crate::clip::{Clip, FRAME_SECONDS};
use g1::kinematics::{forward_state, lowest_sole_point, sole_points};
use g1::{JOINT_TABLE, JOINTS, LEFT_FOOT, RIGHT_FOOT, RobotState};
use nalgebra::{Point3, Vector3};
use retarget::signal::{median, quantile};
use serde::Serialize;

/// A sole whose lowest corner is below this is on the ground, m.
pub const TOUCHING: f32 = 0.005;

/// Measures of a clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Quality {
    /// Frames.
    pub frames: usize,
    /// Duration, s.
    pub seconds: f64,
    /// Mean planar speed in the heading frame, m/s.
    pub speed: f64,
    /// Mean yaw rate, rad/s.
    pub yaw_rate: f64,
    /// How well a robot that moves exactly so obeys the clip's command.
    pub tracking: Tracking,
    /// Speeds over half a second that 5 % and 95 % of frames stay below, m/s.
    pub speed_range: [f64; 2],
    /// Speed over the ground of the lowest corner of a standing sole: median, m/s; 0 if none stands.
    pub slip: f64,
    /// The same, which 95 % stay below, m/s.
    pub slip_95: f64,
    /// Deepest point of a sole below the ground, m.
    pub penetration: f64,
    /// Height of the lower sole that nine tenths of frames stay above, m: above 0 the clip floats.
    pub float: f64,
    /// Share of frames in which the left and the right foot stand.
    pub duty: [f64; 2],
    /// Share of frames in which no foot stands.
    pub flight: f64,
    /// Lowest and highest pelvis, m.
    pub height: [f64; 2],
    /// Joints beyond their limits.
    pub beyond_limits: Vec<Beyond>,
    /// Greatest joint speed as a share of its motor's, and the joint.
    pub peak_speed: f64,
    /// The joint of `peak_speed`.
    pub peak_joint: String,
    /// Greatest angle between frames, as a share of what the motor can turn in that time.
    pub peak_step: f64,
    /// Greatest joint acceleration, rad/s².
    pub peak_acceleration: f64,
    /// Largest difference between joint or pelvis velocity and the derivative of positions (rad/s, m/s).
    pub velocity_error: f64,
}

/// A joint that leaves its range.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Beyond {
    /// The joint's name.
    pub joint: String,
    /// Frames.
    pub frames: usize,
    /// Farthest beyond the limit, rad.
    pub by: f64,
}

impl Quality {
    /// Measures a clip.
    ///
    /// # Panics
    /// If it has no frames.
    pub fn of(clip: &Clip) -> Self {
        assert!(!clip.frames.is_empty(), "{} has frames", clip.name);
        let feet: Vec<Feet> = clip.frames.iter().map(Feet::of).collect();
        let mut slips = slips(&feet);
        let mut speeds = speeds(clip);
        let stands = |foot: usize| share(&feet, |f| f.low[foot] < TOUCHING);
        let mut lower: Vec<f64> = feet
            .iter()
            .map(|f| f64::from(f.low[0].min(f.low[1])))
            .collect();
        let deepest = lower.iter().copied().fold(0.0, f64::min);
        let heights = || clip.frames.iter().map(|f| f64::from(f.position.z));
        let (peak_speed, peak_joint) = peak_speed(&clip.frames);
        Self {
            frames: clip.frames.len(),
            seconds: clip.seconds(),
            speed: f64::from(clip.speed()),
            yaw_rate: f64::from(clip.command[2]),
            tracking: Tracking::of(clip),
            speed_range: [quantile(&mut speeds, 0.05), quantile(&mut speeds, 0.95)],
            slip: median(&mut slips),
            slip_95: quantile(&mut slips, 0.95),
            penetration: 0.0 - deepest,
            float: quantile(&mut lower, 0.1).max(0.0),
            duty: [stands(0), stands(1)],
            flight: share(&feet, |f| f.low.iter().all(|low| *low >= TOUCHING)),
            height: [
                heights().fold(f64::INFINITY, f64::min),
                heights().fold(0.0, f64::max),
            ],
            beyond_limits: beyond_limits(&clip.frames),
            peak_speed,
            peak_joint,
            peak_step: peak_step(&clip.frames),
            peak_acceleration: peak_acceleration(&clip.frames),
            velocity_error: velocity_error(&clip.frames),
        }
    }
}

/// Speeds over half a second at every frame, m/s.
pub fn speeds(clip: &Clip) -> Vec<f64> {
    let half = (0.25 / FRAME_SECONDS).round() as usize;
    let last = clip.frames.len() - 1;
    (0..=last)
        .map(|i| {
            let around = &clip.frames[i.saturating_sub(half)..=(i + half).min(last)];
            let sum = around
                .iter()
                .map(RobotState::velocity_in_heading)
                .fold(nalgebra::Vector2::zeros(), |sum, v| sum + v);
            f64::from(sum.norm()) / around.len() as f64
        })
        .collect()
}

/// Where the soles are in a frame.
struct Feet {
    corners: [[Point3<f32>; 4]; 2],
    low: [f32; 2],
    /// Where the feet point, unit vectors in the world.
    toes: [Vector3<f32>; 2],
}

impl Feet {
    fn of(state: &RobotState) -> Self {
        let bodies = forward_state(state);
        Self {
            corners: [LEFT_FOOT, RIGHT_FOOT].map(|foot| sole_points(&bodies, foot)),
            low: [LEFT_FOOT, RIGHT_FOOT].map(|foot| lowest_sole_point(&bodies, foot)),
            toes: [LEFT_FOOT, RIGHT_FOOT].map(|foot| bodies[foot].rotation * Vector3::x()),
        }
    }
}

fn share(feet: &[Feet], is: impl Fn(&Feet) -> bool) -> f64 {
    feet.iter().filter(|f| is(f)).count() as f64 / feet.len() as f64
}

/// Speeds over the ground of the corner that bears, for each standing foot and pair of frames.
fn slips(feet: &[Feet]) -> Vec<f64> {
    let mut slips = Vec::new();
    for pair in feet.windows(2) {
        for foot in 0..2 {
            let (a, b) = (&pair[0].corners[foot], &pair[1].corners[foot]);
            let low = |k: usize| a[k].z + b[k].z;
            let bearing = (0..4).min_by(|&j, &k| low(j).total_cmp(&low(k)));
            let Some(k) = bearing.filter(|_| pair.iter().all(|f| f.low[foot] < TOUCHING)) else {
                continue;
            };
            slips.push(f64::from((b[k] - a[k]).xy().norm()) / FRAME_SECONDS);
        }
    }
    slips
}

fn beyond_limits(frames: &[RobotState]) -> Vec<Beyond> {
    let beyond = |j: usize| {
        let joint = &JOINT_TABLE[j];
        let by = |f: &RobotState| {
            let q = f64::from(f.joint_positions[j]);
            (joint.lower - q).max(q - joint.upper)
        };
        // `f32` rounds the limit itself.
        let over: Vec<f64> = frames.iter().map(by).filter(|by| *by > 1e-6).collect();
        let most = over.iter().copied().reduce(f64::max)?;
        Some(Beyond {
            joint: joint.name.into(),
            frames: over.len(),
            by: most,
        })
    };
    (0..JOINTS).filter_map(beyond).collect()
}

fn peak_speed(frames: &[RobotState]) -> (f64, String) {
    let peak = |j: usize| {
        let speeds = frames
            .iter()
            .map(|f| f64::from(f.joint_velocities[j].abs()));
        speeds.fold(0.0, f64::max) / JOINT_TABLE[j].velocity_limit
    };
    let fastest = (0..JOINTS)
        .max_by(|&i, &j| peak(i).total_cmp(&peak(j)))
        .unwrap_or(0);
    (peak(fastest), JOINT_TABLE[fastest].name.into())
}

fn peak_step(frames: &[RobotState]) -> f64 {
    let share = |pair: &[RobotState]| {
        (0..JOINTS)
            .map(|j| {
                let step = pair[1].joint_positions[j] - pair[0].joint_positions[j];
                f64::from(step.abs()) / (JOINT_TABLE[j].velocity_limit * FRAME_SECONDS)
            })
            .fold(0.0, f64::max)
    };
    frames.windows(2).map(share).fold(0.0, f64::max)
}

fn peak_acceleration(frames: &[RobotState]) -> f64 {
    let change = |pair: &[RobotState]| {
        (0..JOINTS)
            .map(|j| f64::from((pair[1].joint_velocities[j] - pair[0].joint_velocities[j]).abs()))
            .fold(0.0, f64::max)
    };
    frames.windows(2).map(change).fold(0.0, f64::max) / FRAME_SECONDS
}

/// Against central differences; the ends have none.
fn velocity_error(frames: &[RobotState]) -> f64 {
    let error = |three: &[RobotState]| {
        let [before, now, after] = three else {
            return 0.0;
        };
        let rate = |a: f32, b: f32| (f64::from(b) - f64::from(a)) / (2.0 * FRAME_SECONDS);
        let joints = (0..JOINTS).map(|j| {
            let derivative = rate(before.joint_positions[j], after.joint_positions[j]);
            (derivative - f64::from(now.joint_velocities[j])).abs()
        });
        let base = (0..3).map(|axis| {
            let derivative = rate(before.position[axis], after.position[axis]);
            (derivative - f64::from(now.linear_velocity[axis])).abs()
        });
        joints.chain(base).fold(0.0, f64::max)
    };
    frames.windows(3).map(error).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
