//! A case: a start, motors, what they are told and what happens to the robot.
//!
//! Separate because a case must be complete: another simulator gets nothing else.

use g1::{DEFAULT_POSE, JOINT_TABLE, JOINTS, RobotState};
use serde::{Deserialize, Serialize};

/// The step that engines are used with, s.
pub const STEP: f64 = 0.005;
/// Steps between two targets: they change at 50 Hz.
pub const HOLD: usize = 4;

/// Gains and limits of every joint's motor: τ = kp·(target − q) − kd·q̇, no more than effort.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gains {
    /// kp, N·m/rad.
    pub stiffness: [f32; JOINTS],
    /// kd, N·m·s/rad.
    pub damping: [f32; JOINTS],
    /// Greatest torque, N·m.
    pub effort: [f32; JOINTS],
}

impl Gains {
    /// The robot's own.
    pub fn of_the_robot() -> Self {
        Self {
            stiffness: JOINT_TABLE.map(|joint| joint.kp as f32),
            damping: JOINT_TABLE.map(|joint| joint.kd as f32),
            effort: JOINT_TABLE.map(|joint| joint.effort as f32),
        }
    }

    /// Motors that hold the robot up without a policy; no robot has them.
    pub fn stiff() -> Self {
        let gains = JOINT_TABLE.map(|joint| match joint.name {
            name if name.contains("hip") => (400.0, 4.0),
            name if name.contains("knee") => (600.0, 8.0),
            name if name.contains("ankle") => (320.0, 6.0),
            name if name.contains("waist") => (800.0, 10.0),
            _ => (160.0, 2.0),
        });
        Self {
            stiffness: gains.map(|(stiffness, _)| stiffness),
            damping: gains.map(|(_, damping)| damping),
            effort: [1e6; JOINTS],
        }
    }

    /// Motors without current.
    pub fn limp() -> Self {
        Self {
            stiffness: [0.0; JOINTS],
            damping: [0.0; JOINTS],
            effort: [0.0; JOINTS],
        }
    }
}

/// A change of the whole robot's velocity at once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Push {
    /// Before which target, counted from 0.
    pub at: usize,
    /// World frame, m/s.
    pub change: [f32; 3],
}

/// A case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Its name; traces refer to it.
    pub name: String,
    /// Length, in steps of [`STEP`].
    pub steps: usize,
    /// Steps of [`STEP`] between two frames of its trace.
    pub every: usize,
    /// The state that it begins in.
    pub start: RobotState,
    /// The motors.
    pub gains: Gains,
    /// Target positions of the joints, rad, one after another for [`HOLD`] steps; the last one stays.
    pub targets: Vec<[f32; JOINTS]>,
    /// Kicks.
    pub pushes: Vec<Push>,
    /// An acceleration of the whole robot beside gravity, world frame, m/s².
    pub pull: [f32; 3],
    /// Steps of [`STEP`] before that acceleration begins.
    pub pull_from: usize,
    /// Whether every engine is compared with its own run at a tenth of the step.
    pub refined: bool,
}

impl Case {
    /// A robot that is told to hold the default pose.
    pub(crate) fn new(name: &str, seconds: f64, start: RobotState, gains: Gains) -> Self {
        Self {
            name: name.into(),
            steps: (seconds / STEP).round() as usize,
            every: 1,
            start,
            gains,
            targets: vec![DEFAULT_POSE],
            pushes: Vec::new(),
            pull: [0.0; 3],
            pull_from: 0,
            refined: false,
        }
    }

    /// What the motors are told during a step of [`STEP`].
    pub fn target(&self, step: usize) -> &[f32; JOINTS] {
        &self.targets[(step / HOLD).min(self.targets.len() - 1)]
    }

    /// By how much the whole robot's velocity is changed at the beginning of a step of [`STEP`], m/s.
    pub fn push(&self, step: usize) -> Option<[f32; 3]> {
        let due = |push: &&Push| push.at * HOLD == step;
        self.pushes.iter().find(due).map(|push| push.change)
    }
}
