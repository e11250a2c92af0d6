//! What a step writes, and when.

use super::*;

#[test]
fn features_go_from_step_to_step_and_stop_at_an_episodes_end() {
    let (task, _) = eventful();
    let randomization = RandomizationConfig::default();
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
    let mut fleet = fleet(&task, &RandomizationConfig::default(), 2, 8);
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
fn the_last_step_is_told_also_where_an_episode_ended() {
    let (mut task, _) = eventful();
    task.termination = of_steps(3, false);
    let mut fleet = fleet(&task, &RandomizationConfig::default(), 2, 4);
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
