//! Every key of a configuration against the rules of a resume.

mod runs;

use std::collections::BTreeSet;

use run::resume::{Rule, rule};
use toml::Value;

use super::*;

/// Everything that can be given and is not by default.
const OPTIONS: &str = "
[run]
from = '/a'
[ppo]
kl_target = { from = 0.03, to = 0.01, samples = [1.0, 2.0] }
mirrored_share = { from = 0.5, to = 0.0, samples = [1e6, 2e6] }
[discriminator]
command_blur = [0.1, 0.1, 0.1]
";

/// Keys that no resume may change.
const FIXED: [&str; 15] = [
    "discriminator.frames",
    "discriminator.hidden",
    "discriminator.loss",
    "discriminator.spacing",
    "exploration.kind",
    "observation.actor.past",
    "observation.actor.terms",
    "observation.critic.past",
    "observation.critic.terms",
    "observation.discriminator.terms",
    "policy.critic_hidden",
    "policy.hidden",
    "run.from",
    "run.seed",
    // Its presence.
    "discriminator.command_blur",
];

fn full() -> Config {
    let mut config = Config::parse(OPTIONS, "a test").unwrap();
    resolve::resolve(&mut config).unwrap();
    config
}

/// Another value of the same type.
fn other(value: &Value) -> Value {
    match value {
        Value::Integer(number) => (number + 1).into(),
        Value::Float(number) => (number + 1.0).into(),
        Value::Boolean(yes) => (!yes).into(),
        Value::String(text) => format!("{text}-other").into(),
        Value::Array(list) => list
            .iter()
            .chain(list.first())
            .cloned()
            .collect::<Vec<_>>()
            .into(),
        other => panic!("no leaf: {other}"),
    }
}

#[test]
fn every_key_may_change_or_is_refused_by_name() {
    let before = full();
    let mut fixed = BTreeSet::new();
    for (path, value) in before.leaves() {
        assert!(rule(&path).is_some(), "{path} has no rule");
        let mut after = before.clone();
        after.put(&path, other(&value), "a test");
        let checked = resume::check(&before, &after, || false);
        match checked {
            Ok(changes) => assert_eq!((changes.len(), &changes[0].path), (1, &path)),
            Err(refused) => {
                let words = refused.to_string();
                assert!(words.contains(&format!("{path}: ")), "{words}");
                fixed.insert(path.clone());
            }
        }
        // Taken away or added is a change as well.
        let mut without = before.clone();
        without.remove(&path);
        for (a, b) in [(&before, &without), (&without, &before)] {
            let refused = resume::check(a, b, || false).is_err();
            assert_eq!(refused, FIXED.contains(&path.as_str()), "{path}");
        }
    }
    let expected: BTreeSet<String> = FIXED[..14].iter().map(ToString::to_string).collect();
    assert_eq!(fixed, expected);
}

#[test]
fn what_the_switch_was_decided_by_is_fixed_after_it() {
    let before = full();
    let mut count = 0;
    for (path, value) in before.leaves() {
        let mut after = before.clone();
        after.put(&path, other(&value), "a test");
        let in_one = resume::check(&before, &after, || false).is_ok();
        let in_two = resume::check(&before, &after, || true).is_ok();
        let decides = path.starts_with("scheduler.");
        assert_eq!(in_one && !in_two, decides, "{path}");
        count += usize::from(decides);
    }
    assert!(count >= 7, "{count} keys of the scheduler");
}

#[test]
fn every_key_of_learning_has_a_rule_of_its_own() {
    // What a new key of these means to a checkpoint has to be thought about.
    for section in ["run", "policy", "exploration", "ppo", "discriminator"] {
        assert_eq!(rule(&format!("{section}.new_key")), None, "{section}");
    }
    assert_eq!(rule("task.new_key"), Some(Rule::Free));
}
