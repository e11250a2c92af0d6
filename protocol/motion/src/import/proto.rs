//! Motions of ProtoMotions: what `torch.save` makes of one motion (`.motion`) or of a library (`.pt`).
//!
//! Separate as every format is. Files hold the places of bodies without names; the count of bodies and of
//! joint angles says which character they are of. Layouts: `protomotions/components/motion_lib.py` and the
//! models in `protomotions/data/assets/mjcf` of NVlabs/ProtoMotions at 607ca7a0.

use super::file::File;
use super::file::array::{Array, PLACES};
use super::file::pickle::Pickle;
use super::file::torch;
use super::human::Joints;
use super::joints::{self, Table};
use super::order::{self, Said};
use super::{Motion, Sure, isaac, rate};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::kinematics::forward;
use g1::{LEFT_FOOT, RIGHT_FOOT};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// Names of a part in a file of one motion and in a library.
const BODIES: [&str; 2] = ["rigid_body_pos", "gts"];
const TURNS: [&str; 2] = ["rigid_body_rot", "grs"];
const ANGLES: [&str; 2] = ["dof_pos", "dps"];

/// Bodies of the characters that are no G1, in the order of their models.
const SMPL: [&str; 24] = [
    "Pelvis",
    "L_Hip",
    "L_Knee",
    "L_Ankle",
    "L_Toe",
    "R_Hip",
    "R_Knee",
    "R_Ankle",
    "R_Toe",
    "Torso",
    "Spine",
    "Chest",
    "Neck",
    "Head",
    "L_Thorax",
    "L_Shoulder",
    "L_Elbow",
    "L_Wrist",
    "L_Hand",
    "R_Thorax",
    "R_Shoulder",
    "R_Elbow",
    "R_Wrist",
    "R_Hand",
];
const SOMA: [&str; 23] = [
    "Hips",
    "Spine1",
    "Spine2",
    "Chest",
    "Neck1",
    "Neck2",
    "Head",
    "RightShoulder",
    "RightArm",
    "RightForeArm",
    "RightHand",
    "LeftShoulder",
    "LeftArm",
    "LeftForeArm",
    "LeftHand",
    "RightLeg",
    "RightShin",
    "RightFoot",
    "RightToeBase",
    "LeftLeg",
    "LeftShin",
    "LeftFoot",
    "LeftToeBase",
];
const AMP: [&str; 15] = [
    "pelvis",
    "torso",
    "head",
    "right_upper_arm",
    "right_lower_arm",
    "right_hand",
    "left_upper_arm",
    "left_lower_arm",
    "left_hand",
    "right_thigh",
    "right_shin",
    "right_foot",
    "left_thigh",
    "left_shin",
    "left_foot",
];
/// Fingers of a hand of SMPL-X, which stand after its wrist: 15 bodies without names that matter.
const FINGERS: usize = 15;
/// A foot that is farther from every body of the file is no foot of this robot, m.
const AGREES: f64 = 0.05;

/// Whether a pickle is such a motion, or a library of them.
pub(super) fn is(pickle: &Pickle) -> bool {
    BODIES.iter().any(|name| pickle.has(name))
}

/// Reads a file: motion and frames per second.
pub(super) fn read(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Motion, Option<f64>), MotionError> {
    let pickle = match torch::read(file)? {
        Some(pickle) => pickle,
        None => Pickle::read(file, file.bytes)?,
    };
    let fps = rate(file, &pickle)?;
    let (places, name) = pickle.part(file, &BODIES, EXPECTED)?;
    let (turns, turns_name) = pickle.part(file, &TURNS, EXPECTED)?;
    let angles = ANGLES
        .iter()
        .find_map(|&name| Some((pickle.array(&[name])?, name)));
    let bodies = places.width() / 3;
    places.check(file, name, &[3 * bodies], PLACES)?;
    turns.check(file, turns_name, &[4 * bodies], (f64::INFINITY, ""))?;
    turns.check_length(file, turns_name, (&places, name))?;
    if let Some((angles, angles_name)) = &angles
        && matches!(angles.width(), 23 | 29)
        && bodies > angles.width()
    {
        let (pelvis, turn) = (places.part(0, 3), turns.part(0, 4));
        let (angles, names) = order::of_g1(file, (angles, angles_name), Said::Nothing, decisions)?;
        let table = Table {
            position: (&pelvis, name),
            orientation: (&turn, turns_name),
            joints: (&angles, angles_name),
            columns: joints::columns(&names).expect("both orders have all joints"),
        };
        let rows = table.rows(file, QuaternionOrder::Xyzw)?;
        let gap = rows
            .iter()
            .enumerate()
            .map(|(i, row)| {
                let base = Isometry3::from_parts(row.position.into(), row.orientation);
                feet_gap(&base, &row.joints, places.frame(i))
            })
            .fold(0.0, f64::max);
        if gap > AGREES {
            return Err(file.unusable(
                &format!("has no bodies where the feet of a G1 would be (off by {gap:.2} m)"),
                "export the motion of a G1 with its own model",
            ));
        }
        decisions.push(format!(
            "a G1: feet are off by {:.1} cm at most",
            100.0 * gap
        ));
        return Ok((Motion::Robot(rows, Sure::Yes), fps));
    }
    let joints = human(file, &places, &turns, (name, turns_name))?;
    decisions.push(format!("a humanoid of {bodies} bodies"));
    Ok((Motion::Human(joints), fps))
}

