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

    /// A cyclic clip repeated for at least so many seconds, going on along its command straight
    /// ahead; any other clip as it is.
    pub fn unrolled(&self, seconds: f64) -> Self {
        let cycles = if self.cyclic {
            (seconds / self.seconds()).ceil().max(1.0) as usize
        } else {
            1
        };
        let way = self.command[0] * self.seconds() as f32;
        let ahead = |cycle: usize| {
            self.frames.iter().map(move |frame| {
                let mut frame = *frame;
                frame.position.x += way * cycle as f32;
                frame
            })
        };
        Self {
            frames: (0..cycles).flat_map(ahead).collect(),
            cyclic: false,
            name: self.name.clone(),
            ..*self
        }
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

#[cfg(test)]
mod tests {
    use crate::gait;

    #[test]
    fn unrolling_goes_on_without_a_jump() {
        let walk = gait::walk(1.0).unwrap();
        let long = walk.unrolled(5.0);
        assert!(long.seconds() > 4.95 && !long.cyclic);
        assert_eq!(long.frames[..walk.frames.len()], walk.frames);
        for pair in long.frames.windows(2) {
            let step = (pair[1].position - pair[0].position).norm();
            assert!((step - 0.02).abs() < 0.01, "{step}"); // 1 m/s at 50 Hz, and some bounce
        }
        assert_eq!(long.unrolled(99.0), long);
    }
}
