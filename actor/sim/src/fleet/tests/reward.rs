//! What a fleet writes as the task's reward.

use super::*;
use crate::feet::Footing;
use crate::gate::GateConfig;
use crate::gate::single_stance::SingleStance;
use crate::moment::{self, Moment};
use g1::gait::CONTACT_FORCE;
use g1::kinematics;
use g1::links::LEFT_FOOT;

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

/// What standing on one foot leaves, beside uprightness.
fn long_steps(pay: SingleStance) -> GateConfig {
    GateConfig {
        single_stance: Some(pay),
        ..GateConfig::default()
    }
}

/// The left hip and knee pull their foot up.
fn left_foot_up() -> [f32; ACTION] {
    let mut action = [0.0; ACTION];
    (action[0], action[3]) = (-3.0, 4.0);
    action
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
            task.pay(&Moment::new(
                &command,
                state,
                out.energies[0],
                &Footing::default()
            ))
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

#[test]
fn the_share_of_long_steps_is_paid_to_who_stands_on_one_foot() {
    for physics in ENGINES {
        let plain = ahead();
        let paying = TaskConfig {
            gate: long_steps(SingleStance {
                share: 0.5.into(),
                seconds: 0.1,
                ..SingleStance::default()
            }),
            ..plain.clone()
        };
        let run = |task: &TaskConfig| {
            let mut fleet = fleet_in(physics, task, &RandomizationConfig::default(), 1, 9);
            let mut rows = Vec::new();
            for _ in 0..25 {
                let out = step(&mut fleet, &left_foot_up());
                assert_eq!(out.ends[0], 0.0);
                rows.push((
                    out.task_rewards[0],
                    [out.foot_forces[0], out.foot_forces[1]],
                ));
            }
            rows
        };
        let (without, with) = (run(&plain), run(&paying));
        let mut one_foot = 0;
        let mut seen = [false; 2];
        for ((plain, forces), (paid, _)) in without.iter().zip(&with) {
            let [left, right] = forces.map(|force| force > CONTACT_FORCE);
            one_foot = if !left && right { one_foot + 1 } else { 0 };
            // 0.1 s are five steps; the right foot has stood for longer unless it lifted.
            let share = if left == right { 0.5 } else { 1.0 };
            if left == right || one_foot >= 5 {
                assert!(
                    (paid / plain - share).abs() < 1e-5,
                    "{physics:?}: {paid} {plain}"
                );
                seen[usize::from(left != right)] = true;
            } else {
                assert!(*paid > 0.5 * plain && paid < plain);
            }
        }
        assert_eq!(seen, [true; 2], "{physics:?}: both cases came");
    }
}

#[test]
fn a_foot_is_paid_by_its_own_height_in_the_world() {
    for physics in ENGINES {
        let lift = 0.03;
        let task = TaskConfig {
            gate: long_steps(SingleStance {
                share: 0.5.into(),
                seconds: 0.1, // five to ten steps pay all
                lift: Some(lift),
                ..SingleStance::default()
            }),
            ..ahead()
        };
        let mut fleet = fleet_in(physics, &task, &RandomizationConfig::default(), 1, 9);
        let feet = Footing::default();
        let (mut one_foot, mut high) = (0, 0);
        for _ in 0..25 {
            let command = fleet.command(0);
            let out = step(&mut fleet, &left_foot_up());
            let state = fleet.state(0);
            let moment = Moment::new(&command, state, out.energies[0], &feet);
            let obeys = ahead().pay(&moment);
            let [left, right] = [0, 1].map(|foot| out.foot_forces[foot] > CONTACT_FORCE);
            let bodies = kinematics::forward_state(state);
            let height = kinematics::lowest_sole_point(&bodies, LEFT_FOOT);
            one_foot = if !left && right { one_foot + 1 } else { 0 };
            if (5..=10).contains(&one_foot) {
                let low = (2.0 - height / lift).clamp(0.0, 1.0);
                let paid = out.task_rewards[0] / obeys;
                assert!(
                    (paid - (0.5 + 0.5 * low)).abs() < 1e-4,
                    "{physics:?}: {paid} at {height} m"
                );
                high += usize::from(low < 1.0);
            }
        }
        assert!(high > 0, "{physics:?}: no foot rose above {lift} m");
    }
}
