//! The table adds up, and blocks do not overlap.

use super::*;

use g1::OBSERVATION;
use observation::ObservationConfig;

fn layout() -> RolloutLayout {
    RolloutLayout {
        environments: 3,
        steps: 2,
        lists: Lists::default(),
    }
}

#[test]
fn the_table_adds_up() {
    // 82 + 23 + 23 + six single numbers + 53 + 53 + 2 = 242 per step; 82 + 82 = 164 once.
    assert_eq!(layout().per_step(), 242);
    assert_eq!(layout().once(), 164);
    // 3·(2·242 + 164) = 3·648
    assert_eq!(layout().len(), 1944);
}

#[test]
fn blocks_follow_each_other_in_the_order_of_the_table() {
    let numbers: Vec<f32> = (0..layout().len()).map(|index| index as f32).collect();
    let view = layout().view(&numbers);
    assert_eq!(view.observations[0], 0.0);
    assert_eq!(view.actions[0], 492.0); // after 2·3·82
    assert_eq!(view.means[0], 630.0); // + 2·3·23
    assert_eq!(view.log_probs[0], 768.0); // + 2·3·23
    assert_eq!(view.features[0], 804.0); // + 6 blocks of 2·3
    assert_eq!(view.last_observations[0], 1452.0); // 2·3·242
    assert_eq!(view.timeout_observations[0], 1698.0); // + 3·82
    assert_eq!(view.timeout_observations[245], 1943.0); // the last of all
    // Second step of the actions: environment 0 begins 3·23 numbers later.
    assert_eq!(view.step(1).actions[0], 492.0 + 69.0);
    assert_eq!(view.step(1).actions.len(), 69);
}

#[test]
fn what_is_written_by_step_is_read_at_its_place_and_nothing_overlaps() {
    let mut numbers = vec![0.0; layout().len()];
    let mut view = layout().view_mut(&mut numbers);
    for step in 0..2 {
        let now = view.step(step);
        let blocks = [
            now.observations,
            now.actions,
            now.means,
            now.log_probs,
            now.task_rewards,
            now.energies,
            now.tracking_errors,
            now.ends,
            now.episode_steps,
            now.features,
            now.next_features,
            now.foot_forces,
        ];
        for (block, numbers) in blocks.into_iter().enumerate() {
            // Adding finds numbers that two blocks share.
            numbers
                .iter_mut()
                .for_each(|number| *number += (100 * step + block + 1) as f32);
        }
    }
    view.last_observations.fill(1000.0);
    view.timeout_observations.fill(2000.0);

    let view = layout().view(&numbers);
    assert!(view.step(0).observations.iter().all(|&n| n == 1.0));
    assert!(view.step(1).observations.iter().all(|&n| n == 101.0));
    assert!(view.step(1).ends.iter().all(|&n| n == 108.0)); // eighth block
    assert!(view.step(0).foot_forces.iter().all(|&n| n == 12.0)); // twelfth block
    assert!(view.last_observations.iter().all(|&n| n == 1000.0));
    assert!(view.timeout_observations.iter().all(|&n| n == 2000.0));
    assert!(
        numbers.iter().all(|&n| n != 0.0),
        "a number without a block"
    );
}

#[test]
fn numbers_that_cannot_be_are_found_and_named() {
    let flaw = |change: fn(&mut RolloutViewMut<'_>)| {
        let mut numbers = vec![0.0; layout().len()];
        change(&mut layout().view_mut(&mut numbers));
        let flaw = layout().view(&numbers).flaw();
        flaw.map(|flaw| (flaw.field, flaw.row))
    };
    assert_eq!(flaw(|_| {}), None);
    let nan = flaw(|view| view.observations[4 * OBSERVATION + 7] = f32::NAN);
    assert_eq!(nan, Some(("observations", 4)));
    let infinite = flaw(|view| view.task_rewards[5] = f32::NEG_INFINITY);
    assert_eq!(infinite, Some(("task_rewards", 5)));
    assert_eq!(flaw(|view| view.ends[2] = 5.0), Some(("ends", 2)));
    assert_eq!(flaw(|view| view.ends[2] = 2.5), Some(("ends", 2)));
    let known =
        |view: &mut RolloutViewMut<'_>| view.ends[..4].copy_from_slice(&[1.0, 2.0, 3.0, 4.0]);
    assert_eq!(flaw(known), None);
    let negative = flaw(|view| view.episode_steps[0] = -1.0);
    assert_eq!(negative, Some(("episode_steps", 0)));
    // Nothing timed out: these numbers mean nothing.
    assert_eq!(flaw(|view| view.timeout_observations.fill(f32::NAN)), None);
    let timed_out = flaw(|view| {
        view.ends[4] = 2.0; // second step, second environment
        view.timeout_observations[OBSERVATION] = f32::INFINITY;
    });
    assert_eq!(timed_out, Some(("timeout_observations", 1)));
}

#[test]
fn sizes_that_no_memory_holds_have_no_length() {
    let most = u32::MAX as usize;
    let huge = RolloutLayout {
        environments: most,
        steps: most,
        ..layout()
    };
    assert_eq!(huge.checked_len(), None);
    assert_eq!(layout().checked_len(), Some(layout().len()));
}

#[test]
#[should_panic(expected = "length of a rollout")]
fn a_message_of_another_length_is_refused() {
    layout().view(&[0.0; 7]);
}

#[test]
fn what_only_the_critic_sees_has_blocks_of_its_own() {
    let text = "[actor]\nterms = ['command', 'gravity']\n[critic]\nterms = ['actor', 'friction', 'foot_forces']";
    let config: ObservationConfig = toml::from_str(text).unwrap();
    let layout = RolloutLayout {
        lists: (&config.tables().unwrap()).into(),
        ..layout()
    };
    // 6 + 23 + 23 + six single numbers + 53 + 53 + 2 + 3 of the critic's own; 6 + 6 + 3 + 3 once.
    assert_eq!((layout.per_step(), layout.once()), (169, 18));
    let mut numbers = vec![0.0; layout.len()];
    let mut view = layout.view_mut(&mut numbers);
    view.step(1).critic.fill(1.0);
    view.last_critic.fill(2.0);
    view.timeout_critic[3] = f32::NAN;
    let view = layout.view(&numbers);
    assert_eq!((view.critic.len(), view.measured.len()), (2 * 3 * 3, 0));
    assert!(view.step(0).critic.iter().all(|&n| n == 0.0));
    assert!(view.step(1).critic.iter().all(|&n| n == 1.0));
    assert_eq!(numbers[layout.len() - 18..][..9], [2.0; 9]);
    // What the critic saw at a time-out counts where an episode timed out.
    assert_eq!(layout.view(&numbers).flaw(), None);
    layout.view_mut(&mut numbers).ends[4] = Cause::TimeOut.code();
    let flaw = layout.view(&numbers).flaw().unwrap();
    assert_eq!((flaw.field, flaw.row), ("timeout_critic", 1));
}
