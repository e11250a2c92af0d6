//! Poses that are possible are reached, and limits hold for those that are not.

use super::*;
use g1::{LEFT_FOOT, RIGHT_FOOT};
use nalgebra::UnitQuaternion;

/// A pose within the limits and the target that it is.
fn posed(q: &[f64; JOINTS]) -> (Target, Isometry3<f64>, [Isometry3<f64>; 2]) {
    let base = Isometry3::from_parts(
        [1.0, 2.0, 0.75].into(),
        UnitQuaternion::from_euler_angles(0.05, 0.1, 0.7),
    );
    let bodies = forward(&base, q);
    let target = Target {
        pelvis: base.rotation,
        place: base.translation.vector,
        waist: q[WAIST],
        bones: bones(&bodies),
        feet: [bodies[LEFT_FOOT].rotation, bodies[RIGHT_FOOT].rotation],
    };
    (target, base, [bodies[LEFT_FOOT], bodies[RIGHT_FOOT]])
}

fn stepping() -> [f64; JOINTS] {
    let mut q = DEFAULT_POSE.map(f64::from);
    q[..6].copy_from_slice(&[-0.6, 0.1, 0.15, 0.9, -0.3, 0.05]);
    q[6..12].copy_from_slice(&[0.3, -0.05, -0.1, 0.5, 0.1, -0.05]);
    q[13..17].copy_from_slice(&[0.6, 0.3, 0.2, 0.6]);
    q
}

fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos().to_degrees()
}

#[test]
fn directions_of_a_possible_pose_are_reached() {
    let (target, base, _) = posed(&stepping());
    let solved = solve(&target, &base, None, None, &DEFAULT_POSE.map(f64::from));
    let reached = bones(&forward(&base, &solved.joints));
    for (bone, wanted) in reached.iter().flatten().zip(target.bones.iter().flatten()) {
        assert!(angle(bone, wanted) < 0.5, "{}°", angle(bone, wanted));
    }
    assert!(solved.at_limit.iter().all(|held| !held));
}

#[test]
fn planned_feet_are_met_to_a_tenth_of_a_millimetre() {
    let (target, base, feet) = posed(&stepping());
    let solved = solve(
        &target,
        &base,
        Some(feet),
        None,
        &DEFAULT_POSE.map(f64::from),
    );
    let bodies = forward(&base, &solved.joints);
    for (foot, wanted) in [LEFT_FOOT, RIGHT_FOOT].into_iter().zip(&feet) {
        let gap = bodies[foot].translation.vector - wanted.translation.vector;
        assert!(gap.norm() < 1e-4, "{gap:?}");
        assert!(bodies[foot].rotation.angle_to(&wanted.rotation) < 0.01);
    }
}

#[test]
fn limits_and_speeds_hold_whatever_is_asked() {
    let (mut target, base, _) = posed(&stepping());
    // Legs up beside the ears, arms behind the back, in one frame.
    target.bones = [[Vector3::z(), Vector3::y(), -Vector3::x(), Vector3::z()]; 2];
    target.waist = 9.0;
    let before = DEFAULT_POSE.map(f64::from);
    let first = solve(&target, &base, None, None, &before);
    assert!(first.at_limit.iter().any(|held| *held));
    let next = solve(&target, &base, None, Some(&before), &before);
    assert!(next.at_speed.iter().any(|held| *held));
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        for q in [first.joints[i], next.joints[i]] {
            assert!(q > joint.lower && q < joint.upper, "{}", joint.name);
        }
        let speed = (next.joints[i] - before[i]).abs() * RATE;
        assert!(speed < joint.velocity_limit, "{} at {speed}", joint.name);
    }
}
