//! Fleets whose robots' legs are driven into each other, in both engines.

use g1::collision::nearest;
use g1::{ACTION, RobotState, joints};
use sim::{
    CommandConfig, FallConfig, Fleet, Mechanics, Physics, RandomizationConfig, StartConfig, Starts,
    StepRows, TaskConfig, TerminationConfig,
};

const ROBOTS: usize = 3;

/// Robots far above the ground that no fall ends.
fn fleet(physics: Physics, self_collision: bool) -> Fleet {
    let task = TaskConfig {
        termination: TerminationConfig {
            fall: FallConfig {
                height: 0.0,
                upright: -1.0,
            },
            ..TerminationConfig::default()
        },
        start: StartConfig {
            reference_share: 1.0.into(),
            lift: 0.0,
            position_noise: 0.0,
            velocity_noise: 0.0,
        },
        command: CommandConfig {
            matched_share: 1.0.into(),
            ..CommandConfig::default()
        },
        ..TaskConfig::default()
    };
    let mut start = RobotState::standing();
    start.position.z = 20.0;
    let starts: Starts = [(start, [0.0; 3], 1.0)].into_iter().collect();
    let mechanics = Mechanics {
        physics,
        self_collision,
    };
    let plain = RandomizationConfig::default();
    Fleet::new(mechanics, &task, &plain, starts, ROBOTS, 1).unwrap()
}

/// Rolls both hips inward for so many control steps.
fn squeeze(fleet: &mut Fleet, steps: usize) {
    let mut action = [0.0; ACTION];
    action[joints::LEFT_LEG + 1] = -0.5 / g1::ACTION_SCALE;
    action[joints::RIGHT_LEG + 1] = 0.5 / g1::ACTION_SCALE;
    let actions = [action; ROBOTS].concat();
    let mut rows = StepRows::of(fleet, 0.0);
    for _ in 0..steps {
        fleet.step(&actions, &mut rows.out());
    }
}

#[test]
fn legs_stop_at_each_other_unless_told_to_pass() {
    for physics in [Physics::Rapier, Physics::Batched] {
        let after = |self_collision| {
            let mut fleet = fleet(physics, self_collision);
            squeeze(&mut fleet, 40);
            nearest(fleet.state(0)).1
        };
        // At rest against each other after the blow.
        let (meeting, passing) = (after(true), after(false));
        assert!(meeting > -0.005, "{physics:?}: {meeting} m");
        assert!(passing < -0.05, "{physics:?}: {passing} m");
    }
}

#[test]
fn a_fleet_saved_while_legs_meet_goes_on_bit_by_bit() {
    for physics in [Physics::Rapier, Physics::Batched] {
        let mut saved = fleet(physics, true);
        squeeze(&mut saved, 15);
        assert!(nearest(saved.state(0)).1 < 0.01, "{physics:?}");
        let mut other = fleet(physics, true);
        other.restore(&saved.save()).unwrap();
        squeeze(&mut saved, 15);
        squeeze(&mut other, 15);
        for robot in 0..ROBOTS {
            assert_eq!(saved.state(robot), other.state(robot), "{physics:?}");
        }
    }
}
