//! Parts of the robot within each other.

use super::*;

/// Both hips rolled inward by an angle in frames 10 to 19.
fn crossed(angle: f32) -> Clip {
    standing(50, |i, frame| {
        if (9..19).contains(&i) {
            frame.joint_positions[LEFT_LEG + 1] = -angle;
            frame.joint_positions[index_of("right_hip_roll_joint").unwrap()] = angle;
        }
    })
}

#[test]
fn legs_within_each_other_are_named_with_frames_and_depth() {
    let clip = crossed(0.3);
    let defect = found(&clip, Kind::Touch);
    assert_eq!(defect.severity, Severity::Unfit);
    assert_eq!((defect.frames.first, defect.frames.last), (10, 19));
    assert_eq!(defect.frames.count, 10);
    let (pair, distance) = g1::collision::nearest(&clip.frames[9]);
    assert_eq!(defect.value, -f64::from(distance));
    assert_eq!(defect.joints[..2], g1::collision::names(pair));
    assert!(defect.says.contains("within each other"));
    assert!(defect.remedy.contains("cut"));
}

#[test]
fn legs_that_pass_closely_are_no_defect_and_a_brush_is_odd() {
    // Hips are 0.233 m apart and feet 0.06 m wide: straight legs 0.7 m long meet from about 0.12 rad on.
    assert!(!kinds(&crossed(0.08)).contains(&Kind::Touch));
    let brush = (0..100)
        .map(|i| 0.08 + 0.001 * i as f32)
        .map(crossed)
        .find(|clip| kinds(clip).contains(&Kind::Touch))
        .unwrap();
    let defect = found(&brush, Kind::Touch);
    assert_eq!(defect.severity, Severity::Odd);
    assert!((0.0..0.005).contains(&defect.value), "{} m", defect.value);
}

#[test]
fn an_arm_against_the_trunk_is_odd_however_deep() {
    let clip = standing(50, |_, frame| {
        frame.joint_positions[index_of("left_shoulder_roll_joint").unwrap()] = -0.3;
        frame.joint_positions[index_of("left_shoulder_yaw_joint").unwrap()] = -1.0;
    });
    let defect = found(&clip, Kind::Touch);
    assert_eq!(defect.severity, Severity::Odd);
    assert!(defect.value > 0.02, "{} m", defect.value);
    assert_eq!(defect.joints[..2], ["left forearm", "trunk"]);
}
