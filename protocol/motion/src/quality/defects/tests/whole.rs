//! The robot as a whole: where it faces, how it is.

use super::*;

#[test]
fn a_robot_that_faces_away_from_its_way_is_named() {
    let mut back = walk(-0.5, 3.0);
    back.name = "take_7".into();
    let defect = found(&back, Kind::Backward);
    assert_eq!(defect.severity, Severity::Unfit);
    assert!((defect.value - 0.5).abs() < 0.02, "{}", defect.value);
    assert_eq!(defect.frames.count, back.frames.len());
    back.name = "walk_backward".into();
    assert_eq!(found(&back, Kind::Backward).severity, Severity::Odd);
    // A walk whose pelvis is turned about while it goes the same way.
    let about = UnitQuaternion::from_euler_angles(0.0, 0.0, std::f32::consts::PI);
    let mut turned = walk(1.0, 3.0);
    for frame in &mut turned.frames {
        frame.orientation = about * frame.orientation;
    }
    assert_eq!(found(&turned, Kind::Backward).severity, Severity::Unfit);
    // And its planted feet go twice as fast.
    let slip = found(&turned, Kind::Slip);
    assert!(
        slip.severity == Severity::Unfit && slip.value > 1.0,
        "{slip:?}"
    );
    // One step back in a walk ahead is nothing.
    let mut mixed = walk(1.0, 6.0);
    let end = mixed.frames[mixed.frames.len() - 1].position.x;
    let mut back = walk(-0.5, 1.0).frames;
    for frame in &mut back {
        frame.position.x += end;
    }
    mixed.frames.extend(back);
    assert!(!kinds(&mixed).contains(&Kind::Backward));
}

#[test]
fn a_lying_robot_is_named() {
    let on_back = UnitQuaternion::from_euler_angles(0.0, -std::f32::consts::FRAC_PI_2, 0.0);
    let fallen = standing(100, |i, frame| {
        if i >= 60 {
            frame.orientation = on_back;
            frame.position.z = 0.1;
        }
    });
    let defect = found(&fallen, Kind::Lying);
    assert_eq!((defect.frames.first, defect.frames.last), (61, 100));
    assert!(
        defect.says.contains("tilted by up to 90°"),
        "{}",
        defect.says
    );
    assert_eq!(defect.severity, Severity::Unfit);
    // Its soles are not spoken of.
    for kind in [Kind::Flight, Kind::Drift, Kind::Penetration, Kind::Float] {
        assert!(!kinds(&fallen).contains(&kind), "{kind:?}");
    }
    let sitting = standing(50, |_, frame| frame.position.z = 0.15);
    let defect = found(&sitting, Kind::Lying);
    assert_eq!(defect.severity, Severity::Unfit);
    assert!(defect.says.contains("sits"), "{}", defect.says);
}

#[test]
fn the_deepest_squat_is_odd_and_no_lying() {
    // Knees folded to their end, soles level, the trunk upright.
    let squat = standing(50, |_, frame| {
        for leg in [0, 6] {
            frame.joint_positions[leg] = -2.0;
            frame.joint_positions[leg + 3] = 2.87;
            frame.joint_positions[leg + 4] = -0.87;
        }
        let bodies = g1::kinematics::forward_state(frame);
        frame.position.z -= g1::kinematics::lowest_foot_point(&bodies);
    });
    let height = squat.frames[0].position.z;
    assert!((0.20..0.22).contains(&height), "{height}");
    assert_eq!(found(&squat, Kind::Lying).severity, Severity::Odd);
}
