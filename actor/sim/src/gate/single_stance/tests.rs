//! What feet earn, by hand.

use super::*;

const LEFT: [f32; 2] = [315.0, 0.0];
const RIGHT: [f32; 2] = [0.0, 315.0];
const BOTH: [f32; 2] = [160.0, 155.0];
const NONE: [f32; 2] = [0.0; 2];
const AHEAD: [f32; 3] = [1.0, 0.0, 0.0];

/// Soles that never leave the ground by a millimetre.
fn flat(_: Foot) -> f32 {
    0.0
}

/// Factor after steps with these forces.
fn factor(steps: &[([f32; 2], usize)]) -> f32 {
    let mut feet = Footing::default();
    for &(forces, count) in steps {
        (0..count).for_each(|_| feet.step(forces));
    }
    SingleStance::default().factor(&AHEAD, &feet, flat)
}

#[test]
fn long_steps_pay_by_hand() {
    let close = |got: f32, expected: f32| assert!((got - expected).abs() < 1e-6, "{got}");
    close(factor(&[(BOTH, 9)]), 0.7);
    close(factor(&[(NONE, 9)]), 0.7);
    // The right foot has swung for 10 steps of 20 ms, half of 0.4 s, the left has stood for longer.
    close(factor(&[(BOTH, 9), (LEFT, 10)]), 0.85);
    close(factor(&[(BOTH, 9), (LEFT, 39)]), 1.0);
    close(factor(&[(BOTH, 9), (LEFT, 60)]), 0.7);
    // The left foot has just landed; how long the right has been in the air does not help.
    close(factor(&[(NONE, 30), (LEFT, 2)]), 0.7 + 0.3 * 0.1);
}

#[test]
fn pay_may_grow_with_the_square_but_not_that_of_a_run() {
    let config = SingleStance {
        power: 2.0,
        run_from: Some(1.8),
        ..SingleStance::default()
    };
    let mut feet = Footing::default();
    (0..10).for_each(|_| feet.step(LEFT));
    // Half of 0.4 s pays a quarter of 0.3, and half of it at a run.
    let factors = [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet, flat));
    assert!((factors[0] - 0.775).abs() < 1e-6 && (factors[1] - 0.85).abs() < 1e-6);
    // All of it pays all, whatever the exponent.
    (0..10).for_each(|_| feet.step(LEFT));
    assert!((config.factor(&AHEAD, &feet, flat) - 1.0).abs() < 1e-6);
}

#[test]
fn ways_aside_back_and_on_the_spot_may_have_a_share_of_their_own() {
    let feet = Footing::default();
    let config = |aside_share| SingleStance {
        aside_share,
        run_from: Some(1.8),
        run_share: Some(0.1),
        ..SingleStance::default()
    };
    let others = [
        [-0.5, 0.0, 0.0],
        [0.0, 0.3, 0.0],
        [0.0, 0.0, 0.5],
        [0.5, 0.0, 0.5],
    ];
    for command in others {
        assert_eq!(config(Some(0.2)).factor(&command, &feet, flat), 0.8);
        assert_eq!(config(None).factor(&command, &feet, flat), 0.7);
    }
    // Straight ahead it does not count, nor at a run, straight or not.
    assert_eq!(config(Some(0.2)).factor(&AHEAD, &feet, flat), 0.7);
    assert_eq!(config(Some(0.2)).factor(&[2.0, 0.0, 0.4], &feet, flat), 0.9);
}

#[test]
fn who_lifts_a_foot_too_high_is_paid_less_for_the_step_by_hand() {
    let config = SingleStance {
        lift: Some(0.08),
        run_from: Some(1.8),
        ..SingleStance::default()
    };
    let mut feet = Footing::default();
    (0..10).for_each(|_| feet.step(LEFT));
    let factor = |speed: f32, right: f32| {
        config.factor(&[speed, 0.0, 0.0], &feet, |foot| match foot {
            Foot::Left => 9.0,
            Foot::Right => right,
        })
    };
    let close = |got: f32, expected: f32| assert!((got - expected).abs() < 1e-6, "{got}");
    // Half of 0.4 s pays half of 0.3; 0.12 m is half-way from 0.08 to 0.16: a quarter.
    close(factor(1.0, 0.08), 0.85);
    close(factor(1.0, 0.12), 0.775);
    close(factor(1.0, 0.2), 0.7);
    // A run's feet may rise as they like.
    close(factor(1.8, 0.2), 0.85);
}

#[test]
fn a_run_is_paid_for_its_flight_too() {
    let config = SingleStance {
        run_from: Some(1.8),
        ..SingleStance::default()
    };
    let mut feet = Footing::default();
    let mut step = |forces, count| {
        (0..count).for_each(|_| feet.step(forces));
        [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet, flat))
    };
    let close = |got: [f32; 2], expected: [f32; 2]| {
        let near = |i: usize| (got[i] - expected[i]).abs() < 1e-6;
        assert!(near(0) && near(1), "{got:?}");
    };
    close(step(BOTH, 9), [0.7, 0.7]);
    close(step(LEFT, 10), [0.85, 0.85]);
    // The right foot has been in the air for 14 of 20 steps.
    close(step(NONE, 4), [0.7, 0.7 + 0.3 * 0.7]);
    // It lands; the left is in the air for 4 steps and 2.
    close(step(RIGHT, 2), [0.7 + 0.3 * 0.1, 0.7 + 0.3 * 0.3]);
}

