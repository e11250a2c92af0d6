//! Teleports and accelerations.

use super::*;

#[test]
fn a_teleport_is_named_with_its_frame() {
    let mut clip = walk(1.0, 2.0);
    for frame in &mut clip.frames[30..] {
        frame.position.x -= 5.0;
    }
    let defect = found(&clip, Kind::Teleport);
    assert_eq!(defect.severity, Severity::Unfit);
    // Frame 31 of those counted from 1: 5 m, less the 2 cm of a walk.
    assert_eq!((defect.frames.worst, defect.frames.count), (31, 1));
    assert!((defect.value - 4.98).abs() < 0.01 && defect.unit == "m");
    assert!(defect.says.contains("frame 31 (0.60 s)"), "{}", defect.says);
    assert!(!kinds(&clip).contains(&Kind::Backward)); // no travel
    // In the first step, and a tenth of a metre, and up.
    for (at, by) in [(1, Vector3::x()), (60, Vector3::z() * 0.1)] {
        let mut clip = walk(1.0, 2.0);
        for frame in &mut clip.frames[at..] {
            frame.position += by;
        }
        assert_eq!(found(&clip, Kind::Teleport).frames.worst, at + 1);
    }
    // Half a turn between frames 50 and 51.
    let about = UnitQuaternion::from_euler_angles(0.0, 0.0, std::f32::consts::PI);
    let turned = standing(100, |i, frame| {
        if i >= 50 {
            frame.orientation = about * frame.orientation;
        }
    });
    let defect = found(&turned, Kind::Teleport);
    assert_eq!((defect.frames.worst, defect.unit), (51, "°"));
    assert!((defect.value - 180.0).abs() < 1e-3);
    // Two places are one defect.
    let twice = standing(100, |i, frame| {
        frame.position.x += [0.0, 1.0, 3.0][(i / 25).min(2)];
    });
    let defect = found(&twice, Kind::Teleport);
    assert_eq!((defect.frames.first, defect.frames.worst), (26, 51));
    assert!((defect.value - 2.0).abs() < 1e-6);
    // 2 m within two frames, as a file of 25 frames a second has them, and turned by 90°: one place.
    let spread = standing(100, |i, frame| {
        frame.position.x += (i as f32 - 49.0).clamp(0.0, 2.0);
        if i >= 50 {
            frame.orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, 1.57);
        }
    });
    let defect = found(&spread, Kind::Teleport);
    assert_eq!(defect.frames.count, 1);
    assert!((defect.value - 2.0).abs() < 1e-5, "{defect:?}");
    assert!(
        defect.says.contains("moves 2.00 m within 2 frames"),
        "{}",
        defect.says
    );
    // 20 m/s, smoothly: nobody runs so.
    let fast = standing(100, |i, frame| frame.position.x += 0.004 * (i * i) as f32);
    assert!(kinds(&fast).contains(&Kind::Teleport));
}

#[test]
fn a_pelvis_that_is_elsewhere_for_a_frame_was_as_far_away_as_it_was() {
    // There in frame 101 (and in 103), and back: 5 m, not the 4 cm between the frames around it.
    for frames in [1, 3] {
        let mut clip = walk(1.0, 4.0);
        for frame in &mut clip.frames[100..100 + frames] {
            frame.position.y += 5.0;
        }
        let defect = found(&clip, Kind::Teleport);
        assert_eq!((defect.frames.worst, defect.frames.count), (101, 1));
        assert!((defect.value - 5.0).abs() < 0.05, "{defect:?}");
        assert!(defect.says.contains("m in one frame"), "{}", defect.says);
    }
}

#[test]
fn a_larger_jump_of_a_joint_is_never_milder() {
    // In one of 500 frames; 0.2 rad are 500 rad/s² to and fro, 0.3 rad 750, 0.38 rad 950, 0.5 rad 1250.
    let knee = index_of("left_knee_joint").unwrap();
    let severity = |by: f32| {
        let clip = standing(500, |i, frame| {
            if i >= 250 {
                frame.joint_positions[knee] += by;
            }
        });
        found(&clip, Kind::Acceleration).severity
    };
    assert_eq!(severity(0.2), Severity::Odd);
    assert_eq!([0.3, 0.38, 0.5, 1.4].map(severity), [Severity::Unfit; 4]);
}

#[test]
fn limbs_that_nothing_alive_moves_are_named() {
    // A snap there and back: 0.6 rad in a frame are 1500 rad/s² at its ends, −3000 between.
    let hip = index_of("left_hip_pitch_joint").unwrap();
    let snap = standing(50, |i, frame| {
        if i == 20 {
            frame.joint_positions[hip] += 0.6;
        }
    });
    let defect = found(&snap, Kind::Acceleration);
    assert_eq!(defect.joints, ["left_hip_pitch_joint"]);
    assert_eq!(defect.severity, Severity::Unfit);
    assert!((defect.value - 3000.0).abs() < 0.1, "{}", defect.value);
    assert_eq!(
        (defect.frames.first, defect.frames.worst, defect.frames.last),
        (20, 21, 22)
    );
    // An arm that shakes by 0.1 rad every frame: 4·0.05/0.0004 = 500 rad/s² to and fro.
    let elbow = index_of("right_elbow_joint").unwrap();
    let shake = standing(50, |i, frame| {
        frame.joint_positions[elbow] += if i % 2 == 0 { 0.05 } else { -0.05 };
    });
    let defect = found(&shake, Kind::Acceleration);
    assert_eq!((defect.joints.len(), defect.frames.count), (1, 48));
    assert!((defect.value - 500.0).abs() < 0.1, "{}", defect.value);
    assert_eq!(defect.severity, Severity::Unfit);
    // 0.2 rad in a frame, once: 500 and −500 rad/s² in two of 250 frames are a glitch, in two of 100 more than that.
    let glitch = |frames| {
        standing(frames, |i, frame| {
            if i >= 25 {
                frame.joint_positions[elbow] += 0.2;
            }
        })
    };
    let severity = |frames| found(&glitch(frames), Kind::Acceleration).severity;
    assert_eq!(
        [severity(250), severity(100)],
        [Severity::Odd, Severity::Unfit]
    );
    // By 0.03 rad it is 150 rad/s², noise of markers.
    let noise = standing(50, |i, frame| {
        frame.joint_positions[elbow] += if i % 2 == 0 { 0.015 } else { -0.015 };
    });
    assert_eq!(of(&noise), []);
}

#[test]
fn all_joints_at_once_are_one_defect() {
    let snap = standing(50, |i, frame| {
        if i == 20 {
            frame.joint_positions = frame.joint_positions.map(|q| q + 0.2);
        }
    });
    let all = of(&snap);
    let accelerating = all.iter().filter(|d| d.kind == Kind::Acceleration);
    assert_eq!(accelerating.count(), 1);
    assert_eq!(found(&snap, Kind::Acceleration).joints.len(), 23);
    assert!(
        all.len() < 4 && all.iter().all(|d| d.says.len() < 250),
        "{all:?}"
    );
}
