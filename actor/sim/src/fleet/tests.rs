//! Contracts of the fleet: what is written when, what depends on what.

mod reward;

use super::*;
use crate::command::CommandConfig;
use crate::model::Variation;
use crate::physics::Physics;
use crate::rows::StepRows;
use crate::start::StartConfig;
use g1::JOINTS;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const ENGINES: [Physics; 2] = [Physics::Rapier, Physics::Batched];

/// What no step writes.
const UNTOUCHED: f32 = -77.0;

fn step(fleet: &mut Fleet, actions: &[f32]) -> StepRows {
    let mut rows = StepRows::filled(fleet.len(), UNTOUCHED);
    fleet.step(actions, &mut rows.out());
    rows
}

fn walking_frames() -> Starts {
    let mut state = RobotState::standing();
    state.linear_velocity.x = 0.8;
    Starts {
        states: vec![state; 3],
        commands: vec![[0.8, 0.0, 0.0]; 3],
        cumulative_weights: vec![1.0, 2.0, 3.0],
    }
}

fn fleet(task: &TaskConfig, randomization: &RandomizationConfig, n: usize, seed: u64) -> Fleet {
    Fleet::new(task, randomization, walking_frames(), n, seed).unwrap()
}

/// Actions from a generator of their own.
struct Actions(Pcg64Mcg);

impl Actions {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }
    fn draw(&mut self, n: usize, size: f32) -> Vec<f32> {
        (0..n * ACTION)
            .map(|_| size * (2.0 * self.0.random::<f32>() - 1.0))
            .collect()
    }
}

/// Short episodes and everything random, so that resets, pushes and commands all come.
fn eventful() -> (TaskConfig, RandomizationConfig) {
    let task = TaskConfig {
        episode_steps: 20,
        command: CommandConfig {
            resample_seconds: [0.06, 0.2],
            ..CommandConfig::default()
        },
        start: StartConfig {
            reference_share: 0.7,
            ..StartConfig::default()
        },
        ..TaskConfig::default()
    };
    let randomization = RandomizationConfig {
        impulse_seconds: [0.1, 0.3],
        ..RandomizationConfig::default()
    };
    (task, randomization)
}

fn eventful_in(physics: Physics) -> (TaskConfig, RandomizationConfig) {
    let (task, randomization) = eventful();
    (TaskConfig { physics, ..task }, randomization)
}

#[test]
fn same_seed_same_bits_whoever_else_is_in_the_fleet() {
    ENGINES.into_iter().for_each(same_bits);
}

fn same_bits(physics: Physics) {
    let (task, randomization) = eventful_in(physics);
    let mut five = fleet(&task, &randomization, 5, 11);
    let mut two = fleet(&task, &randomization, 2, 11);
    let mut other = fleet(&task, &randomization, 2, 12);
    assert_ne!(two.observations(), other.observations());
    let mut actions = Actions::new(1);
    let mut resets = 0;
    for _ in 0..60 {
        let asked = actions.draw(5, 1.0);
        let a = step(&mut five, &asked);
        let b = step(&mut two, &asked[..2 * ACTION]);
        step(&mut other, &asked[..2 * ACTION]);
        assert_eq!(five.observations()[..2 * OBSERVATION], *two.observations());
        assert_eq!(a.next_features[..2 * FEATURES], b.next_features);
        assert_eq!(a.energies[..2], b.energies);
        assert_eq!(a.foot_forces[..4], b.foot_forces);
        resets += b.ends.iter().filter(|end| **end != 0.0).count();
    }
    assert!(resets >= 4, "{resets}");
    // Environments of one fleet differ.
    let rows = five.observations().as_chunks::<OBSERVATION>().0;
    assert_ne!(rows[0], rows[1]);
}

#[test]
fn a_restored_fleet_continues_bit_by_bit_across_resets() {
    ENGINES.into_iter().for_each(continues);
}