#[test]
fn flight_pays_until_the_next_foot_is_lifted_and_a_walk_has_none() {
    let config = SingleStance {
        share: 1.0.into(),
        run_from: Some(1.8),
        flight: 1.0,
        ..SingleStance::default()
    };
    let mut feet = Footing::default();
    let mut paid = |forces, count| {
        (0..count).for_each(|_| feet.step(forces));
        [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet, flat))[1]
    };
    let close = |got: f32, expected: f32| assert!((got - expected).abs() < 1e-6, "{got}");
    close(paid(BOTH, 9), 0.0);
    close(paid(LEFT, 10), 0.0);
    // The left foot follows: 20 ms of 40.
    close(paid(NONE, 1), 0.5);
    // Whoever lands after that has flown for as long, and for nothing more.
    close(paid(RIGHT, 12), 0.5);
    close(paid(NONE, 2), 1.0);
    close(paid(NONE, 3), 1.0);
    close(paid(LEFT, 3), 1.0);
    // Down with both, and off with one: a walk again.
    close(paid(BOTH, 1), 0.0);
    close(paid(RIGHT, 8), 0.0);
}

#[test]
fn a_part_of_a_run_is_paid_for_flight() {
    let config = SingleStance {
        run_from: Some(1.8),
        flight: 0.5,
        ..SingleStance::default()
    };
    let mut feet = Footing::default();
    (0..10).for_each(|_| feet.step(LEFT));
    // Half of 0.4 s pays half of the share, of which half is for flight at a run: none yet.
    let factors = [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet, flat));
    assert!((factors[0] - 0.85).abs() < 1e-6 && (factors[1] - 0.775).abs() < 1e-6);
}

#[test]
fn beyond_a_walk_and_below_a_run_only_obeying_is_paid() {
    let config = SingleStance {
        walk_to: Some(1.2),
        run_from: Some(1.8),
        run_share: Some(0.1),
        ..SingleStance::default()
    };
    // Both feet down: no long step is paid for, and neither is flight.
    let feet = Footing::default();
    let factors = [1.2, 1.3, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet, flat));
    assert_eq!(factors, [0.7, 1.0, 0.9]);
}

#[test]
fn who_is_told_to_stand_is_not_asked_to_lift_a_foot() {
    let feet = Footing::default();
    let config = SingleStance::default();
    assert_eq!(config.factor(&[0.0; 3], &feet, flat), 1.0);
    assert_eq!(config.factor(&[0.0, 0.0, 0.5], &feet, flat), 0.7);
}

#[test]
fn who_is_told_to_stand_may_be_asked_to_keep_both_feet_down() {
    let config = SingleStance {
        standing: 0.4,
        ..SingleStance::default()
    };
    let mut feet = Footing::default();
    feet.step(BOTH);
    assert_eq!(config.factor(&[0.0; 3], &feet, flat), 1.0);
    assert_eq!(config.factor(&[0.0, 0.0, 0.5], &feet, flat), 0.7);
    for forces in [LEFT, NONE] {
        feet.step(forces);
        assert_eq!(config.factor(&[0.0; 3], &feet, flat), 0.6);
    }
}

#[test]
fn shares_beyond_all_and_times_of_nothing_are_refused() {
    let refused = |share, seconds| {
        let config = SingleStance {
            share: Ramp::Constant(share),
            seconds,
            run_from: Some(0.2),
            ..SingleStance::default()
        };
        config.validate().unwrap_err().to_string()
    };
    assert!(refused(1.5, 0.4).contains("share = 1.5"));
    assert!(refused(0.5, 0.0).contains("seconds = 0"));
    assert!(refused(0.5, 0.4).contains("run_from = 0.2"));
    let unpaid = SingleStance {
        flight: 0.5,
        ..SingleStance::default()
    };
    let refused = unpaid.validate().unwrap_err().to_string();
    assert!(refused.contains("flight = 0.5"), "{refused}");
    let never = SingleStance {
        run_share: Some(0.2),
        ..SingleStance::default()
    };
    let refused = never.validate().unwrap_err().to_string();
    assert!(refused.contains("run_share = 0.2"), "{refused}");
    let root = SingleStance {
        power: 0.5,
        ..SingleStance::default()
    };
    let refused = root.validate().unwrap_err().to_string();
    assert!(refused.contains("power = 0.5"), "{refused}");
    let aside = SingleStance {
        aside_share: Some(1.2),
        ..SingleStance::default()
    };
    let refused = aside.validate().unwrap_err().to_string();
    assert!(refused.contains("aside_share = 1.2"), "{refused}");
    let flat_footed = SingleStance {
        lift: Some(0.0),
        ..SingleStance::default()
    };
    let refused = flat_footed.validate().unwrap_err().to_string();
    assert!(refused.contains("lift = 0"), "{refused}");
    let backward = SingleStance {
        walk_to: Some(-1.0),
        ..SingleStance::default()
    };
    let refused = backward.validate().unwrap_err().to_string();
    assert!(refused.contains("walk_to = -1"), "{refused}");
    SingleStance::default().validate().unwrap();
}
