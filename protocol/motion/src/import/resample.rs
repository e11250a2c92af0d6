//! Brings a robot's rows of any rate to 50 Hz, makes them this robot's, and differentiates.
//!
//! Separate from reading because it is geometry: whatever the format, motion passes here.

use super::file::File;
use super::joints::DROPPED;
use super::{Row, Source, bounds, calibration, ground, lean};
use crate::clip::{Clip, FRAME_SECONDS};
use crate::error::MotionError;
use g1::{JOINTS, RobotState};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use retarget::signal;
use std::path::Path;

/// The clip of a robot's rows at some rate, named after the file, and what was wrong with them; adds what was done to
/// `decisions`.
pub(super) fn clip(
    file: &File<'_>,
    rows: &[Row],
    fps: f64,
    on_ground: bool,
    decisions: &mut Vec<String>,
) -> Result<(Clip, Source), MotionError> {
    check_duration(file, rows.len(), fps)?;
    let rows = &rows[calibration::of_robot(rows, fps, decisions)..];
    check_duration(file, rows.len(), fps)?;
    let mut frames = resampled(rows, fps);
    lean::into_pelvis(&mut frames, decisions);
    let jumps = bounds::hold(&mut frames, decisions);
    // Without grounding nothing hides the ground: the clip itself shows it.
    let floor = if on_ground {
        ground::put(&mut frames, decisions)
    } else {
        None
    };
    Ok((finished(file.path, &frames), Source { jumps, floor }))
}

/// Refuses what is too short to have velocities.
pub(super) fn check_duration(file: &File<'_>, frames: usize, fps: f64) -> Result<(), MotionError> {
    if signal::resampled_length(frames, fps) >= 3 {
        return Ok(());
    }
    let seconds = frames.saturating_sub(1) as f64 / fps;
    Err(file.unusable(
        &format!("lasts {seconds:.3} s ({frames} rows)"),
        "a clip needs at least 0.04 s; check fps or give a longer file",
    ))
}

/// The clip of rows at 50 Hz that need nothing done.
pub(super) fn finished(path: &Path, rows: &[Row]) -> Clip {
    let frames = with_velocities(rows);
    let name = path
        .file_stem()
        .map_or_else(|| "file".into(), |stem| stem.to_string_lossy());
    Clip {
        name: name.into_owned(),
        command: mean_command(&frames),
        frames,
        cyclic: false,
        weight: 1.0,
    }
}

/// Cubic splines through the rows, after a low pass of 5 ms where they are closer than that.
fn resampled(rows: &[Row], fps: f64) -> Vec<Row> {
    const SMOOTHING_SECONDS: f64 = 0.005;
    let count = signal::resampled_length(rows.len(), fps);
    let series = |get: &dyn Fn(usize) -> f64| {
        let values: Vec<f64> = (0..rows.len()).map(get).collect();
        signal::resample(
            &signal::gaussian(&values, SMOOTHING_SECONDS * fps),
            fps,
            count,
        )
    };
    let places: [Vec<f64>; 3] = std::array::from_fn(|axis| series(&|i| rows[i].position[axis]));
    let turns = same_sign(rows);
    let turns: [Vec<f64>; 4] = std::array::from_fn(|part| series(&|i| turns[i].coords[part]));
    let joints: [Vec<f64>; JOINTS] = std::array::from_fn(|j| series(&|i| rows[i].joints[j]));
    let dropped: [Vec<f64>; DROPPED.len()] =
        std::array::from_fn(|j| series(&|i| rows[i].dropped[j]));
    (0..count)
        .map(|k| {
            let turn =
                Quaternion::from_vector(std::array::from_fn::<f64, 4, _>(|p| turns[p][k]).into());
            let nearest = ((k as f64 * FRAME_SECONDS * fps).round() as usize).min(rows.len() - 1);
            Row {
                position: Vector3::from_fn(|axis, _| places[axis][k]),
                // Half a turn between rows has no way between.
                orientation: UnitQuaternion::try_new(turn, 0.5)
                    .unwrap_or(rows[nearest].orientation),
                joints: std::array::from_fn(|j| joints[j][k]),
                dropped: std::array::from_fn(|j| dropped[j][k]),
            }
        })
        .collect()
}

/// The rows' quaternions, each on the side of the one before: q and −q are the same turn.
fn same_sign(rows: &[Row]) -> Vec<Quaternion<f64>> {
    let mut turns: Vec<Quaternion<f64>> = rows
        .iter()
        .map(|row| *row.orientation.quaternion())
        .collect();
    for i in 1..turns.len() {
        if turns[i].dot(&turns[i - 1]) < 0.0 {
            turns[i] = -turns[i];
        }
    }
    turns
}

/// Central differences; one-sided at the ends.
fn with_velocities(rows: &[Row]) -> Vec<RobotState> {
    (0..rows.len())
        .map(|i| {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(rows.len() - 1));
            let (a, now, b) = (&rows[before], &rows[i], &rows[after]);
            let span = (after - before) as f64 * FRAME_SECONDS;
            let turn = (b.orientation * a.orientation.inverse()).scaled_axis();
            RobotState {
                position: now.position.cast(),
                orientation: now.orientation.cast(),
                linear_velocity: ((b.position - a.position) / span).cast(),
                angular_velocity: (turn / span).cast(),
                joint_positions: now.joints.map(|q| q as f32),
                joint_velocities: std::array::from_fn::<_, JOINTS, _>(|j| {
                    ((b.joints[j] - a.joints[j]) / span) as f32
                }),
            }
        })
        .collect()
}

/// Mean velocity in the heading frame and mean yaw rate.
fn mean_command(frames: &[RobotState]) -> [f32; 3] {
    let mut sum = [0.0; 3];
    for frame in frames {
        let v = frame.velocity_in_heading();
        sum[0] += v.x;
        sum[1] += v.y;
        sum[2] += frame.angular_velocity.z;
    }
    sum.map(|s| s / frames.len() as f32)
}

#[cfg(test)]
#[path = "resample_tests.rs"]
mod tests;
