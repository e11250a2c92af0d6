//! The built-in walk written as other programs would, and broken files.

use super::*;
use crate::gait;
use crate::import::file::npz::tests::Builder;
use crate::import::file::pickle::tests::Writer;
use g1::RobotState;
use g1::kinematics::forward_state;
use std::path::Path;

fn walk() -> Vec<RobotState> {
    gait::walk(1.0).unwrap().frames
}

fn named(state: &RobotState, names: &[&str]) -> Vec<f64> {
    let ours = joints::ours();
    let angle = |name: &&str| {
        let joint = ours.iter().position(|ours| ours == name);
        joint.map_or(0.0, |j| f64::from(state.joint_positions[j]))
    };
    names.iter().map(angle).collect()
}

/// BeyondMimic's layout in an order of joints; bodies that the robot with 23 joints lacks are at the origin.
pub(in crate::import) fn beyond_mimic_file(names: &[&str]) -> Vec<u8> {
    let frames = walk();
    let (mut angles, mut places, mut turns) = (Vec::new(), Vec::new(), Vec::new());
    for state in &frames {
        angles.extend(named(state, names));
        let bodies = forward_state(state);
        for body in 0..=names.len() {
            let ours = match body.checked_sub(1).map(|joint| names[joint]) {
                None => Some(0),
                Some(name) => joints::ours()
                    .iter()
                    .position(|ours| *ours == name)
                    .map(|j| j + 1),
            };
            let Some(ours) = ours else {
                places.extend([0.0; 3]);
                turns.extend([1.0, 0.0, 0.0, 0.0]);
                continue;
            };
            places.extend(
                bodies[ours]
                    .translation
                    .vector
                    .iter()
                    .map(|x| f64::from(*x)),
            );
            let q = bodies[ours].rotation;
            turns.extend([q.w, q.i, q.j, q.k].map(f64::from));
        }
    }
    let (t, n) = (frames.len() as u64, names.len() as u64);
    Builder::new()
        .numbers("fps", &[1], &[50.0])
        .numbers("joint_pos", &[t, n], &angles)
        .numbers("body_pos_w", &[t, n + 1, 3], &places)
        .numbers("body_quat_w", &[t, n + 1, 4], &turns)
        .done()
}

/// GMR's layout: quaternions with the scalar last.
pub(in crate::import) fn gmr_file(joints: usize) -> Vec<u8> {
    let frames = walk();
    let names: Vec<&str> = if joints == 29 {
        SDK_29.to_vec()
    } else {
        joints::ours().to_vec()
    };
    let angles: Vec<f64> = frames.iter().flat_map(|s| named(s, &names)).collect();
    let places: Vec<f64> = frames
        .iter()
        .flat_map(|s| s.position.iter().map(|x| f64::from(*x)).collect::<Vec<_>>())
        .collect();
    let turns: Vec<f64> = frames
        .iter()
        .flat_map(|s| {
            [
                s.orientation.i,
                s.orientation.j,
                s.orientation.k,
                s.orientation.w,
            ]
            .map(f64::from)
        })
        .collect();
    let t = frames.len();
    Writer::new()
        .op(b"}(")
        .text("fps")
        .integer(50)
        .text("root_pos")
        .array(&[t, 3], &places)
        .text("root_rot")
        .array(&[t, 4], &turns)
        .text("dof_pos")
        .array(&[t, joints], &angles[..t * joints.min(names.len())])
        .text("local_body_pos")
        .op(b"N")
        .op(b"u")
        .done()
}

fn file(bytes: &[u8]) -> File<'_> {
    File {
        path: Path::new("walk"),
        bytes,
    }
}

#[test]
fn the_order_of_joints_is_told_by_where_the_feet_are() {
    let ours = joints::ours();
    for (names, told) in [
        (&SDK_29[..], "SDK"),
        (&ISAAC_29, "Isaac"),
        (&ours, "SDK"),
        (&ISAAC_23, "Isaac"),
        (&Order::Waist.names(), "ASAP"),
    ] {
        let bytes = beyond_mimic_file(names);
        let mut decisions = Vec::new();
        let (rows, fps) = beyond_mimic(&file(&bytes), &mut decisions).unwrap();
        assert_eq!(fps, Some(50.0));
        assert!(
            decisions[0].contains(&format!("joints in {told}"))
                || decisions[0].contains(&format!("joints in the {told}")),
            "{decisions:?}"
        );
        for (row, state) in rows.iter().zip(walk()) {
            for ((a, b), name) in row.joints.iter().zip(state.joint_positions).zip(ours) {
                let expected = if names.contains(&name) {
                    f64::from(b)
                } else {
                    0.0
                };
                assert!((a - expected).abs() < 1e-6, "{told}: {name}");
            }
        }
    }
}

#[test]
fn gmr_gives_29_or_23_joints() {
    for joints in [29, 23] {
        let bytes = gmr_file(joints);
        let (rows, fps) = gmr(&file(&bytes), false, &mut Vec::new()).unwrap();
        assert_eq!((rows.len(), fps), (walk().len(), Some(50.0)));
        assert!((rows[3].joints[22] - f64::from(walk()[3].joint_positions[22])).abs() < 1e-6);
    }
}

#[test]
fn errors_say_what_is_expected() {
    let build = |width: u64, place: f64| {
        Builder::new()
            .numbers("joint_pos", &[1, width], &vec![0.0; width as usize])
            .numbers(
                "body_pos_w",
                &[1, width + 1, 3],
                &vec![place; 3 * (width as usize + 1)],
            )
            .numbers(
                "body_quat_w",
                &[1, width + 1, 4],
                &[1.0, 0.0, 0.0, 0.0].repeat(width as usize + 1),
            )
            .done()
    };
    for (bytes, parts) in [
        (build(20, 0.0), ["joint_pos", "[1, 20]", "23 or 29"]),
        (build(29, 0.3), ["walk", "no known order", "joint_names"]),
        (
            build(29, f64::NAN),
            ["frame 1, body_pos_w[0]", "NaN", "repair"],
        ),
    ] {
        let message = beyond_mimic(&file(&bytes), &mut Vec::new())
            .unwrap_err()
            .to_string();
        for part in parts {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
    }
    let bytes = Writer::new()
        .op(b"}")
        .text("fps")
        .integer(30)
        .op(b"s")
        .done();
    let message = gmr(&file(&bytes), false, &mut Vec::new())
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("root_pos") && message.contains("but fps"),
        "{message}"
    );
}
