//! Robots keep to their kind of command from episode to episode.

use sim::{
    CommandConfig, Fleet, Kind, KindsConfig, Physics, RandomizationConfig, Starts, StepRows,
    TaskConfig, TerminationConfig, TimeOutConfig,
};

#[test]
fn every_episode_of_a_robot_begins_with_its_kind() {
    let task = TaskConfig {
        termination: TerminationConfig {
            time_out: TimeOutConfig {
                steps: 3,
                ..TimeOutConfig::default()
            },
            ..TerminationConfig::default()
        },
        command: CommandConfig {
            forward: [-0.5, 1.0].into(),
            lateral: [-0.4, 0.4].into(),
            matched_share: 0.5.into(),
            kinds: Some(KindsConfig {
                standing: 1.0,
                forward: 2.0,
                lateral: 1.0,
                ..KindsConfig::default()
            }),
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let standing = g1::RobotState::standing();
    // No motion of lateral kind: such robots begin standing, and still go aside.
    let starts: Starts = [(standing, [0.7, 0.0, 0.0], 1.0), (standing, [0.0; 3], 1.0)]
        .into_iter()
        .collect();
    let mut fleet = Fleet::new(
        Physics::Batched,
        &task,
        &RandomizationConfig::default(),
        starts,
        8,
        1,
    )
    .unwrap();
    let mut rows = StepRows::of(&fleet, 0.0);
    let expected = [
        Kind::Standing,
        Kind::Standing,
        Kind::Forward,
        Kind::Forward,
        Kind::Forward,
        Kind::Forward,
        Kind::Lateral,
        Kind::Lateral,
    ];
    let (mut matched, mut drawn) = (0, 0);
    for _ in 0..30 {
        for (robot, kind) in expected.into_iter().enumerate() {
            let command = fleet.command(robot);
            assert_eq!(Kind::of(command), kind, "robot {robot}: {command:?}");
            if kind == Kind::Forward {
                *(if command[0] == 0.7 {
                    &mut matched
                } else {
                    &mut drawn
                }) += 1;
            }
        }
        fleet.step(&[0.0; 8 * g1::ACTION], &mut rows.out());
    }
    assert!(
        matched > 0 && drawn > 0,
        "{matched} of the motion's speed, {drawn} others"
    );
}
