//! The recipe of retargeting, from capture to postures.
//!
//! Separate because it only says in which order the other modules work.

use crate::account::account;
use crate::capture::{Capture, Side};
use crate::feet::Plan;
use crate::limb::{ANKLE, ARMS, Chain, HIP, LEGS};
use crate::posture::{Free, Posture};
use crate::report::Report;
use crate::targets::{self, Target};
use crate::{RATE, contact, feet, path, signal, solver};
use g1::joints::WAIST;
use g1::kinematics::{forward, lowest_foot_point};
use g1::{DEFAULT_POSE, JOINT_TABLE, JOINTS, LEFT_FOOT, RIGHT_FOOT};
use nalgebra::{Isometry3, SVector};

/// Share of a motor's top speed that is used.
const SPEED_SHARE: f64 = 0.95;

/// Postures of the robot at [`RATE`] that do what a human did, and the account of it.
///
/// # Panics
/// If the capture has fewer than two frames at [`RATE`], or legs of no length: importers refuse both.
pub fn retarget(capture: &Capture) -> (Vec<Posture>, Report) {
    let human = capture.at_rate();
    assert!(human.frames.len() > 1, "a capture lasts at least 0.02 s");
    let leg = capture.leg_length();
    assert!(leg > 0.0, "a human has legs");
    let scale = targets::scale(leg);
    let contacts = contact::detect(&human);
    let targets = targets::of(&human, scale, &contacts);

    let mut joints: Vec<[f64; JOINTS]> = targets.iter().map(upright).collect();
    arms(&targets, &mut joints);
    let legs = Side::BOTH.map(|side| free_leg(&targets, side.index()));
    put(&mut joints, &legs);
    let free: Vec<Free> = targets
        .iter()
        .zip(&joints)
        .map(|(target, joints)| free_feet(target, joints))
        .collect();
    let plan = feet::plan(&free, &contacts);
    let bases: Vec<Isometry3<f64>> = targets
        .iter()
        .zip(&plan.shift)
        .map(|(target, shift)| nalgebra::Translation3::from(*shift) * target.frame())
        .collect();
    let [left, right] = legs;
    put(
        &mut joints,
        &[
            planned_leg(&targets, &bases, &plan, 0, left),
            planned_leg(&targets, &bases, &plan, 1, right),
        ],
    );
    let slowed = slow_down(&mut joints);

    let mut postures: Vec<Posture> = bases
        .iter()
        .zip(&joints)
        .map(|(&base, &joints)| Posture { base, joints })
        .collect();
    let lifted = lift_out_of_the_ground(&mut postures);
    let report = account(
        &human,
        &targets,
        &plan,
        &postures,
        (&slowed, leg, scale, lifted),
    );
    (postures, report)
}

/// The default pose with the waist where it shall be.
fn upright(target: &Target) -> [f64; JOINTS] {
    let mut joints = DEFAULT_POSE.map(f64::from);
    joints[WAIST] = target.waist;
    joints
}

/// Arms by the directions of their bones.
fn arms(targets: &[Target], joints: &mut [[f64; JOINTS]]) {
    let torsos: Vec<Isometry3<f64>> = targets
        .iter()
        .zip(&*joints)
        .map(|(target, joints)| forward(&target.frame(), joints)[WAIST + 1])
        .collect();
    for (side, first) in ARMS.into_iter().enumerate() {
        let chain = Chain::<5>::new(first);
        let task =
            |i: usize, q: &SVector<f64, 5>| solver::arm(&chain, &torsos[i], &targets[i], side, q);
        let mut path = solver::march(&chain, targets.len(), &task);
        path::smooth(&chain, &mut path, &task);
        for (joints, q) in joints.iter_mut().zip(&path) {
            joints[first..first + 5].copy_from_slice(q.as_slice());
        }
    }
}

/// A leg by directions only: the feet go where they go.
fn free_leg(targets: &[Target], side: usize) -> Vec<SVector<f64, 6>> {
    let chain = Chain::<6>::new(LEGS[side]);
    let task = |i: usize, q: &SVector<f64, 6>| solver::leg(&chain, &targets[i], side, q);
    let mut path = solver::march(&chain, targets.len(), &task);
    path::smooth(&chain, &mut path, &task);
    path
}

/// The same leg with the feet where they must be.
fn planned_leg(
    targets: &[Target],
    bases: &[Isometry3<f64>],
    plan: &Plan,
    side: usize,
    mut path: Vec<SVector<f64, 6>>,
) -> Vec<SVector<f64, 6>> {
    let chain = Chain::<6>::new(LEGS[side]);
    let task = |i: usize, q: &SVector<f64, 6>| {
        let (bones, foot) = (&targets[i].bones[side], &plan.feet[i][side]);
        solver::planned_leg(&chain, &bases[i], bones, foot, q)
    };
    path::smooth(&chain, &mut path, &task);
    path
}

fn put(joints: &mut [[f64; JOINTS]], legs: &[Vec<SVector<f64, 6>>; 2]) {
    for (first, leg) in LEGS.into_iter().zip(legs) {
        for (joints, q) in joints.iter_mut().zip(leg) {
            joints[first..first + 6].copy_from_slice(q.as_slice());
        }
    }
}

/// Holds back what is faster than its motor, and counts the frames of each joint.
fn slow_down(joints: &mut [[f64; JOINTS]]) -> [usize; JOINTS] {
    let mut slowed = [0; JOINTS];
    for i in 1..joints.len() {
        for (j, joint) in JOINT_TABLE.iter().enumerate() {
            let (before, reach) = (joints[i - 1][j], SPEED_SHARE * joint.velocity_limit / RATE);
            let q = joints[i][j].clamp(before - reach, before + reach);
            slowed[j] += usize::from(q != joints[i][j]);
            joints[i][j] = q;
        }
    }
    slowed
}

fn free_feet(target: &Target, joints: &[f64; JOINTS]) -> Free {
    let bodies = forward(&target.frame(), joints);
    // Joint i moves body i + 1.
    let origin = |joint: usize| bodies[joint + 1].translation.vector;
    Free {
        feet: [bodies[LEFT_FOOT], bodies[RIGHT_FOOT]],
        hips: LEGS.map(|leg| origin(leg + HIP)),
        ankles: LEGS.map(|leg| origin(leg + ANKLE)),
    }
}

/// Lifts smoothly what is below the ground still, and says by how much at most.
fn lift_out_of_the_ground(postures: &mut [Posture]) -> f64 {
    let sinking: Vec<f64> = postures
        .iter()
        .map(|p| (-lowest_foot_point(&forward(&p.base, &p.joints))).max(0.0))
        .collect();
    let lift = signal::envelope(&sinking, 3);
    for (posture, lift) in postures.iter_mut().zip(&lift) {
        posture.base.translation.z += lift;
    }
    lift.into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
