//! Actors come and go while a run goes on.

use std::process::Command;

use protocol::{Domain, Node, Shutdown, WeightsSubscriber};
use rustix::process::Signal;
use serde_json::Value;

use crate::harness::{Process, Runs, holder, metrics, own_memory, program, until, until_iteration};

/// Starts actors `from` to `to` − 1 of a running group.
fn join(runs: &Runs, name: &str, from: u32, to: u32) -> Vec<Process> {
    let start = |index: u32| {
        let mut command = Command::new(program("ampco-actor"));
        command
            .arg("--run-dir")
            .arg(runs.run(name))
            .args(["--index", &index.to_string()]);
        Process::start(command)
    };
    (from..to).map(start).collect()
}

/// The newest line of metrics that `wanted` accepts.
fn line(runs: &Runs, name: &str, awaited: &str, wanted: impl Fn(&Value) -> bool) -> Value {
    until(awaited, || {
        metrics(&runs.run(name)).pop().filter(|line| wanted(line))
    })
}

/// From one actor to `most` and back, one robot each. Returns all metrics.
fn breathe(mode: &str, most: u32) -> Vec<Value> {
    let runs = Runs::new();
    let mode = format!("run.mode={mode}");
    let mut group = runs.train(
        "elastic",
        &[
            "--actors",
            "1",
            "--set",
            "fleet.environments=1",
            "--set",
            &mode,
            "--set",
            "run.deadlines.rollout_seconds=5",
        ],
    );
    until_iteration(&runs.run("elastic"), 2);
    let learner = holder(&runs.run("elastic"), "learner").expect("alive");
    let before = own_memory(learner);

    let guests = join(&runs, "elastic", 1, most);
    let full = line(&runs, "elastic", "all actors in one batch", |line| {
        line["actors"] == most && line["rollouts"] == most
    });
    until_iteration(
        &runs.run("elastic"),
        full["iteration"].as_u64().expect("a number") + 20,
    );
    // A batch of 64 rollouts of 8 steps of a robot is under a megabyte; the rest is its learning.
    let grown = own_memory(learner).saturating_sub(before);
    assert_clock(&runs, "elastic");
    assert!(grown < 64 << 20, "the learner grew by {grown} bytes");

    for guest in &guests {
        guest.signal(Signal::TERM);
    }
    for mut guest in guests {
        assert!(guest.end().success(), "{}", guest.stderr.text());
    }
    line(&runs, "elastic", "one actor again", |line| {
        line["actors"] == 1 && line["rollouts"] == 1
    });
    assert_eq!(holder(&runs.run("elastic"), "learner"), Some(learner));
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
    metrics(&runs.run("elastic"))
}

/// The clock that weights carry is the count of the metrics, guests' samples included: what follows the samples goes at
/// one pace in learner and actors.
fn assert_clock(runs: &Runs, name: &str) {
    let domain = Domain::for_run(&runs.run(name)).expect("a domain");
    let node = Node::join(&domain, "monitor", &Shutdown::manual()).expect("joined");
    let weights = WeightsSubscriber::new(&node).expect("a place");
    let (version, samples) = until("weights", || {
        let newest = weights.newest().expect("readable")?;
        Some((newest.header().version, newest.header().samples))
    });
    let lines = metrics(&runs.run(name));
    let of_version = |line: &&Value| line["iteration"].as_u64() == Some(version);
    let line = lines
        .iter()
        .find(of_version)
        .expect("logged before it was sent");
    assert_eq!(line["samples"].as_u64(), Some(samples), "{line}");
    // 8 rows an iteration is what the group was started for.
    assert!(samples > 8 * version, "{line}");
}

/// Rows follow the actors, and no iteration waited for one that was gone longer than its deadline of 5 s
/// allows, and some more on a busy machine.
fn assert_followed(lines: &[Value], most: u64) {
    let mut before = 0;
    for line in lines {
        let samples = line["samples"].as_u64().expect("a number");
        let rollouts = line["rollouts"].as_u64().expect("a number");
        assert!((1..=most).contains(&rollouts), "{line}");
        assert_eq!(samples - before, 8 * rollouts, "{line}"); // 8 steps of one robot
        before = samples;
        let waited = line["timing"]["gather_seconds"].as_f64().expect("a number");
        assert!(waited < 15.0, "{line}");
    }
}

#[test]
fn in_lock_step_from_one_actor_to_32_and_back() {
    let lines = breathe("lockstep", 32);
    assert_followed(&lines, 32);
    for line in &lines {
        assert_eq!(line["policy_lag"], 0.0, "{line}");
        assert_eq!(line["dropped"], 0, "{line}");
    }
}

#[test]
fn overlapped_from_one_actor_to_a_flood_of_64_and_back() {
    let lines = breathe("overlapped", 64);
    assert_followed(&lines, 64);
    for line in &lines {
        // run.max_lag is 2: what is older is counted as stale and not used.
        assert!(line["policy_lag"].as_f64() <= Some(2.0), "{line}");
        assert_eq!(line["duplicated"], 0, "{line}");
    }
}