/// Frames per second; a library must be of one motion.
fn rate(file: &File<'_>, pickle: &Pickle) -> Result<Option<f64>, MotionError> {
    let first = |name: &str| {
        pickle
            .array(&[name])
            .and_then(|a| a.values.first().copied())
    };
    if let Some(counts) = pickle.array(&["motion_num_frames"])
        && counts.values.len() != 1
    {
        return Err(file.unusable(
            &format!("is a library of {} motions", counts.values.len()),
            "give the .motion files that it was made of, or a library of one",
        ));
    }
    let stated = (
        first("fps"),
        first("motion_dt").map(|seconds| 1.0 / seconds),
    );
    if let (Some(fps), Some(of_dt)) = stated
        && !rate::agree(fps, of_dt)
    {
        let of_dt = rate::shown(of_dt);
        return Err(file.unusable(
            &format!("states two rates: fps = {fps}, and {of_dt} frames a second by motion_dt"),
            "keep the right one of them",
        ));
    }
    Ok(stated.0.or(stated.1))
}

/// What a motion of ProtoMotions has.
const EXPECTED: &str = "expected fps, dof_pos, rigid_body_pos and rigid_body_rot";

/// How far the robot's feet are from the nearest bodies of the file, m.
fn feet_gap(base: &Isometry3<f64>, joints: &[f64; g1::JOINTS], places: &[f64]) -> f64 {
    let ours = forward(base, joints);
    let nearest = |foot: usize| {
        let foot = ours[foot].translation.vector;
        let bodies = places.chunks_exact(3).map(Vector3::from_column_slice);
        bodies
            .map(|place| (place - foot).norm())
            .fold(f64::INFINITY, f64::min)
    };
    nearest(LEFT_FOOT).max(nearest(RIGHT_FOOT))
}

/// The joints of a character that is no G1, by the count of its bodies.
fn human(
    file: &File<'_>,
    places: &Array,
    turns: &Array,
    (name, turns_name): (&str, &str),
) -> Result<Joints, MotionError> {
    let owned = |names: &[&str]| -> Vec<String> { names.iter().map(|n| (*n).to_owned()).collect() };
    let names = match places.width() / 3 {
        24 => owned(&SMPL),
        52 => {
            let fingers = |side: &str| {
                (0..FINGERS)
                    .map(move |i| format!("{side} finger {i}"))
                    .collect()
            };
            let (left, right) = (owned(&SMPL[..18]), owned(&SMPL[19..23]));
            let [first, second]: [Vec<String>; 2] = ["one", "other"].map(fingers);
            [left, first, right, second].concat()
        }
        23 => owned(&SOMA),
        15 => owned(&AMP),
        _ => {
            let problem = format!("array {name} has the shape {:?}", places.shape);
            return Err(file.unusable(
                &problem,
                "known are the G1 (with dof_pos of 29 or 23), and 24, 52, 23 or 15 bodies for SMPL, SMPL-X, \
                 SOMA and the AMP humanoid",
            ));
        }
    };
    let frames: Vec<Vec<Isometry3<f64>>> = (0..places.frames())
        .map(|i| {
            let bodies = places
                .frame(i)
                .chunks_exact(3)
                .zip(turns.frame(i).chunks_exact(4));
            bodies
                .map(|(place, turn)| {
                    let quaternion = joints::quaternion(turn, QuaternionOrder::Xyzw);
                    joints::check_unit(file, i, turns_name, &quaternion)?;
                    let turn = UnitQuaternion::from_quaternion(quaternion);
                    Ok(Isometry3::from_parts(
                        Vector3::from_column_slice(place).into(),
                        turn,
                    ))
                })
                .collect()
        })
        .collect::<Result<_, MotionError>>()?;
    Ok(isaac::with_toes(names, &frames))
}

#[cfg(test)]
#[path = "proto_tests.rs"]
pub(super) mod tests;
