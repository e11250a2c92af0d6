//! JSON with a list of `Frames`: DeepMimic's clips, and those of TienKung-Lab and its relatives.
//!
//! Separate as every format is; the two share that a frame is a row of numbers whose count alone says what
//! they are.

use super::file::File;
use super::file::array::{ANGLES, Array, PLACES};
use super::joints::{self, Table};
use super::order::{self, Said};
use super::skeleton::{self, Body, DEEPMIMIC, TIENKUNG};
use super::{Motion, Sure, isaac};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::JOINTS;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use retarget::signal::median;
use serde::Deserialize;

/// The parts of such a file that matter.
#[derive(Deserialize)]
struct Clip {
    #[serde(rename = "Frames")]
    frames: Vec<Vec<f64>>,
    /// TienKung's seconds between frames; DeepMimic's stand in the frames.
    #[serde(rename = "FrameDuration")]
    duration: Option<f64>,
}

/// DeepMimic's numbers of a frame: seconds, place, quaternion (scalar first), then the joints of
/// `humanoid3d`, balls as quaternions.
const DEEPMIMIC_WIDTH: usize = 44;
/// TienKung's numbers of the root: place, three angles. A frame has them, the joints, and the speeds of all.
const ROOT: usize = 6;
/// Speeds that differ by less, as a share, are the same.
const SAME: f64 = 0.15;

/// Which of the two a text is, by its keys.
pub(super) fn is_deepmimic(text: &str) -> Option<bool> {
    text.contains("\"Frames\"")
        .then(|| !text.contains("\"FrameDuration\""))
}

/// Reads DeepMimic's clip: motion and frames per second.
pub(super) fn deepmimic(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Motion, Option<f64>), MotionError> {
    let (frames, _) = parse(file)?;
    frames.check(file, "Frames", &[DEEPMIMIC_WIDTH], PLACES)?;
    let fps = even_rate(file, &frames)?;
    let bodies = (0..frames.frames())
        .map(|i| {
            let frame = frames.frame(i);
            let root = quaternion(file, i, &frame[4..8])?;
            let (mut pose, mut rest) = (Vec::new(), &frame[8..]);
            for (.., joint) in &DEEPMIMIC {
                let count = match joint {
                    skeleton::Joint::Fixed => continue,
                    skeleton::Joint::Hinge(_) => 1,
                    skeleton::Joint::Ball => 4,
                };
                let (numbers, others) = rest.split_at(count);
                rest = others;
                match numbers {
                    [angle] => pose.push(*angle),
                    ball => pose.extend(quaternion(file, i, ball)?.scaled_axis().iter()),
                }
            }
            let at = Vector3::from_column_slice(&frame[1..4]);
            let root = Isometry3::from_parts(at.into(), root);
            Ok(skeleton::posed(&DEEPMIMIC, root, &pose))
        })
        .collect::<Result<Vec<_>, MotionError>>()?;
    decisions.push("DeepMimic's humanoid of 28 joints".into());
    Ok((human(&DEEPMIMIC, &bodies), Some(fps)))
}

fn quaternion(
    file: &File<'_>,
    frame: usize,
    numbers: &[f64],
) -> Result<UnitQuaternion<f64>, MotionError> {
    let quaternion = joints::quaternion(numbers, QuaternionOrder::Wxyz);
    joints::check_unit(file, frame, "Frames", &quaternion)?;
    Ok(UnitQuaternion::from_quaternion(quaternion))
}

fn human(skeleton: &[Body], bodies: &[Vec<Isometry3<f64>>]) -> Motion {
    let names = skeleton
        .iter()
        .map(|(name, ..)| (*name).to_owned())
        .collect();
    Motion::Human(isaac::with_toes(names, bodies))
}

/// Frames per second from the seconds in front of every frame; that of the last says nothing.
fn even_rate(file: &File<'_>, frames: &Array) -> Result<f64, MotionError> {
    let seconds: Vec<f64> = (0..frames.frames()).map(|i| frames.frame(i)[0]).collect();
    let usual = median(&mut seconds.clone());
    let uneven = seconds[..seconds.len() - 1]
        .iter()
        .position(|s| (s - usual).abs() > 0.02 * usual.abs());
    match uneven {
        Some(frame) => Err(file.frame(
            frame,
            "Frames[0]",
            format!("lasts {} s where others last {usual} s", seconds[frame]),
            "frames must be evenly spaced; resample the motion",
        )),
        None => Ok(1.0 / usual),
    }
}

