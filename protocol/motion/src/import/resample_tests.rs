//! Imported motion whose truth is known.

use super::*;
use crate::gait;
use crate::import::{Options, load};
use g1::kinematics::{forward_state, lowest_foot_point};
use g1::state::STANDING_HEIGHT;
use g1::{DEFAULT_POSE, JOINT_TABLE};
use nalgebra::{UnitQuaternion, Vector3};
use std::fmt::Write as _;

fn options(fps: f64) -> Options {
    Options {
        fps: Some(fps),
        ..Options::default()
    }
}

fn clip_of(rows: &[Row], name: &str, fps: f64, ground: bool) -> Result<Clip, MotionError> {
    let file = File {
        path: Path::new(name),
        bytes: b"",
    };
    clip(&file, rows, fps, ground, &mut Vec::new()).map(|(clip, _)| clip)
}

/// Turning left at 0.5 rad/s on a circle at 1 m/s, left knee opening at 2 rad/s, 7 cm too low.
fn circling(fps: f64, seconds: f64) -> Vec<Row> {
    let count = (fps * seconds).round() as usize + 1;
    let row = |i: usize| {
        let time = i as f64 / fps;
        let (sin, cos) = (0.5 * time).sin_cos();
        let mut joints = DEFAULT_POSE.map(f64::from);
        joints[13] = 2.0 * time;
        Row {
            position: Vector3::new(2.0 * sin, 2.0 - 2.0 * cos, STANDING_HEIGHT - 0.07),
            orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, 0.5 * time),
            joints,
            dropped: [0.0; 6],
        }
    };
    (0..count).map(row).collect()
}

#[test]
fn any_rate_becomes_50_hertz_on_the_ground_with_velocities() {
    for fps in [25.0, 30.0, 50.0, 120.0, 500.0] {
        let clip = clip_of(&circling(fps, 1.0), "circle.csv", fps, true).unwrap();
        assert_eq!(clip.frames.len(), 51, "{fps} fps");
        assert_eq!((clip.name.as_str(), clip.cyclic), ("circle", false));
        for frame in &clip.frames[1..50] {
            assert!((frame.position.z - STANDING_HEIGHT as f32).abs() < 1e-5);
            let v = frame.velocity_in_heading();
            assert!(
                (v.x - 1.0).abs() < 0.01 && v.y.abs() < 0.03,
                "{fps} fps: {v:?}"
            );
            assert!((frame.angular_velocity.z - 0.5).abs() < 1e-3);
            assert!((frame.joint_velocities[13] - 2.0).abs() < 1e-3);
            assert!(frame.joint_velocities[0].abs() < 1e-4);
        }
        for (mean, expected) in clip.command.iter().zip([1.0, 0.0, 0.5]) {
            assert!(
                (mean - expected).abs() < 0.01,
                "{fps} fps: {:?}",
                clip.command
            );
        }
    }
}

#[test]
fn grounding_keeps_flight_and_lifts_what_sinks() {
    let mut rows = circling(50.0, 1.0);
    for row in &mut rows[20..30] {
        row.position.z += 0.2; // a jump
    }
    rows[40].position.z -= 0.03; // a stumble into the ground
    let clip = clip_of(&rows, "jump.csv", 50.0, true).unwrap();
    let height = |i: usize| lowest_foot_point(&forward_state(&clip.frames[i]));
    assert!((height(25) - 0.2).abs() < 1e-4);
    assert!((height(10)).abs() < 1e-4);
    for i in 0..clip.frames.len() {
        // 3 mm below the ground are on it.
        assert!(height(i) > -0.003 - 1e-5, "frame {i} at {}", height(i));
    }
    let raw = clip_of(&rows, "jump.csv", 50.0, false).unwrap();
    assert!((raw.frames[0].position.z - (STANDING_HEIGHT - 0.07) as f32).abs() < 1e-6);
}

