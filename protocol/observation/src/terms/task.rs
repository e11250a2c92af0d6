//! Of the task: what is asked for, and what was done last.

use super::joints::NAMES;
use crate::reflect::of_joints;
use crate::term::{Kind, Term};
use g1::mirror::mirror_command;

pub(crate) static COMMAND: Term = Term {
    name: "command",
    labels: &["forward", "left", "yaw_rate"],
    write: |scene, out| out.copy_from_slice(scene.command),
    mirror: |i| (i, mirror_command([1.0; g1::COMMAND])[i]),
    kind: Kind::Beside,
    unit: "m/s, m/s, rad/s",
    frame: "heading",
    meaning: "forward and leftward velocity, yaw rate that are asked for",
};

pub(crate) static PREVIOUS_ACTION: Term = Term {
    name: "previous_action",
    labels: &NAMES,
    write: |scene, out| out.copy_from_slice(scene.previous_action),
    mirror: of_joints,
    kind: Kind::Beside,
    unit: "1",
    frame: "joint",
    meaning: "the network's output one step before",
};
