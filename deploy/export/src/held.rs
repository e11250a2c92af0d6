//! Motors of the larger G1, of 29, that a policy of 23 joints does not drive: where the smaller robot is rigid.
//!
//! Separate because they are no joints of this project's robot: they are facts about another one that runs its policies.

use serde::{Deserialize, Serialize};

/// A motor that is held at its default position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldMotor {
    /// Name of its joint in Unitree's URDF.
    pub name: String,
    /// Index of its motor in Unitree's `LowCmd` and `LowState` (`unitree_hg`).
    pub unitree_motor: u32,
    /// rad.
    pub default_position: f64,
    /// rad.
    pub lower: f64,
    /// rad.
    pub upper: f64,
    /// N·m/rad.
    pub kp: f64,
    /// N·m·s/rad.
    pub kd: f64,
    /// N·m.
    pub effort: f64,
    /// rad/s.
    pub velocity_limit: f64,
}

struct Kind {
    limit: f64,
    kd: f64,
    effort: f64,
    velocity_limit: f64,
}

/// Range: `g1_29dof.xml` of unitree_mujoco (BSD-3-Clause). The rest: unitree_rl_lab's configuration of the robot
/// (Apache-2.0), which drives the waist with half of what that model allows.
const WAIST: Kind = Kind {
    limit: 0.52,
    kd: 5.0,
    effort: 25.0,
    velocity_limit: 37.0,
};
const WRIST: Kind = Kind {
    limit: 1.61443,
    kd: 1.0,
    effort: 5.0,
    velocity_limit: 22.0,
};
const KP: f64 = 40.0;

const MOTORS: [(&str, u32, Kind); 6] = [
    ("waist_roll_joint", 13, WAIST),
    ("waist_pitch_joint", 14, WAIST),
    ("left_wrist_pitch_joint", 20, WRIST),
    ("left_wrist_yaw_joint", 21, WRIST),
    ("right_wrist_pitch_joint", 27, WRIST),
    ("right_wrist_yaw_joint", 28, WRIST),
];

/// All of them, by index.
pub fn motors() -> Vec<HeldMotor> {
    let motor = |(name, unitree_motor, kind): (&str, u32, Kind)| HeldMotor {
        name: name.to_owned(),
        unitree_motor,
        default_position: 0.0,
        lower: -kind.limit,
        upper: kind.limit,
        kp: KP,
        kd: kind.kd,
        effort: kind.effort,
        velocity_limit: kind.velocity_limit,
    };
    MOTORS.into_iter().map(motor).collect()
}
