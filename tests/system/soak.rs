//! The short form of a soak: a few kills at random, and nothing lost.

use std::process::Command;

use serde_json::Value;

use crate::harness::{Runs, finish, program};

#[test]
fn a_few_kills_lose_nothing_and_leave_nothing() {
    soak(&[]);
}

#[test]
fn nor_do_a_few_kills_on_two_machines() {
    soak(&["--hosts", "1", "--actors", "1"]);
}

fn soak(arguments: &[&str]) {
    let runs = Runs::new();
    let mut command = Command::new(program("ampco"));
    command
        .args(["soak", "--kills", "8", "--seed", "3", "--runs-dir"])
        .arg(runs.path())
        .args(arguments);
    let (_, out, said) = finish(command);
    let last = out.lines().last().unwrap_or_else(|| panic!("{said}"));
    let outcome: Value = serde_json::from_str(last).expect("JSON");
    let mut keys: Vec<&str> = outcome
        .as_object()
        .expect("an object")
        .keys()
        .map(String::as_str)
        .collect();
    keys.sort_unstable();
    let expected = [
        "dropped",
        "kills",
        "left_bytes",
        "restarts",
        "sent",
        "uncounted",
        "used",
        "whole_seconds_max",
    ];
    assert_eq!(keys, expected);
    assert_eq!(outcome["kills"], 8, "{said}");
    assert!(outcome["restarts"].as_u64() >= Some(8), "{outcome}");
    assert_eq!(outcome["uncounted"], 0, "{outcome}");
    assert_eq!(outcome["left_bytes"], 0, "{outcome}");
    assert!(outcome["used"].as_u64() > Some(0), "{outcome}");
    let dropped = outcome["dropped"].as_object().expect("by reason");
    let dropped: u64 = dropped.values().filter_map(Value::as_u64).sum();
    let used = outcome["used"].as_u64().expect("a number");
    assert_eq!(outcome["sent"].as_u64(), Some(used + dropped), "{outcome}");
    assert!(!said.contains("although there was checkpoint"), "{said}");
    assert!(!said.contains("still alive"), "{said}");
    // The promise of 5 s is for a machine that does nothing else; here twenty tests run beside it.
    let longest = outcome["whole_seconds_max"].as_f64().expect("a number");
    assert!(longest < 60.0, "{outcome} {said}");
}
