//! Motion that no body makes: teleports and accelerations.
//!
//! Separate because both look at second differences: what cannot be told from a frame alone.

use super::super::defect::{Defect, Frames, Kind, Severity, few};
use crate::clip::FRAME_SECONDS;
use g1::{JOINT_TABLE, JOINTS, RobotState};
use nalgebra::Vector3;

/// Acceleration of a pelvis that no body makes, m/s²: 10 g, which stops a fall from 1 m (more than a good jump) within
/// 0.1 m of bending the legs. It is a step of 3.9 cm in a frame. Captures and built-in gaits stay below 4.2 g at 50 Hz.
const PELVIS: f64 = 98.1;
/// Way in a frame that nobody runs, m: 12.4 m/s, the fastest that was measured (100 m in Berlin, 2009), for 0.02 s.
const RUN: f64 = 0.248;
/// Acceleration of a limb, or of a turning pelvis, that nothing alive makes, rad/s²: from rest to the top speed of the
/// robot's knee, 20 rad/s, within a frame, where a muscle takes more than two to build up its force. It is a step of 23°.
/// The fastest built-in walk peaks at 850, captures that retarget well at 520.
pub(super) const LIMB: f64 = 1000.0;
/// The same in two successive frames, one against the other, rad/s²: 8° a frame² there and back. Going on like that is a
/// shake at 25 Hz by 2° to either side (4·0.035 rad in (0.02 s)²), where tremor is at 8 to 12 Hz and below a degree.
/// Built-in gaits and captures that retarget well stay below 280.
const SHAKE: f64 = 350.0;
/// The same that is no glitch, rad/s²: twice a shake, a joint that is 16° elsewhere from one frame to the next.
pub(super) const JOLT: f64 = 700.0;
/// Share of a clip that may shake and is only odd: a glitch in a long take.
const GLITCHES: f64 = 0.01;
/// Frames apart that belong to one jump.
const APART: usize = 3;

const DT2: f64 = FRAME_SECONDS * FRAME_SECONDS;

/// Places where the pelvis is moved or turned at once.
pub(super) fn teleport(frames: &[RobotState]) -> Option<Defect> {
    let steps = differences(frames, |a, b| b.position.cast() - a.position.cast());
    let turns = differences(frames, |a, b| {
        (b.orientation.cast::<f64>() * a.orientation.cast::<f64>().inverse()).scaled_axis()
    });
    let mut moved = jerked(&steps, PELVIS, PELVIS);
    for (moved, step) in moved.iter_mut().skip(1).zip(&steps) {
        *moved |= step.norm() > RUN;
    }
    let mut jumps = jumps(&moved, &steps, "m");
    jumps.extend(self::jumps(&jerked(&turns, LIMB, SHAKE), &turns, "°"));
    jumps.sort_by_key(|jump| jump.frame);
    let worse = |a: &&Jump, b: &&Jump| a.share().total_cmp(&b.share());
    // One place that is both moved and turned is one jump.
    let jumps: Vec<&Jump> = jumps
        .chunk_by(|a, b| b.frame - a.frame <= APART)
        .filter_map(|place| place.iter().max_by(worse))
        .collect();
    let worst = jumps.iter().copied().max_by(worse)?;
    let what = match worst.unit {
        "m" => format!("moves {:.2} m", worst.by),
        _ => format!("turns by {:.0}°", worst.by),
    };
    let time = match worst.frames {
        1 => "in one frame".into(),
        frames => format!("within {frames} frames"),
    };
    let places = match jumps.len() {
        1 => String::new(),
        places => format!(", the worst of {places} such places"),
    };
    let at: Vec<(usize, f64)> = jumps
        .iter()
        .map(|jump| (jump.frame, jump.share()))
        .collect();
    Some(Defect::new(
        Kind::Teleport,
        Severity::Unfit,
        Frames::of(&at)?,
        (worst.by, worst.unit),
        &format!("teleports: the pelvis {what} {time}{places}"),
    ))
}

/// A place where the pelvis is elsewhere at once.
struct Jump {
    /// The frame that the greatest of its steps leads to, from 0.
    frame: usize,
    /// How many steps it takes: more than one in a file of fewer frames a second.
    frames: usize,
    /// How far, m or degrees.
    by: f64,
    unit: &'static str,
}

impl Jump {
    /// How far beyond what a body does.
    fn share(&self) -> f64 {
        self.by
            / if self.unit == "m" {
                RUN
            } else {
                (LIMB * DT2).to_degrees()
            }
    }
}

