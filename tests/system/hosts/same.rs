//! Where the actors are changes no bit.

use rustix::process::{Signal, kill_process};

use super::Spread;
use crate::harness::{Process, bytes, holder, metrics, until, until_iteration, without_timing};
use crate::repeat::{PATIENT, assert_same};

fn ended(mut process: Process) {
    assert!(process.end().success(), "{}", process.stderr.text());
}

#[test]
fn actors_on_other_machines_make_the_same_weights_also_over_a_stop_and_a_resume() {
    same_wherever("fleet.physics=batched");
}

#[test]
fn nor_does_it_matter_where_they_are_in_rapier() {
    same_wherever("fleet.physics=rapier");
}

fn same_wherever(physics: &'static str) {
    let spread = Spread::new();
    let train = |iterations: &'static str| {
        let arguments = [
            "--actors",
            "3",
            "--iterations",
            iterations,
            "--set",
            physics,
        ];
        [&arguments[..], &PATIENT[..]].concat()
    };
    let whole = spread.runs.train("whole", &train("8"));
    ended(whole);

    let group = spread.train("spread", 1, &train("8"));
    let host = spread.join("spread", 2);
    ended(group);
    let said = host.stderr.text();
    ended(host);
    assert_same(&spread.runs, "whole", "spread", 8);
    assert!(said.contains("joined run spread"), "{said}");
    assert!(
        said.contains("actors 1, 2 × ") && !said.contains("other processors"),
        "{said}"
    );

    // All actors elsewhere, on two hosts, and a stop in the middle.
    let group = spread.train("halves", 0, &train("4"));
    let hosts = [spread.join("halves", 2), spread.join("halves", 1)];
    ended(group);
    hosts.into_iter().for_each(ended);
    let lines = metrics(&spread.runs.run("halves"));
    assert_eq!(lines.len(), 4);
    let group = spread.resume("halves", 0, &["--iterations", "8"]);
    let hosts = [spread.join("halves", 1), spread.join("halves", 2)];
    ended(group);
    hosts.into_iter().for_each(ended);
    assert_same(&spread.runs, "whole", "halves", 8);
    // Nothing is left on the machine of the actors.
    for host in spread.hosts() {
        let domain = protocol::Domain::for_run(&host).expect("a domain");
        let left = until("its memory to be removed", || {
            let left = domain.leftovers().expect("readable");
            left.is_empty().then_some(left)
        });
        assert!(left.is_empty());
    }
}

#[test]
fn nor_does_it_matter_that_the_learner_s_machine_was_killed_whole() {
    const LAST: &str = "40";
    let spread = Spread::new();
    let arguments = ["--actors", "3", "--iterations", LAST, "--set"];
    let arguments = [&arguments[..], &["checkpoint_every=3"], &PATIENT[..]].concat();
    ended(spread.runs.train("whole", &arguments));

    let mut group = spread.train("killed", 1, &arguments);
    let host = spread.join("killed", 2);
    let run = spread.runs.run("killed");
    until_iteration(&run, 7);
    let roles = ["learner", "gate", "actor-0", "scheduler"];
    let others: Vec<_> = roles.iter().filter_map(|role| holder(&run, role)).collect();
    group.signal(Signal::KILL);
    for pid in others {
        // Told to end by the supervisor's death, it may have ended.
        let _ = kill_process(pid, Signal::KILL);
    }
    group.end();
    let reached = metrics(&run).len();
    assert!(reached < 40, "killed too late: iteration {reached}");
    ended(spread.resume("killed", 1, &["--iterations", LAST]));
    ended(host);
    let checkpoint = |name: &str| spread.runs.run(name).join("checkpoints/00000040");
    for file in [
        "policy.bin",
        "learning.bin",
        "actor-0.bin",
        "actor-1.bin",
        "actor-2.bin",
    ] {
        let [one, other] = ["whole", "killed"].map(|name| bytes(&checkpoint(name).join(file)));
        assert!(one == other, "{file} differs");
    }
    // What was on its way to the killed learner arrives at the next, which counts it and leaves it.
    let lines = |name: &str| -> Vec<_> {
        let lines = metrics(&spread.runs.run(name)).into_iter();
        let told = lines.map(|line| {
            let mut line = without_timing(line);
            line.as_object_mut().expect("a record").remove("stale");
            line
        });
        told.collect()
    };
    assert_eq!(lines("whole"), lines("killed"));
}
