//! Measures of batches of a few steps, by hand.

use super::*;
use g1::observation::{COMMAND, GRAVITY};
use g1::{FEATURES, OBSERVATION};

fn of(batch: &Batch, episode_length: Option<f64>) -> Measures {
    Measures::of(batch, episode_length, &Places::of(&Tables::default()))
}

/// Two robots of which each step's forces and hip angles are given, standing high.
fn batch(steps: &[[([f32; 2], f32); 2]]) -> Batch {
    let mut batch = Batch::new(crate::robot(&Tables::default()).widths());
    batch.resize(1, steps.len(), 2);
    for (step, robots) in steps.iter().enumerate() {
        for (robot, (forces, hip)) in robots.iter().enumerate() {
            let row = 2 * step + robot;
            batch.foot_forces[2 * row..][..2].copy_from_slice(forces);
            let features = &mut batch.next_features[row * FEATURES..][..FEATURES];
            (features[0], features[1]) = (0.79, 0.5);
            (features[7], features[13]) = (*hip, -*hip);
            let seen = &mut batch.observations[row * OBSERVATION..][..OBSERVATION];
            seen[GRAVITY].copy_from_slice(&[0.0, 0.0, -1.0]);
            seen[COMMAND.start] = 0.5;
        }
    }
    batch
}

const LEFT: [f32; 2] = [300.0, 0.0];
const RIGHT: [f32; 2] = [0.0, 300.0];

#[test]
fn robots_follow_themselves_and_not_their_neighbours() {
    let walk = batch(&[
        [(LEFT, 0.3), (RIGHT, -0.3)],
        [(RIGHT, -0.3), (LEFT, 0.3)],
        [(LEFT, 0.3), (RIGHT, -0.3)],
    ]);
    let measures = of(&walk, Some(1000.0));
    // Each robot lands once in each of steps 2 and 3: 4 landings / 2 feet / 6 rows · 50 Hz.
    assert!((measures.stride_rate().unwrap() - 50.0 / 3.0).abs() < 1e-9);
    assert_eq!(measures.conduct.gait().contact_correlation(), Some(-1.0));
    assert_eq!(measures.verdict(), Verdict::Walk);
    // Robot 0 alone, steps 1 and 2, after which the next gravity is known; one landing, on
    // sliding feet: 2 · 0.5 m/s · 20 ms.
    assert!((measures.slip_per_stride().unwrap() - 0.02).abs() < 1e-6);
}

#[test]
fn who_is_told_to_go_aside_is_not_asked_unless_all_are() {
    let mut mixed = batch(&[[(LEFT, 0.3), (LEFT, 0.3)], [(RIGHT, -0.3), (LEFT, 0.3)]]);
    for step in 0..2 {
        let other = 2 * step + 1;
        mixed.next_features[other * FEATURES + 13] = 0.3;
        mixed.observations[other * OBSERVATION + COMMAND.start] = 0.1;
    }
    // The robot that walks has its hips at ±.3 and ∓.3, the other both at .3.
    let correlation = of(&mixed, None).conduct.gait().hip_correlation();
    assert!((correlation.unwrap() + 1.0).abs() < 1e-9);
    for row in 0..4 {
        mixed.observations[row * OBSERVATION + COMMAND.start] = 0.1;
    }
    // Of both: left .3 −.3 .3 .3, right −.3 .3 .3 .3, covariance −.0225, variance .0675.
    let correlation = of(&mixed, None).conduct.gait().hip_correlation();
    assert!((correlation.unwrap() + 1.0 / 3.0).abs() < 1e-6);
}

#[test]
fn a_walk_that_does_not_turn_as_it_is_told_is_no_walk() {
    let mut walk = batch(&[[(LEFT, 0.3), (RIGHT, -0.3)], [(RIGHT, -0.3), (LEFT, 0.3)]]);
    for row in 0..4 {
        // The third number of a command, and the yaw rate among the features: robots turn as told, at 0.5 of 0.6 rad/s.
        walk.observations[row * OBSERVATION + COMMAND.start + 2] = -0.6;
        walk.next_features[row * FEATURES + 6] = -0.5;
    }
    let measures = of(&walk, Some(1000.0));
    assert_eq!(measures.verdict(), Verdict::Walk);
    let (asked, turned) = measures.conduct.pace().turns().unwrap();
    assert!((asked - 0.6).abs() < 1e-6 && (turned - 0.5).abs() < 1e-6);
    for row in 0..4 {
        walk.next_features[row * FEATURES + 6] = 0.0;
    }
    let verdict = of(&walk, Some(1000.0)).verdict();
    assert_eq!(verdict.to_string(), "veer: 0.00 of 0.60 rad/s");
}

#[test]
fn a_new_episode_does_not_land() {
    let mut walk = batch(&[[(LEFT, 0.3), (LEFT, 0.3)], [(RIGHT, -0.3), (RIGHT, -0.3)]]);
    assert!(of(&walk, None).stride_rate() > Some(0.0));
    walk.ends[0] = 1.0;
    walk.ends[1] = 1.0;
    assert_eq!(of(&walk, None).stride_rate(), Some(0.0));
}

#[test]
fn ten_iterations_are_judged_together() {
    let walk = of(&batch(&[[(LEFT, 0.3), (RIGHT, -0.3)]; 2]), Some(1000.0));
    let fall = of(&batch(&[[(LEFT, 0.3), (RIGHT, -0.3)]; 2]), Some(30.0));
    let mut watch = Watch::default();
    for iteration in 1..=9 {
        watch.take(iteration, &fall);
    }
    assert_eq!(watch.said, None);
    watch.take(10, &fall);
    assert_eq!(watch.said, Some("fall"));
    // One long life among nine short ones: (9·0.6 s + 20 s) / 10 = 2.54 s is long enough.
    watch.take(11, &walk);
    for iteration in 12..=20 {
        watch.take(iteration, &fall);
    }
    assert_eq!(watch.said, Some("walk"));
}

#[test]
fn measures_are_the_same_wherever_they_are_found() {
    let walk = batch(&[
        [(LEFT, 0.3), (RIGHT, -0.3)],
        [(RIGHT, -0.3), (LEFT, 0.3)],
        [(LEFT, 0.3), (RIGHT, -0.3)],
    ]);
    let blind = "[actor]\nterms = ['joint_velocity']\n[discriminator]\nterms = ['key_bodies']";
    let config: observation::ObservationConfig = toml::from_str(blind).unwrap();
    let tables = config.tables().unwrap();
    let mut other = Batch::new(crate::robot(&tables).widths());
    other.resize(1, 3, 2);
    other.foot_forces.copy_from_slice(&walk.foot_forces);
    for row in 0..6 {
        // Command, features, gravity.
        let seen = &walk.observations[row * OBSERVATION..][..OBSERVATION];
        let features = &walk.next_features[row * FEATURES..][..FEATURES];
        let measured = [&seen[COMMAND], features, &seen[GRAVITY]].concat();
        other.measured[row * measured.len()..][..measured.len()].copy_from_slice(&measured);
    }
    let found = Measures::of(&other, Some(1000.0), &Places::of(&tables));
    assert_eq!(found, of(&walk, Some(1000.0)));
}
