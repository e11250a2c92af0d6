//! What a robot's sensors tell of it: turned, offset and late.
//!
//! Separate because it makes a state of a state: whatever the policy's list names is then written from that one, and all
//! terms agree with each other.

use crate::time::SUBSTEPS;
use g1::{JOINTS, RobotState};
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Control steps that are remembered, the present one first.
const MEMORY: usize = 3;

/// The sensors of one robot in one episode, and what they told.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Senses {
    /// Added to the joints' positions, rad.
    pub(super) encoder: [f32; JOINTS],
    /// Turns the world so that gravity points down in it: the robot knows no other down.
    pub(super) upright: UnitQuaternion<f32>,
    /// From the IMU's frame to the pelvis'.
    pub(super) mount: UnitQuaternion<f32>,
    /// Age of what is told, physics steps.
    pub(super) delay: usize,
    told: [RobotState; MEMORY],
}

impl Senses {
    /// Exact ones.
    pub(super) fn exact() -> Self {
        Self {
            encoder: [0.0; JOINTS],
            upright: UnitQuaternion::identity(),
            mount: UnitQuaternion::identity(),
            delay: 0,
            told: [RobotState::standing(); MEMORY],
        }
    }

    /// At the start of an episode: nothing was otherwise before.
    pub(super) fn begin(&mut self, state: &RobotState) {
        self.told = [self.tell(state); MEMORY];
    }

    /// After a control step.
    pub(super) fn step(&mut self, state: &RobotState) {
        self.told.rotate_right(1);
        self.told[0] = self.tell(state);
    }

    /// The robot as its policy sees it now.
    pub(crate) fn seen(&self) -> RobotState {
        let (whole, part) = (self.delay / SUBSTEPS, self.delay % SUBSTEPS);
        if part == 0 {
            return self.told[whole];
        }
        let share = part as f32 / SUBSTEPS as f32;
        between(&self.told[whole], &self.told[whole + 1], share)
    }

    /// A state as it is told. Velocities of the pelvis keep their direction to it until the IMU's mount turns them.
    fn tell(&self, state: &RobotState) -> RobotState {
        let mut told = *state;
        told.orientation = self.upright * state.orientation * self.mount;
        told.linear_velocity = self.upright * state.linear_velocity;
        told.angular_velocity = self.upright * state.angular_velocity;
        for (position, offset) in told.joint_positions.iter_mut().zip(self.encoder) {
            *position += offset;
        }
        told
    }
}

/// A straight line from one state to another, `share` of the way.
fn between(from: &RobotState, to: &RobotState, share: f32) -> RobotState {
    let mix = |from: [f32; JOINTS], to: [f32; JOINTS]| {
        let mut mixed = from;
        for (mixed, to) in mixed.iter_mut().zip(to) {
            *mixed += share * (to - *mixed);
        }
        mixed
    };
    RobotState {
        position: from.position.lerp(&to.position, share),
        orientation: from.orientation.nlerp(&to.orientation, share),
        linear_velocity: from.linear_velocity.lerp(&to.linear_velocity, share),
        angular_velocity: from.angular_velocity.lerp(&to.angular_velocity, share),
        joint_positions: mix(from.joint_positions, to.joint_positions),
        joint_velocities: mix(from.joint_velocities, to.joint_velocities),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    fn at(height: f32) -> RobotState {
        let mut state = RobotState::standing();
        state.position.z = height;
        state.joint_positions[3] = 10.0 * height;
        state
    }

    #[test]
    fn what_is_seen_is_as_old_as_the_delay() {
        let mut senses = Senses::exact();
        senses.begin(&at(0.0));
        for height in [1.0, 2.0, 3.0] {
            senses.step(&at(height));
        }
        // Two control steps ago it was at 1, one ago at 2: 5 ms are a quarter of the way.
        for (delay, height) in [(0, 3.0), (1, 2.75), (4, 2.0), (6, 1.5), (8, 1.0)] {
            senses.delay = delay;
            let seen = senses.seen();
            assert_eq!(seen.position.z, height, "{delay}");
            assert!((seen.joint_positions[3] - 10.0 * height).abs() < 1e-5);
        }
        senses.begin(&at(7.0));
        assert_eq!(senses.seen().position.z, 7.0);
    }

    #[test]
    fn an_imu_that_leans_forward_sees_gravity_ahead() {
        let mut senses = Senses::exact();
        // The IMU is pitched nose down by 0.03 rad: down is ahead of it, and a turn to the left is a roll too.
        senses.mount = UnitQuaternion::from_scaled_axis(Vector3::y() * 0.03);
        let mut state = RobotState::standing();
        state.angular_velocity = Vector3::z();
        state.joint_velocities[0] = 2.0;
        senses.encoder[0] = 0.02;
        senses.begin(&state);
        let seen = senses.seen();
        let (sin, cos) = 0.03_f32.sin_cos();
        let down = seen.projected_gravity();
        assert!(
            (down - Vector3::new(sin, 0.0, -cos)).norm() < 1e-6,
            "{down}"
        );
        let turn = seen.angular_velocity_in_base();
        assert!(
            (turn - Vector3::new(-sin, 0.0, cos)).norm() < 1e-6,
            "{turn}"
        );
        let off = seen.joint_positions[0] - state.joint_positions[0];
        assert!((off - 0.02).abs() < 1e-6 && seen.joint_velocities[0] == 2.0);
        assert_eq!(seen.joint_positions[1], state.joint_positions[1]);
    }
}
