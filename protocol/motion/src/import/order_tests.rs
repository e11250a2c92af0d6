//! Arms that hang, in both orders, and poses that could be either.

use super::*;
use std::path::Path;

/// A posture by name, rad; the rest is zero.
fn frames(order: Order, count: usize, posture: &[(&str, f64)]) -> Array {
    let angle = |name: &&str| {
        posture
            .iter()
            .find(|(n, _)| n == name)
            .map_or(0.0, |(_, a)| *a)
    };
    let frame = order.names().iter().map(angle).collect::<Vec<f64>>();
    Array::of(vec![count, JOINTS], frame.repeat(count), false).unwrap()
}

/// Arms beside the body, elbows bent, wrists turned in: a pair.
const HANGING: [(&str, f64); 9] = [
    ("left_knee", 0.3),
    ("left_shoulder_pitch", 0.2),
    ("left_shoulder_roll", 0.25),
    ("left_elbow", 0.9),
    ("left_wrist_roll", 0.1),
    ("right_shoulder_pitch", 0.2),
    ("right_shoulder_roll", -0.25),
    ("right_elbow", 0.9),
    ("right_wrist_roll", -0.1),
];

fn told(angles: &Array, said: Said) -> Result<(Array, Vec<String>, Vec<String>), String> {
    let file = File {
        path: Path::new("walk.pkl"),
        bytes: b"",
    };
    let mut decisions = Vec::new();
    of_g1(&file, (angles, "dof_pos"), said, &mut decisions)
        .map(|(array, names)| (array, names, decisions))
        .map_err(|e| e.to_string())
}

fn angle(array: &Array, names: &[String], name: &str) -> f64 {
    array.frame(0)[names.iter().position(|n| *n == name).unwrap()]
}

#[test]
fn the_orders_are_those_of_the_two_robots() {
    // humanoidverse/config/robot/g1/g1_29dof_anneal_23dof.yaml of ASAP, from the 13th joint on.
    assert_eq!(
        Order::Waist.names()[12..],
        [
            "waist_yaw",
            "waist_roll",
            "waist_pitch",
            "left_shoulder_pitch",
            "left_shoulder_roll",
            "left_shoulder_yaw",
            "left_elbow",
            "right_shoulder_pitch",
            "right_shoulder_roll",
            "right_shoulder_yaw",
            "right_elbow",
        ]
    );
    assert_eq!(Order::Wrists.names()[13..18][4], "left_wrist_roll");
    assert_eq!(Order::Waist.names()[..12], Order::Wrists.names()[..12]);
}

#[test]
fn arms_that_are_a_pair_tell_the_order() {
    for (order, word) in [(Order::Wrists, "arms of 5"), (Order::Waist, "arms of 4")] {
        let (array, names, told) = told(&frames(order, 3, &HANGING), Said::Nothing).unwrap();
        assert!(told[0].contains(word), "{told:?}");
        for (name, expected) in [
            ("left_elbow", 0.9),
            ("right_elbow", 0.9),
            ("right_shoulder_roll", -0.25),
        ] {
            assert_eq!(angle(&array, &names, name), expected, "{order:?} {name}");
        }
        let wrist = if order == Order::Wrists { 0.1 } else { 0.0 };
        assert_eq!(angle(&array, &names, "left_wrist_roll"), wrist);
        assert_eq!(
            told.iter().any(|t| t.starts_with("wrists")),
            order == Order::Waist
        );
    }
}

#[test]
fn limits_tell_where_arms_do_not() {
    // 2.0 rad is more than the right shoulder's roll can do (1.59), which this column is in the other
    // order, and within an upper arm's pitch (2.67).
    let mut raised = HANGING;
    raised[5] = ("right_shoulder_pitch", 2.0);
    let (_, _, decisions) = told(&frames(Order::Waist, 1, &raised), Said::Nothing).unwrap();
    assert!(
        decisions[0].contains("arms of 4") && decisions[0].contains("0.41 rad beyond"),
        "{decisions:?}"
    );
    // 1 rad is more than a waist's roll can do (0.52): the column is a shoulder's pitch.
    raised[5] = ("right_shoulder_pitch", 0.2);
    raised[1] = ("left_shoulder_pitch", 1.0);
    let (_, _, decisions) = told(&frames(Order::Wrists, 1, &raised), Said::Nothing).unwrap();
    assert!(
        decisions[0].contains("arms of 5") && decisions[0].contains("0.48 rad beyond"),
        "{decisions:?}"
    );
}

