//! What a fleet writes as the task's reward.

use super::*;
use crate::moment::{self, Moment};

/// Straight ahead, and nobody falls.
fn ahead() -> TaskConfig {
    TaskConfig {
        command: CommandConfig {
            forward: [0.5, 0.5].into(),
            pure_share: 1.0.into(),
            ..CommandConfig::default()
        },
        termination: TerminationConfig {
            fall: FallConfig {
                height: 0.0,
                upright: -1.0,
            },
            ..TerminationConfig::default()
        },
        ..TaskConfig::default()
    }
}

#[test]
fn reward_and_error_are_those_of_the_state_reached_under_the_old_command() {
    let task = TaskConfig {
        reward: RewardConfig {
            track: Some(Track {
                kernel: 2.0.into(),
                yaw_rate: 0.25.into(),
                ..Track::default()
            }),
            ..RewardConfig::default()
        },
        command: CommandConfig {
            resample_seconds: [0.02, 0.02], // a new command every step
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let mut fleet = fleet(&task, &RandomizationConfig::default(), 1, 9);
    for _ in 0..5 {
        let command = fleet.command(0);
        let out = step(&mut fleet, &[0.0; ACTION]);
        assert_eq!(out.ends[0], 0.0);
        let state = fleet.state(0);
        assert_eq!(
            out.task_rewards[0],
            task.pay(&Moment::new(&command, state, out.energies[0]))
        );
        assert_eq!(
            out.tracking_errors[0],
            moment::velocity_error(&command, state)
        );
        assert_ne!(fleet.command(0), command);
    }
}

#[test]
fn terms_are_told_since_they_were_asked_for_and_broken_steps_are_none() {
    let task = ahead();
    let mut fleet = fleet_in(
        Physics::Batched,
        &task,
        &RandomizationConfig::default(),
        2,
        9,
    );
    assert_eq!(fleet.take_terms(), []);
    let mut asked = [0.0; 2 * ACTION];
    // The second robot's first step breaks: it pays nothing, and no term was looked at.
    asked[ACTION] = f32::NAN;
    let first = step(&mut fleet, &asked);
    asked[ACTION] = 0.0;
    let second = step(&mut fleet, &asked);
    let told = fleet.take_terms();
    assert_eq!([told[0].0, told[1].0], ["reward/track", "gate/upright"]);
    let rewards = [
        first.task_rewards[0],
        second.task_rewards[0],
        second.task_rewards[1],
    ];
    assert_eq!(first.task_rewards[1], 0.0);
    // Robots that stand are upright but for a thousandth, so that the product of the means is the mean of the products.
    let mean = rewards.iter().sum::<f32>() / 3.0;
    assert!(
        (told[0].1 * told[1].1 - mean).abs() < 1e-4,
        "{told:?} {mean}"
    );
    assert_eq!(fleet.take_terms(), []);
}
