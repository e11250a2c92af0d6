//! The robot against itself: legs and arms that meet, in the air and by their motors.

use super::tests::{lifted, limp};
use super::*;
use crate::model::Variation;
use g1::collision::nearest;
use g1::{DEFAULT_POSE, joints};

/// Rolls of the hips: the left one's negative side is inward, the right one's positive.
const ROLLS: [usize; 2] = [joints::LEFT_LEG + 1, joints::RIGHT_LEG + 1];

fn inward(angle: f32) -> RobotState {
    let mut state = lifted(20.0);
    state.joint_positions[ROLLS[0]] = -angle;
    state.joint_positions[ROLLS[1]] = angle;
    state
}

fn robot(state: &RobotState, self_collision: bool) -> World {
    let mut world = World::with_self_collision(&Variation::NOMINAL, self_collision);
    world.set_state(state);
    world
}

/// The smallest gap after a second of motors that roll the hips inward, m.
fn driven(self_collision: bool) -> f32 {
    let mut targets = DEFAULT_POSE;
    targets[ROLLS[0]] = -0.5;
    targets[ROLLS[1]] = 0.5;
    let mut world = robot(&inward(0.0), self_collision);
    let mut engine = Engine::new();
    for _ in 0..50 {
        world.control_step(&mut engine, &Gains::of_the_robot(), &targets);
    }
    assert!(world.is_sound());
    nearest(&world.state()).1
}

#[test]
fn legs_that_are_driven_into_each_other_stop_at_each_other() {
    // Motors ask 100 N·m/rad of what is left of half a radian: some 100 N at the shins.
    let (meeting, passing) = (driven(true), driven(false));
    assert!((-0.01..0.01).contains(&meeting), "{meeting} m");
    assert!(passing < -0.05, "{passing} m");
}

#[test]
fn what_meets_is_parted_and_the_robot_as_a_whole_is_not_pushed() {
    let state = inward(0.2);
    assert!(nearest(&state).1 < -0.01);
    let after = |self_collision| {
        let mut world = robot(&state, self_collision);
        let mut engine = Engine::new();
        world.control_step(&mut engine, &limp(), &DEFAULT_POSE);
        world.state()
    };
    let (meeting, passing) = (after(true), after(false));
    let [left, right] = ROLLS.map(|i| meeting.joint_velocities[i] - passing.joint_velocities[i]);
    assert!(left > 0.05, "{left} rad/s outward");
    // Mirrored, but for the order in which one sweep takes shin against shin and shin against foot.
    assert!((left + right).abs() < 0.1 * left, "{left} {right}");
    // Nothing outside acts but gravity: the centre of mass falls as before.
    let centre = |state: &RobotState| {
        g1::kinematics::centre_of_mass(&g1::kinematics::forward_state(state)).coords
    };
    let moved = (centre(&meeting) - centre(&passing)).norm();
    assert!(moved < 1e-4, "{moved} m");
}

#[test]
fn what_does_not_meet_has_the_same_bits_with_and_without() {
    let stand = |self_collision| {
        let mut world = robot(&RobotState::standing(), self_collision);
        let mut engine = Engine::new();
        for _ in 0..25 {
            world.control_step(&mut engine, &Gains::of_the_robot(), &DEFAULT_POSE);
        }
        world.state()
    };
    assert_eq!(stand(true), stand(false));
}

#[test]
fn a_copy_goes_on_bit_by_bit_while_parts_meet() {
    let mut targets = DEFAULT_POSE;
    targets[ROLLS[0]] = -0.5;
    let mut engine = Engine::new();
    let gains = Gains::of_the_robot();
    let mut world = robot(&inward(0.15), true);
    for _ in 0..10 {
        world.control_step(&mut engine, &gains, &targets);
    }
    assert!(nearest(&world.state()).1 < 0.01);
    let bytes = bincode::serde::encode_to_vec(&world, bincode::config::standard()).unwrap();
    let (mut copy, _): (World, usize) =
        bincode::serde::decode_from_slice(&bytes, bincode::config::standard()).unwrap();
    for step in 0..50 {
        world.control_step(&mut engine, &gains, &targets);
        copy.control_step(&mut Engine::new(), &gains, &targets);
        assert_eq!(world.state(), copy.state(), "step {step}");
    }
}

#[test]
fn an_arm_meets_the_trunk() {
    // The upper arm pulled in and the forearm turned across the chest.
    let mut targets = DEFAULT_POSE;
    targets[joints::LEFT_ARM + 1] = -0.6;
    targets[joints::LEFT_ARM + 2] = -1.0;
    let after = |self_collision| {
        let mut world = robot(&lifted(20.0), self_collision);
        let mut engine = Engine::new();
        for _ in 0..75 {
            world.control_step(&mut engine, &Gains::of_the_robot(), &targets);
        }
        nearest(&world.state())
    };
    let (pair, passing) = after(false);
    assert_eq!(g1::collision::names(pair), ["left forearm", "trunk"]);
    assert!(passing < -0.02, "{passing} m");
    let (_, meeting) = after(true);
    assert!(meeting > -0.01, "{meeting} m");
}
