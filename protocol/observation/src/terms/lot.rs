//! Of what befalls a robot (`[event]`): late commands and sensors, other motors, sloping ground, a force.

use super::joints::NAMES;
use crate::reflect::{pairs, polar, put, same};
use crate::term::{Kind, Term};
use nalgebra::Vector3;

pub(crate) static DELAYS: Term = Term {
    name: "delays",
    labels: &["action", "observation"],
    write: |scene, out| out.copy_from_slice(&scene.truth.lot.delays),
    mirror: same,
    kind: Kind::Beside,
    unit: "s",
    frame: "",
    meaning: "from an action to the motors, and age of what the policy sees",
};

pub(crate) static STIFFNESS: Term = Term {
    name: "stiffness",
    labels: &NAMES,
    write: |scene, out| out.copy_from_slice(&scene.truth.lot.stiffness),
    mirror: pairs,
    kind: Kind::Beside,
    unit: "1",
    frame: "joint",
    meaning: "factor of kp",
};

pub(crate) static DAMPING: Term = Term {
    name: "damping",
    labels: &NAMES,
    write: |scene, out| out.copy_from_slice(&scene.truth.lot.damping),
    mirror: pairs,
    kind: Kind::Beside,
    unit: "1",
    frame: "joint",
    meaning: "factor of kd",
};

pub(crate) static MOTOR_STRENGTH: Term = Term {
    name: "motor_strength",
    labels: &NAMES,
    write: |scene, out| out.copy_from_slice(&scene.truth.lot.motor_strength),
    mirror: pairs,
    kind: Kind::Beside,
    unit: "1",
    frame: "joint",
    meaning: "factor of the greatest torque",
};

pub(crate) static SLOPE: Term = Term {
    name: "slope",
    labels: &["x", "y", "z"],
    write: |scene, out| {
        let down = Vector3::from(scene.truth.lot.down);
        put(
            &scene.state.orientation.inverse_transform_vector(&down),
            out,
        );
    },
    mirror: polar,
    kind: Kind::Beside,
    unit: "1",
    frame: "base",
    meaning: "true direction of gravity, which leans where the ground slopes, unit length",
};

pub(crate) static FORCE: Term = Term {
    name: "force",
    labels: &["x", "y", "z"],
    write: |scene, out| {
        let force = Vector3::from(scene.truth.lot.force);
        put(
            &scene.state.orientation.inverse_transform_vector(&force),
            out,
        );
    },
    mirror: polar,
    kind: Kind::Beside,
    unit: "N",
    frame: "base",
    meaning: "on the torso in the last step",
};
