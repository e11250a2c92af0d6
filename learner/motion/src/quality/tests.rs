//! A clip without defects, and each defect alone.

use super::*;
use crate::gait;

#[test]
fn the_built_in_walk_has_no_defects() {
    let walk = gait::walk(1.0).unwrap();
    let quality = Quality::of(&walk);
    assert_eq!(quality.defects(), Vec::<String>::new());
    assert!((quality.speed - 1.0).abs() < 1e-5);
    assert!(quality.slip < 0.05 && quality.penetration < 0.002);
    assert!(quality.duty[0] > 0.55 && quality.flight == 0.0);
    let run = Quality::of(&gait::run(2.2).unwrap());
    // Both soles are more than 5 mm up: the middle of each flight.
    assert!(run.flight > 0.05, "{}", run.flight);
}

#[test]
fn every_defect_is_named() {
    let mut clip = gait::walk(1.0).unwrap();
    for (i, frame) in clip.frames.iter_mut().enumerate() {
        frame.position.z -= 0.02;
        frame.position.y += 0.01 * i as f32; // 0.5 m/s sideways
    }
    clip.frames[5].joint_positions[3] = -0.2;
    let defects = Quality::of(&clip).defects().join("; ");
    for part in ["slip", "below the ground", "left_knee_joint", "motor"] {
        assert!(defects.contains(part), "{part} is not in {defects}");
    }
    for frame in &mut clip.frames {
        frame.position.z += 0.3;
    }
    let defects = Quality::of(&clip).defects().join("; ");
    assert!(defects.contains("floats"), "{defects}");
    clip.frames.truncate(10);
    assert!(Quality::of(&clip).defects().join(" ").contains("lasts"));
}

#[test]
fn a_lying_velocity_is_found() {
    let mut clip = gait::walk(1.0).unwrap();
    clip.frames[9].joint_velocities[2] += 0.5;
    assert!(Quality::of(&clip).velocity_error > 0.4);
}
