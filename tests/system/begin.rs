//! A run that begins with the policy of another, or with a shipped one.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::harness::{Runs, bytes, finish, metrics, program, repository};

#[test]
fn a_run_begins_with_the_policy_of_another_and_nothing_else() {
    let runs = Runs::new();
    let train = |name: &str, arguments: &[&str]| {
        let mut group = runs.train(name, &[&["--actors", "1"], arguments].concat());
        assert!(group.end().success(), "{}", group.stderr.text());
    };
    train("first", &["--iterations", "2"]);
    let once = ["--iterations", "1", "--set", "seed=9"];
    train("from", &[&once[..], &["--from", "first"]].concat());
    train("anew", &once);
    let policy = |name: &str, at: u64| -> Vec<f32> {
        let path = format!("checkpoints/{at:08}/policy.bin");
        let bytes = bytes(&runs.run(name).join(path));
        let numbers = bytes.as_chunks::<4>().0.iter();
        numbers.map(|number| f32::from_le_bytes(*number)).collect()
    };
    let first = policy("first", 2);
    let far = |name: &str| {
        let pairs = policy(name, 1).into_iter().zip(first.iter().copied());
        pairs.map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt()
    };
    let (from, anew) = (far("from"), far("anew"));
    assert!(from < 0.5 * anew, "{from} {anew}");
    assert_eq!(metrics(&runs.run("from"))[0]["iteration"], 1);
}

#[test]
fn a_run_begins_with_a_shipped_policy() {
    let runs = Runs::new();
    let mut group = runs.train("first", &["--actors", "1", "--iterations", "2"]);
    assert!(group.end().success(), "{}", group.stderr.text());
    let shipped = runs.path().join("shipped");
    let mut ship = Command::new(program("ampco"));
    ship.args(["export", "first", "--ship", "--runs-dir"])
        .arg(runs.path())
        .arg("--out")
        .arg(&shipped);
    let (success, _, said) = finish(ship);
    assert!(success, "{said}");
    let from = shipped.to_str().expect("text");
    let rest = ["--actors", "1", "--iterations", "1", "--from", from];
    let mut group = runs.train("from", &rest);
    assert!(group.end().success(), "{}", group.stderr.text());
    let kept = fs::read_to_string(runs.run("from").join("config.toml")).expect("kept");
    assert!(kept.contains("critic_first = 0.0"), "{kept}");
    let weights = |folder: &Path| bytes(&folder.join("policy.bin"));
    let learnt = weights(&runs.run("from").join("checkpoints/00000001"));
    assert!(learnt != weights(&shipped), "nothing was learnt");
}

#[test]
fn the_actor_of_a_policy_without_critic_waits() {
    let runs = Runs::new();
    // As policies were shipped before critics were.
    let whole = repository().join("deploy/policies/walk");
    let parts = ["policy.bin", "judge.bin"].map(|name| (name, bytes(&whole.join(name))));
    let parts = parts.each_ref().map(|(name, bytes)| (*name, &bytes[..]));
    let shipped = run::Checkpoints::new(runs.path().join("shipped"))
        .write(735, "shipped", &parts)
        .expect("written");
    fs::copy(whole.join("config.toml"), shipped.join("config.toml")).expect("copied");
    let from = shipped.to_str().expect("text");
    let hidden = [
        "--set",
        "policy.hidden=[256,128,64]",
        "--set",
        "policy.critic_hidden=[256,128,64]",
    ];
    let rest = ["--actors", "1", "--iterations", "1", "--from", from];
    let mut group = runs.train("from", &[&rest[..], &hidden].concat());
    assert!(group.end().success(), "{}", group.stderr.text());
    let kept = fs::read_to_string(runs.run("from").join("config.toml")).expect("kept");
    assert!(kept.contains("critic_first = 1000000.0"), "{kept}");
    // Statistics take the batch in, and σ is the run's own; the actor behind them is what was shipped.
    let learnt = bytes(&runs.run("from").join("checkpoints/00000001/policy.bin"));
    let given = bytes(&shipped.join("policy.bin"));
    let actor = 4 * (2 * 82 + 23);
    assert!(learnt[actor..] == given[actor..], "the actor has changed");
}
