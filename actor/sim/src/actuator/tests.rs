//! Motors by hand: torques, limits and work.

use super::*;
use crate::engine::Engine;
use crate::model::Variation;
use crate::world::{PHYSICS_STEP, World};
use g1::RobotState;

/// In the air, so that nothing but the motors and gravity acts.
fn hanging() -> World {
    let mut world = World::new(&Variation::NOMINAL);
    let mut state = RobotState::standing();
    state.position.z += 3.0;
    world.set_state(&state);
    world
}

#[test]
fn zero_action_asks_for_the_default_pose() {
    assert_eq!(targets(&[0.0; JOINTS]), DEFAULT_POSE);
    let mut action = [0.0; JOINTS];
    action[3] = -2.0; // left knee: 0.3 − 0.25·2
    assert!((targets(&action)[3] + 0.2).abs() < 1e-6);
}

#[test]
fn torque_is_stiffness_times_error_less_damping_times_speed() {
    let mut world = hanging();
    let mut goal = DEFAULT_POSE;
    goal[3] += 0.1; // knee, 150 N·m/rad: 15 N·m
    goal[16] += 2.0; // elbow, 40 N·m/rad: 80 N·m asked, 25 given
    let gains = Gains::of_the_robot();
    let torques = drive(Law::Table(&gains), &goal, world.multibody_mut());
    assert!((torques.of(3, 0.0) - 15.0).abs() < 1e-3);
    assert!((torques.of(3, 0.5) - 13.0).abs() < 1e-3); // 15 − 4·0.5
    assert_eq!(torques.of(16, 0.0), 25.0);
    assert_eq!(torques.of(16, 9.0), 25.0); // saturated: constant over the step
    assert_eq!(torques.of(0, 0.0), 0.0);
}

#[test]
fn the_torque_that_is_told_is_the_one_that_acted() {
    // Momentum of the whole robot about the knee's motor: with two runs from the same state,
    // one with and one without current in one joint, the work told must equal the difference in
    // what the physics gained. Told work τ·q̇⁺·dt against ½·q̇⁺·(I_eff·q̇⁺): from rest,
    // τ·dt = I_eff·q̇⁺ with I_eff = 1/(M⁻¹)ᵢᵢ.
    let mut world = hanging();
    let mut engine = Engine::new();
    let mut gains = Gains::of_the_robot();
    gains.damping = [0.0; JOINTS];
    for i in 0..JOINTS {
        if i != 3 {
            gains.stiffness[i] = 0.0;
        }
    }
    let mut goal = DEFAULT_POSE;
    goal[3] += 0.02; // 150·0.02 = 3 N·m
    let told = world.physics_step(&mut engine, &gains, &goal).energy;
    let speed = world.state().joint_velocities[3];
    assert!((told - 3.0 * speed * PHYSICS_STEP).abs() < 1e-6 * told.abs().max(1.0));
    let effective = 3.0 * PHYSICS_STEP / speed;
    // The shank and foot about the knee weigh about 0.1 kg·m², less what the thigh gives way.
    assert!((0.02..0.2).contains(&effective), "{effective} kg·m²");
    let unit = world.multibody().inv_augmented_mass();
    let mut column = nalgebra::DVector::zeros(BASE_DEGREES + JOINTS);
    column[BASE_DEGREES + 3] = 1.0;
    unit.solve_mut(&mut column);
    let expected = 1.0 / column[BASE_DEGREES + 3];
    assert!(
        (effective - expected).abs() < 0.02 * expected,
        "{effective} {expected}"
    );
}

#[test]
fn limits_are_used_in_shares() {
    let mut world = hanging();
    let mut state = world.state();
    state.joint_velocities[12] = 3.2; // waist, of at most 32 rad/s
    world.set_state(&state);
    let mut gains = Gains::of_the_robot();
    gains.stiffness[12] = 0.0;
    gains.damping = [0.0; JOINTS]; // the torque below is the one at the step's start
    let mut goal = DEFAULT_POSE;
    goal[3] += 0.278; // knee: 150·0.278 = 41.7 N·m, 0.3 of 139
    goal[16] += 2.0; // elbow: 80 asked, all of its 25 given
    let mut engine = Engine::new();
    let step = world.physics_step(&mut engine, &gains, &goal);
    assert!((step.torque_use[3] - 0.3).abs() < 1e-4);
    assert_eq!(step.torque_use[16], 1.0);
    assert!(step.torque_use[12] < 1e-6);
    let waist = world.state().joint_velocities[12];
    assert!(waist > 1.0 && (step.speed_use[12] - waist / 32.0).abs() < 1e-6);
    // A control step remembers its greatest: the knee asks for less and less on its way.
    let whole = world.control_step(&mut engine, &gains, &goal);
    let last = world.physics_step(&mut engine, &gains, &goal);
    assert!(whole.torque_use[3] > last.torque_use[3]);
}

#[test]
fn braking_costs_nothing() {
    let mut world = hanging();
    let mut state = world.state();
    state.joint_velocities[12] = 2.0; // waist turning
    world.set_state(&state);
    let mut gains = Gains::of_the_robot();
    gains.stiffness = [0.0; JOINTS]; // pure dampers only ever take energy
    let exertion = world.physics_step(&mut Engine::new(), &gains, &DEFAULT_POSE);
    assert_eq!(exertion.energy, 0.0);
    assert!(world.state().joint_velocities[12] < 2.0);
}
