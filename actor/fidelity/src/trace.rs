//! A trace: what a robot did in a case, as an engine tells it.
//!
//! Separate because other simulators write it.

use g1::{JOINTS, RobotState, collision, kinematics};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// Where the robot was at one moment, and what the floor did to it since the frame before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Pelvis origin, world, m.
    pub position: [f32; 3],
    /// Orientation of the pelvis: w, i, j, k.
    pub orientation: [f32; 4],
    /// Joint positions, rad.
    pub joints: [f32; JOINTS],
    /// Greatest vertical force on both soles together, of the steps since the frame before, N.
    pub peak: f32,
    /// Their mean vertical force, N.
    pub force: f32,
}

/// What a robot did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trace {
    /// Name of the case.
    pub case: String,
    /// Step that it was simulated with, s.
    pub dt: f64,
    /// A frame after every [`crate::Case::every`] steps.
    pub frames: Vec<Frame>,
    /// Whether all numbers were usable to the end.
    pub sound: bool,
}

impl Frame {
    /// Of a state, with the forces still to come.
    pub fn of(state: &RobotState) -> Self {
        let q = state.orientation;
        Self {
            position: state.position.into(),
            orientation: [q.w, q.i, q.j, q.k],
            joints: state.joint_positions,
            peak: 0.0,
            force: 0.0,
        }
    }

    /// Place and posture as a state at rest.
    fn state(&self) -> RobotState {
        let [w, i, j, k] = self.orientation;
        let mut state = RobotState::standing();
        state.position = Vector3::from(self.position);
        state.orientation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
        state.joint_positions = self.joints;
        state
    }

    /// The smallest gap between parts of the robot that can meet, m; negative where they are within each other.
    pub fn nearest(&self) -> f32 {
        collision::nearest(&self.state()).1
    }

    /// Mean place of the corners of both soles on the floor, m.
    pub fn feet(&self) -> [f32; 2] {
        let bodies = kinematics::forward_state(&self.state());
        let mut mean = [0.0; 2];
        for foot in [g1::LEFT_FOOT, g1::RIGHT_FOOT] {
            for corner in kinematics::sole_points(&bodies, foot) {
                mean[0] += corner.x / 8.0;
                mean[1] += corner.y / 8.0;
            }
        }
        mean
    }
}