fn continues(physics: Physics) {
    let (task, randomization) = eventful_in(physics);
    let mut original = fleet(&task, &randomization, 3, 5);
    let mut actions = Actions::new(2);
    for _ in 0..33 {
        step(&mut original, &actions.draw(3, 1.0));
    }
    let bytes = original.save();
    let mut restored = fleet(&task, &randomization, 3, 99);
    restored.restore(&bytes).unwrap();
    assert_eq!(restored.observations(), original.observations());
    assert_eq!(restored.save(), bytes);
    for t in 0..60 {
        let asked = actions.draw(3, 1.0);
        assert_eq!(
            step(&mut original, &asked),
            step(&mut restored, &asked),
            "step {t}"
        );
        assert_eq!(original.observations(), restored.observations(), "step {t}");
        assert_eq!(original.features(), restored.features(), "step {t}");
    }
}

#[test]
fn bytes_that_do_not_fit_are_refused_and_change_nothing() {
    let (task, randomization) = eventful();
    let mut two = fleet(&task, &randomization, 2, 1);
    let three = fleet(&task, &randomization, 3, 1);
    let before = two.save();
    let error = two.restore(&three.save()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("holds 3 environments, this fleet has 2")
    );
    assert!(matches!(
        two.restore(&before[..100]),
        Err(SimError::Snapshot { bytes: 100, .. })
    ));
    assert_eq!(two.save(), before);
    let (task, randomization) = eventful_in(Physics::Batched);
    let other = fleet(&task, &randomization, 2, 1);
    let error = two.restore(&other.save()).unwrap_err();
    assert!(error.to_string().contains("task.physics"), "{error}");
    assert_eq!(two.save(), before);
}

#[test]
fn features_go_from_step_to_step_and_stop_at_an_episodes_end() {
    let (task, _) = eventful();
    let randomization = RandomizationConfig::none();
    let mut fleet = fleet(&task, &randomization, 4, 3);
    let mut actions = Actions::new(3);
    let (mut falls, mut timeouts, mut steps) = (0, 0, [0.0; 4]);
    for _ in 0..80 {
        let out = step(&mut fleet, &actions.draw(4, 2.0));
        for (i, steps) in steps.iter_mut().enumerate() {
            *steps += 1.0;
            assert_eq!(out.episode_steps[i], *steps);
            let next = &out.next_features[i * FEATURES..][..FEATURES];
            let begins = &fleet.features()[i * FEATURES..][..FEATURES];
            let last_seen = &out.timeout_observations[i * OBSERVATION..][..OBSERVATION];
            if out.ends[i] == 0.0 {
                assert_eq!(
                    next, begins,
                    "o_{{t+1}} of a running episode is the next o_t"
                );
                assert!(last_seen.iter().all(|x| *x == UNTOUCHED));
                continue;
            }
            *steps = 0.0;
            // The old episode ended lower or elsewhere; the new one begins standing or walking.
            assert_ne!(next, begins);
            assert!(begins[0] > 0.77, "a new episode's height {}", begins[0]);
            if out.ends[i] == 1.0 {
                falls += 1;
                assert!(last_seen.iter().all(|x| *x == UNTOUCHED));
            } else {
                timeouts += 1;
                assert_eq!(out.ends[i], 2.0);
                // Without sensor noise the last observation tells the same as the last features.
                assert_eq!(last_seen[..7], next[..7]);
                assert_eq!(last_seen[36..59], next[30..53]);
            }
            let begun = &fleet.observations()[i * OBSERVATION..][..OBSERVATION];
            assert!(
                begun[observation::PREVIOUS_ACTION]
                    .iter()
                    .all(|a| *a == 0.0)
            );
        }
    }
    assert!(timeouts > 0 && timeouts + falls >= 16, "{timeouts} {falls}"); // 80 steps of 20 each
}

#[test]
fn observations_show_the_command_and_the_previous_action() {
    let task = TaskConfig::default();
    let mut fleet = fleet(&task, &RandomizationConfig::none(), 2, 8);
    let asked = Actions::new(4).draw(2, 0.3);
    step(&mut fleet, &asked);
    for i in 0..2 {
        let seen = &fleet.observations()[i * OBSERVATION..][..OBSERVATION];
        assert_eq!(seen[observation::COMMAND], fleet.command(i));
        assert_eq!(
            seen[observation::PREVIOUS_ACTION],
            asked[i * ACTION..][..ACTION]
        );
        let mut expected = [0.0; OBSERVATION];
        let action: &[f32; JOINTS] = asked[i * ACTION..][..ACTION].try_into().unwrap();
        let command = fleet.command(i);
        observation::policy_observation(fleet.state(i), &command, action, &mut expected);
        assert_eq!(seen, expected);
    }
    fleet.hold_command(1, [0.1, 0.2, 0.3]);
    assert_eq!(
        fleet.observations()[OBSERVATION..][observation::COMMAND],
        [0.1, 0.2, 0.3]
    );
}

