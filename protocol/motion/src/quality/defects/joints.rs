//! Joints against their ranges and their motors.
//!
//! Separate because these are the robot's bounds, not a body's.

use super::super::Quality;
use super::super::defect::{Defect, Frames, Kind, Severity, few};
use crate::clip::FRAME_SECONDS;
use g1::{JOINT_TABLE, JOINTS, RobotState};

/// This near to a limit a joint is against its stop, rad: retargeting keeps 1e-4 away, tables have three digits.
const AT_STOP: f64 = 0.01;
/// Share of a clip in which a joint may be there: more than half is most of it. Captures that retarget well have 7 % at
/// the ankles' roll, the narrowest range.
const MOST: f64 = 0.5;
/// Beyond a limit by less, rad (half a degree), physics only pushes the joint back.
const BEYOND: f64 = 0.01;

pub(super) fn of(frames: &[RobotState], quality: &Quality) -> Vec<Defect> {
    [motor(frames), limits(frames, quality), stops(frames)]
        .into_iter()
        .flatten()
        .collect()
}

/// Joints that turn farther between two frames than their motors can.
fn motor(frames: &[RobotState]) -> Option<Defect> {
    let share = |j: usize, i: usize| {
        let step = frames[i].joint_positions[j] - frames[i - 1].joint_positions[j];
        f64::from(step.abs()) / (JOINT_TABLE[j].velocity_limit * FRAME_SECONDS)
    };
    of_joints(frames.len(), |j, i| {
        let share = if i == 0 { 0.0 } else { share(j, i) };
        (share > 1.0).then_some(share)
    })
    .map(|(names, bad, most)| {
        let says = format!(
            "outruns the motor, by up to {most:.1} times its speed: {}",
            few(&names)
        );
        let severity = Severity::Unfit;
        Defect::new(
            Kind::Motor,
            severity,
            bad,
            (most, "of the motor's speed"),
            &says,
        )
        .of_joints(names)
    })
}

/// Joints that leave their range.
fn limits(frames: &[RobotState], quality: &Quality) -> Option<Defect> {
    if quality.beyond_limits.is_empty() {
        return None;
    }
    of_joints(frames.len(), |j, i| {
        // `f32` rounds the limit itself.
        Some(beyond(&frames[i], j)).filter(|by| *by > 1e-6)
    })
    .map(|(names, bad, most)| {
        let severity = if most > BEYOND {
            Severity::Unfit
        } else {
            Severity::Odd
        };
        let says = format!("up to {most:.3} rad beyond the limit: {}", few(&names));
        Defect::new(Kind::Limits, severity, bad, (most, "rad"), &says).of_joints(names)
    })
}

/// Joints that rest against a stop for most of the clip.
fn stops(frames: &[RobotState]) -> Option<Defect> {
    let at_stop = |j: usize, i: usize| beyond(&frames[i], j).abs() < AT_STOP;
    let share = |j: usize| {
        let count = (0..frames.len()).filter(|&i| at_stop(j, i)).count();
        count as f64 / frames.len() as f64
    };
    let shares: Vec<f64> = (0..JOINTS).map(share).collect();
    of_joints(frames.len(), |j, i| {
        (shares[j] > MOST && at_stop(j, i)).then_some(shares[j])
    })
    .map(|(names, bad, most)| {
        let says = format!(
            "against a stop in {:.0} % of frames: {}",
            100.0 * most,
            few(&names)
        );
        let severity = Severity::Unfit;
        Defect::new(Kind::Stops, severity, bad, (most, "of the frames"), &says).of_joints(names)
    })
}

/// How far a joint is beyond its range, rad; negative within.
fn beyond(frame: &RobotState, j: usize) -> f64 {
    let (q, joint) = (f64::from(frame.joint_positions[j]), &JOINT_TABLE[j]);
    (joint.lower - q).max(q - joint.upper)
}

/// The joints and frames of which `bad` says how bad they are: names (worst first), frames, the worst.
fn of_joints(
    frames: usize,
    bad: impl Fn(usize, usize) -> Option<f64>,
) -> Option<(Vec<String>, Frames, f64)> {
    let mut worst_at: Vec<Option<f64>> = vec![None; frames];
    let mut joints: Vec<(usize, f64)> = Vec::new();
    for j in 0..JOINTS {
        let mut most: Option<f64> = None;
        for (i, worst) in worst_at.iter_mut().enumerate() {
            let found = bad(j, i);
            // `None` is less than any number.
            most = if found > most { found } else { most };
            *worst = if found > *worst { found } else { *worst };
        }
        joints.extend(most.map(|most| (j, most)));
    }
    joints.sort_by(|a, b| b.1.total_cmp(&a.1));
    let most = joints.first()?.1;
    let at: Vec<(usize, f64)> = worst_at
        .iter()
        .enumerate()
        .filter_map(|(i, by)| by.map(|by| (i, by)))
        .collect();
    let names = joints
        .iter()
        .map(|&(j, _)| JOINT_TABLE[j].name.into())
        .collect();
    Some((names, Frames::of(&at)?, most))
}
