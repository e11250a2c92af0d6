//! A recording: states at 50 Hz with what was asked of the robot and what it felt.
//!
//! As JSON it is what `deploy/python` turns into other formats and what other simulators are compared with, so it
//! holds every number of a state and, of a policy, what it saw and did.

use g1::RobotState;
use serde::{Deserialize, Serialize};

/// What was recorded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// What it shows, in a few words.
    pub title: String,
    /// Where it comes from: run and iteration, or the clip's source.
    pub source: String,
    /// Time between frames, s.
    pub frame_seconds: f64,
    /// When the robot had fallen by the task's rule, s; the frames go on until it lies.
    pub fell_at: Option<f64>,
    /// The frames in order.
    pub frames: Vec<Frame>,
}

/// One moment. Names follow `RobotState`; quaternions are w x y z.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Pelvis origin in the world, m.
    pub position: [f32; 3],
    /// Pelvis to world, w x y z.
    pub orientation: [f32; 4],
    /// Velocity of the pelvis origin, world frame, m/s.
    pub linear_velocity: [f32; 3],
    /// Of the pelvis, world frame, rad/s.
    pub angular_velocity: [f32; 3],
    /// rad, in joint order.
    pub joint_positions: Vec<f32>,
    /// rad/s, in joint order.
    pub joint_velocities: Vec<f32>,
    /// Forward and leftward velocity (m/s, heading frame) and yaw rate (rad/s) as they are.
    pub velocity: [f32; 3],
    /// The same as they were asked for.
    pub command: [f32; 3],
    /// Vertical force on the left and the right sole, mean over the step that led here, N; none in a clip.
    pub foot_forces: Option<[f32; 2]>,
    /// Positive mechanical work of the step that led here, J; none in a clip.
    pub energy: Option<f32>,
    /// What the policy saw here; none in a clip.
    pub observation: Option<Vec<f32>>,
    /// What it did then, 23 numbers; none in a clip and in the last frame.
    pub action: Option<Vec<f32>>,
}

impl Frame {
    /// A state under a command, without what only a simulation knows.
    pub fn of(state: &RobotState, command: [f32; 3]) -> Self {
        let [forward, left]: [f32; 2] = state.velocity_in_heading().into();
        let q = state.orientation;
        Self {
            position: state.position.into(),
            orientation: [q.w, q.i, q.j, q.k],
            linear_velocity: state.linear_velocity.into(),
            angular_velocity: state.angular_velocity.into(),
            joint_positions: state.joint_positions.to_vec(),
            joint_velocities: state.joint_velocities.to_vec(),
            velocity: [forward, left, state.angular_velocity.z],
            command,
            foot_forces: None,
            energy: None,
            observation: None,
            action: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{UnitQuaternion, Vector3};
    use std::f32::consts::FRAC_PI_2;

    #[test]
    fn velocity_is_seen_from_where_the_robot_faces() {
        let state = RobotState {
            orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2),
            linear_velocity: Vector3::new(0.0, 0.5, 0.0),
            ..RobotState::standing()
        };
        let frame = Frame::of(&state, [1.0, 0.0, 0.0]);
        // Facing world y and moving along it.
        assert!((frame.velocity[0] - 0.5).abs() < 1e-6 && frame.velocity[1].abs() < 1e-6);
        let half = (FRAC_PI_2 / 2.0).cos();
        assert!((frame.orientation[0] - half).abs() < 1e-6);
        assert!((frame.orientation[3] - half).abs() < 1e-6);
    }
}
