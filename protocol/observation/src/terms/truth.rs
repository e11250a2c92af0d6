//! Of the simulation: what the robot itself cannot know.

use crate::reflect::{polar, put, same, sides};
use crate::term::{Kind, Term};
use g1::gait::CONTACT_FORCE;
use nalgebra::Vector3;

pub(crate) static FRICTION: Term = Term {
    name: "friction",
    labels: &["coefficient"],
    write: |scene, out| out[0] = scene.truth.friction,
    mirror: same,
    kind: Kind::Beside,
    unit: "1",
    frame: "",
    meaning: "friction coefficient between soles and ground",
};

pub(crate) static PAYLOAD: Term = Term {
    name: "payload",
    labels: &["mass"],
    write: |scene, out| out[0] = scene.truth.payload,
    mirror: same,
    kind: Kind::Beside,
    unit: "kg",
    frame: "",
    meaning: "added to the torso's mass",
};

pub(crate) static COM_OFFSET: Term = Term {
    name: "com_offset",
    labels: &["x", "y", "z"],
    write: |scene, out| out.copy_from_slice(&scene.truth.com_offset),
    mirror: polar,
    kind: Kind::Beside,
    unit: "m",
    frame: "torso",
    meaning: "added to the torso's centre of mass",
};

pub(crate) static FOOT_FORCES: Term = Term {
    name: "foot_forces",
    labels: &["left", "right"],
    write: |scene, out| out.copy_from_slice(&scene.truth.foot_forces),
    mirror: sides,
    kind: Kind::Beside,
    unit: "N",
    frame: "world",
    meaning: "vertical force on each sole, mean over the last step",
};

pub(crate) static CONTACTS: Term = Term {
    name: "contacts",
    labels: &["left", "right"],
    write: |scene, out| {
        let down = scene.truth.foot_forces.map(|force| force > CONTACT_FORCE);
        out.copy_from_slice(&down.map(|down| f32::from(u8::from(down))));
    },
    mirror: sides,
    kind: Kind::Beside,
    unit: "1",
    frame: "",
    meaning: "1 where a foot carried more than 20 N in the last step, else 0",
};

pub(crate) static PUSH: Term = Term {
    name: "push",
    labels: &["x", "y", "z"],
    write: |scene, out| {
        let push = Vector3::from(scene.truth.push);
        put(
            &scene.state.orientation.inverse_transform_vector(&push),
            out,
        );
    },
    mirror: polar,
    kind: Kind::Beside,
    unit: "m/s",
    frame: "base",
    meaning: "jump of velocity by a push in the last step, zeros where there was none",
};
