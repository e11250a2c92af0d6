//! Accounts of short journals, by hand.

use super::*;

/// An actor that sends 0 to `count` − 1, all delivered.
fn sends(count: u64) -> Vec<Entry> {
    (0..count)
        .flat_map(|number| {
            let key = (0, 100, number);
            [
                Entry::Sending(key),
                Entry::Sent(key, "delivered".to_owned()),
            ]
        })
        .collect()
}

fn used(learner: u64, iteration: u64, number: u64) -> Entry {
    Entry::Received(learner, iteration, (0, 100, number), "used".to_owned())
}

fn dropped(account: &Account, reason: &str) -> u64 {
    account.dropped.get(reason).copied().unwrap_or(0)
}

#[test]
fn a_rollout_that_vanishes_while_everyone_lives_is_uncounted() {
    let learner = vec![Entry::Begun(7, 0), used(7, 1, 0), used(7, 2, 2)];
    let account = account(&[sends(3), learner]);
    assert_eq!((account.sent, account.used, account.uncounted), (3, 2, 1));
    assert!(account.dropped.is_empty());
}

#[test]
fn a_killed_learner_takes_along_what_it_has_not_saved_and_what_lies_in_its_buffer() {
    // Killed in iteration 3 with a checkpoint of 1; rollouts 3 and 4 lay in its buffer.
    let learner = vec![
        Entry::Begun(7, 0),
        used(7, 1, 0),
        used(7, 2, 1),
        used(7, 3, 2),
        Entry::Begun(8, 1),
        used(8, 2, 5),
    ];
    let account = account(&[sends(6), learner]);
    assert_eq!((account.sent, account.used, account.uncounted), (6, 2, 0));
    assert_eq!(dropped(&account, "rolled_back"), 2);
    assert_eq!(dropped(&account, "unread"), 2);
}

#[test]
fn no_death_excuses_more_than_was_under_way() {
    let learner = vec![
        Entry::Begun(7, 0),
        used(7, 1, 0),
        Entry::Begun(8, 1),
        used(8, 2, 6),
    ];
    // 1 to 5 are missing, and four can have been under way.
    let account = account(&[sends(7), learner]);
    assert_eq!((dropped(&account, "unread"), account.uncounted), (4, 1));
}

#[test]
fn learned_from_twice_is_uncounted_and_a_repetition_that_was_left_is_not() {
    let again = |fate: &str| Entry::Received(7, 2, (0, 100, 0), fate.to_owned());
    let learner = |fate| vec![Entry::Begun(7, 0), used(7, 1, 0), again(fate)];
    let twice = account(&[sends(1), learner("used")]);
    assert_eq!((twice.used, twice.uncounted), (0, 1));
    let once = account(&[sends(1), learner("duplicate")]);
    assert_eq!((once.used, once.uncounted), (1, 0));
}

#[test]
fn what_actors_and_learner_give_up_has_its_reason() {
    let actor = vec![
        Entry::Sending((0, 100, 0)),
        Entry::Sent((0, 100, 0), "unheard".to_owned()),
        Entry::Sending((0, 100, 1)),
        Entry::Sent((0, 100, 1), "full".to_owned()),
        Entry::Sending((0, 100, 2)),
        Entry::Sent((0, 100, 2), "delivered".to_owned()),
        Entry::Sending((0, 100, 3)), // killed while sending
    ];
    let stale = Entry::Received(7, 1, (0, 100, 2), "stale".to_owned());
    let account = account(&[actor, vec![Entry::Begun(7, 0), stale]]);
    assert_eq!((account.sent, account.used, account.uncounted), (4, 0, 0));
    for reason in ["unheard", "full", "stale", "unread"] {
        assert_eq!(dropped(&account, reason), 1, "{reason}");
    }
}
