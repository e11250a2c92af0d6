//! The measures of a clip.

use super::*;
use crate::gait;

#[test]
fn the_built_in_walk_is_good() {
    let walk = gait::walk(1.0).unwrap();
    let quality = Quality::of(&walk);
    assert!((quality.speed - 1.0).abs() < 1e-5);
    assert!(quality.slip < 0.05 && quality.penetration < 0.002);
    assert!(quality.duty[0] > 0.55 && quality.flight == 0.0);
    let run = Quality::of(&gait::run(2.2).unwrap());
    // Both soles are more than 5 mm up: the middle of each flight.
    assert!(run.flight > 0.05, "{}", run.flight);
}

#[test]
fn a_lying_velocity_is_found() {
    let mut clip = gait::walk(1.0).unwrap();
    clip.frames[9].joint_velocities[2] += 0.5;
    assert!(Quality::of(&clip).velocity_error > 0.4);
}
