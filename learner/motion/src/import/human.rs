//! From the joints of any skeleton to a capture: names, up, unit.
//!
//! Separate because every format of human motion passes here. Files say neither which axis points up
//! nor what their unit is; both are told from the body itself, and shown.

use super::file::File;
use super::{calibration, resample};
use crate::error::MotionError;
use nalgebra::{Point3, Vector3};
use retarget::{Capture, LANDMARKS, Landmark, Landmarks, Side};

/// Joint positions over time, as a file has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Joints {
    pub(super) names: Vec<String>,
    /// Positions in every frame, in the order of `names`, in the file's unit and axes.
    pub(super) frames: Vec<Vec<Vector3<f64>>>,
}

/// Names of a joint, without side, in the order in which they are looked for: some mean another joint
/// in another skeleton ("LeftLeg" is a shin unless there is a "LeftShin").
const NAMES: [(Landmark, &[&str]); 7] = [
    (
        Landmark::Hip,
        &["upleg", "thigh", "upperleg", "hip", "femur", "leg"],
    ),
    (
        Landmark::Knee,
        &["shin", "lowerleg", "knee", "calf", "tibia", "leg"],
    ),
    (Landmark::Ankle, &["ankle", "foot"]),
    (
        Landmark::Toe,
        &["toebase", "toe", "toes", "ball", "foottoe", "footend"],
    ),
    (
        Landmark::Shoulder,
        &["arm", "upperarm", "uparm", "humerus", "shoulder"],
    ),
    (
        Landmark::Elbow,
        &["forearm", "lowerarm", "elbow", "lowarm", "radius"],
    ),
    (Landmark::Wrist, &["wrist", "hand"]),
];

/// Units that captures come in, m. Those of CMU are inches over 0.45.
const UNITS: [(f64, &str); 4] = [
    (1.0, "m"),
    (0.01, "cm"),
    (0.001, "mm"),
    (0.0254 / 0.45, "inches/0.45"),
];
/// Thigh and shin together of an adult, m, and how far from it a body may be.
const USUAL_LEG: f64 = 0.84;
const LEGS: std::ops::RangeInclusive<f64> = 0.45..=1.25;

/// The capture that a skeleton's joints are; adds what was decided to `decisions`.
///
/// # Errors
/// A joint that is missing, too few frames, a number that is not finite, a body that does not stand or
/// is of no human size.
pub(super) fn capture(
    file: &File<'_>,
    joints: &Joints,
    fps: f64,
    decisions: &mut Vec<String>,
) -> Result<Capture, MotionError> {
    if joints.frames.is_empty() {
        return Err(file.unusable("holds no frames", "export the motion again"));
    }
    let columns = columns(file, &joints.names)?;
    for (i, frame) in joints.frames.iter().enumerate() {
        for (landmark, &column) in columns.iter().enumerate() {
            if !frame[column].iter().all(|x| x.is_finite()) {
                let field = &joints.names[columns[landmark]];
                let problem = "the position is not finite".into();
                return Err(file.frame(i, field, problem, "repair or cut the frame"));
            }
        }
    }
    let frames: Vec<Landmarks> = joints
        .frames
        .iter()
        .map(|frame| Landmarks(columns.map(|column| Point3::from(frame[column]))))
        .collect();
    let mut capture = Capture { fps, frames };
    stand_up(file, &mut capture, decisions)?;
    to_metres(file, &mut capture, decisions)?;
    let pose = calibration::of_human(&capture, decisions);
    capture.frames.drain(..pose);
    resample::check_duration(file, capture.frames.len(), fps)?;
    Ok(capture)
}

