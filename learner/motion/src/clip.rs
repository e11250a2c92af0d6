//! A clip of reference motion: states of the robot at 50 Hz.
//!
//! Separate because built-in and imported motion end here, and all uses begin here.

use g1::RobotState;
use g1::mirror::{mirror_command, mirror_state};

/// Time between the frames of a clip, s: the policy's step.
pub const FRAME_SECONDS: f64 = 0.02;

/// A piece of motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// What it is, for logs.
    pub name: String,
    /// States at 50 Hz, velocities filled in.
    pub frames: Vec<RobotState>,
    /// Whether the first frame follows the last (in everything but place).
    pub cyclic: bool,
    /// Mean motion in the heading frame: forward, leftward velocity (m/s), yaw rate (rad/s).
    pub command: [f32; 3],
    /// Share among the clips of a dataset; not normalised.
    pub weight: f32,
}

impl Clip {
    /// Duration, s.
    pub fn seconds(&self) -> f64 {
        self.transitions() as f64 * FRAME_SECONDS
    }

    /// Mean planar speed, m/s.
    pub fn speed(&self) -> f32 {
        self.command[0].hypot(self.command[1])
    }

    /// Pairs of successive frames: one less than frames, or as many if the clip is cyclic.
    pub fn transitions(&self) -> usize {
        self.frames.len().saturating_sub(usize::from(!self.cyclic))
    }

    /// The clip seen in a mirror: left and right swapped.
    pub fn mirrored(&self) -> Self {
        Self {
            name: format!("{} mirrored", self.name),
            frames: self.frames.iter().map(mirror_state).collect(),
            command: mirror_command(self.command),
            ..*self
        }
    }
}