#[test]
fn a_spline_leaves_no_limit_and_no_speed_behind() {
    // An ankle at its stop for a while and then away from it: between rows at 30 Hz the spline shoots
    // over the stop. A knee from 0 to 2.8 rad between two rows: 84 rad/s of 20.
    let mut rows = circling(30.0, 1.0);
    let stop = JOINT_TABLE[5].upper;
    for (i, row) in rows.iter_mut().enumerate() {
        row.joints[5] = if (8..14).contains(&i) { stop } else { -0.1 };
        row.joints[3] = if i < 15 { 0.0 } else { 2.8 };
    }
    let raw = resampled(&rows, 30.0);
    assert!(raw.iter().any(|row| row.joints[5] > stop + 0.01));
    let clip = clip_of(&rows, "stop.csv", 30.0, true).unwrap();
    for frame in &clip.frames {
        for (j, joint) in JOINT_TABLE.iter().enumerate() {
            let q = f64::from(frame.joint_positions[j]);
            assert!((joint.lower..=joint.upper).contains(&q), "{}", joint.name);
            let speed = f64::from(frame.joint_velocities[j]).abs();
            assert!(speed <= joint.velocity_limit, "{} {speed}", joint.name);
        }
    }
    for pair in clip.frames.windows(2) {
        let step = pair[1].joint_positions[3] - pair[0].joint_positions[3];
        assert!(step.abs() <= 20.0 * 0.02, "{step}");
    }
    assert!((clip.frames[50].joint_positions[3] - 2.8).abs() < 1e-3);
}

#[test]
fn too_short_a_file_says_so() {
    for rows in [0, 1, 2] {
        let error = clip_of(&circling(50.0, 1.0)[..rows], "short.csv", 50.0, true);
        let message = error.unwrap_err().to_string();
        assert!(
            message.contains("short.csv") && message.contains("0.04 s"),
            "{message}"
        );
    }
    assert!(clip_of(&circling(50.0, 0.04), "enough.csv", 50.0, true).is_ok());
}

#[test]
fn a_written_walk_reads_back_as_it_was() {
    let walk = gait::walk(1.0).unwrap();
    let mut text = String::from("x,y,z,qw,qx,qy,qz");
    for joint in &JOINT_TABLE {
        let _ = write!(text, ",{}", joint.name);
    }
    for frame in &walk.frames {
        let q = frame.orientation;
        let p = frame.position;
        let _ = write!(
            text,
            "\n{},{},{},{},{},{},{}",
            p.x, p.y, p.z, q.w, q.i, q.j, q.k
        );
        for joint in frame.joint_positions {
            let _ = write!(text, ",{joint}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.csv");
    std::fs::write(&path, text).unwrap();
    let read = load(&path, &options(50.0)).unwrap();
    assert_eq!(read.frames.len(), walk.frames.len());
    for (a, b) in read.frames.iter().zip(&walk.frames) {
        assert!((a.position - b.position).norm() < 2e-3);
        assert!(a.orientation.angle_to(&b.orientation) < 1e-3);
        for j in 0..JOINTS {
            assert!((a.joint_positions[j] - b.joint_positions[j]).abs() < 1e-6);
        }
    }
    // The clip is not a whole number of strides once its last frame has no successor.
    assert!((read.command[0] - 1.0).abs() < 0.03, "{:?}", read.command);
}

#[test]
fn a_missing_file_is_named_with_the_remedy() {
    let error = load(Path::new("/nonexistent/run.csv"), &options(50.0)).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("/nonexistent/run.csv") && message.contains("motion.clips"),
        "{message}"
    );
    assert!(load(Path::new("/"), &options(50.0)).is_err()); // a folder is not a file
}

#[test]
fn bytes_that_are_not_text_are_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("noise.csv");
    std::fs::write(&path, [0xff, 0xfe, 0x00, 0x31, 0x2c, 0x0a]).unwrap();
    assert!(load(&path, &options(50.0)).is_err());
}

#[test]
fn velocities_of_a_slow_file_are_smooth() {
    // A knee that swings at 1.5 Hz, in a file of 30 Hz: straight lines between rows would make the
    // velocity jump by up to q̈/30 Hz = 0.6·(2π·1.5)²/30 = 1.8 rad/s between frames.
    let swing = |t: f64| 0.6 * (std::f64::consts::TAU * 1.5 * t).sin();
    let mut rows = circling(30.0, 2.0);
    for (i, row) in rows.iter_mut().enumerate() {
        row.joints[3] = 0.7 + swing(i as f64 / 30.0);
    }
    let clip = clip_of(&rows, "swing.csv", 30.0, true).unwrap();
    let rate = std::f64::consts::TAU * 1.5;
    for (k, frame) in clip
        .frames
        .iter()
        .enumerate()
        .skip(3)
        .take(clip.frames.len() - 6)
    {
        let exact = 0.6 * rate * (rate * k as f64 * FRAME_SECONDS).cos();
        // Central differences shorten the speed by (ωh)²/6 = 0.6 %.
        assert!(
            (f64::from(frame.joint_velocities[3]) - exact).abs() < 0.06,
            "frame {k}"
        );
    }
}
