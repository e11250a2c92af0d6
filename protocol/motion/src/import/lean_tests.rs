//! Leans whose result is known.

use super::*;
use g1::DEFAULT_POSE;
use g1::joints::RIGHT_LEG;

const HEIGHT: f64 = 0.75;

fn rows(dropped: [f64; 6], yaw: f64) -> Vec<Row> {
    let mut joints = DEFAULT_POSE.map(f64::from);
    joints[WAIST] = yaw;
    let row = Row {
        position: Vector3::new(1.0, 2.0, HEIGHT),
        orientation: UnitQuaternion::identity(),
        joints,
        dropped,
    };
    vec![row; 20]
}

#[test]
fn a_bow_is_done_by_pelvis_and_hips() {
    let mut rows = rows([0.0, 0.2, 0.0, 0.0, 0.0, 0.0], 0.0);
    let before = rows[0];
    let mut decisions = Vec::new();
    into_pelvis(&mut rows, &mut decisions);
    // The hip pitch joints are 0.1027 m below the pelvis and stay where they are.
    let (sin, cos) = 0.2f64.sin_cos();
    let place = Vector3::new(1.0 + 0.1027 * sin, 2.0, HEIGHT - 0.1027 * (1.0 - cos));
    for row in &rows {
        assert!((row.position - place).norm() < 1e-9, "{}", row.position);
        let (roll, pitch, yaw) = row.orientation.euler_angles();
        assert!((pitch - 0.2).abs() < 1e-9 && roll.abs() < 1e-9 && yaw.abs() < 1e-9);
        for (j, (a, b)) in row.joints.iter().zip(before.joints).enumerate() {
            let hip_pitch = j == LEFT_LEG || j == RIGHT_LEG;
            let expected = if hip_pitch { b - 0.2 } else { b };
            assert!(
                (a - expected).abs() < 1e-6,
                "joint {j}: {a} is not {expected}"
            );
        }
        assert_eq!(row.dropped, [0.0; 6]);
    }
    let [said] = decisions.as_slice() else {
        panic!("{decisions:?}")
    };
    assert!(
        said.starts_with("waist_pitch (11°): this robot has no such joint; the lean went into")
    );
    assert!(said.contains("lowered by up to 0.0 mm") && said.contains("move by up to 0.0 mm"));
}

#[test]
fn torso_and_feet_stay_whatever_the_lean() {
    for (roll, pitch, yaw) in [
        (0.1, 0.0, 0.0),
        (-0.2, 0.3, 0.5),
        (0.25, -0.1, -1.0),
        (0.02, 0.5, 0.0),
    ] {
        let mut rows = rows([roll, pitch, 0.0, 0.0, 0.0, 0.0], yaw);
        let goals = feet(&rows[0]);
        let torso = UnitQuaternion::from_euler_angles(0.0, 0.0, yaw)
            * UnitQuaternion::from_euler_angles(roll, 0.0, 0.0)
            * UnitQuaternion::from_euler_angles(0.0, pitch, 0.0);
        into_pelvis(&mut rows, &mut Vec::new());
        for row in &rows {
            let bodies = forward(&base(row), &row.joints);
            assert!(bodies[WAIST + 1].rotation.angle_to(&torso) < 1e-6);
            for (foot, goal) in feet(row).iter().zip(&goals) {
                let away = (foot.translation.vector - goal.translation.vector).norm();
                assert!(away < 1e-3, "{away} m at {roll}, {pitch}, {yaw}");
                let turned = foot.rotation.angle_to(&goal.rotation);
                assert!(turned < 0.01, "{turned} rad at {roll}, {pitch}, {yaw}");
            }
            for (q, joint) in row.joints.iter().zip(&JOINT_TABLE) {
                assert!((joint.lower..=joint.upper).contains(q), "{}", joint.name);
            }
        }
    }
}

#[test]
fn a_pelvis_that_is_too_high_for_its_legs_comes_down() {
    // Hips 0.1165 m beside the middle: a roll by 0.2 rad raises one of them by 23 mm. Legs in the default
    // pose, knees at 0.3 rad, are shorter than straight ones by 0.61 m · (1 − cos 0.15) = 7 mm.
    let mut rows = rows([0.2, 0.0, 0.0, 0.0, 0.0, 0.0], 0.0);
    let moved = lean(&mut rows);
    assert!((0.012..0.020).contains(&moved.lowered), "{}", moved.lowered);
    assert!(moved.feet < 1e-3, "{}", moved.feet);
    assert!(
        (rows[10].position.z - (HEIGHT - 0.1027 * (1.0 - 0.2f64.cos()) - moved.lowered)).abs()
            < 1e-4
    );
}

#[test]
fn wrists_are_left_out_and_said_from_five_degrees_on() {
    // 0.1 rad are 5.7°, 0.08 rad 4.6°.
    let mut rows = rows([0.0, 0.0, 0.1, 0.08, -0.5, 0.0], 0.3);
    let before = rows[0];
    let mut decisions = Vec::new();
    into_pelvis(&mut rows, &mut decisions);
    assert_eq!(
        decisions,
        ["left_wrist_pitch (6°), right_wrist_pitch (29°): this robot has no such joint; left out"]
    );
    assert_eq!(
        (rows[0].joints, rows[0].position),
        (before.joints, before.position)
    );
    assert_eq!(rows[0].orientation, before.orientation);
    decisions.clear();
    say_others(
        &[("left_thumb".into(), 1.0), ("head".into(), 0.01)],
        &mut decisions,
    );
    assert_eq!(
        decisions,
        ["left_thumb (57°): this robot has no such joint; left out"]
    );
}
