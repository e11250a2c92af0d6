//! A first frame that is no motion: the pose in which a skeleton was calibrated.
//!
//! Separate because humans and robots have it alike. Most conversions of CMU's captures to BVH begin with
//! a T-pose, solvers with the robot's zero pose; a body that jumps from there to its first step would teach
//! a jump.

use super::Row;
use g1::{DEFAULT_POSE, JOINTS};
use nalgebra::Vector3;
use retarget::{Capture, Landmark, Landmarks, Side};
use std::f64::consts::PI;

/// A turn that is a jump if the next are much smaller: kicks and throws turn a bone at up to 2300°/s (40 rad/s),
/// but not from one frame of a recording to the next and then no more. Rad/s, and the least angle, rad.
const FASTEST_TURN: f64 = 900.0 * PI / 180.0;
const LEAST_TURN: f64 = 15.0 * PI / 180.0;
/// Out of a T-pose or a robot's zero pose less is enough, since nothing human begins so; rad.
const OUT_OF_POSE: f64 = 30.0 * PI / 180.0;
const OUT_OF_ZERO: f64 = 0.1;
/// No human runs faster, m/s; and the least way that is a jump, m.
const FASTEST_RUN: f64 = 12.5;
const LEAST_WAY: f64 = 0.3;
/// The pose may be held, exactly, for so long, s.
const LONGEST: f64 = 1.0;
/// A frame that is held differs by less than this share of a jump.
const HELD: f64 = 0.02;
/// The two steps after a jump are smaller than this share of it, or it belongs to the motion.
const ALONE: f64 = 1.0 / 3.0;

/// The way from one frame to the next.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Greatest turn of a bone or a joint, as a share of the greatest that is possible.
    turn: f64,
    /// Way of hips or pelvis, as a share of the same.
    way: f64,
    /// What to say of it if it is a jump.
    angle: f64,
    metres: f64,
}

/// How many leading frames of a human's capture are a calibration pose; says so.
pub(super) fn of_human(capture: &Capture, decisions: &mut Vec<String>) -> usize {
    let frames = &capture.frames;
    let step = |i: usize| {
        let (a, b) = (&frames[i], &frames[i + 1]);
        let turns = bones(a).into_iter().zip(bones(b)).map(|(a, b)| a.angle(&b));
        let angle = turns.fold(0.0, f64::max);
        let metres = (b.middle(Landmark::Hip) - a.middle(Landmark::Hip)).norm();
        let possible = possible_turn(capture.fps);
        Step {
            turn: angle
                / if is_t_pose(a) {
                    OUT_OF_POSE.min(possible)
                } else {
                    possible
                },
            way: metres / (FASTEST_RUN / capture.fps).max(LEAST_WAY),
            angle,
            metres,
        }
    };
    let count = leading(frames.len(), capture.fps, step, decisions);
    if count > 0 && is_t_pose(&frames[0]) {
        decisions.push("the pose that was dropped is a T-pose".into());
    }
    count
}

/// How many leading rows of a robot's motion are a calibration pose; says so.
pub(super) fn of_robot(rows: &[Row], fps: f64, decisions: &mut Vec<String>) -> usize {
    let step = |i: usize| {
        let (a, b) = (&rows[i], &rows[i + 1]);
        let turns = a.joints.iter().zip(b.joints).map(|(a, b)| (b - a).abs());
        let angle = turns.fold(0.0, f64::max);
        let metres = (b.position - a.position).norm();
        let possible = possible_turn(fps);
        Step {
            turn: angle
                / if is_zero(a) {
                    OUT_OF_ZERO.min(possible)
                } else {
                    possible
                },
            way: metres / (FASTEST_RUN / fps).max(LEAST_WAY),
            angle,
            metres,
        }
    };
    leading(rows.len(), fps, step, decisions)
}

/// A turn between frames that only a jump exceeds, rad.
fn possible_turn(fps: f64) -> f64 {
    (FASTEST_TURN / fps).max(LEAST_TURN)
}

/// Leading frames that are alike and from which nobody gets to the next frame.
fn leading(
    frames: usize,
    fps: f64,
    step: impl Fn(usize) -> Step,
    decisions: &mut Vec<String>,
) -> usize {
    let longest = (LONGEST * fps) as usize;
    // The motion after it must have two steps at least, to compare the jump with.
    for i in 0..frames.saturating_sub(3).min(longest + 1) {
        let now = step(i);
        let after = [step(i + 1), step(i + 2)];
        let jump = |share: fn(&Step) -> f64| {
            share(&now) > 1.0 && after.iter().all(|next| share(next) < ALONE * share(&now))
        };
        if jump(|step| step.turn) || jump(|step| step.way) {
            let count = i + 1;
            let what = if count == 1 {
                "dropped the first frame, a calibration pose".to_owned()
            } else {
                format!("dropped the first {count} frames, a calibration pose held")
            };
            decisions.push(format!(
                "{what}: the next frame is {:.0}° and {:.2} m away, in {:.1} ms",
                now.angle.to_degrees(),
                now.metres,
                1000.0 / fps
            ));
            return count;
        }
        if now.turn > HELD || now.way > HELD {
            return 0;
        }
    }
    0
}

/// Directions of thighs, shins, upper arms, forearms and trunk.
fn bones(frame: &Landmarks) -> [Vector3<f64>; 9] {
    use Landmark::{Ankle, Elbow, Hip, Knee, Shoulder, Wrist};
    let ends = [
        (Hip, Knee),
        (Knee, Ankle),
        (Shoulder, Elbow),
        (Elbow, Wrist),
    ];
    let bone = |i: usize| {
        let (from, to) = ends[i % 4];
        frame.of(Side::BOTH[i / 4], to) - frame.of(Side::BOTH[i / 4], from)
    };
    std::array::from_fn(|i| {
        if i < 8 {
            bone(i)
        } else {
            frame.middle(Shoulder) - frame.middle(Hip)
        }
    })
}

/// Whether both arms are stretched out to the sides, within 30°.
fn is_t_pose(frame: &Landmarks) -> bool {
    let out = frame.of(Side::Left, Landmark::Hip) - frame.of(Side::Right, Landmark::Hip);
    let arms = bones(frame);
    let along = |bone: &Vector3<f64>, way: Vector3<f64>| bone.angle(&way) < PI / 6.0;
    arms[2..4].iter().all(|bone| along(bone, out))
        && arms[6..8].iter().all(|bone| along(bone, -out))
}

/// Whether all joints are at zero, or all in the default pose.
fn is_zero(row: &Row) -> bool {
    let near = |pose: [f64; JOINTS]| {
        row.joints
            .iter()
            .zip(pose)
            .all(|(a, b)| (a - b).abs() < 1e-3)
    };
    near([0.0; JOINTS]) || near(DEFAULT_POSE.map(f64::from))
}

#[cfg(test)]
#[path = "calibration_tests.rs"]
mod tests;
