//! The Unitree G1 with 23 joints, as facts: bodies, joints, frames, and what the policy sees of them.
//!
//! Separate because the simulation, the reference motion and the networks must agree on one joint
//! order and one set of frames. SI units throughout; the world has z up, a base frame has x forward
//! and y left. Tables are `f64` constants; what runs at 50 Hz is `f32`.
//!
//! | subject | file |
//! | --- | --- |
//! | masses and inertias of the 24 bodies, the foot box | [`links`] |
//! | the 23 joints: frames, limits, gains, default pose, the joint order | [`joints`] |
//! | torque of the motors at speed | [`motors`] |
//! | measures of a gait: hips, contacts, feet, motors, and a verdict | [`gait`] |
//! | a state of the robot and its frames | [`state`] |
//! | what the policy and the discriminator see | [`observation`] |
//! | left–right reflection | [`mirror`] |
//! | forward kinematics, Jacobian, foot and mass points | [`kinematics`] |
//! | what the bodies look like in pictures | [`shapes`] |
//! | which parts of the robot can touch each other | [`collision`] |
//! | the same robot as MJCF, for MuJoCo | [`mjcf`] |
#![forbid(unsafe_code)]

pub mod collision;
pub mod gait;
pub mod joints;
pub mod kinematics;
pub mod links;
pub mod mirror;
pub mod mjcf;
pub mod motors;
pub mod observation;
pub mod shapes;
pub mod state;

pub use joints::{ACTION_SCALE, DEFAULT_POSE, JOINT_TABLE, Joint};
pub use links::{LEFT_FOOT, LINK_TABLE, Link, RIGHT_FOOT};
pub use state::RobotState;

/// Rigid bodies of the robot, the pelvis first.
pub const BODIES: usize = 24;
/// Actuated joints; joint `i` moves body `i + 1`.
pub const JOINTS: usize = 23;
/// Numbers in a policy observation (III-A).
pub const OBSERVATION: usize = 82;
/// Numbers in the features of one time step that the discriminator sees (III-A).
pub const FEATURES: usize = 53;
/// Numbers in an action: one target offset per joint.
pub const ACTION: usize = JOINTS;
/// Numbers in a command: forward velocity, leftward velocity (m/s), yaw rate (rad/s).
pub const COMMAND: usize = 3;
