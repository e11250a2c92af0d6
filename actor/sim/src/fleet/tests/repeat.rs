//! The same bits: by seed, by place, and after a restart.

use super::*;

#[test]
fn same_seed_same_bits_whoever_else_is_in_the_fleet() {
    ENGINES.into_iter().for_each(same_bits);
}

fn same_bits(physics: Physics) {
    let (task, randomization) = eventful();
    let mut five = fleet_in(physics, &task, &randomization, 5, 11);
    let mut two = fleet_in(physics, &task, &randomization, 2, 11);
    let mut other = fleet_in(physics, &task, &randomization, 2, 12);
    assert_ne!(two.observations(), other.observations());
    let mut actions = Actions::new(1);
    let mut resets = 0;
    for _ in 0..60 {
        let asked = actions.draw(5, 1.0);
        let a = step(&mut five, &asked);
        let b = step(&mut two, &asked[..2 * ACTION]);
        step(&mut other, &asked[..2 * ACTION]);
        assert_eq!(five.observations()[..2 * OBSERVATION], *two.observations());
        assert_eq!(a.next_features[..2 * FEATURES], b.next_features);
        assert_eq!(a.energies[..2], b.energies);
        assert_eq!(a.foot_forces[..4], b.foot_forces);
        resets += b.ends.iter().filter(|end| **end != 0.0).count();
    }
    assert!(resets >= 4, "{resets}");
    // Environments of one fleet differ.
    let rows = five.observations().as_chunks::<OBSERVATION>().0;
    assert_ne!(rows[0], rows[1]);
}

#[test]
fn a_restored_fleet_continues_bit_by_bit_across_resets() {
    ENGINES.into_iter().for_each(continues);
}

fn continues(physics: Physics) {
    let (task, randomization) = eventful();
    let mut original = fleet_in(physics, &task, &randomization, 3, 5);
    let mut actions = Actions::new(2);
    for _ in 0..33 {
        step(&mut original, &actions.draw(3, 1.0));
    }
    let bytes = original.save();
    let mut restored = fleet_in(physics, &task, &randomization, 3, 99);
    restored.restore(&bytes).unwrap();
    assert_eq!(restored.observations(), original.observations());
    assert_eq!(restored.save(), bytes);
    for t in 0..60 {
        let asked = actions.draw(3, 1.0);
        assert_eq!(
            step(&mut original, &asked),
            step(&mut restored, &asked),
            "step {t}"
        );
        assert_eq!(original.observations(), restored.observations(), "step {t}");
        assert_eq!(original.features(), restored.features(), "step {t}");
    }
}

#[test]
fn bytes_that_do_not_fit_are_refused_and_change_nothing() {
    let (task, randomization) = eventful();
    let mut two = fleet(&task, &randomization, 2, 1);
    let three = fleet(&task, &randomization, 3, 1);
    let before = two.save();
    let error = two.restore(&three.save()).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("holds 3 environments, this fleet has 2")
    );
    assert!(error.is_of_another_fleet());
    let error = two.restore(&before[..100]).unwrap_err();
    assert!(matches!(error, SimError::Snapshot { bytes: 100, .. }));
    assert!(!error.is_of_another_fleet());
    assert_eq!(two.save(), before);
    let other = fleet_in(Physics::Batched, &task, &randomization, 2, 1);
    let error = two.restore(&other.save()).unwrap_err();
    let words = error.to_string();
    assert!(
        words.contains("in Batched") && words.contains("in Rapier"),
        "{words}"
    );
    assert!(error.is_of_another_fleet());
    assert_eq!(two.save(), before);
}
