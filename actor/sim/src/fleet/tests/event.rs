//! What befalls robots, in both engines.

use super::*;
use crate::event::EventConfig;
use ::observation::ObservationConfig;

/// Every row at once.
const ALL: &str = "\
action_delay = { range = [0.0, 0.04] }
observation_delay = { range = [0.0, 0.04] }
stiffness = { range = [0.8, 1.2] }
damping = { range = [0.8, 1.2] }
motor_strength = { range = [0.8, 1.1] }
joint_friction = { range = [0.0, 1.5] }
joint_damping = { range = [0.0, 0.2] }
encoder_offset = { range = [-0.02, 0.02] }
imu_tilt = { range = [0.0, 0.035] }
payload = { range = [-1.0, 4.0] }
ground_friction = { range = [0.3, 1.2] }
slope = { range = [0.0, 0.087] }
force = { range = [50.0, 150.0], duration = [0.05, 0.2], seconds = [0.1, 0.3] }
torque_speed = true
plain_share = 0.4
";

/// What a robot measures, and what only the simulation knows of it.
const LISTS: &str = "\
actor.terms = ['angular_velocity', 'gravity', 'joint_position', 'command']
actor.past = 2
critic.terms = ['actor', 'delays', 'stiffness', 'damping', 'motor_strength', 'slope', 'force', 'gravity']
";

fn event(text: &str) -> EventConfig {
    toml::from_str(text).unwrap()
}

fn befallen(
    physics: Physics,
    lists: &str,
    task: &TaskConfig,
    table: &RandomizationConfig,
    event: &EventConfig,
    n: usize,
    seed: u64,
) -> Fleet {
    let observation: ObservationConfig = toml::from_str(lists).unwrap();
    let tables = observation.tables().unwrap();
    let varied = (table, event);
    Fleet::seen_by(&tables, physics, task, varied, walking_frames(), n, seed).unwrap()
}

fn eventful_without_friction() -> (TaskConfig, RandomizationConfig) {
    let (task, table) = eventful();
    let table = RandomizationConfig {
        friction: None,
        ..table
    };
    (task, table)
}

#[test]
fn a_restored_fleet_continues_bit_by_bit_under_all_rows() {
    for physics in ENGINES {
        let (task, table) = eventful_without_friction();
        let all = event(ALL);
        let mut original = befallen(physics, LISTS, &task, &table, &all, 5, 5);
        let mut actions = Actions::new(2);
        for _ in 0..33 {
            step(&mut original, &actions.draw(5, 1.0));
        }
        let bytes = original.save();
        let mut restored = befallen(physics, LISTS, &task, &table, &all, 5, 99);
        restored.restore(&bytes).unwrap();
        assert_eq!(restored.save(), bytes);
        for t in 0..60 {
            let asked = actions.draw(5, 1.0);
            let steps = (step(&mut original, &asked), step(&mut restored, &asked));
            assert_eq!(steps.0, steps.1, "step {t}");
            assert_eq!(original.observations(), restored.observations(), "step {t}");
            assert_eq!(
                original.critic_observations(),
                restored.critic_observations(),
                "step {t}"
            );
        }
        // One that nothing befalls is restored from bytes of before, and the other way round.
        let mut plain = befallen(physics, LISTS, &task, &table, &event(""), 5, 5);
        let plain_bytes = plain.save();
        restored.restore(&plain_bytes).unwrap();
        assert_eq!(restored.save(), plain_bytes);
        plain.restore(&bytes).unwrap();
        assert_eq!(plain.save(), bytes);
        assert!(plain.restore(&bytes[..bytes.len() - 3]).is_err());
    }
}

#[test]
fn robots_that_nothing_befalls_do_not_notice_the_others() {
    for physics in ENGINES {
        let (task, table) = eventful_without_friction();
        let mut with = befallen(physics, "", &task, &table, &event(ALL), 5, 11);
        let mut without = befallen(physics, "", &task, &table, &event(""), 5, 11);
        // Of five robots the golden ratio's multiples leave 0, 2 (0.236) and 5 (0.090) below 0.4.
        let plain = [0, 2];
        let mut actions = Actions::new(1);
        for _ in 0..40 {
            let asked = actions.draw(5, 1.0);
            let (a, b) = (step(&mut with, &asked), step(&mut without, &asked));
            for robot in plain {
                assert_eq!(a.energies[robot], b.energies[robot], "{robot}");
                assert_eq!(with.state(robot), without.state(robot), "{robot}");
            }
        }
        assert_ne!(with.state(1), without.state(1));
        // A table that nothing is left of is as none.
        with.set_event(&event(""));
        assert!(with.restore(&without.save()).is_ok());
        let asked = actions.draw(5, 1.0);
        assert_eq!(step(&mut with, &asked), step(&mut without, &asked));
    }
}

