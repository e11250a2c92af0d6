//! The recipe of retargeting, from capture to postures.
//!
//! Separate because it only says in which order the other modules work.

use crate::capture::{Capture, Side};
use crate::feet::{Free, Plan};
use crate::report::{Report, bones_off, held};
use crate::solver::{self, Solved};
use crate::targets::{self, Target};
use crate::{RATE, contact, feet, signal};
use g1::joints::{LEFT_LEG, RIGHT_LEG};
use g1::kinematics::{forward, lowest_foot_point};
use g1::{DEFAULT_POSE, JOINTS, LEFT_FOOT, RIGHT_FOOT};
use nalgebra::{Isometry3, Vector3};

/// Where the pelvis is and how the joints stand, in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// Frame of the pelvis in the world, m.
    pub base: Isometry3<f64>,
    /// Joint positions, rad.
    pub joints: [f64; JOINTS],
}

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

    let first = free_pass(&targets);
    let free: Vec<Free> = targets
        .iter()
        .zip(&first)
        .map(|(t, s)| free_feet(t, s))
        .collect();
    let plan = feet::plan(&free, &contacts);
    let second = planned_pass(&targets, &plan, &first);

    let mut postures: Vec<Posture> = (0..targets.len())
        .map(|i| Posture {
            base: base(&targets[i], plan.raise[i]),
            joints: second[i].joints,
        })
        .collect();
    let lifted = lift_out_of_the_ground(&mut postures);
    let report = account(
        &human,
        &targets,
        &plan,
        &second,
        &postures,
        (leg, scale, lifted),
    );
    (postures, report)
}

fn base(target: &Target, raise: f64) -> Isometry3<f64> {
    let place = target.place + Vector3::new(0.0, 0.0, raise);
    Isometry3::from_parts(place.into(), target.pelvis)
}

/// Directions only: the feet go where they go.
fn free_pass(targets: &[Target]) -> Vec<Solved> {
    let mut before: Option<[f64; JOINTS]> = None;
    targets
        .iter()
        .map(|target| {
            let guess = before.unwrap_or(DEFAULT_POSE.map(f64::from));
            let solved = solver::solve(target, &base(target, 0.0), None, before.as_ref(), &guess);
            before = Some(solved.joints);
            solved
        })
        .collect()
}

/// With the feet where they must be, each frame from what directions alone gave.
fn planned_pass(targets: &[Target], plan: &Plan, first: &[Solved]) -> Vec<Solved> {
    let mut before: Option<[f64; JOINTS]> = None;
    (0..targets.len())
        .map(|i| {
            let base = base(&targets[i], plan.raise[i]);
            let feet = Some(plan.feet[i]);
            let guess = &first[i].joints;
            let solved = solver::solve(&targets[i], &base, feet, before.as_ref(), guess);
            before = Some(solved.joints);
            solved
        })
        .collect()
}

