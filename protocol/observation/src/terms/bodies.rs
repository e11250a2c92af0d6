//! Of the body: where feet, hands and head are.

use crate::reflect::polar;
use crate::term::{Kind, Term};
use g1::kinematics::key_points;

pub(crate) static KEY_BODIES: Term = Term {
    name: "key_bodies",
    labels: &[
        "left_foot_x",
        "left_foot_y",
        "left_foot_z",
        "right_foot_x",
        "right_foot_y",
        "right_foot_z",
        "left_hand_x",
        "left_hand_y",
        "left_hand_z",
        "right_hand_x",
        "right_hand_y",
        "right_hand_z",
        "head_x",
        "head_y",
        "head_z",
    ],
    write: |scene, out| {
        let points = key_points(&scene.state.joint_positions);
        for (out, point) in out.chunks_exact_mut(3).zip(points) {
            out.copy_from_slice(point.coords.as_slice());
        }
    },
    // Left and right change places in pairs; the head has none.
    mirror: |i| {
        let (axis, sign) = polar(i % 3);
        let body = match i / 3 {
            body @ 0..4 => body ^ 1,
            head => head,
        };
        (3 * body + axis, sign)
    },
    kind: Kind::Length,
    unit: "m",
    frame: "base",
    meaning: "feet, hands and head, seen from the pelvis",
};