#[test]
fn timeouts_are_staggered_and_then_a_full_episode_apart() {
    let task = TaskConfig {
        episode_steps: 12,
        start: StartConfig {
            reference_share: 0.0,
            ..StartConfig::default()
        },
        ..TaskConfig::default()
    };
    let count = |staggered: bool| {
        let task = TaskConfig {
            staggered,
            ..task.clone()
        };
        let mut fleet = fleet(&task, &RandomizationConfig::none(), 6, 2);
        let mut ended = vec![Vec::new(); 6];
        for t in 1..=24 {
            let out = step(&mut fleet, &[0.0; 6 * ACTION]);
            for (i, times) in ended.iter_mut().enumerate() {
                if out.ends[i] != 0.0 {
                    assert_eq!(out.ends[i], 2.0, "standing for ¼ s is no fall");
                    times.push(t);
                }
            }
        }
        ended
    };
    assert!(count(false).iter().all(|times| times == &[12, 24]));
    let staggered = count(true);
    for times in &staggered {
        assert!((1..=12).contains(&times[0]));
        assert_eq!(times[1], times[0] + 12);
    }
    assert!(staggered.iter().any(|times| times[0] != staggered[0][0]));
}

#[test]
fn limp_robots_fall_and_their_episode_ends() {
    let mut gains = Gains::of_the_robot();
    gains.effort = [0.0; JOINTS];
    let task = TaskConfig::default();
    let none = RandomizationConfig::none();
    let mut fleet = Fleet::with_gains(&task, &none, Starts::default(), 1, 4, gains).unwrap();
    let fall = (0..100)
        .map(|_| step(&mut fleet, &[0.0; ACTION]))
        .find(|out| out.ends[0] != 0.0)
        .expect("falls within 2 s");
    assert_eq!(fall.ends[0], 1.0);
    let (height, last) = (fall.next_features[0], &fall.next_features);
    assert!(
        height < 0.55 || last.iter().all(|x| x.is_finite()),
        "{height}"
    );
    assert_eq!(fall.energies[0], 0.0); // no current, no work
}

#[test]
fn starts_match_their_clip_in_the_share_asked_for() {
    for share in [0.0, 1.0] {
        let task = TaskConfig {
            command: CommandConfig {
                forward: [1.0, 1.2],
                matched_share: share,
                ..CommandConfig::default()
            },
            ..TaskConfig::default()
        };
        let fleet = fleet(&task, &RandomizationConfig::none(), 20, 1);
        for i in 0..20 {
            assert_eq!(fleet.command(i) == [0.8, 0.0, 0.0], share == 1.0);
        }
    }
}

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
        mass_variation: false,
        friction: false,
        com_offset: false,
        impulse: false,
        ..RandomizationConfig::default()
    };
    let mut blurred = fleet(&task, &noisy, 1, 6);
    let mut exact = fleet(&task, &RandomizationConfig::none(), 1, 6);
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
        impulse: true,
        impulse_range: [0.5, 0.5],
        impulse_seconds: [0.1, 0.1], // every fifth step
        ..RandomizationConfig::none()
    };
    let mut pushed = fleet(&task, &pushed, 1, 6);
    let mut still = fleet(&task, &RandomizationConfig::none(), 1, 6);
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
        impulse_seconds: [0.1, 0.1],
        ..RandomizationConfig::default()
    };
    let mut shared = fleet(&task, &shared, 4, 6);
    let mut plain = fleet(&task, &RandomizationConfig::none(), 4, 6);
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
        ..RandomizationConfig::default()
    };
    let error = wrong.validate().unwrap_err().to_string();
    assert!(error.contains("plain_share"), "{error}");
}