/// One robot that begins standing, long episodes, and nothing else that is random.
fn calm(physics: Physics, lists: &str, rows: &str) -> Fleet {
    let task = TaskConfig {
        termination: of_steps(10_000, false),
        start: StartConfig {
            reference_share: 0.0.into(),
            position_noise: 0.0,
            velocity_noise: 0.0,
            ..StartConfig::default()
        },
        ..TaskConfig::default()
    };
    let none = RandomizationConfig::default();
    befallen(physics, lists, &task, &none, &event(rows), 1, 3)
}

#[test]
fn an_action_acts_later_by_its_delay() {
    for physics in ENGINES {
        // Four physics steps late: what is asked for in one control step moves the robot in the next.
        let late = "action_delay = { range = [0.02, 0.02] }";
        let (mut late, mut prompt) = (calm(physics, "", late), calm(physics, "", ""));
        let (rest, bent) = (vec![0.0; ACTION], vec![1.0; ACTION]);
        step(&mut late, &bent);
        step(&mut prompt, &rest);
        assert_eq!(late.state(0), prompt.state(0));
        step(&mut late, &rest);
        step(&mut prompt, &bent);
        assert_eq!(late.state(0), prompt.state(0));
        // Two of the four: neither as one nor as the other.
        let mut half = calm(physics, "", "action_delay = { range = [0.01, 0.01] }");
        let mut never = calm(physics, "", "");
        step(&mut half, &bent);
        step(&mut never, &rest);
        assert_ne!(half.state(0), never.state(0));
    }
}

#[test]
fn what_is_seen_is_as_old_as_the_delay_and_what_is_paid_is_not() {
    let lists = "actor.terms = ['joint_angle', 'previous_action']\ncritic.terms = ['joint_angle']";
    for physics in ENGINES {
        let mut fleet = calm(
            physics,
            lists,
            "observation_delay = { range = [0.03, 0.03] }",
        );
        let mut past = vec![fleet.state(0).joint_positions];
        let mut actions = Actions::new(4);
        for _ in 0..6 {
            let asked = actions.draw(1, 1.0);
            step(&mut fleet, &asked);
            past.push(fleet.state(0).joint_positions);
            let seen = &fleet.observations()[..JOINTS];
            let newest = past.len() - 1;
            let at = |steps: usize| past[newest.saturating_sub(steps)];
            for (joint, seen) in seen.iter().enumerate() {
                // 30 ms: half-way between one step ago and two.
                let expected = 0.5 * (at(1)[joint] + at(2)[joint]);
                assert!((seen - expected).abs() < 1e-6);
            }
            // The action before is known at once, and the critic sees the truth.
            assert_eq!(fleet.observations()[JOINTS..], asked);
            assert_eq!(fleet.critic_observations(), past[newest]);
        }
    }
}

#[test]
fn a_force_pushes_a_robot_of_either_engine_alike() {
    let row = "force = { range = [150.0, 150.0], duration = [0.1, 0.1], seconds = [0.02, 0.02] }";
    let lists = "critic.terms = ['actor', 'force']";
    let moved = ENGINES.map(|physics| {
        let (mut pushed, mut still) = (calm(physics, lists, row), calm(physics, lists, ""));
        let rest = vec![0.0; ACTION];
        for _ in 0..5 {
            step(&mut pushed, &rest);
            step(&mut still, &rest);
        }
        let force = &pushed.critic_observations()[..3];
        assert!((force[0].hypot(force[1]) - 150.0).abs() < 15.0, "{force:?}");
        assert_eq!(still.critic_observations(), [0.0; 3]);
        pushed.state(0).linear_velocity - still.state(0).linear_velocity
    });
    let [rapier, batched] = moved;
    assert!(rapier.norm() > 0.05, "{rapier}");
    assert!(
        (rapier - batched).norm() < 0.2 * rapier.norm(),
        "{rapier} {batched}"
    );
}

#[test]
fn motors_and_slopes_are_the_same_in_both_engines() {
    for row in [
        "stiffness = { range = [0.5, 0.5] }",
        "damping = { range = [3.0, 3.0] }",
        "motor_strength = { range = [0.1, 0.1] }",
        "joint_friction = { range = [3.0, 3.0] }",
        "joint_damping = { range = [2.0, 2.0] }",
        "slope = { range = [0.3, 0.3] }",
        "encoder_offset = { range = [0.1, 0.1] }",
    ] {
        let mut actions = Actions::new(8);
        let asked = actions.draw(1, 2.0);
        let changes = ENGINES.map(|physics| {
            let (mut other, mut plain) = (calm(physics, "", row), calm(physics, "", ""));
            for _ in 0..4 {
                step(&mut other, &asked);
                step(&mut plain, &asked);
            }
            let of = |fleet: &Fleet| nalgebra::SVector::from(fleet.state(0).joint_positions);
            of(&other) - of(&plain)
        });
        let [rapier, batched] = changes;
        assert!(rapier.norm() > 0.005, "{row}: {}", rapier.norm());
        let apart = (rapier - batched).norm() / rapier.norm();
        assert!(apart < 0.25, "{row}: {apart}");
    }
}
