//! From the joints of any skeleton to a capture: which joint is which, up, unit.
//!
//! Separate because every format of human motion passes here. Files say neither which axis points up
//! nor what their unit is; both are told from the body itself, and shown.

mod columns;
mod feet;
mod hierarchy;
mod names;

use super::file::File;
use super::{calibration, resample};
use crate::error::MotionError;
use feet::Toes;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use names::Names;
use retarget::{Capture, LANDMARKS, Landmark, Landmarks, Side};
use std::collections::BTreeMap;

/// Joint positions over time, as a file has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Joints {
    pub(super) names: Vec<String>,
    /// Positions in every frame, in the order of `names`, in the file's unit and axes.
    pub(super) frames: Vec<Vec<Vector3<f64>>>,
    /// The joint that each hangs on; empty if the file does not say.
    pub(super) parents: Vec<Option<usize>>,
    /// How joints turn in every frame, of those that may be ankles without toes.
    pub(super) turns: BTreeMap<usize, Vec<UnitQuaternion<f32>>>,
}

/// Units that captures come in, m. Those of CMU are inches over 0.45.
const UNITS: [(f64, &str); 6] = [
    (1.0, "m"),
    (0.01, "cm"),
    (0.001, "mm"),
    (0.0254 / 0.45, "inches/0.45"),
    (0.0254, "inches"),
    (0.3048, "feet"),
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
    let names = Names::of(&joints.names);
    let (columns, toe_columns) = columns::of(file, joints, &names, decisions)?;
    check_finite(file, joints, &columns)?;
    let of = |side, landmark| columns[Landmarks::index(side, landmark)];
    let up = up(joints, &of);
    let Some(toes) = feet::toes(joints, &names, toe_columns, &of, up) else {
        return Err(columns::missing(file, joints, Side::Left, Landmark::Toe));
    };
    let frames = landmarks(file, joints, &columns, toes, decisions)?;
    let mut capture = Capture { fps, frames };
    stand_up(file, &mut capture, decisions)?;
    to_metres(file, &mut capture, decisions)?;
    let pose = calibration::of_human(&capture, decisions);
    capture.frames.drain(..pose);
    resample::check_duration(file, capture.frames.len(), fps)?;
    Ok(capture)
}

fn check_finite(file: &File<'_>, joints: &Joints, columns: &[usize]) -> Result<(), MotionError> {
    for (i, frame) in joints.frames.iter().enumerate() {
        for &column in columns {
            if !frame[column].iter().all(|x| x.is_finite()) {
                let problem = "the position is not finite".into();
                return Err(file.frame(
                    i,
                    &joints.names[column],
                    problem,
                    "repair or cut the frame",
                ));
            }
        }
    }
    Ok(())
}

/// The axis that points up, y or z: the one along which shoulders are above ankles.
fn up(joints: &Joints, of: &dyn Fn(Side, Landmark) -> usize) -> Vector3<f64> {
    let rise = |frame: &Vec<Vector3<f64>>| {
        let way =
            frame[of(Side::Left, Landmark::Shoulder)] - frame[of(Side::Left, Landmark::Ankle)];
        way.try_normalize(1e-9).unwrap_or_default()
    };
    let rise: Vector3<f64> = joints.frames.iter().map(rise).sum();
    if rise.y > rise.z {
        Vector3::y()
    } else {
        Vector3::z()
    }
}

/// The landmarks of all frames, with their toes.
fn landmarks(
    file: &File<'_>,
    joints: &Joints,
    columns: &[usize; LANDMARKS],
    toes: Toes,
    decisions: &mut Vec<String>,
) -> Result<Vec<Landmarks>, MotionError> {
    let at = Side::BOTH.map(|side| Landmarks::index(side, Landmark::Toe));
    let mut columns = *columns;
    if let Toes::Joints(toes) = toes {
        (columns[at[0]], columns[at[1]]) = (toes[0], toes[1]);
        check_finite(file, joints, &toes)?;
    }
    let of_frame = |frame: &Vec<Vector3<f64>>| columns.map(|column| Point3::from(frame[column]));
    let mut frames: Vec<Landmarks> = joints
        .frames
        .iter()
        .map(|frame| Landmarks(of_frame(frame)))
        .collect();
    if let Toes::Made(places, told) = toes {
        for (frame, places) in frames.iter_mut().zip(places) {
            (frame.0[at[0]], frame.0[at[1]]) = (places[0].into(), places[1].into());
        }
        decisions.push(told);
    }
    Ok(frames)
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
    let mut units = UNITS;
    units.sort_by(|a, b| misfit(a.0).total_cmp(&misfit(b.0)));
    let [(unit, name), (other, other_name), ..] = units;
    if !LEGS.contains(&(leg * unit)) {
        return Err(file.unusable(
            &format!("has legs {leg:.3} long, which is no human in m, cm, mm, inches, feet or inches/0.45"),
            "scale the motion to metres",
        ));
    }
    for point in capture.frames.iter_mut().flat_map(|frame| &mut frame.0) {
        point.coords *= unit;
    }
    let or = if LEGS.contains(&(leg * other)) {
        format!(" (or {other_name}: {:.3} m)", leg * other)
    } else {
        String::new()
    };
    decisions.push(format!("unit {name}: legs of {:.3} m{or}", leg * unit));
    Ok(())
}

#[cfg(test)]
mod skeleton_tests;
#[cfg(test)]
pub(super) mod tests;
