//! Lists other than the paper's: past frames, a critic of its own, what is measured beside.

use super::*;
use crate::randomization::{Push, Row};
use ::observation::{ObservationConfig, Tables};

/// The paper's terms in another order, half of them remembered, and a critic that knows more.
const LISTS: &str = "
[actor]
terms = ['joint_velocity', 'command', 'height', 'gravity', 'previous_action']
past = 2
[actor.term.gravity]
past = 0
scale = 10.0
[critic]
terms = ['actor', 'linear_velocity', 'foot_forces', 'contacts', 'friction', 'payload', 'com_offset', 'push']
[critic.term.foot_forces]
past = 1
[discriminator]
terms = ['key_bodies', 'joint_velocity']
";

fn tables(text: &str) -> Tables {
    let config: ObservationConfig = toml::from_str(text).unwrap();
    config.tables().unwrap()
}

fn seen(text: &str, task: &TaskConfig, table: &RandomizationConfig, n: usize, seed: u64) -> Fleet {
    seen_in(Physics::Rapier, text, task, table, [n, seed as usize])
}

fn seen_in(
    physics: Physics,
    text: &str,
    task: &TaskConfig,
    table: &RandomizationConfig,
    [n, seed]: [usize; 2],
) -> Fleet {
    let starts = walking_frames();
    Fleet::seen_by(&tables(text), physics, task, table, starts, n, seed as u64).unwrap()
}

/// Joint velocities at present and one and two steps before.
fn velocities(row: &[f32]) -> [&[f32]; 3] {
    std::array::from_fn(|age| &row[age * JOINTS..][..JOINTS])
}

#[test]
fn past_frames_are_those_of_the_steps_before_and_of_no_episode_before() {
    ENGINES.into_iter().for_each(remembers);
}

fn remembers(physics: Physics) {
    let (task, _) = eventful();
    let none = RandomizationConfig::default();
    let starts = walking_frames();
    let mut paper = Fleet::new(physics, &task, &none, starts, 3, 7).unwrap();
    let mut fleet = seen_in(physics, LISTS, &task, &none, [3, 7]);
    let width = fleet.tables().actor.width();
    assert_eq!(width, 3 * (JOINTS + 3 + 1 + JOINTS) + 3);
    let now = |fleet: &Fleet, robot: usize| fleet.state(robot).joint_velocities;
    let mut before: Vec<[[f32; JOINTS]; 3]> = (0..3).map(|i| [now(&fleet, i); 3]).collect();
    let mut actions = Actions::new(7);
    let mut time_outs = 0;
    for _ in 0..60 {
        let asked = actions.draw(3, 1.0);
        let out = step(&mut fleet, &asked);
        // What is seen of the robots does not move them.
        assert_eq!(out.ends, step(&mut paper, &asked).ends);
        for (i, before) in before.iter_mut().enumerate() {
            let row = &fleet.observations()[i * width..][..width];
            if out.ends[i] == 0.0 {
                *before = [now(&fleet, i), before[0], before[1]];
            } else {
                if out.ends[i] == Cause::TimeOut.code() {
                    time_outs += 1;
                    let last = &out.timeout_observations[i * width..][..width];
                    let [newest, older, oldest] = velocities(last);
                    assert_eq!(newest, fleet.last_step(i).state.joint_velocities);
                    assert_eq!([older, oldest], [&before[0][..], &before[1]]);
                }
                *before = [now(&fleet, i); 3];
            }
            assert_eq!(velocities(row), before.each_ref().map(|frame| &frame[..]));
            let theirs = &paper.observations()[i * OBSERVATION..][..OBSERVATION];
            let gravity = &row[3 * (JOINTS + 3 + 1)..][..3];
            let tenfold = observation::GRAVITY.map(|place| 10.0 * theirs[place]);
            assert!(gravity.iter().copied().eq(tenfold));
        }
    }
    assert!(time_outs >= 6, "{time_outs}"); // 60 steps of 3 robots, 20 to an episode
}

#[test]
fn a_restored_fleet_remembers() {
    for physics in ENGINES {
        let (task, table) = eventful();
        let mut original = seen_in(physics, LISTS, &task, &table, [2, 5]);
        let mut actions = Actions::new(2);
        for _ in 0..13 {
            step(&mut original, &actions.draw(2, 1.0));
        }
        let mut restored = seen_in(physics, LISTS, &task, &table, [2, 99]);
        restored.restore(&original.save()).unwrap();
        for t in 0..40 {
            let asked = actions.draw(2, 1.0);
            let (a, b) = (step(&mut original, &asked), step(&mut restored, &asked));
            assert_eq!(a, b, "step {t}");
            assert_eq!(original.observations(), restored.observations());
            assert_eq!(
                original.critic_observations(),
                restored.critic_observations()
            );
        }
        // Rows of other lists do not fit.
        let mut paper = Fleet::new(physics, &task, &table, walking_frames(), 2, 5).unwrap();
        assert!(paper.restore(&original.save()).is_err());
    }
}