/// The jumps of flagged frames: flags close to each other are one.
fn jumps(flags: &[bool], steps: &[Vector3<f64>], unit: &'static str) -> Vec<Jump> {
    let flagged: Vec<usize> = (0..flags.len()).filter(|&i| flags[i]).collect();
    let groups = flagged.chunk_by(|a, b| b - a <= APART);
    groups
        .map(|group| {
            let (first, last) = (group[0].max(1), group[group.len() - 1]);
            // Step i − 1 leads to frame i; the step out of the last flagged frame belongs to the jump too.
            let end = farthest(first, (last + 1).min(steps.len()), steps);
            let into = (first..=end)
                .max_by(|&i, &j| steps[i - 1].norm().total_cmp(&steps[j - 1].norm()))
                .expect("a jump has a step");
            let most = steps[into - 1].norm();
            let great = |&i: &usize| 2.0 * steps[i - 1].norm() > most;
            let before = (first..into).rev().take_while(great).count();
            let after = (into + 1..=end).take_while(great).count();
            let way: Vector3<f64> = steps[into - 1 - before..into + after].iter().sum();
            Jump {
                frame: into,
                frames: before + 1 + after,
                by: if unit == "m" {
                    way.norm()
                } else {
                    way.norm().to_degrees()
                },
                unit,
            }
        })
        .collect()
}

/// The frame from `first` to `last` that is farthest from the one before `first`: of what goes there and back, there.
fn farthest(first: usize, last: usize, steps: &[Vector3<f64>]) -> usize {
    let (mut way, mut most, mut at) = (Vector3::zeros(), 0.0, first);
    for i in first..=last {
        way += steps[i - 1];
        if way.norm() > most {
            (most, at) = (way.norm(), i);
        }
    }
    at
}

/// Joints that accelerate like nothing alive.
pub(super) fn acceleration(frames: &[RobotState]) -> Option<Defect> {
    let mut worst_at = vec![0.0_f64; frames.len()];
    let mut joints: Vec<(usize, f64)> = Vec::new();
    let mut jolted = false;
    for j in 0..JOINTS {
        let angle = |f: &RobotState| Vector3::x() * f64::from(f.joint_positions[j]);
        let steps = differences(frames, |a, b| angle(b) - angle(a));
        let flags = jerked(&steps, LIMB, SHAKE);
        jolted |= jerked(&steps, LIMB, JOLT).contains(&true);
        let mut most: f64 = 0.0;
        for i in (0..frames.len()).filter(|&i| flags[i]) {
            let acceleration = (steps[i] - steps[i - 1]).norm() / DT2;
            worst_at[i] = worst_at[i].max(acceleration);
            most = most.max(acceleration);
        }
        if most > 0.0 {
            joints.push((j, most));
        }
    }
    joints.sort_by(|a, b| b.1.total_cmp(&a.1));
    let (_, most) = *joints.first()?;
    let bad: Vec<(usize, f64)> = worst_at
        .into_iter()
        .enumerate()
        .filter(|(_, a)| *a > 0.0)
        .collect();
    let names: Vec<String> = joints
        .iter()
        .map(|&(j, _)| JOINT_TABLE[j].name.into())
        .collect();
    let how = if most > LIMB {
        "like nothing alive"
    } else {
        "to and fro, as nothing alive shakes"
    };
    let says = format!(
        "acceleration {how}: up to {most:.0} rad/s², {:.0}° a frame², at {}",
        (most * DT2).to_degrees(),
        few(&names)
    );
    let severity = if jolted || bad.len() as f64 > GLITCHES * frames.len() as f64 {
        Severity::Unfit
    } else {
        Severity::Odd
    };
    let (kind, at) = (Kind::Acceleration, Frames::of(&bad)?);
    let defect = Defect::new(kind, severity, at, (most, "rad/s²"), &says);
    Some(defect.of_joints(names))
}

/// What changes from each frame to the next.
fn differences(
    frames: &[RobotState],
    change: impl Fn(&RobotState, &RobotState) -> Vector3<f64>,
) -> Vec<Vector3<f64>> {
    frames
        .windows(2)
        .map(|pair| change(&pair[0], &pair[1]))
        .collect()
}

/// Frames whose acceleration (steps are per frame) is beyond `most`, or beyond `against` and followed or preceded by one
/// beyond it the other way. A flag per frame; the first and the last have no acceleration.
fn jerked(steps: &[Vector3<f64>], most: f64, against: f64) -> Vec<bool> {
    let accelerations: Vec<Vector3<f64>> = steps
        .windows(2)
        .map(|pair| (pair[1] - pair[0]) / DT2)
        .collect();
    let mut flags = vec![false; steps.len() + 1];
    for (i, a) in accelerations.iter().enumerate() {
        flags[i + 1] |= a.norm() > most;
        if let Some(next) = accelerations.get(i + 1) {
            let back = a.dot(next) < 0.0 && a.norm().min(next.norm()) > against;
            flags[i + 1] |= back;
            flags[i + 2] |= back;
        }
    }
    flags
}
