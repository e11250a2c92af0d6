//! The 23 joints: frames, limits, motors, gains, default pose, and the one joint order.
//!
//! Separate because the order is the contract of every vector of 23 numbers in the project.
//! Geometry, limits and efforts: Unitree's `robots/g1_description/g1_23dof_rev_1_0.urdf` in
//! unitreerobotics/unitree_ros at commit d6f13aad, BSD-3-Clause. Gains, armature, default pose and
//! action scale: `UNITREE_G1_23DOF_CFG` of unitree_rl_lab (read at 08332d5d), Apache-2.0.
//!
//! The order is that of Unitree's SDK without the six joints that the 23-joint robot lacks:
//! left leg 0–5, right leg 6–11, waist yaw 12, left arm 13–17, right arm 18–22.

use crate::JOINTS;

/// A hinge and the motor that drives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Name in the URDF, ending in `_joint`.
    pub name: &'static str,
    /// Index of the body that carries the joint; the joint moves body `index + 1`.
    pub parent: usize,
    /// Axis of rotation in the joint frame: a unit vector along x, y or z.
    pub axis: [f64; 3],
    /// Origin of the joint frame in the parent frame, m.
    pub origin: [f64; 3],
    /// Orientation of the joint frame in the parent frame, rad: R = Rz(yaw)·Ry(pitch)·Rx(roll).
    pub rpy: [f64; 3],
    /// Lower position limit, rad.
    pub lower: f64,
    /// Upper position limit, rad.
    pub upper: f64,
    /// Greatest torque, N·m.
    pub effort: f64,
    /// Greatest speed, rad/s.
    pub velocity_limit: f64,
    /// Stiffness of the position controller, N·m/rad.
    pub kp: f64,
    /// Damping of the position controller, N·m·s/rad.
    pub kd: f64,
    /// Rotor inertia felt at the joint, kg·m².
    pub armature: f64,
    /// Position in the default pose, rad.
    pub default_position: f64,
}

/// Action to target offset, rad per unit: target = default pose + scale · action.
pub const ACTION_SCALE: f32 = 0.25;
/// Joint index of the left hip pitch; the left leg is six joints from here.
pub const LEFT_LEG: usize = 0;
/// Joint index of the right hip pitch; the right leg is six joints from here.
pub const RIGHT_LEG: usize = 6;
/// Joint index of the waist yaw.
pub const WAIST: usize = 12;
/// Joint index of the left shoulder pitch; the left arm is five joints from here.
pub const LEFT_ARM: usize = 13;
/// Joint index of the right shoulder pitch; the right arm is five joints from here.
pub const RIGHT_ARM: usize = 18;

/// The default pose, rad: knees slightly bent, arms beside the body.
pub const DEFAULT_POSE: [f32; JOINTS] = {
    let mut pose = [0.0; JOINTS];
    let mut i = 0;
    while i < JOINTS {
        pose[i] = JOINT_TABLE[i].default_position as f32;
        i += 1;
    }
    pose
};

/// The joint of that name.
pub fn index_of(name: &str) -> Option<usize> {
    JOINT_TABLE.iter().position(|joint| joint.name == name)
}

struct Motor {
    effort: f64,
    velocity_limit: f64,
    kp: f64,
    kd: f64,
}

const fn motor(effort: f64, velocity_limit: f64, kp: f64, kd: f64) -> Motor {
    Motor {
        effort,
        velocity_limit,
        kp,
        kd,
    }
}

const HIP: Motor = motor(88.0, 32.0, 100.0, 2.0);
const HIP_ROLL: Motor = motor(139.0, 20.0, 100.0, 2.0);
const KNEE: Motor = motor(139.0, 20.0, 150.0, 4.0);
const ANKLE: Motor = motor(35.0, 30.0, 40.0, 2.0);
const WAIST_YAW: Motor = motor(88.0, 32.0, 200.0, 5.0);
const ARM: Motor = motor(25.0, 37.0, 40.0, 1.0);
const ARMATURE: f64 = 0.01;

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