#[test]
fn what_could_be_either_is_asked_for() {
    // One arm forward, the other back.
    let one_sided = frames(
        Order::Waist,
        2,
        &[
            ("left_shoulder_pitch", -0.5),
            ("left_elbow", 0.5),
            ("right_shoulder_yaw", 0.4),
        ],
    );
    let message = told(&one_sided, Said::Nothing).unwrap_err();
    for part in [
        "walk.pkl",
        "dof_pos",
        "two orders",
        "--format phc",
        "--format gmr",
        "joint_names",
    ] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
    for order in Order::BOTH {
        let (_, _, usual) = told(&one_sided, Said::Usual(order)).unwrap();
        assert!(
            usual[0].starts_with(order.told()) && usual[0].contains("usual"),
            "{usual:?}"
        );
        let (_, _, user) = told(&one_sided, Said::User(order)).unwrap();
        assert!(user[0].contains("--format"), "{user:?}");
    }
    // The user's word does not bend a waist by 1 rad.
    let mut raised = HANGING;
    raised[1] = ("left_shoulder_pitch", 1.0);
    let message = told(&frames(Order::Wrists, 1, &raised), Said::User(Order::Waist)).unwrap_err();
    assert!(message.contains("0.48 rad beyond"), "{message}");
    let (_, _, zero) = told(
        &frames(
            Order::Waist,
            1,
            &[("left_knee", 0.4), ("left_elbow", 0.015)],
        ),
        Said::Nothing,
    )
    .unwrap();
    assert!(zero[0].contains("either order"), "{zero:?}");
}

#[test]
fn other_counts_of_joints_are_refused() {
    let (array, names, _) = {
        let angles = Array::of(
            vec![1, 29],
            (0..29).map(|i| f64::from(i) / 100.0).collect(),
            false,
        );
        told(&angles.unwrap(), Said::Nothing).unwrap()
    };
    assert_eq!(angle(&array, &names, "waist_pitch"), 0.14);
    for width in [19, 21, 27] {
        let angles = Array::of(vec![1, width], vec![0.0; width], false).unwrap();
        let message = told(&angles, Said::Nothing).unwrap_err();
        assert!(
            message.contains(&format!("[1, {width}]")) && message.contains("23 or 29"),
            "{message}"
        );
    }
}

#[test]
fn joints_that_no_g1_has_are_named_if_they_moved() {
    let file = File {
        path: Path::new("walk.npz"),
        bytes: b"",
    };
    let mut names: Vec<String> = SDK_29.iter().map(|name| format!("{name}_joint")).collect();
    names.extend(["left_thumb_joint".into(), "head".into()]);
    // The thumb reaches 1 rad (57°), the head 0.05 rad (3°).
    let mut values = vec![0.0; 2 * 31];
    (values[29], values[31 + 29], values[31 + 30]) = (0.3, -1.0, 0.05);
    let angles = Array::of(vec![2, 31], values, false).unwrap();
    let mut decisions = Vec::new();
    named(&file, (&angles, "q"), &names, &mut decisions).unwrap();
    let said = "left_thumb (57°): this robot has no such joint; left out";
    assert_eq!(decisions, ["joints by the file's names", said]);
}

#[test]
fn rows_without_names_are_read_in_the_order_that_fits() {
    let file = File {
        path: Path::new("walk.csv"),
        bytes: b"",
    };
    let rows = |order: Order, posture: &[(&str, f64)]| -> Vec<Row> {
        let angles = frames(order, 2, posture);
        let row = |i: usize| Row {
            position: nalgebra::Vector3::zeros(),
            orientation: nalgebra::UnitQuaternion::identity(),
            joints: angles.frame(i).try_into().unwrap(),
            dropped: [0.0; 6],
        };
        (0..2).map(row).collect()
    };
    let mut leaning = HANGING.to_vec();
    leaning.push(("waist_pitch", 0.2));
    for order in Order::BOTH {
        let (rows, told) = of_rows(&file, rows(order, &leaning)).unwrap();
        assert!(told.starts_with(order.told()), "{told}");
        // Elbows are the 17th and the 22nd of ours, wrists follow them.
        let wrist = if order == Order::Wrists { 0.1 } else { 0.0 };
        assert_eq!(rows[1].joints[16..18], [0.9, wrist], "{order:?}");
        assert_eq!(rows[1].joints[21..23], [0.9, -wrist], "{order:?}");
        // The waist's pitch is the second of the joints that we lack.
        let lean = if order == Order::Waist { 0.2 } else { 0.0 };
        assert_eq!(rows[1].dropped[..2], [0.0, lean], "{order:?}");
    }
    let one_sided = rows(
        Order::Wrists,
        &[("left_shoulder_pitch", -0.4), ("right_elbow", 0.5)],
    );
    let message = of_rows(&file, one_sided).unwrap_err().to_string();
    assert!(
        message.contains("two orders") && message.contains("header"),
        "{message}"
    );
}
