//! One seed, lock-step: the same bits on every run, whoever is faster.

use rustix::process::{Signal, kill_process};

use crate::harness::{Runs, bytes, holder, metrics, until_iteration, without_timing};

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
    for line in lines("one") {
        // Eq. 14 alone: one term, one gate, and what is paid is at most either.
        let mean = |key: &str| line[key].as_f64().expect("a mean");
        let paid = mean("task_mean");
        assert!(paid > 0.0 && paid <= mean("reward/track") + 1e-6, "{line}");
        assert!(paid <= mean("gate/upright") + 1e-6, "{line}");
        let terms = line.as_object().expect("a record").keys();
        let terms = terms.filter(|key| key.starts_with("reward/") || key.starts_with("gate/"));
        assert_eq!(terms.count(), 2, "{line}");
    }
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

/// Every value that an exact continuation depends on is the same in two runs: metrics, and all of
/// the checkpoint of iteration `iteration`, networks, optimisers, normalisers, replay, generators and
/// robots.
pub(crate) fn assert_same(runs: &Runs, one: &str, other: &str, iteration: u64) {
    let lines = |name: &str| -> Vec<_> {
        metrics(&runs.run(name))
            .into_iter()
            .map(without_timing)
            .collect()
    };
    assert_eq!(lines(one).len() as u64, iteration);
    for (one, other) in lines(one).iter().zip(&lines(other)) {
        assert_eq!(one, other);
    }
    assert_eq!(lines(other).len() as u64, iteration);
    let part = |name: &str, file: &str| {
        let checkpoint = runs.run(name).join(format!("checkpoints/{iteration:08}"));
        bytes(&checkpoint.join(file))
    };
    for file in ["policy.bin", "learning.bin", "actor-0.bin", "actor-1.bin"] {
        assert!(part(one, file) == part(other, file), "{file} differs");
    }
    let shell = |name: &str| {
        let shell: serde_json::Value =
            serde_json::from_slice(&part(name, "shell.json")).expect("JSON");
        let mut shell = shell;
        shell.as_object_mut().expect("an object").remove("seconds");
        shell
    };
    assert_eq!(shell(one), shell(other));
}

/// On a busy machine nobody is to go on without the scheduler or an actor: that would be another run.
pub(crate) const PATIENT: [&str; 4] = [
    "--set",
    "run.deadlines.directive_seconds=60",
    "--set",
    "run.deadlines.rollout_seconds=60",
];

/// A task that grows through all 8 iterations of 128 samples: its clock goes on where it stopped.
const GROWING: &str = "task.reward.track.kernel={from=0.25,to=8,samples=[0,1024]}";

#[test]
fn stopping_and_resuming_changes_no_bit() {
    stop_and_resume(&["--set", GROWING]);
}

#[test]
fn nor_does_it_where_the_task_waits_for_robots_that_stay_up() {
    let metrics = stop_and_resume(&["--set", GROWING, "--set", "scheduler.pace=progress"]);
    // Nothing is learned in eight iterations: what grows waits all along, one iteration after the other.
    for (before, line) in metrics.iter().enumerate().skip(1) {
        assert_eq!(line["held"].as_u64(), Some(before as u64), "{line}");
    }
}

#[test]
fn nor_does_it_with_past_frames_and_a_critic_that_sees_more() {
    let metrics = stop_and_resume(&[
        "--set",
        "observation.actor.terms=['angular_velocity','gravity','command','joint_position','joint_velocity','previous_action']",
        "--set",
        "observation.actor.past=5",
        "--set",
        "observation.critic.terms=['actor','linear_velocity','height','friction','foot_forces']",
        "--set",
        "observation.discriminator.terms=['height','joint_angle','key_bodies']",
    ]);
    // Gait is measured whatever the lists are.
    assert!(
        metrics
            .iter()
            .all(|line| line["joint_speed_use"].is_number())
    );
}

/// Runs 8 iterations at once and in two halves; gives the metrics, which are those of both.
fn stop_and_resume(set: &[&str]) -> Vec<serde_json::Value> {
    let runs = Runs::new();
    let train = |name: &str, iterations: &str| {
        let arguments = ["--actors", "2", "--iterations", iterations];
        let arguments = [&arguments[..], &PATIENT[..], set].concat();
        let mut group = runs.train(name, &arguments);
        assert!(group.end().success(), "{}", group.stderr.text());
    };
    train("whole", "8");
    train("halves", "4");
    let mut second = runs.resume("halves", &["--iterations", "8"]);
    assert!(second.end().success(), "{}", second.stderr.text());
    assert_same(&runs, "whole", "halves", 8);
    metrics(&runs.run("whole"))
}

/// Kills a whole group in the middle, lets it go on from its last checkpoint, and compares it with one
/// that nobody disturbed.
fn killing_changes_no_bit(physics: &str) {
    const LAST: &str = "60";
    let runs = Runs::new();
    let arguments = [
        &[
            "--actors",
            "2",
            "--set",
            "checkpoint_every=3",
            "--set",
            physics,
        ],
        &PATIENT[..],
    ]
    .concat();
    let limited = [&arguments[..], &["--iterations", LAST]].concat();
    let mut whole = runs.train("whole", &limited);
    assert!(whole.end().success(), "{}", whole.stderr.text());

    let mut killed = runs.train("killed", &limited);
    let run = runs.run("killed");
    until_iteration(&run, 7);
    // The supervisor first: it would start the others again.
    let roles = ["learner", "actor-0", "actor-1", "scheduler"];
    let others: Vec<_> = roles.iter().filter_map(|role| holder(&run, role)).collect();
    killed.signal(Signal::KILL);
    for pid in others {
        // Told to end by the supervisor's death, it may have ended.
        let _ = kill_process(pid, Signal::KILL);
    }
    killed.end();
    let reached = metrics(&run).len();
    assert!(reached < 60, "killed too late: iteration {reached}");

    let mut resumed = runs.resume("killed", &["--iterations", LAST]);
    assert!(resumed.end().success(), "{}", resumed.stderr.text());
    assert_same(&runs, "whole", "killed", 60);
}

#[test]
fn killing_the_whole_group_and_resuming_changes_no_bit() {
    killing_changes_no_bit("physics=rapier");
}

#[test]
fn nor_does_it_with_batched_physics() {
    killing_changes_no_bit("physics=batched");
}
