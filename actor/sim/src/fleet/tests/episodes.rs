//! Where episodes begin and how they end.

use super::*;
use crate::fleet::make::Make;
use ::observation::Tables;
use nalgebra::UnitQuaternion;
use std::f32::consts::FRAC_PI_3;
use vocabulary::Ramp;

#[test]
fn timeouts_are_staggered_and_then_a_full_episode_apart() {
    let task = TaskConfig {
        start: StartConfig {
            reference_share: 0.0.into(),
            ..StartConfig::default()
        },
        ..TaskConfig::default()
    };
    let count = |staggered: bool| {
        let task = TaskConfig {
            termination: of_steps(12, staggered),
            ..task.clone()
        };
        let mut fleet = fleet(&task, &RandomizationConfig::default(), 6, 2);
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
    let none = RandomizationConfig::default();
    let make = Make {
        mechanics: Physics::Rapier.into(),
        gains,
        tables: Tables::default(),
    };
    let mut fleet = Fleet::build(make, &task, &none, Starts::default(), 1, 4).unwrap();
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
fn every_end_tells_its_cause() {
    ENGINES.into_iter().for_each(tells_causes);
}

fn tells_causes(physics: Physics) {
    // Told to walk at 1 m/s: a robot that stands is a fifth of it off after one step of a mean over 0.1 s, and 0.05 is allowed.
    let strict = TaskConfig {
        command: CommandConfig {
            forward: [1.0, 1.0].into(),
            ..CommandConfig::default()
        },
        start: StartConfig {
            reference_share: 0.0.into(),
            ..StartConfig::default()
        },
        termination: TerminationConfig {
            stray: Some(StrayConfig {
                share: 0.0.into(),
                least: 0.05.into(),
                seconds: 0.1,
                grace: 0.0,
                ..StrayConfig::default()
            }),
            ..of_steps(1, false)
        },
        ..TaskConfig::default()
    };
    let lenient = TaskConfig {
        termination: of_steps(1, false),
        ..strict.clone()
    };
    let mut leaning = RobotState::standing();
    leaning.orientation = UnitQuaternion::from_euler_angles(0.0, FRAC_PI_3, 0.0);
    let end = |task: &TaskConfig, state: &RobotState, action: f32| {
        let mut fleet = fleet_in(physics, task, &RandomizationConfig::default(), 1, 4);
        let _ = fleet.bodies.begin(0, &Variation::NOMINAL, state);
        step(&mut fleet, &[action; ACTION]).ends[0]
    };
    let standing = RobotState::standing();
    // The time is up in all of these: what a robot did itself comes first, and a fall before all that follows from it.
    for (task, state, action, cause) in [
        (&lenient, &standing, 0.0, Cause::TimeOut),
        (&strict, &standing, 0.0, Cause::Stray),
        (&lenient, &leaning, 0.0, Cause::Fall),
        (&strict, &leaning, 0.0, Cause::Fall),
        (&strict, &standing, f32::NAN, Cause::Fault),
    ] {
        assert_eq!(
            end(task, state, action),
            cause.code(),
            "{physics:?} {cause:?}"
        );
    }
}

#[test]
fn starts_match_their_clip_in_the_share_asked_for() {
    for share in [0.0, 1.0] {
        let task = TaskConfig {
            command: CommandConfig {
                forward: [1.0, 1.2].into(),
                matched_share: Ramp::Constant(share),
                ..CommandConfig::default()
            },
            ..TaskConfig::default()
        };
        let fleet = fleet(&task, &RandomizationConfig::default(), 20, 1);
        for i in 0..20 {
            assert_eq!(fleet.command(i) == [0.8, 0.0, 0.0], share == 1.0);
        }
    }
}
