//! Table I, and the robots that it leaves alone.

use super::*;

#[test]
fn noise_is_in_observations_only() {
    let task = TaskConfig {
        start: StartConfig {
            position_noise: 0.0,
            velocity_noise: 0.0,
            ..StartConfig::default()
        },
        ..TaskConfig::default()
    };
    let noisy = RandomizationConfig {
        mass_variation: None,
        friction: None,
        com_offset: None,
        impulse: None,
        ..RandomizationConfig::table_one()
    };
    let mut blurred = fleet(&task, &noisy, 1, 6);
    let mut exact = fleet(&task, &RandomizationConfig::default(), 1, 6);
    let a = step(&mut blurred, &[0.1; ACTION]);
    let b = step(&mut exact, &[0.1; ACTION]);
    assert_eq!(a.next_features, b.next_features);
    assert_eq!(a.task_rewards, b.task_rewards);
    assert_eq!(blurred.features(), exact.features());
    assert_ne!(blurred.observations(), exact.observations());
    // Height, command and previous action carry no noise.
    assert_eq!(blurred.observations()[0], exact.observations()[0]);
    assert_eq!(blurred.observations()[59..], exact.observations()[59..]);
}

#[test]
fn pushes_come_at_their_time() {
    let task = TaskConfig::default();
    let pushed = RandomizationConfig {
        impulse: Some(Push {
            range: [0.5, 0.5],
            seconds: [0.1, 0.1], // every fifth step
        }),
        ..RandomizationConfig::default()
    };
    let mut pushed = fleet(&task, &pushed, 1, 6);
    let mut still = fleet(&task, &RandomizationConfig::default(), 1, 6);
    for t in 1..=5 {
        step(&mut pushed, &[0.0; ACTION]);
        step(&mut still, &[0.0; ACTION]);
        let change = pushed.state(0).linear_velocity - still.state(0).linear_velocity;
        // (±0.5, ±0.5) m/s, less what the feet hold back within a step.
        assert_eq!(change.xy().norm() > 0.2, t == 5, "step {t}: {change:?}");
    }
}

#[test]
fn the_table_leaves_its_share_of_robots_alone() {
    let task = TaskConfig::default();
    let shared = RandomizationConfig {
        plain_share: 0.5,
        impulse: Some(Push {
            range: [0.0, 0.5],
            seconds: [0.1, 0.1],
        }),
        ..RandomizationConfig::table_one()
    };
    let mut shared = fleet(&task, &shared, 4, 6);
    let mut plain = fleet(&task, &RandomizationConfig::default(), 4, 6);
    for _ in 0..6 {
        step(&mut shared, &[0.0; 4 * ACTION]);
        step(&mut plain, &[0.0; 4 * ACTION]);
    }
    // Multiples of the golden ratio: 0, 0.62, 0.24, 0.85.
    for (robot, spared) in [true, false, true, false].into_iter().enumerate() {
        let seen = |fleet: &Fleet| {
            let row = robot * OBSERVATION..(robot + 1) * OBSERVATION;
            (fleet.observations()[row].to_vec(), *fleet.state(robot))
        };
        assert_eq!(seen(&shared) == seen(&plain), spared, "robot {robot}");
    }
    let wrong = RandomizationConfig {
        plain_share: 1.5,
        ..RandomizationConfig::table_one()
    };
    let error = wrong.validate().unwrap_err().to_string();
    assert!(error.contains("plain_share"), "{error}");
}

#[test]
fn a_push_from_outside_moves_the_robot_that_it_is_meant_for() {
    let (task, _) = eventful();
    let mut pushed = fleet(&task, &RandomizationConfig::default(), 2, 6);
    let mut left_alone = fleet(&task, &RandomizationConfig::default(), 2, 6);
    pushed.push(0, [0.0, 0.5, 0.0]);
    let rest = [0.0; 2 * ACTION];
    step(&mut pushed, &rest);
    step(&mut left_alone, &rest);
    let gain = pushed.state(0).linear_velocity.y - left_alone.state(0).linear_velocity.y;
    assert!((0.3..0.6).contains(&gain), "{gain} m/s");
    assert_eq!(pushed.state(1), left_alone.state(1));
}
