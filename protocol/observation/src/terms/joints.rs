//! Of the joints: positions and velocities.

use crate::reflect::of_joints;
use crate::term::{Kind, Term};
use g1::{DEFAULT_POSE, JOINT_TABLE, JOINTS};

/// Names of the joints in their order.
pub(crate) static NAMES: [&str; JOINTS] = {
    let mut names = [""; JOINTS];
    let mut i = 0;
    while i < JOINTS {
        names[i] = JOINT_TABLE[i].name;
        i += 1;
    }
    names
};

pub(crate) static JOINT_POSITION: Term = Term {
    name: "joint_position",
    labels: &NAMES,
    write: |scene, out| {
        for ((relative, position), rest) in out
            .iter_mut()
            .zip(scene.state.joint_positions)
            .zip(DEFAULT_POSE)
        {
            *relative = position - rest;
        }
    },
    mirror: of_joints,
    kind: Kind::JointPosition,
    unit: "rad",
    frame: "joint",
    meaning: "less the default position",
};

pub(crate) static JOINT_ANGLE: Term = Term {
    name: "joint_angle",
    labels: &NAMES,
    write: |scene, out| out.copy_from_slice(&scene.state.joint_positions),
    mirror: of_joints,
    kind: Kind::JointPosition,
    unit: "rad",
    frame: "joint",
    meaning: "the joints' own positions, nothing taken away",
};

pub(crate) static JOINT_VELOCITY: Term = Term {
    name: "joint_velocity",
    labels: &NAMES,
    write: |scene, out| out.copy_from_slice(&scene.state.joint_velocities),
    mirror: of_joints,
    kind: Kind::JointVelocity,
    unit: "rad/s",
    frame: "joint",
    meaning: "",
};
