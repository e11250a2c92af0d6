//! Brings rows of any rate to 50 Hz, puts the feet on the ground and differentiates.
//!
//! Separate from reading because it is geometry: whatever the format, motion passes here.

use super::{Options, Row};
use crate::clip::{Clip, FRAME_SECONDS};
use crate::error::MotionError;
use g1::kinematics::{forward, lowest_foot_point};
use g1::{JOINTS, RobotState};
use nalgebra::Isometry3;
use std::path::Path;

/// The clip of some rows, named after the file.
pub(super) fn clip(rows: &[Row], path: &Path, options: &Options) -> Result<Clip, MotionError> {
    let mut frames = resampled(rows, options.fps);
    if frames.len() < 3 {
        let seconds = rows.len().saturating_sub(1) as f64 / options.fps;
        return Err(MotionError::File {
            path: path.into(),
            problem: format!("lasts {seconds:.3} s ({} rows)", rows.len()),
            remedy: "a clip needs at least 0.04 s; check fps or give a longer file".into(),
        });
    }
    if options.ground {
        put_on_ground(&mut frames);
    }
    let frames = with_velocities(&frames);
    let name = path
        .file_stem()
        .map_or_else(|| "file".into(), |stem| stem.to_string_lossy());
    Ok(Clip {
        name: name.into_owned(),
        command: mean_command(&frames),
        frames,
        cyclic: false,
        weight: 1.0,
    })
}

/// Linear between rows, spherical for the orientation.
fn resampled(rows: &[Row], fps: f64) -> Vec<Row> {
    let Some(last) = rows.len().checked_sub(1) else {
        return Vec::new();
    };
    // A hair of tolerance: 3 rows at 50 fps last 0.04 s, which must give 3 frames.
    let count = (last as f64 / fps / FRAME_SECONDS + 1e-6).floor() as usize + 1;
    (0..count)
        .map(|k| {
            let at = k as f64 * FRAME_SECONDS * fps;
            let i = (at.floor() as usize).min(last);
            let (a, b) = (&rows[i], &rows[(i + 1).min(last)]);
            let u = (at - i as f64).clamp(0.0, 1.0);
            Row {
                position: a.position.lerp(&b.position, u),
                orientation: a
                    .orientation
                    .try_slerp(&b.orientation, u, 1e-9)
                    .unwrap_or(a.orientation), // half a turn between rows has no way between
                joints: std::array::from_fn(|j| a.joints[j] + u * (b.joints[j] - a.joints[j])),
            }
        })
        .collect()
}

/// Moves the whole motion so that the lowest tenth of its frames touches the ground, then lifts
/// what still sinks, smoothly. One shift for all keeps the flight of a run.
fn put_on_ground(rows: &mut [Row]) {
    let lowest = |row: &Row| {
        let base = Isometry3::from_parts(row.position.into(), row.orientation);
        lowest_foot_point(&forward(&base, &row.joints))
    };
    let mut heights: Vec<f64> = rows.iter().map(lowest).collect();
    let mut sorted = heights.clone();
    sorted.sort_by(f64::total_cmp);
    let shift = sorted[sorted.len() / 10];
    for (row, height) in rows.iter_mut().zip(&mut heights) {
        row.position.z -= shift;
        *height -= shift;
    }
    // The greatest sinking within two frames, averaged over two frames: never less than a frame's
    // own, since each of the averaged maxima sees it.
    let window = |i: usize| i.saturating_sub(2)..(i + 3).min(heights.len());
    let sinking = |i: usize| window(i).map(|j| -heights[j]).fold(0.0, f64::max);
    for (i, row) in rows.iter_mut().enumerate() {
        let around = window(i);
        let count = around.len() as f64;
        row.position.z += around.map(sinking).sum::<f64>() / count;
    }
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
