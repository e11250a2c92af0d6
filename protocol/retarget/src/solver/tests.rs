//! Poses that are possible are reached, and limits hold for those that are not.

use super::*;
use g1::joints::WAIST;
use g1::kinematics::forward;
use g1::{DEFAULT_POSE, JOINTS, LEFT_FOOT, RIGHT_FOOT};
use nalgebra::UnitQuaternion;

/// A pose within the limits and the target that it is.
fn posed(q: &[f64; JOINTS]) -> (Target, [Isometry3<f64>; BODIES]) {
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
    (target, bodies)
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
    let q = stepping();
    let (target, bodies) = posed(&q);
    for side in 0..2 {
        let chain = Chain::<6>::new(LEGS[side]);
        let legs = march(&chain, 2, &|_, q: &_| leg(&chain, &target, side, q));
        for k in 0..6 {
            let (found, wanted) = (legs[1][k], q[LEGS[side] + k]);
            assert!(
                (found - wanted).abs() < 0.02,
                "{k}: {found} is not {wanted}"
            );
        }
        let chain = Chain::<5>::new(ARMS[side]);
        let torso = bodies[WAIST + 1];
        let arms = march(&chain, 2, &|_, q: &_| arm(&chain, &torso, &target, side, q));
        let mut reached = q;
        reached[ARMS[side]..ARMS[side] + 5].copy_from_slice(arms[1].as_slice());
        let reached = bones(&forward(&target.frame(), &reached))[side];
        for (bone, wanted) in reached.iter().zip(&target.bones[side]).skip(2) {
            assert!(angle(bone, wanted) < 0.5, "{}°", angle(bone, wanted));
        }
    }
}

#[test]
fn a_firm_foot_is_met_to_a_tenth_of_a_millimetre() {
    let (target, bodies) = posed(&stepping());
    for (side, foot) in [LEFT_FOOT, RIGHT_FOOT].into_iter().enumerate() {
        let chain = Chain::<6>::new(LEGS[side]);
        let foothold = Foothold {
            frame: bodies[foot],
            firm: 1.0,
            pivot: Vector3::zeros(),
            tipped: 0.0,
            clearance: 0.0,
        };
        let task = |_: usize, q: &SVector<f64, 6>| {
            planned_leg(&chain, &bodies[0], &target.bones[side], &foothold, q)
        };
        let legs = march(&chain, 2, &task);
        let gap = (chain.pose(&bodies[0], &legs[1]).end().translation.vector)
            - bodies[foot].translation.vector;
        assert!(gap.norm() < 1e-4, "{gap:?}");
    }
}

/// A foot on its toe keeps its toe where it is, whatever the leg makes of its pitch.
#[test]
fn a_tipped_foot_turns_about_its_edge() {
    let (target, bodies) = posed(&stepping());
    let chain = Chain::<6>::new(LEGS[0]);
    let edge = Vector3::new(0.12, 0.0, -0.035);
    let pitched = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.3);
    let toe = bodies[LEFT_FOOT] * Point3::from(edge);
    let mut frame = bodies[LEFT_FOOT];
    frame.rotation *= pitched; // not what the bones want
    frame.translation.vector = toe.coords - frame.rotation * edge;
    let foothold = Foothold {
        frame,
        firm: 1.0,
        pivot: edge,
        tipped: 1.0,
        clearance: 0.0,
    };
    let task = |_: usize, q: &SVector<f64, 6>| {
        planned_leg(&chain, &bodies[0], &target.bones[0], &foothold, q)
    };
    let end = chain.pose(&bodies[0], &march(&chain, 2, &task)[1]).end();
    assert!((end * Point3::from(edge) - toe).norm() < 1e-4);
    // Bones weigh ten times what the pitch does: most of the 0.3 rad is given up.
    let left = (end.rotation * Vector3::x()).angle(&(bodies[LEFT_FOOT].rotation * Vector3::x()));
    assert!(left < 0.1, "{left} rad");
}

#[test]
fn limits_hold_whatever_is_asked() {
    let (mut target, bodies) = posed(&stepping());
    // Legs up beside the ears, arms behind the back.
    target.bones = [[Vector3::z(), Vector3::y(), -Vector3::x(), Vector3::z()]; 2];
    for side in 0..2 {
        let chain = Chain::<6>::new(LEGS[side]);
        let q = march(&chain, 2, &|_, q: &_| leg(&chain, &target, side, q))[1];
        assert_eq!(q, chain.clamped(&q));
        assert!((0..6).any(|k| q[k] == chain.lower[k] || q[k] == chain.upper[k]));
        let chain = Chain::<5>::new(ARMS[side]);
        let torso = bodies[WAIST + 1];
        let q = march(&chain, 2, &|_, q: &_| arm(&chain, &torso, &target, side, q))[1];
        assert_eq!(q, chain.clamped(&q));
    }
}

/// Least squares on angles have wrong minima: from a leg that was behind, one that is ahead is found.
#[test]
fn a_limb_that_ends_far_off_is_tried_again() {
    let (target, _) = posed(&stepping());
    let mut other = target;
    other.bones[0][0] = -target.bones[0][0];
    other.bones[0][1] = -target.bones[0][1];
    let chain = Chain::<6>::new(LEGS[0]);
    let task =
        |i: usize, q: &SVector<f64, 6>| leg(&chain, if i == 0 { &other } else { &target }, 0, q);
    let path = march(&chain, 2, &task);
    for (k, (found, wanted)) in path[1].iter().zip(stepping()).enumerate() {
        assert!(
            (found - wanted).abs() < 0.05,
            "{k}: {found} is not {wanted}"
        );
    }
}
