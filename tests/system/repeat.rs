//! One seed, lock-step: the same bits on every run, whoever is faster.

use crate::harness::{Runs, bytes, metrics, without_timing};

#[test]
fn two_runs_of_one_seed_write_the_same_metrics_and_weights() {
    let runs = Runs::new();
    for name in ["one", "two"] {
        let mut group = runs.train(
            name,
            &["--actors", "2", "--iterations", "6", "--set", "seed=7"],
        );
        assert!(group.end().success(), "{}", group.stderr.text());
    }
    let lines = |name: &str| -> Vec<_> {
        metrics(&runs.run(name))
            .into_iter()
            .map(without_timing)
            .collect()
    };
    assert_eq!(lines("one").len(), 6);
    assert_eq!(lines("one"), lines("two"));
    let policy = |name: &str| bytes(&runs.run(name).join("checkpoints/00000006/policy.bin"));
    assert!(policy("one") == policy("two"), "weights differ");
}

#[test]
fn another_seed_is_another_run() {
    let runs = Runs::new();
    for (name, seed) in [("one", "seed=7"), ("two", "seed=8")] {
        let mut group = runs.train(name, &["--actors", "1", "--iterations", "2", "--set", seed]);
        assert!(group.end().success(), "{}", group.stderr.text());
    }
    let policy = |name: &str| bytes(&runs.run(name).join("checkpoints/00000002/policy.bin"));
    assert!(policy("one") != policy("two"), "the seed changes nothing");
}

#[test]
fn stopping_and_resuming_changes_no_bit() {
    let runs = Runs::new();
    let mut whole = runs.train("whole", &["--actors", "2", "--iterations", "8"]);
    assert!(whole.end().success(), "{}", whole.stderr.text());
    let mut first = runs.train("halves", &["--actors", "2", "--iterations", "4"]);
    assert!(first.end().success(), "{}", first.stderr.text());
    let mut second = runs.resume("halves", &["--iterations", "8"]);
    assert!(second.end().success(), "{}", second.stderr.text());

    let lines = |name: &str| -> Vec<_> {
        metrics(&runs.run(name))
            .into_iter()
            .map(without_timing)
            .collect()
    };
    for (whole, halves) in lines("whole").iter().zip(&lines("halves")) {
        assert_eq!(whole, halves);
    }
    let policy = |name: &str| bytes(&runs.run(name).join("checkpoints/00000008/policy.bin"));
    assert!(policy("whole") == policy("halves"), "weights differ");
}