#[test]
fn broken_numbers_reset_and_never_leave() {
    ENGINES.into_iter().for_each(resets_what_broke);
}

fn resets_what_broke(physics: Physics) {
    let (task, randomization) = eventful_in(physics);
    let mut fleet = fleet(&task, &randomization, 2, 1);
    let mut asked = vec![0.0; 2 * ACTION];
    asked[5] = f32::NAN;
    let out = step(&mut fleet, &asked);
    assert_eq!((out.ends[0], out.ends[1]), (1.0, 0.0));
    assert_eq!(fleet.faults(), 1);
    // An action large enough to overflow f32 inside the physics.
    asked[5] = 0.0;
    let mut state = *fleet.state(1);
    state.joint_velocities[2] = f32::INFINITY;
    let _ = fleet.bodies.begin(1, &Variation::NOMINAL, &state);
    let broken = step(&mut fleet, &asked);
    assert_eq!(broken.ends[1], 1.0);
    assert_eq!(fleet.faults(), 2);
    for numbers in [&out.next_features, &out.task_rewards, &out.tracking_errors]
        .into_iter()
        .chain([&broken.next_features, &broken.energies, &broken.foot_forces])
    {
        assert!(numbers.iter().all(|x| x.is_finite()));
    }
    assert!(fleet.observations().iter().all(|x| x.is_finite()));
    assert_eq!(step(&mut fleet, &asked).episode_steps[1], 1.0, "begun anew");
}

#[test]
fn violent_actions_leave_finite_numbers() {
    ENGINES.into_iter().for_each(stays_finite);
}

fn stays_finite(physics: Physics) {
    let (task, randomization) = eventful_in(physics);
    let mut fleet = fleet(&task, &randomization, 4, 13);
    let mut actions = Actions::new(5);
    for size in [1.0, 10.0, 1e3, 1e6] {
        for _ in 0..30 {
            let out = step(&mut fleet, &actions.draw(4, size));
            let rows = [&out.next_features, &out.task_rewards, &out.energies];
            assert!(rows.iter().all(|row| row.iter().all(|x| x.is_finite())));
            assert!(fleet.observations().iter().all(|x| x.is_finite()));
        }
    }
}

#[test]
fn a_fleet_can_move_to_another_thread() {
    fn assert_send<T: Send>() {}
    assert_send::<Fleet>();
}

#[test]
fn the_last_step_is_told_also_where_an_episode_ended() {
    let (mut task, _) = eventful();
    task.episode_steps = 3;
    task.staggered = false;
    let mut fleet = fleet(&task, &RandomizationConfig::none(), 2, 4);
    assert_eq!(fleet.last_step(1).state, *fleet.state(1));
    assert_eq!(fleet.last_step(1).exertion, Exertion::default());
    let mut actions = Actions::new(4);
    for t in 1..=3 {
        let out = step(&mut fleet, &actions.draw(2, 1.0));
        let last = fleet.last_step(1);
        assert_eq!(last.exertion.energy, out.energies[1]);
        assert_eq!(last.exertion.foot_forces, out.foot_forces[2..]);
        let mut features = [0.0; FEATURES];
        observation::features(&last.state, &mut features);
        assert_eq!(features, out.next_features[FEATURES..]);
        assert_eq!(last.state == *fleet.state(1), t < 3);
    }
}

#[test]
fn a_push_from_outside_moves_the_robot_that_it_is_meant_for() {
    let (task, _) = eventful();
    let mut pushed = fleet(&task, &RandomizationConfig::none(), 2, 6);
    let mut left_alone = fleet(&task, &RandomizationConfig::none(), 2, 6);
    pushed.push(0, [0.0, 0.5, 0.0]);
    let rest = [0.0; 2 * ACTION];
    step(&mut pushed, &rest);
    step(&mut left_alone, &rest);
    let gain = pushed.state(0).linear_velocity.y - left_alone.state(0).linear_velocity.y;
    assert!((0.3..0.6).contains(&gain), "{gain} m/s");
    assert_eq!(pushed.state(1), left_alone.state(1));
}