#[test]
fn the_critic_knows_what_is_true() {
    let table = RandomizationConfig {
        friction: Some(Row { range: [0.6; 2] }),
        mass_variation: Some(Row { range: [0.4; 2] }),
        com_offset: Some(Row { range: [0.05; 2] }),
        impulse: Some(Push {
            range: [0.5; 2],
            seconds: [0.06; 2], // every third step
        }),
        ..RandomizationConfig::table_one()
    };
    let mut fleet = seen(LISTS, &TaskConfig::default(), &table, 1, 3);
    let begun = fleet.critic_observations().to_vec();
    // Velocity 3, forces 2·2, contacts 2, friction, payload, offset 3, push 3.
    assert_eq!(begun.len(), 17);
    assert_eq!(begun[3..9], [0.0; 6], "nothing was felt yet");
    let mut forces_before = [0.0; 2];
    for t in 1..=4 {
        let out = step(&mut fleet, &[0.0; ACTION]);
        let row = fleet.critic_observations();
        // Table I blurs what the actor sees of velocities; the critic sees them as they are.
        assert_eq!(row[..3], *fleet.state(0).velocity_in_base().as_slice());
        assert_eq!(row[3..5], out.foot_forces[..]);
        // An episode's first frame stands for those before it.
        assert_eq!(row[5..7], forces_before);
        forces_before = [out.foot_forces[0], out.foot_forces[1]];
        let down = [0, 1].map(|side| f32::from(u8::from(out.foot_forces[side] > 20.0)));
        assert_eq!(row[7..9], down);
        assert_eq!(row[9..14], [0.6, 0.4, 0.05, 0.05, 0.05]);
        let push = row[14..17].iter().map(|x| x * x).sum::<f32>().sqrt();
        // (±0.5, ±0.5) m/s in whatever frame.
        let expected = if t == 3 { 0.5_f32.hypot(0.5) } else { 0.0 };
        assert!((push - expected).abs() < 1e-5, "step {t}: {push}");
    }
    fleet.push(0, [0.0, 0.25, 0.0]);
    step(&mut fleet, &[0.0; ACTION]);
    let push = &fleet.critic_observations()[14..17];
    let size = push.iter().map(|x| x * x).sum::<f32>().sqrt();
    assert!((size - 0.25).abs() < 1e-5, "{push:?}");
}

#[test]
fn a_held_command_shows_in_every_list_at_once() {
    let lists = "[actor]\nterms = ['command']\npast = 1\n[actor.term.command]\nscale = 2.0\n\
                 [critic]\nterms = ['height', 'command']";
    let task = TaskConfig::default();
    let mut fleet = seen(lists, &task, &RandomizationConfig::default(), 1, 3);
    fleet.hold_command(0, [0.5, 0.0, 0.25]);
    // Before the first step the first frame stands for those before it.
    let doubled = [1.0, 0.0, 0.5];
    assert_eq!(fleet.observations(), [doubled, doubled].concat());
    assert_eq!(fleet.critic_observations()[1..], [0.5, 0.0, 0.25]);
    step(&mut fleet, &[0.0; ACTION]);
    fleet.hold_command(0, [0.0; 3]);
    assert_eq!(fleet.observations(), [[0.0; 3], doubled].concat());
}

#[test]
fn what_is_measured_beside_is_of_the_step_and_its_command() {
    let task = TaskConfig {
        command: CommandConfig {
            resample_seconds: [0.02, 0.02], // a new command every step
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let blind = "[actor]\nterms = ['joint_velocity']\n[discriminator]\nterms = ['key_bodies']";
    let mut fleet = seen(blind, &task, &RandomizationConfig::table_one(), 1, 3);
    let command = fleet.command(0);
    let out = step(&mut fleet, &[0.1; ACTION]);
    assert_ne!(fleet.command(0), command);
    assert_eq!(out.measured[..3], command);
    let mut features = [0.0; FEATURES];
    observation::features(fleet.state(0), &mut features);
    assert_eq!(out.measured[3..3 + FEATURES], features);
    let gravity = fleet.state(0).projected_gravity();
    assert_eq!(out.measured[3 + FEATURES..], *gravity.as_slice());
    assert_eq!((out.next_features.len(), out.timeout_critic.len()), (15, 0));
}

#[test]
fn noise_of_a_list_is_not_for_robots_that_are_left_alone() {
    let noisy = "[actor]\nterms = ['height']\n[actor.term.height]\nnoise = 0.5\n\
                 [critic]\nterms = ['height']";
    let task = TaskConfig::default();
    let shares = |share: f32| {
        let table = RandomizationConfig {
            plain_share: share,
            ..RandomizationConfig::default()
        };
        let fleet = seen(noisy, &task, &table, 4, 3);
        fleet.observations() == fleet.critic_observations()
    };
    assert!(!shares(0.0) && shares(1.0));
}
