//! A state of the robot and the frames that it is seen from.
//!
//! Separate because simulated and reference motion meet here: both are a `RobotState` per frame.

use crate::{DEFAULT_POSE, JOINTS};
use nalgebra::{UnitQuaternion, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// Height of the pelvis when the default pose stands flat on the ground, m (sole at z = 0).
pub const STANDING_HEIGHT: f64 = 0.7842021819153314;

/// Where every body is and how it moves: the free base plus 23 joints.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RobotState {
    /// Origin of the pelvis link in the world, m.
    pub position: Vector3<f32>,
    /// Orientation of the pelvis: turns base-frame vectors into world vectors.
    pub orientation: UnitQuaternion<f32>,
    /// Velocity of the pelvis origin in the world frame, m/s.
    pub linear_velocity: Vector3<f32>,
    /// Angular velocity of the pelvis in the world frame, rad/s.
    pub angular_velocity: Vector3<f32>,
    /// Joint positions, rad.
    pub joint_positions: [f32; JOINTS],
    /// Joint velocities, rad/s.
    pub joint_velocities: [f32; JOINTS],
}

impl RobotState {
    /// At rest in the default pose, soles on the ground at the world's origin, facing x.
    pub fn standing() -> Self {
        Self {
            position: Vector3::new(0.0, 0.0, STANDING_HEIGHT as f32),
            orientation: UnitQuaternion::identity(),
            linear_velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
            joint_positions: DEFAULT_POSE,
            joint_velocities: [0.0; JOINTS],
        }
    }

    /// Direction of gravity in the base frame, unit length: (0, 0, −1) when upright.
    #[inline]
    pub fn projected_gravity(&self) -> Vector3<f32> {
        let q = self.orientation;
        // The last row of the rotation matrix, negative. Asked for three times per step of every robot: nalgebra's
        // general turn of a vector costs ten times as much.
        Vector3::new(
            2.0 * (q.w * q.j - q.i * q.k),
            -2.0 * (q.j * q.k + q.w * q.i),
            2.0 * (q.i * q.i + q.j * q.j) - 1.0,
        )
    }

    /// Velocity of the pelvis in the base frame, m/s.
    #[inline]
    pub fn velocity_in_base(&self) -> Vector3<f32> {
        self.in_base(&self.linear_velocity)
    }

    /// Angular velocity of the pelvis in the base frame, rad/s.
    #[inline]
    pub fn angular_velocity_in_base(&self) -> Vector3<f32> {
        self.in_base(&self.angular_velocity)
    }

    /// A vector of the world seen from the base:  Rᵀ·v.
    #[inline]
    fn in_base(&self, v: &Vector3<f32>) -> Vector3<f32> {
        let q = self.orientation;
        let (w, x, y, z) = (q.w, q.i, q.j, q.k);
        Vector3::new(
            (1.0 - 2.0 * (y * y + z * z)) * v.x
                + 2.0 * ((x * y + w * z) * v.y + (x * z - w * y) * v.z),
            (1.0 - 2.0 * (x * x + z * z)) * v.y
                + 2.0 * ((x * y - w * z) * v.x + (y * z + w * x) * v.z),
            (1.0 - 2.0 * (x * x + y * y)) * v.z
                + 2.0 * ((x * z + w * y) * v.x + (y * z - w * x) * v.y),
        )
    }

