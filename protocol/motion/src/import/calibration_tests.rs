//! Poses before a motion, and motions that begin fast.

use super::*;
use crate::import::human::tests::STANDING;
use nalgebra::{Point3, UnitQuaternion};

/// A human that slides ahead by 1 cm a frame, arms down.
fn sliding(frames: usize, fps: f64) -> Capture {
    let frame = |i: usize| {
        let ahead = Vector3::new(0.01 * i as f64, 0.0, 0.0);
        Landmarks(STANDING.map(|(_, p)| Point3::from(p) + ahead))
    };
    Capture {
        fps,
        frames: (0..frames).map(frame).collect(),
    }
}

/// The same frame with the arms raised sideways by an angle: 0 is down, π/2 a T.
fn raised(frame: &Landmarks, angle: f64) -> Landmarks {
    let mut frame = *frame;
    for (side, sign) in [(Side::Left, 1.0), (Side::Right, -1.0)] {
        let arm = Vector3::new(0.0, sign * angle.sin(), -angle.cos());
        let shoulder = frame.of(side, Landmark::Shoulder);
        frame.0[Landmarks::index(side, Landmark::Elbow)] = shoulder + 0.28 * arm;
        frame.0[Landmarks::index(side, Landmark::Wrist)] = shoulder + 0.52 * arm;
    }
    frame
}

fn dropped(capture: &Capture) -> (usize, Vec<String>) {
    let mut decisions = Vec::new();
    let count = of_human(capture, &mut decisions);
    assert_eq!(count == 0, decisions.is_empty(), "{decisions:?}");
    (count, decisions)
}

#[test]
fn a_t_pose_before_the_motion_is_dropped_and_said() {
    for fps in [120.0, 60.0, 30.0, 10.0] {
        for held in [1, 2, 8] {
            let mut capture = sliding(40, fps);
            let pose = raised(&capture.frames[0], PI / 2.0);
            capture.frames[..held].fill(pose);
            let (count, said) = dropped(&capture);
            assert_eq!(count, held, "{fps} fps");
            // The forearm of STANDING points ahead a little: (0.05, 0, −0.24) is 90° from sideways.
            assert!(said[0].contains("the next frame is 90°"), "{said:?}");
            assert!(said[1].contains("T-pose"), "{said:?}");
        }
    }
}

#[test]
fn other_poses_and_places_are_dropped_if_nobody_gets_from_there() {
    // All arms 20° off at 120 frames a second: 2400°/s for one frame.
    let mut capture = sliding(40, 120.0);
    for frame in &mut capture.frames {
        *frame = raised(frame, 0.0);
    }
    capture.frames[0] = raised(&capture.frames[0], 20f64.to_radians());
    let (count, said) = dropped(&capture);
    assert_eq!(count, 1);
    assert!(said[0].contains("20°") && said.len() == 1, "{said:?}");
    // 3 m away, then 1 cm a frame.
    let mut capture = sliding(40, 120.0);
    for point in &mut capture.frames[0].0 {
        point.x -= 3.0;
    }
    let (count, said) = dropped(&capture);
    assert!(count == 1 && said[0].contains("3.01 m"), "{said:?}");
}

#[test]
fn motion_is_kept_however_it_begins() {
    let of = |fps: f64, angle: &dyn Fn(usize) -> f64| {
        let mut capture = sliding(60, fps);
        for (i, frame) in capture.frames.iter_mut().enumerate() {
            *frame = raised(frame, angle(i));
        }
        dropped(&capture).0
    };
    // Out of a T-pose by 3° a frame; in it all the time; 40 rad/s (19° a frame) from the first frame on.
    assert_eq!(of(30.0, &|i| PI / 2.0 - 0.05 * i as f64), 0);
    assert_eq!(of(120.0, &|_| PI / 2.0), 0);
    assert_eq!(of(120.0, &|i| i as f64 * 40.0 / 120.0), 0);
    // A cut in the middle of a motion is no calibration.
    assert_eq!(
        of(120.0, &|i| if i < 30 { 0.01 * i as f64 } else { 1.5 }),
        0
    );
    assert_eq!(dropped(&sliding(2, 30.0)).0, 0);
}

#[test]
fn a_robots_zero_pose_is_dropped() {
    let pose = |joints: [f64; JOINTS], x: f64| Row {
        position: Vector3::new(x, 0.0, 0.75),
        orientation: UnitQuaternion::identity(),
        joints,
        dropped: [0.0; 6],
    };
    let stands = DEFAULT_POSE.map(f64::from);
    // Zero pose, then standing: the elbows turn by 0.97 rad (56°).
    let mut rows: Vec<Row> = (0..30).map(|i| pose(stands, 0.01 * f64::from(i))).collect();
    rows[0] = pose([0.0; JOINTS], 0.0);
    for fps in [30.0, 500.0] {
        let mut said = Vec::new();
        assert_eq!(of_robot(&rows, fps, &mut said), 1);
        assert!(said[0].contains("56°"), "{said:?}");
    }
    // A T: shoulders rolled out by 1.2 rad (69°), which their motors do at 30 frames a second.
    rows[0] = pose(stands, 0.0);
    (rows[0].joints[14], rows[0].joints[19]) = (0.25 + 1.2, -0.25 - 1.2);
    let mut said = Vec::new();
    assert_eq!(of_robot(&rows, 30.0, &mut said), 1);
    assert!(said[0].contains("69°"), "{said:?}");
    // Standing in the default pose, then walking off, is a motion.
    let mut rows = vec![pose(stands, 0.0); 30];
    for (i, row) in rows.iter_mut().enumerate().skip(10) {
        row.joints[0] += 0.05 * (i - 9) as f64;
    }
    assert_eq!(of_robot(&rows, 30.0, &mut Vec::new()), 0);
}