/// Reads a clip of TienKung-Lab's layout: motion and frames per second.
pub(super) fn tienkung(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Motion, Option<f64>), MotionError> {
    let (frames, duration) = parse(file)?;
    let counts = [29, JOINTS, skeleton::numbers(&TIENKUNG)];
    let widths = counts.map(|joints| 2 * (ROOT + joints));
    frames.check(
        file,
        "Frames",
        &widths,
        (
            1e4,
            "places are in metres, speeds in metres or radians a second",
        ),
    )?;
    let count = frames.width() / 2 - ROOT;
    let Some(seconds) = duration.filter(|seconds| *seconds > 0.0) else {
        return Err(file.unusable("has no FrameDuration", "write the seconds between frames"));
    };
    whole_poses(file, &frames, count, seconds, decisions)?;
    let (place, angles) = (frames.part(0, 3), frames.part(ROOT, count));
    angles.check(file, "Frames, joints", &[count], ANGLES)?;
    place.check(file, "Frames, root", &[3], PLACES)?;
    // Rx·Ry·Rz: `gmr_data_conversion.py` of TienKung-Lab at 7ce828b2 writes intrinsic x, y, z.
    let root: Vec<UnitQuaternion<f64>> = (0..frames.frames())
        .map(|i| {
            let about = |axis: usize| {
                UnitQuaternion::from_scaled_axis(Vector3::ith(axis, frames.frame(i)[3 + axis]))
            };
            about(0) * about(1) * about(2)
        })
        .collect();
    let fps = Some(rounded_rate(seconds, decisions));
    if count == counts[2] {
        decisions.push("TienKung's robot of 20 joints, as a humanoid".into());
        let posed = |(i, root): (usize, &UnitQuaternion<f64>)| {
            let at = Vector3::from_column_slice(place.frame(i));
            skeleton::posed(
                &TIENKUNG,
                Isometry3::from_parts(at.into(), *root),
                angles.frame(i),
            )
        };
        let bodies: Vec<_> = root.iter().enumerate().map(posed).collect();
        return Ok((human(&TIENKUNG, &bodies), fps));
    }
    let (angles, names) = order::of_g1(file, (&angles, "Frames"), Said::Nothing, decisions)?;
    let turn = joints::quaternions(&root);
    let table = Table {
        position: (&place, "Frames"),
        orientation: (&turn, "Frames"),
        joints: (&angles, "Frames"),
        columns: joints::columns(&names).expect("both orders have all joints"),
    };
    Ok((
        Motion::Robot(table.rows(file, QuaternionOrder::Wxyz)?, Sure::Yes),
        fps,
    ))
}

/// Frames per second of a duration that is written with three digits: 0.033 s are 30 frames a second.
fn rounded_rate(seconds: f64, decisions: &mut Vec<String>) -> f64 {
    const USUAL: [f64; 2] = [30.0, 60.0];
    let written = |fps: f64| (1000.0 / fps).round() / 1000.0;
    match USUAL
        .into_iter()
        .find(|&fps| (seconds - written(fps)).abs() < 1e-9)
    {
        Some(fps) => {
            decisions.push(format!(
                "a FrameDuration of {seconds} s is {fps} frames a second, rounded"
            ));
            fps
        }
        None => 1.0 / seconds,
    }
}

/// Checks that frames are poses and their speeds, not the observations that a discriminator is shown:
/// those have as many numbers (joints, their speeds, twelve of hands and feet), but no root.
fn whole_poses(
    file: &File<'_>,
    frames: &Array,
    count: usize,
    seconds: f64,
    decisions: &mut Vec<String>,
) -> Result<(), MotionError> {
    let poses = speeds_fit(frames, ROOT, 2 * ROOT + count, count, seconds);
    let shown = speeds_fit(frames, 0, count, count, seconds);
    let stands = (0..frames.frames()).all(|i| {
        let frame = frames.frame(i);
        (0.3..2.0).contains(&frame[2]) && frame[3].abs() < 1.0 && frame[4].abs() < 1.0
    });
    if poses < SAME && poses < shown || poses.max(shown) < SAME && stands {
        decisions.push(format!(
            "frames of the root, {count} joints and their speeds"
        ));
        return Ok(());
    }
    let (problem, remedy) = if shown < SAME {
        (
            "holds what a discriminator is shown (joints, speeds, hands and feet), without the root",
            "give the motion for display, in TienKung-Lab's motion_visualization",
        )
    } else {
        (
            "has frames whose second half is not the speed of the first",
            "expected root place, three angles, joints, then the speeds of all, and their FrameDuration",
        )
    };
    Err(file.unusable(problem, remedy))
}

/// By which share the numbers from `speed` on are not the speeds of those from `value` on: the median over
/// frames of the error, by that of the speeds. Speeds may be to the frame before or to the one after.
fn speeds_fit(frames: &Array, value: usize, speed: usize, count: usize, seconds: f64) -> f64 {
    if frames.frames() < 2 {
        return 0.0;
    }
    let norm = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(|x| x * x).sum::<f64>().sqrt();
    let (mut before, mut after, mut size) = (Vec::new(), Vec::new(), Vec::new());
    for i in 1..frames.frames() {
        let (a, b) = (frames.frame(i - 1), frames.frame(i));
        let moved = |k: usize| (b[value + k] - a[value + k]) / seconds;
        before.push(norm(&mut (0..count).map(|k| b[speed + k] - moved(k))));
        after.push(norm(&mut (0..count).map(|k| a[speed + k] - moved(k))));
        size.push(
            norm(&mut (0..count).map(moved)).max(norm(&mut (0..count).map(|k| a[speed + k]))),
        );
    }
    const STILL: f64 = 1e-3;
    let error = median(&mut before).min(median(&mut after));
    error / median(&mut size).max(STILL)
}

/// The frames of a file, all as long, and the seconds between them.
fn parse(file: &File<'_>) -> Result<(Array, Option<f64>), MotionError> {
    let text = file.text();
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let clip: Clip = serde_json::from_str(text).map_err(|error| {
        file.line(
            error.line(),
            format!("no clip: {error}"),
            "expected JSON with Frames, a list of lists of numbers; it may be cut off",
        )
    })?;
    let width = clip.frames.first().map_or(0, Vec::len);
    if let Some(frame) = clip.frames.iter().position(|frame| frame.len() != width) {
        let problem = format!(
            "{} numbers where the first has {width}",
            clip.frames[frame].len()
        );
        return Err(file.frame(frame, "Frames", problem, "give every frame as many numbers"));
    }
    let shape = vec![clip.frames.len(), width];
    let array = Array::of(shape, clip.frames.concat(), false);
    Ok((array.expect("every frame is as long"), clip.duration))
}

#[cfg(test)]
#[path = "frames_tests.rs"]
pub(super) mod tests;