    /// Planar velocity in the heading frame, m/s: the world turned by yaw only, x where the robot faces.
    #[inline]
    pub fn velocity_in_heading(&self) -> Vector2<f32> {
        let (sin, cos) = self.heading();
        // Sine and cosine of the yaw without an angle: this is asked for several times per step of every robot.
        let length = (sin * sin + cos * cos).sqrt();
        let (sin, cos) = if length > 0.0 {
            (sin / length, cos / length)
        } else {
            (0.0, 1.0)
        };
        let v = self.linear_velocity;
        Vector2::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x)
    }

    /// Heading of the pelvis, rad in (−π, π]: the yaw of R = Rz(yaw)·Ry(pitch)·Rx(roll).
    #[inline]
    pub fn yaw(&self) -> f32 {
        let (y, x) = self.heading();
        y.atan2(x)
    }

    /// Leftward (y) and forward (x) part of the base's x axis on the floor; 0 of both where it points up or down.
    #[inline]
    fn heading(&self) -> (f32, f32) {
        let q = self.orientation;
        (
            2.0 * (q.w * q.k + q.i * q.j),
            1.0 - 2.0 * (q.j * q.j + q.k * q.k),
        )
    }

    /// Whether every number is finite.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.position.iter().all(|x| x.is_finite())
            && self.orientation.coords.iter().all(|x| x.is_finite())
            && self.linear_velocity.iter().all(|x| x.is_finite())
            && self.angular_velocity.iter().all(|x| x.is_finite())
            && self.joint_positions.iter().all(|x| x.is_finite())
            && self.joint_velocities.iter().all(|x| x.is_finite())
    }
}

/// The rotation of a quaternion w x y z, which need not have length 1.
pub fn quaternion(w: f32, x: f32, y: f32, z: f32) -> UnitQuaternion<f32> {
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

    fn close(a: Vector3<f32>, b: Vector3<f32>) -> bool {
        (a - b).norm() < 1e-6
    }

    #[test]
    fn gravity_points_down_when_upright_and_to_where_the_robot_leans() {
        let mut state = RobotState::standing();
        assert_eq!(state.projected_gravity(), -Vector3::z());
        // Pitched forward by a quarter turn the robot lies on its face: down is its own +x.
        state.orientation = UnitQuaternion::from_euler_angles(0.0, FRAC_PI_2, 0.0);
        assert!(close(state.projected_gravity(), Vector3::x()));
        // Rolled by +90° about x the left side is up: down is its own −y.
        state.orientation = UnitQuaternion::from_euler_angles(FRAC_PI_2, 0.0, 0.0);
        assert!(close(state.projected_gravity(), -Vector3::y()));
    }

    #[test]
    fn vectors_turn_as_nalgebra_turns_them() {
        let mut state = RobotState::standing();
        state.orientation = UnitQuaternion::from_euler_angles(0.4, -0.7, 2.1);
        state.linear_velocity = Vector3::new(1.0, -2.0, 3.0);
        state.angular_velocity = Vector3::new(-0.5, 0.25, 2.0);
        let turned = |v| state.orientation.inverse_transform_vector(&v);
        assert!(close(state.projected_gravity(), turned(-Vector3::z())));
        assert!(close(
            state.velocity_in_base(),
            turned(state.linear_velocity)
        ));
        let angular = turned(state.angular_velocity);
        assert!(close(state.angular_velocity_in_base(), angular));
    }

    #[test]
    fn heading_frame_turns_with_yaw_only() {
        let mut state = RobotState::standing();
        state.linear_velocity = Vector3::new(0.0, 1.0, 0.5);
        // Facing world y and pitched: moving along world y is moving straight ahead.
        state.orientation = UnitQuaternion::from_euler_angles(0.1, FRAC_PI_4, FRAC_PI_2);
        assert!((state.yaw() - FRAC_PI_2).abs() < 1e-6);
        assert!((state.velocity_in_heading() - Vector2::new(1.0, 0.0)).norm() < 1e-6);
        // Facing world x the same motion is to the left.
        state.orientation = UnitQuaternion::identity();
        assert_eq!(state.velocity_in_heading(), Vector2::new(0.0, 1.0));
    }

    #[test]
    fn base_frame_turns_with_the_pelvis() {
        let mut state = RobotState::standing();
        state.orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2);
        state.linear_velocity = Vector3::new(0.0, 2.0, 3.0);
        state.angular_velocity = Vector3::new(1.0, 0.0, 0.0);
        // Facing y: world y is ahead, and world x is to the right (−y of the base).
        assert!(close(state.velocity_in_base(), Vector3::new(2.0, 0.0, 3.0)));
        assert!(close(
            state.angular_velocity_in_base(),
            Vector3::new(0.0, -1.0, 0.0)
        ));
    }
}
