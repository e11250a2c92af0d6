//! Of the pelvis: height, velocities, where down is.

use crate::reflect::{axial, polar, put, same};
use crate::term::{Kind, Term};

pub(crate) static HEIGHT: Term = Term {
    name: "height",
    labels: &["z"],
    write: |scene, out| out[0] = scene.state.position.z,
    mirror: same,
    kind: Kind::Length,
    unit: "m",
    frame: "world",
    meaning: "z of the pelvis link's origin above the ground",
};

pub(crate) static LINEAR_VELOCITY: Term = Term {
    name: "linear_velocity",
    labels: &["x", "y", "z"],
    write: |scene, out| put(&scene.state.velocity_in_base(), out),
    mirror: polar,
    kind: Kind::LinearVelocity,
    unit: "m/s",
    frame: "base",
    meaning: "velocity of the pelvis link's origin",
};

pub(crate) static ANGULAR_VELOCITY: Term = Term {
    name: "angular_velocity",
    labels: &["x", "y", "z"],
    write: |scene, out| put(&scene.state.angular_velocity_in_base(), out),
    mirror: axial,
    kind: Kind::AngularVelocity,
    unit: "rad/s",
    frame: "base",
    meaning: "of the pelvis",
};

pub(crate) static GRAVITY: Term = Term {
    name: "gravity",
    labels: &["x", "y", "z"],
    write: |scene, out| put(&scene.state.projected_gravity(), out),
    mirror: polar,
    kind: Kind::Gravity,
    unit: "1",
    frame: "base",
    meaning: "direction of gravity, unit length: (0, 0, -1) upright",
};