// A macro only so that a row of the table stays a line.
macro_rules! table {
    ($(($name:literal, $parent:literal, $axis:ident, $origin:expr, $rpy:expr, $lower:expr, $upper:expr, $motor:ident, $default:expr),)*) => {
        [$(Joint {
            name: $name,
            parent: $parent,
            axis: $axis,
            origin: $origin,
            rpy: $rpy,
            lower: $lower,
            upper: $upper,
            effort: $motor.effort,
            velocity_limit: $motor.velocity_limit,
            kp: $motor.kp,
            kd: $motor.kd,
            armature: ARMATURE,
            default_position: $default,
        }),*]
    };
}

/// The joints in order: name, parent, axis, origin, roll-pitch-yaw, limits, motor, default position.
#[expect(
    clippy::approx_constant,
    reason = "the URDF's rounded limits, kept as published"
)]
pub const JOINT_TABLE: [Joint; JOINTS] = table! {
        ("left_hip_pitch_joint",       0,   Y, [0.0, 0.064452, -0.1027], [0.0, 0.0, 0.0], -2.5307, 2.8798, HIP, -0.1),
        ("left_hip_roll_joint",        1,   X, [0.0, 0.052, -0.030465], [0.0, -0.1749, 0.0], -0.5236, 2.9671, HIP_ROLL, 0.0),
        ("left_hip_yaw_joint",         2,   Z, [0.025001, 0.0, -0.12412], [0.0, 0.0, 0.0], -2.7576, 2.7576, HIP, 0.0),
        ("left_knee_joint",            3,   Y, [-0.078273, 0.0021489, -0.17734], [0.0, 0.1749, 0.0], -0.087267, 2.8798, KNEE, 0.3),
        ("left_ankle_pitch_joint",     4,   Y, [0.0, -9.4445e-05, -0.30001], [0.0, 0.0, 0.0], -0.87267, 0.5236, ANKLE, -0.2),
        ("left_ankle_roll_joint",      5,   X, [0.0, 0.0, -0.017558], [0.0, 0.0, 0.0], -0.2618, 0.2618, ANKLE, 0.0),
        ("right_hip_pitch_joint",      0,   Y, [0.0, -0.064452, -0.1027], [0.0, 0.0, 0.0], -2.5307, 2.8798, HIP, -0.1),
        ("right_hip_roll_joint",       7,   X, [0.0, -0.052, -0.030465], [0.0, -0.1749, 0.0], -2.9671, 0.5236, HIP_ROLL, 0.0),
        ("right_hip_yaw_joint",        8,   Z, [0.025001, 0.0, -0.12412], [0.0, 0.0, 0.0], -2.7576, 2.7576, HIP, 0.0),
        ("right_knee_joint",           9,   Y, [-0.078273, -0.0021489, -0.17734], [0.0, 0.1749, 0.0], -0.087267, 2.8798, KNEE, 0.3),
        ("right_ankle_pitch_joint",    10,  Y, [0.0, 9.4445e-05, -0.30001], [0.0, 0.0, 0.0], -0.87267, 0.5236, ANKLE, -0.2),
        ("right_ankle_roll_joint",     11,  X, [0.0, 0.0, -0.017558], [0.0, 0.0, 0.0], -0.2618, 0.2618, ANKLE, 0.0),
        ("waist_yaw_joint",            0,   Z, [-0.0039635, 0.0, 0.044], [0.0, 0.0, 0.0], -2.618, 2.618, WAIST_YAW, 0.0),
        ("left_shoulder_pitch_joint",  13,  Y, [0.0039563, 0.10022, 0.24778], [0.27931, 5.4949e-05, -0.00019159], -3.0892, 2.6704, ARM, 0.3),
        ("left_shoulder_roll_joint",   14,  X, [0.0, 0.038, -0.013831], [-0.27925, 0.0, 0.0], -1.5882, 2.2515, ARM, 0.25),
        ("left_shoulder_yaw_joint",    15,  Z, [0.0, 0.00624, -0.1032], [0.0, 0.0, 0.0], -2.618, 2.618, ARM, 0.0),
        ("left_elbow_joint",           16,  Y, [0.015783, 0.0, -0.080518], [0.0, 0.0, 0.0], -1.0472, 2.0944, ARM, 0.97),
        ("left_wrist_roll_joint",      17,  X, [0.1, 0.00188791, -0.01], [0.0, 0.0, 0.0], -1.972222054, 1.972222054, ARM, 0.15),
        ("right_shoulder_pitch_joint", 13,  Y, [0.0039563, -0.10021, 0.24778], [-0.27931, 5.4949e-05, 0.00019159], -3.0892, 2.6704, ARM, 0.3),
        ("right_shoulder_roll_joint",  19,  X, [0.0, -0.038, -0.013831], [0.27925, 0.0, 0.0], -2.2515, 1.5882, ARM, -0.25),
        ("right_shoulder_yaw_joint",   20,  Z, [0.0, -0.00624, -0.1032], [0.0, 0.0, 0.0], -2.618, 2.618, ARM, 0.0),
        ("right_elbow_joint",          21,  Y, [0.015783, 0.0, -0.080518], [0.0, 0.0, 0.0], -1.0472, 2.0944, ARM, 0.97),
        ("right_wrist_roll_joint",     22,  X, [0.1, -0.00188791, -0.01], [0.0, 0.0, 0.0], -1.972222054, 1.972222054, ARM, -0.15),
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_is_legs_waist_arms() {
        // SDK order of the 29-joint robot without indices 13, 14, 20, 21, 27, 28.
        let leg = [
            "hip_pitch",
            "hip_roll",
            "hip_yaw",
            "knee",
            "ankle_pitch",
            "ankle_roll",
        ];
        let arm = [
            "shoulder_pitch",
            "shoulder_roll",
            "shoulder_yaw",
            "elbow",
            "wrist_roll",
        ];
        let mut expected = Vec::new();
        expected.extend(leg.map(|part| format!("left_{part}_joint")));
        expected.extend(leg.map(|part| format!("right_{part}_joint")));
        expected.push("waist_yaw_joint".into());
        expected.extend(arm.map(|part| format!("left_{part}_joint")));
        expected.extend(arm.map(|part| format!("right_{part}_joint")));
        let names: Vec<_> = JOINT_TABLE.iter().map(|joint| joint.name).collect();
        assert_eq!(names, expected);
        assert_eq!(index_of("right_knee_joint"), Some(RIGHT_LEG + 3));
        assert_eq!(index_of("waist_yaw_joint"), Some(WAIST));
        assert_eq!(index_of("right_wrist_roll_joint"), Some(RIGHT_ARM + 4));
        assert_eq!(index_of("tail_joint"), None);
    }

    #[test]
    fn axis_is_in_the_name_and_the_default_pose_within_limits() {
        for joint in &JOINT_TABLE {
            let axis = match joint.name {
                n if n.contains("roll") => X,
                n if n.contains("yaw") => Z,
                _ => Y, // pitch, knee, elbow
            };
            assert_eq!(joint.axis, axis, "{}", joint.name);
            assert!(joint.lower < joint.default_position, "{}", joint.name);
            assert!(joint.default_position < joint.upper, "{}", joint.name);
        }
    }

    #[test]
    fn gains_are_those_of_unitree_rl_lab() {
        let gains = |name: &str| {
            let joint = JOINT_TABLE[index_of(name).unwrap()];
            (joint.kp, joint.kd, joint.effort)
        };
        assert_eq!(gains("left_hip_pitch_joint"), (100.0, 2.0, 88.0));
        assert_eq!(gains("right_hip_roll_joint"), (100.0, 2.0, 139.0));
        assert_eq!(gains("left_knee_joint"), (150.0, 4.0, 139.0));
        assert_eq!(gains("right_ankle_pitch_joint"), (40.0, 2.0, 35.0));
        assert_eq!(gains("waist_yaw_joint"), (200.0, 5.0, 88.0));
        assert_eq!(gains("left_elbow_joint"), (40.0, 1.0, 25.0));
    }
}