fn free_feet(target: &Target, solved: &Solved) -> Free {
    let bodies = forward(&base(target, 0.0), &solved.joints);
    Free {
        feet: [bodies[LEFT_FOOT], bodies[RIGHT_FOOT]],
        // Joint i moves body i + 1: hip roll is the second joint of a leg.
        hips: [LEFT_LEG, RIGHT_LEG].map(|leg| bodies[leg + 2].translation.vector),
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

fn account(
    human: &Capture,
    targets: &[Target],
    plan: &Plan,
    solved: &[Solved],
    postures: &[Posture],
    (human_leg, scale, lifted): (f64, f64, f64),
) -> Report {
    let angles: Vec<Vec<f64>> = targets
        .iter()
        .zip(postures)
        .map(|(target, posture)| direction_errors(target, posture))
        .collect();
    let mut errors = angles.concat();
    let count = |held: fn(&Solved) -> &[bool; JOINTS]| -> [usize; JOINTS] {
        std::array::from_fn(|j| solved.iter().filter(|s| held(s)[j]).count())
    };
    let way =
        postures[postures.len() - 1].base.translation.vector - postures[0].base.translation.vector;
    Report {
        frames: postures.len(),
        human_leg,
        scale,
        scaled_speed: scale * human.travel_speed(),
        speed: way.xy().norm() * RATE / (postures.len() - 1) as f64,
        direction_error: signal::median(&mut errors),
        direction_error_95: signal::quantile(&mut errors, 0.95),
        bones_off: bones_off(&angles),
        stances: plan.stances,
        feet_moved: plan.moved,
        lowered: plan.lowered,
        lifted,
        at_limit: held(&count(|s| &s.at_limit)),
        at_speed: held(&count(|s| &s.at_speed)),
    }
}

/// Angles between bones and feet of the robot and those of the human, degrees: thigh, shin, upper arm, forearm and foot
/// of the left side, then of the right.
fn direction_errors(target: &Target, posture: &Posture) -> Vec<f64> {
    let bodies = forward(&posture.base, &posture.joints);
    let bones = solver::bones(&bodies);
    let angle = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(b).clamp(-1.0, 1.0).acos().to_degrees();
    let mut errors = Vec::new();
    for side in Side::BOTH {
        let s = side.index();
        errors.extend(
            bones[s]
                .iter()
                .zip(&target.bones[s])
                .map(|(a, b)| angle(a, b)),
        );
        let foot = [LEFT_FOOT, RIGHT_FOOT][s];
        let toe = bodies[foot].rotation * Vector3::x();
        errors.push(angle(&toe, &(target.feet[s] * Vector3::x())));
    }
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::puppet;
    use g1::JOINT_TABLE;
    use g1::kinematics::sole_points;

    #[test]
    fn a_walking_puppet_becomes_a_walking_robot() {
        let (postures, report) = retarget(&puppet::walking(120.0, 4.4));
        assert_eq!((postures.len(), report.frames), (221, 221));
        assert!((report.speed / report.scaled_speed - 1.0).abs() < 0.01);
        assert!(report.direction_error < 5.0, "{}°", report.direction_error);
        assert!(report.stances >= 8, "{}", report.stances);
        for posture in &postures {
            assert!(lowest_foot_point(&forward(&posture.base, &posture.joints)) > -1e-6);
            for (q, joint) in posture.joints.iter().zip(&JOINT_TABLE) {
                assert!((joint.lower..=joint.upper).contains(q), "{}", joint.name);
            }
        }
        for pair in postures.windows(2) {
            for (j, joint) in JOINT_TABLE.iter().enumerate() {
                let speed = (pair[1].joints[j] - pair[0].joints[j]).abs() * RATE;
                assert!(speed < joint.velocity_limit, "{} at {speed}", joint.name);
            }
        }
    }

    #[test]
    fn standing_feet_do_not_slip() {
        let (postures, _) = retarget(&puppet::walking(120.0, 4.4));
        let mut slips = Vec::new();
        for pair in postures.windows(2) {
            let [a, b] = [0, 1].map(|i| forward(&pair[i].base, &pair[i].joints));
            for foot in [LEFT_FOOT, RIGHT_FOOT] {
                let (p, q) = (sole_points(&a, foot), sole_points(&b, foot));
                let k = (0..4).min_by(|&j, &k| p[j].z.total_cmp(&p[k].z)).unwrap();
                if p[k].z < 0.005 && q[k].z < 0.005 {
                    slips.push((q[k] - p[k]).xy().norm() * RATE);
                }
            }
        }
        assert!(slips.len() > 200, "{}", slips.len());
        let slip = signal::median(&mut slips);
        assert!(slip < 0.02, "{slip} m/s");
    }

    #[test]
    fn the_same_capture_gives_the_same_clip_wherever_it_happens() {
        let here = puppet::walking(100.0, 2.2);
        let mut there = here.clone();
        for frame in &mut there.frames {
            for point in &mut frame.0 {
                *point += Vector3::new(30.0, -7.0, 0.4); // another room, another floor
            }
        }
        let (a, b) = (retarget(&here).0, retarget(&there).0);
        for (a, b) in a.iter().zip(&b) {
            assert!((a.base.translation.z - b.base.translation.z).abs() < 1e-3);
            for (p, q) in a.joints.iter().zip(&b.joints) {
                assert!((p - q).abs() < 1e-3, "{p} {q}");
            }
        }
    }
}