/// The column of each landmark.
fn columns(file: &File<'_>, names: &[String]) -> Result<[usize; LANDMARKS], MotionError> {
    let mut columns = [0; LANDMARKS];
    for side in Side::BOTH {
        let mut taken: Vec<usize> = Vec::new();
        // From the foot up and from the hand up: outer joints have the clearer names.
        for landmark in Landmark::ALL {
            let (_, stems) = NAMES[landmark as usize];
            let found = stems
                .iter()
                .filter(|stem| {
                    !(**stem == "leg" && landmark == Landmark::Hip && !has_shin(names, side))
                })
                .find_map(|stem| {
                    (0..names.len()).find(|i| !taken.contains(i) && is(&names[*i], side, stem))
                });
            let Some(column) = found else {
                let side = if side == Side::Left { "left" } else { "right" };
                return Err(file.unusable(
                    &format!(
                        "has no joint for the {side} {} (but {})",
                        landmark.name(),
                        shortened(names)
                    ),
                    "rename the joint, for example LeftUpLeg, LeftLeg, LeftFoot, LeftToeBase, LeftArm, \
                     LeftForeArm, LeftHand",
                ));
            };
            taken.push(column);
            columns[Landmarks::index(side, landmark)] = column;
        }
    }
    Ok(columns)
}

fn has_shin(names: &[String], side: Side) -> bool {
    names.iter().any(|name| is(name, side, "shin"))
}

/// Whether a joint's name is a side and a stem, in any of the usual ways: LeftFoot, left_foot, L_Foot,
/// Foot_L, lfoot, mixamorig:LeftFoot.
fn is(name: &str, side: Side, stem: &str) -> bool {
    let name = name.rsplit(':').next().unwrap_or(name);
    let plain: String = name
        .chars()
        .filter(char::is_ascii_alphanumeric)
        .map(|c| c.to_ascii_lowercase())
        .collect();
    let (word, letter) = if side == Side::Left {
        ("left", "l")
    } else {
        ("right", "r")
    };
    let parts = name.split(['_', '.', '-', ' ']).count() > 1;
    plain.strip_prefix(word) == Some(stem)
        || plain.strip_suffix(word) == Some(stem)
        || plain.strip_prefix(letter) == Some(stem)
        || (parts && plain.strip_suffix(letter) == Some(stem))
}

fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 12;
    let shown = names
        .iter()
        .take(SHOWN)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match names.len().checked_sub(SHOWN) {
        Some(more @ 1..) => format!("{shown} and {more} more"),
        _ => shown,
    }
}

/// Turns the capture so that z points up: the axis along which shoulders are above ankles.
fn stand_up(
    file: &File<'_>,
    capture: &mut Capture,
    decisions: &mut Vec<String>,
) -> Result<(), MotionError> {
    let mut up = Vector3::zeros();
    for frame in &capture.frames {
        let body = frame.middle(Landmark::Shoulder) - frame.middle(Landmark::Ankle);
        up += body.try_normalize(1e-9).unwrap_or_default();
    }
    up /= capture.frames.len() as f64;
    let shares = format!("bodies point {:.2} along y, {:.2} along z", up.y, up.z);
    if up.y.max(up.z) < 0.5 {
        return Err(file.unusable(
            &format!("does not stand: {shares}"),
            "turn the motion so that y or z points up; people must stand for most of a clip",
        ));
    }
    if up.y > up.z {
        for point in capture.frames.iter_mut().flat_map(|frame| &mut frame.0) {
            *point = Point3::new(point.x, -point.z, point.y);
        }
    }
    let axis = if up.y > up.z { "y" } else { "z" };
    decisions.push(format!("{axis} up: {shares}"));
    Ok(())
}

/// Scales the capture to metres: the unit in which the legs come nearest to an adult's.
fn to_metres(
    file: &File<'_>,
    capture: &mut Capture,
    decisions: &mut Vec<String>,
) -> Result<(), MotionError> {
    let leg = capture.leg_length();
    let misfit = |unit: f64| (leg * unit / USUAL_LEG).ln().abs();
    let (unit, name) = UNITS
        .into_iter()
        .min_by(|a, b| misfit(a.0).total_cmp(&misfit(b.0)))
        .expect("there are units");
    if !LEGS.contains(&(leg * unit)) {
        return Err(file.unusable(
            &format!("has legs {leg:.3} long, which is no human in m, cm, mm or inches/0.45"),
            "scale the motion to metres",
        ));
    }
    for point in capture.frames.iter_mut().flat_map(|frame| &mut frame.0) {
        point.coords *= unit;
    }
    decisions.push(format!("unit {name}: legs of {:.3} m", leg * unit));
    Ok(())
}

#[cfg(test)]
pub(super) mod tests;
