//! Joints against their ranges and motors; bones.

use super::*;

#[test]
fn a_motor_that_is_outrun_is_named() {
    // 1 rad in a frame is 50 rad/s, of 20 for a knee.
    let knee = standing(50, |i, frame| {
        if i >= 25 {
            frame.joint_positions[3] += 1.0;
        }
    });
    let defect = found(&knee, Kind::Motor);
    assert_eq!(defect.joints, ["left_knee_joint"]);
    assert!((defect.value - 2.5).abs() < 1e-5);
    assert_eq!((defect.frames.worst, defect.frames.count), (26, 1));
}

#[test]
fn joints_beyond_a_limit_or_against_a_stop_are_named() {
    let roll = LEFT_LEG + 5;
    let limit = JOINT_TABLE[roll].upper as f32;
    let beyond = |by: f32| {
        standing(100, |i, frame| {
            if i >= 90 {
                frame.joint_positions[roll] = limit + by;
            }
        })
    };
    let defect = found(&beyond(0.1), Kind::Limits);
    assert_eq!(defect.severity, Severity::Unfit);
    assert_eq!((defect.frames.first, defect.frames.count), (91, 10));
    assert!((defect.value - 0.1).abs() < 1e-6);
    assert_eq!(found(&beyond(0.004), Kind::Limits).severity, Severity::Odd);
    let held = |from: usize| {
        standing(100, |i, frame| {
            if i >= from {
                frame.joint_positions[roll] = limit - 0.001;
            }
        })
    };
    let defect = found(&held(40), Kind::Stops);
    assert_eq!(defect.joints, ["left_ankle_roll_joint"]);
    assert_eq!((defect.severity, defect.value), (Severity::Unfit, 0.6));
    assert_eq!((defect.frames.first, defect.frames.last), (41, 100));
    assert!(!kinds(&held(60)).contains(&Kind::Stops)); // 40 % is not most
}

#[test]
fn bones_far_off_are_named_by_the_account() {
    let clip = walk(1.0, 2.0);
    let with = |frames: usize, error_95: f64, named: bool| {
        let bones_off = BoneOff {
            bone: "left shin".into(),
            frames,
            first: 5,
            last: 90,
            worst: 40,
            by: 108.0,
        };
        let report = retarget::Report {
            frames: 100,
            human_leg: 0.84,
            scale: 0.75,
            scaled_speed: 1.0,
            speed: 1.0,
            direction_error: 6.0,
            direction_error_95: error_95,
            bones_off: if named { vec![bones_off] } else { Vec::new() },
            off_target: 0.0,
            knee_error: 0.0,
            sharpest: Vec::new(),
            stances: 4,
            feet_moved: 0.0,
            lowered: 0.0,
            unreached: 0.0,
            carried: 0.0,
            lifted: 0.0,
            floor: None,
            at_limit: Vec::new(),
            at_speed: Vec::new(),
        };
        defects(&clip, &Quality::of(&clip), &Account::Of(Box::new(report)))
    };
    let all = with(30, 25.0, true);
    let [defect] = all.as_slice() else {
        panic!("{all:?}");
    };
    assert_eq!(
        (defect.kind, defect.severity),
        (Kind::Bones, Severity::Unfit)
    );
    assert_eq!(defect.joints, ["left shin"]);
    assert_eq!((defect.value, defect.frames.worst), (108.0, 40));
    assert_eq!(with(20, 25.0, true), []); // a fifth of the clip is not much of it
    assert_eq!(severity(&with(0, 31.0, false)), Some(Severity::Unfit));
    let misfit = Account::Misfit("a.json is of 30 frames, the table has 50".into());
    let all = defects(&clip, &Quality::of(&clip), &misfit);
    assert_eq!(all[0].kind, Kind::Account);
    assert_eq!(severity(&all), Some(Severity::Odd));
}
