//! What broke ends its episode and goes no further.

use super::*;

#[test]
fn broken_numbers_reset_and_never_leave() {
    ENGINES.into_iter().for_each(resets_what_broke);
}

fn resets_what_broke(physics: Physics) {
    let (task, randomization) = eventful();
    let mut fleet = fleet_in(physics, &task, &randomization, 2, 1);
    let mut asked = vec![0.0; 2 * ACTION];
    asked[5] = f32::NAN;
    let out = step(&mut fleet, &asked);
    assert_eq!((out.ends[0], out.ends[1]), (Cause::Fault.code(), 0.0));
    assert_eq!(fleet.faults(), 1);
    // An action large enough to overflow f32 inside the physics.
    asked[5] = 0.0;
    let mut state = *fleet.state(1);
    state.joint_velocities[2] = f32::INFINITY;
    let _ = fleet.bodies.begin(1, &Variation::NOMINAL, &state);
    let broken = step(&mut fleet, &asked);
    assert_eq!(broken.ends[1], Cause::Fault.code());
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
    let (task, randomization) = eventful();
    let mut fleet = fleet_in(physics, &task, &randomization, 4, 13);
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
