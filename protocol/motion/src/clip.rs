//! A clip of reference motion: states of the robot at 50 Hz.
//!
//! Separate because built-in and imported motion end here, and all uses begin here.

use crate::velocity::Velocity;
use g1::RobotState;
use g1::mirror::{mirror_command, mirror_state};
use nalgebra::{Isometry2, UnitQuaternion, Vector3};

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

    /// A cyclic clip repeated for at least so many seconds, going on along its command, be that a
    /// line or a curve; any other clip as it is.
    pub fn unrolled(&self, seconds: f64) -> Self {
        let cycles = if self.cyclic {
            (seconds / self.seconds()).ceil().max(1.0) as usize
        } else {
            1
        };
        let velocity = Velocity::from(self.command);
        let ahead = |cycle: usize| {
            let way = velocity.after(cycle as f64 * self.seconds());
            self.frames.iter().map(move |frame| moved(frame, &way))
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

/// A state carried along the ground and turned with it.
fn moved(state: &RobotState, way: &Isometry2<f64>) -> RobotState {
    let way: Isometry2<f32> = way.cast();
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), way.rotation.angle());
    RobotState {
        position: turn * state.position + way.translation.vector.push(0.0),
        orientation: turn * state.orientation,
        linear_velocity: turn * state.linear_velocity,
        angular_velocity: turn * state.angular_velocity,
        ..*state
    }
}

#[cfg(test)]
mod tests {
    use crate::gait::{self, Velocity};

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

    #[test]
    fn unrolling_a_curve_comes_round_the_circle() {
        let turn = gait::walk(Velocity {
            forward: 0.5,
            lateral: 0.0,
            yaw_rate: 1.0,
        });
        // A circle of 0.5 m radius in 2π s: the cycle that ends after them is back near the start.
        let long = turn.unwrap().unrolled(std::f64::consts::TAU);
        let last = long.frames.len() - 1;
        for pair in long.frames.windows(2) {
            let step = (pair[1].position - pair[0].position).norm();
            assert!(step < 0.02, "{step}"); // 0.5 m/s at 50 Hz, and some sway
            assert!(pair[0].orientation.angle_to(&pair[1].orientation) < 0.06);
        }
        let centre = nalgebra::Vector2::new(0.0, 0.5);
        for frame in &long.frames {
            let radius = (frame.position.xy() - centre).norm();
            assert!((radius - 0.5).abs() < 0.06, "{radius}");
        }
        assert!(last as f64 * crate::FRAME_SECONDS > 6.2);
    }
}
