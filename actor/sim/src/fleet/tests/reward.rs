//! What a fleet writes as the task's reward.

use super::*;
use crate::stance::SingleStanceConfig;

#[test]
fn reward_and_error_are_those_of_the_state_reached_under_the_old_command() {
    let task = TaskConfig {
        kernel: 2.0,
        yaw_rate_weight: 0.25,
        command: CommandConfig {
            resample_seconds: [0.02, 0.02], // a new command every step
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let mut fleet = fleet(&task, &RandomizationConfig::none(), 1, 9);
    for _ in 0..5 {
        let command = fleet.command(0);
        let out = step(&mut fleet, &[0.0; ACTION]);
        assert_eq!(out.ends[0], 0.0);
        let state = fleet.state(0);
        assert_eq!(
            out.task_rewards[0],
            task.reward(&command, state, out.energies[0])
        );
        assert_eq!(
            out.tracking_errors[0],
            crate::task::tracking_error(&command, state)
        );
        assert_ne!(fleet.command(0), command);
    }
}

#[test]
fn the_share_of_long_steps_is_paid_to_who_stands_on_one_foot() {
    for physics in ENGINES {
        let plain = TaskConfig {
            physics,
            command: CommandConfig {
                forward: [0.5, 0.5],
                pure_share: 1.0,
                standing_share: 0.0,
                ..CommandConfig::default()
            },
            fall_height: 0.0,
            fall_upright: -1.0,
            ..TaskConfig::default()
        };
        let paying = TaskConfig {
            single_stance: Some(SingleStanceConfig {
                share: 0.5,
                seconds: 0.1,
                ..SingleStanceConfig::default()
            }),
            ..plain.clone()
        };
        let run = |task: &TaskConfig| {
            let mut fleet = fleet(task, &RandomizationConfig::none(), 1, 9);
            // The left hip and knee pull their foot up.
            let mut action = [0.0; ACTION];
            (action[0], action[3]) = (-3.0, 4.0);
            let mut rows = Vec::new();
            for _ in 0..25 {
                let out = step(&mut fleet, &action);
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
            let [left, right] = forces.map(|force| force > g1::gait::CONTACT_FORCE);
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
