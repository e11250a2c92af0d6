//! The table of all terms, one line each, and the paper's two lists. A term is a constant in a file by its subject.

mod base;
mod bodies;
mod joints;
mod lot;
mod task;
mod truth;

use crate::scene::Scene;
use crate::term::{Term, Writer};

/// Every term that there is.
pub static TERMS: [&Term; 22] = [
    &base::HEIGHT,
    &base::LINEAR_VELOCITY,
    &base::ANGULAR_VELOCITY,
    &base::GRAVITY,
    &task::COMMAND,
    &joints::JOINT_POSITION,
    &joints::JOINT_ANGLE,
    &joints::JOINT_VELOCITY,
    &task::PREVIOUS_ACTION,
    &bodies::KEY_BODIES,
    &truth::FRICTION,
    &truth::PAYLOAD,
    &truth::COM_OFFSET,
    &truth::FOOT_FORCES,
    &truth::CONTACTS,
    &truth::PUSH,
    &lot::DELAYS,
    &lot::STIFFNESS,
    &lot::DAMPING,
    &lot::MOTOR_STRENGTH,
    &lot::SLOPE,
    &lot::FORCE,
];

/// Sequences of terms that one function writes at once: the paper's two lists. They write what the terms' own functions
/// would, and faster.
pub(crate) static TOGETHER: [(&[&str], Writer); 2] = [
    (&PAPER_ACTOR, |scene, out| {
        let Scene { state, .. } = scene;
        g1::observation::policy_observation(state, scene.command, scene.previous_action, out);
    }),
    (&PAPER_DISCRIMINATOR, |scene, out| {
        g1::observation::features(scene.state, out);
    }),
];

/// What the policy sees (Section III-A).
pub const PAPER_ACTOR: [&str; 8] = [
    "height",
    "linear_velocity",
    "angular_velocity",
    "gravity",
    "command",
    "joint_position",
    "joint_velocity",
    "previous_action",
];

/// What the discriminator sees (Section III-A).
pub const PAPER_DISCRIMINATOR: [&str; 5] = [
    "height",
    "linear_velocity",
    "angular_velocity",
    "joint_angle",
    "joint_velocity",
];

/// The name by which the critic's list takes in all that the actor sees, as the actor sees it.
pub const ACTOR: &str = "actor";

/// The term of a name.
pub fn named(name: &str) -> Option<&'static Term> {
    TERMS.iter().copied().find(|term| term.name == name)
}

#[cfg(test)]
mod tests;
