//! Through bytes and back: a whole learner, its policy alone, a shipped one.

use super::*;

#[test]
fn a_saved_state_continues_bit_by_bit() {
    let mut straight = learning();
    let expected = run(&mut straight, 0, 6);
    let mut before = learning();
    run(&mut before, 0, 3);
    let mut after = Learning::new(config(), simple(), 999).expect("usable");
    after.load(&before.save()).expect("the same sizes");
    assert_eq!((after.iteration(), after.samples()), (3, 180));
    assert_eq!(run(&mut after, 3, 6), expected);
    assert_eq!(after.save(), straight.save());
}

#[test]
fn a_policy_is_taken_over_alone() {
    let mut walker = learning();
    run(&mut walker, 0, 3);
    let mut other = Learning::new(config(), simple(), 999).expect("usable");
    let judge = other.save_judge();
    other.load_policy(&walker.save()).expect("the same sizes");
    assert_eq!(other.policy_flat()[..100], walker.policy_flat()[..100]); // statistics and first weights
    assert_eq!(other.save_judge(), judge);
    assert_eq!((other.iteration(), other.samples()), (0, 0));
    let before = other.save();
    assert!(other.load_policy(&before[1..]).is_err());
    assert_eq!(other.save(), before);
}

#[test]
fn a_snapshot_begins_with_its_actor_and_its_statistics() {
    let mut walker = learning();
    run(&mut walker, 0, 3);
    let snapshot = walker.policy_flat().to_vec();
    let mut other = Learning::new(config(), simple(), 999).expect("usable");
    let before = other.save();
    let theirs = walker.critic().to_vec();
    assert!(other.load_snapshot(&snapshot[1..], None).is_err());
    assert!(other.load_snapshot(&snapshot, Some(&theirs[1..])).is_err());
    assert_eq!(other.save(), before);
    other
        .load_snapshot(&snapshot, None)
        .expect("the same sizes");
    for (found, expected) in other.policy_flat().iter().zip(&snapshot) {
        assert!(
            (found - expected).abs() <= 1e-6 * expected.abs(),
            "{found} {expected}"
        );
    }
    assert_ne!(other.critic(), theirs);
    other
        .load_snapshot(&snapshot, Some(&theirs))
        .expect("the same sizes");
    assert_eq!(other.critic(), theirs);
    assert_eq!((other.iteration(), other.samples()), (0, 0));
    assert_eq!(other.core.ppo.rate(), crate::config::LEAST_RATE);
}

#[test]
fn the_critic_learns_first_and_the_actor_begins_gently() {
    let mut config = config();
    // An iteration is 60 rows: the actor waits in the first two.
    config.ppo.critic_first = 61.0;
    let (rate, least) = (config.ppo.learning_rate, crate::config::LEAST_RATE);
    let mut learning = Learning::new(config, simple(), 1).expect("usable");
    let weights = |learning: &Learning| {
        let ppo = &learning.core.ppo;
        (ppo.actor().to_vec(), ppo.critic().to_vec())
    };
    let first = weights(&learning);
    run(&mut learning, 0, 1);
    assert_eq!(learning.core.ppo.rate(), rate);
    run(&mut learning, 1, 2);
    let second = weights(&learning);
    assert_eq!(second.0, first.0);
    assert_ne!(second.1, first.1);
    assert_eq!(learning.core.ppo.rate(), least);
    run(&mut learning, 2, 3);
    assert_ne!(weights(&learning).0, first.0);
}

#[test]
fn a_state_of_other_sizes_is_refused_by_name() {
    let saved = learning().save();
    let mut other = config();
    other.policy.critic_hidden = vec![17];
    let mut other = Learning::new(other, simple(), 1).expect("usable");
    let before = other.save();
    assert_eq!(
        other.load(&saved).expect_err("16 is not 17").to_string(),
        "tensor `critic.layers.0.weight` is critic.layers.0.weight [82, 16] in the saved state and \
         critic.layers.0.weight [82, 17] in the configuration"
    );
    assert!(other.load(&saved[..saved.len() - 1]).is_err());
    assert!(other.load(&[saved.as_slice(), &[0]].concat()).is_err());
    assert!(other.load(b"").is_err());
    assert_eq!(other.save(), before);
}
