//! Whoever is slow or stands still: memory stays bounded, nothing vanishes unseen, nobody waits for
//! ever.

use std::time::{Duration, Instant};

use protocol::{Domain, Node, RewardSubscriber, Shutdown, WeightsSubscriber};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;

use crate::harness::{Runs, holder, length, metrics, own_memory, until, until_iteration};

/// Most versions that weights may be old: `run.max_lag` of these groups.
const MAX_LAG: f64 = 2.0;

/// How long someone stands still, seconds; AMPCO_STALL_SECONDS=30 for the long form.
fn stall() -> Duration {
    Duration::from_secs_f64(length("AMPCO_STALL_SECONDS", 3.0))
}

fn number(line: &Value, key: &str) -> f64 {
    line[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key} in {line}"))
}

fn newest(runs: &Runs, name: &str) -> Value {
    metrics(&runs.run(name)).pop().expect("lines")
}

/// Stops a process for a while, with `meanwhile` at the end of that time.
fn stand_still(pid: Pid, meanwhile: impl FnOnce()) {
    kill_process(pid, Signal::STOP).expect("alive");
    let over = Instant::now() + stall();
    until("the end of the stall", || {
        (Instant::now() >= over).then_some(())
    });
    meanwhile();
    kill_process(pid, Signal::CONT).expect("alive");
}

#[test]
fn a_learner_that_stands_still_loses_what_is_counted_and_nothing_else() {
    let runs = Runs::new();
    let mut group = runs.train(
        "stalled",
        &[
            "--actors",
            "2",
            "--set",
            "run.mode=overlapped",
            "--set",
            "run.deadlines.send_seconds=0.5",
        ],
    );
    let run = runs.run("stalled");
    until_iteration(&run, 20);
    let learner = holder(&run, "learner").expect("alive");
    let actors: Vec<Pid> = ["actor-0", "actor-1"]
        .iter()
        .map(|role| holder(&run, role).expect("alive"))
        .collect();
    let memory = || {
        actors
            .iter()
            .map(|pid| own_memory(*pid))
            .collect::<Vec<_>>()
    };
    let before = memory();
    let reached = newest(&runs, "stalled");
    assert_eq!(number(&reached, "dropped"), 0.0);
    stand_still(learner, || {
        for (before, now) in before.iter().zip(memory()) {
            let grown = now.saturating_sub(*before);
            assert!(grown < 4 << 20, "an actor grew by {grown} bytes");
        }
    });
    let iteration = number(&reached, "iteration") as u64;
    until_iteration(&run, iteration + 50);
    let after = newest(&runs, "stalled");
    // Each actor gave up one rollout per half second, and the gaps were seen.
    assert!(number(&after, "dropped") >= 2.0, "{after}");
    assert!(group.stderr.text().contains("rollout not delivered"));
    for line in metrics(&run) {
        assert!(number(&line, "policy_lag") <= MAX_LAG, "{line}");
        assert_eq!(number(&line, "duplicated"), 0.0, "{line}");
    }
    assert_eq!(
        holder(&run, "learner"),
        Some(learner),
        "nobody had to be started again"
    );
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}

#[test]
fn in_lock_step_a_learner_that_stands_still_loses_nothing() {
    let runs = Runs::new();
    let mut group = runs.train("stalled", &["--actors", "2"]);
    let run = runs.run("stalled");
    until_iteration(&run, 5);
    stand_still(holder(&run, "learner").expect("alive"), || {});
    let reached = number(&newest(&runs, "stalled"), "iteration") as u64;
    until_iteration(&run, reached + 20);
    for line in metrics(&run) {
        for key in ["policy_lag", "dropped", "stale", "duplicated", "surplus"] {
            assert_eq!(number(&line, key), 0.0, "{key} in {line}");
        }
    }
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}

#[test]
fn a_learner_far_slower_than_its_actors_keeps_lag_and_memory_bounded() {
    let runs = Runs::new();
    // A hundred passes over each batch: actors are ten times faster and more.
    let mut group = runs.train(
        "slow",
        &[
            "--actors",
            "2",
            "--set",
            "run.mode=overlapped",
            "--set",
            "ppo.epochs=100",
        ],
    );
    let run = runs.run("slow");
    until_iteration(&run, 8);
    let roles = ["learner", "actor-0", "actor-1"];
    let pids = roles.map(|role| holder(&run, role).expect("alive"));
    let before = pids.map(own_memory);
    until_iteration(&run, 16);
    for ((role, pid), before) in roles.iter().zip(pids).zip(before) {
        let grown = own_memory(pid).saturating_sub(before);
        assert!(grown < 16 << 20, "{role} grew by {grown} bytes");
    }
    let lines = metrics(&run);
    for line in &lines {
        assert!(number(line, "policy_lag") <= MAX_LAG, "{line}");
        assert_eq!(
            number(line, "dropped"),
            0.0,
            "patience is long enough: {line}"
        );
    }
    let slower = |line: &Value| {
        number(&line["timing"], "learn_seconds") > 2.0 * number(&line["timing"], "collect_seconds")
    };
    assert!(lines.iter().skip(2).any(slower), "the learner was not slow");
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}

#[test]
fn a_monitor_that_never_reads_holds_nobody_up() {
    let runs = Runs::new();
    let mut group = runs.train("watched", &["--actors", "1"]);
    let run = runs.run("watched");
    let reached = number(&until_iteration(&run, 2), "iteration") as u64;
    let domain = Domain::for_run(&run).expect("a domain");
    let node = Node::join(&domain, "monitor", &Shutdown::manual()).expect("joined");
    let weights = WeightsSubscriber::new(&node).expect("a place");
    let mut rewards = RewardSubscriber::new(&node).expect("a place");
    // One message is held all the time, as by a process that was stopped while it read.
    let held = until("weights", || weights.newest().expect("readable"));
    let version = held.header().version;
    // More than the 64 reports for which there is room.
    until_iteration(&run, reached + 120);
    assert_eq!(
        held.header().version,
        version,
        "what is held is not written over"
    );
    assert!(held.flat().iter().all(|number| number.is_finite()));
    until("reports after a gap", || {
        rewards.receive().expect("readable")?;
        (rewards.missed() > 0).then_some(())
    });
    for line in metrics(&run) {
        assert_eq!(number(&line, "dropped"), 0.0, "{line}");
    }
    drop((held, weights, rewards, node));
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}
