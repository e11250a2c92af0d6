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

fn carried(number: u64) -> [Entry; 2] {
    [
        Entry::Passed((0, 100, number)),
        Entry::Carried((0, 100, number)),
    ]
}

/// What gate and carrier write of rollouts that all get through but those in `missing`, one after the other.
fn way(count: u64, missing: &[u64]) -> (Vec<Entry>, Vec<Entry>) {
    let (mut gate, mut carrier) = (vec![Entry::Passing(0)], vec![Entry::Carrying(0)]);
    for number in (0..count).filter(|number| !missing.contains(number)) {
        let [passed, carried] = carried(number);
        gate.push(passed);
        carrier.push(carried);
    }
    (gate, carrier)
}

fn learner(numbers: impl IntoIterator<Item = u64>) -> Vec<Entry> {
    let used = numbers
        .into_iter()
        .map(|number| used(7, number + 1, number));
    std::iter::once(Entry::Begun(7, 0)).chain(used).collect()
}

#[test]
fn what_vanishes_on_its_way_from_another_machine_while_everyone_lives_is_uncounted() {
    // Not even carried, although other carriers began before and after the gap.
    let (gate, mut carrier) = way(6, &[2]);
    carrier.insert(1, Entry::Carrying(0));
    carrier.push(Entry::Carrying(0));
    let account = account(&[sends(6), gate, carrier, learner([0, 1, 3, 4, 5])]);
    assert_eq!((account.used, account.uncounted), (5, 1));
}

#[test]
fn a_carrier_that_ends_takes_along_what_was_in_its_hands_and_no_more() {
    let missing: Vec<u64> = (2..10).collect();
    let (gate, mut carrier) = way(12, &missing);
    // It had brought 0 and 1.
    carrier.insert(3, Entry::Carrying(0));
    let account = account(&[sends(12), gate, carrier, learner([0, 1, 10, 11])]);
    assert_eq!((dropped(&account, "unread"), account.uncounted), (6, 2));
}

#[test]
fn a_gate_that_ends_excuses_what_it_had_passed_and_nothing_else() {
    let (mut gate, carrier) = way(6, &[]);
    gate.insert(4, Entry::Passing(0));
    // 2 was passed before the gate ended, 4 after.
    let account = account(&[sends(6), gate, carrier, learner([0, 1, 3, 5])]);
    assert_eq!((dropped(&account, "unread"), account.uncounted), (1, 1));
}

#[test]
fn what_was_acknowledged_and_never_passed_is_uncounted() {
    let (mut gate, carrier) = way(4, &[]);
    gate.retain(|entry| *entry != Entry::Passed((0, 100, 2)));
    gate.push(Entry::Passing(0));
    let account = account(&[sends(4), gate, carrier, learner([0, 1, 3])]);
    assert_eq!((account.used, account.uncounted), (3, 1));
}

#[test]
fn a_carrier_that_gives_a_rollout_up_says_so() {
    let (gate, mut carrier) = way(4, &[3]);
    carrier.push(Entry::Sent((0, 100, 3), "unheard".to_owned()));
    let account = account(&[sends(4), gate, carrier, learner([0, 1, 2])]);
    assert_eq!((dropped(&account, "unheard"), account.uncounted), (1, 0));
}
