//! Distances that can be checked in the head, and the robot's poses.

use super::*;
use crate::mirror;
use crate::{JOINTS, LINK_TABLE};

fn segment(from: [f32; 3], to: [f32; 3]) -> [Point3<f32>; 2] {
    [Point3::from(from), Point3::from(to)]
}

#[test]
fn segments_are_as_far_apart_as_geometry_says() {
    let x = segment([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    // Crossing lines 0.5 apart, the second below.
    let across = segment([0.3, -1.0, -0.5], [0.3, 1.0, -0.5]);
    assert!((between(x, across) - Vector3::new(0.0, 0.0, 0.5)).norm() < 1e-6);
    // Parallel, side by side.
    let beside = segment([-3.0, 2.0, 0.0], [0.0, 2.0, 0.0]);
    assert!((between(x, beside) - Vector3::new(0.0, -2.0, 0.0)).norm() < 1e-6);
    // End to end: from (1, 0, 0) to (4, 4, 0) are 3 and 4, so 5.
    let beyond = segment([4.0, 4.0, 0.0], [9.0, 4.0, 0.0]);
    assert!((between(x, beyond).norm() - 5.0).abs() < 1e-6);
    // An end over the middle.
    let over = segment([0.0, 0.0, 0.2], [0.0, 3.0, 4.0]);
    assert!((between(x, over) - Vector3::new(0.0, 0.0, -0.2)).norm() < 1e-6);
    assert_eq!(between(x, x), Vector3::zeros());
}

#[test]
fn pairs_are_no_neighbours_and_listed_once() {
    for (i, &[a, b]) in PAIR_TABLE.iter().enumerate() {
        let [a, b] = [a, b].map(|capsule| CAPSULE_TABLE[capsule].body);
        assert!(LINK_TABLE[a].parent != Some(b) && LINK_TABLE[b].parent != Some(a) && a != b);
        let again = PAIR_TABLE[..i].iter().any(|&other| {
            let [c, d] = other.map(|capsule| CAPSULE_TABLE[capsule].body);
            [c, d] == [a, b] || [c, d] == [b, a]
        });
        assert!(!again, "pair {i}");
    }
    for (i, capsule) in CAPSULE_TABLE.iter().enumerate() {
        let same = |other: &Capsule| other.body == capsule.body;
        assert_eq!(CAPSULE_TABLE.iter().position(same), Some(i));
    }
}

#[test]
fn a_standing_robot_touches_itself_nowhere() {
    let bodies = kinematics::forward_state(&RobotState::standing());
    for pair in 0..PAIRS {
        let gap = gap(&bodies, pair);
        let [a, b] = names(pair);
        assert!(gap.distance > 0.02, "{a} and {b}: {} m", gap.distance);
        // The first of a pair is further left, save for the arms in front of and beside the trunk.
        assert!(gap.normal.y > 0.0, "{a} and {b}: {:?}", gap.normal);
    }
    // Hips are 2·(0.064452 + 0.052) m apart, thighs hang straight down from them (0.0021489 on to the shins).
    let thighs = gap(&bodies, 0).distance;
    assert!((thighs - (0.232904 - 0.09)).abs() < 1e-3, "{thighs} m");
}

#[test]
fn hips_rolled_inward_bring_the_shins_together() {
    let mut state = RobotState::standing();
    let [left, right] = [1, 7]; // hip rolls; the left one's positive side is outward
    state.joint_positions[left] = -0.3;
    state.joint_positions[right] = 0.3;
    let (pair, distance) = nearest(&state);
    let [a, b] = names(pair);
    assert!(a.starts_with("left") && b.starts_with("right"));
    assert!(distance < -0.03, "{distance} m");
    // 0.7 m long legs from hips 0.23 m apart meet in the middle from 0.16 rad on, less for their thickness.
    state.joint_positions[left] = -0.02;
    state.joint_positions[right] = 0.02;
    assert!(nearest(&state).1 > 0.0);
}

#[test]
fn a_mirrored_robot_has_the_same_gaps() {
    let mut state = RobotState::standing();
    state.joint_positions = std::array::from_fn::<f32, JOINTS, _>(|i| 0.03 * (i % 7) as f32 - 0.08);
    let mirrored = mirror::mirror_state(&state);
    let (a, b) = (nearest(&state).1, nearest(&mirrored).1);
    assert!((a - b).abs() < 1e-4, "{a} {b}");
}
