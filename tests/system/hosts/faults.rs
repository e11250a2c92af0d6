//! Whoever is killed or stopped on whichever machine: the run goes on, and every rollout is accounted for.

use std::thread;
use std::time::{Duration, Instant};

use run::journal::{self, account::account};
use rustix::process::{Pid, Signal, kill_process};

use super::{Spread, at_work};
use crate::harness::{Process, holder, length, metrics, until, until_iteration};

/// An overlapped run of two actors here and two elsewhere that writes down what became of every rollout.
fn begin(spread: &Spread, mode: &str) -> (Process, Process) {
    let mode = format!("run.mode={mode}");
    let arguments = [
        "--actors",
        "4",
        "--set",
        "run.journal=true",
        "--set",
        "checkpoint_every=5",
        "--set",
        "run.deadlines.rollout_seconds=5",
        "--set",
        &mode,
    ];
    let group = spread.train("spread", 2, &arguments);
    let host = spread.join("spread", 2);
    at_work(spread, 2);
    at_work(spread, 3);
    (group, host)
}

/// Iterations that all four actors took part in, from now on.
fn whole_again(spread: &Spread, count: usize) -> Duration {
    let since = Instant::now();
    let run = spread.runs.run("spread");
    let before = metrics(&run).len();
    until("iterations of all actors", || {
        let lines = metrics(&run);
        let whole = lines[before.min(lines.len())..]
            .iter()
            .filter(|line| line["actors"] == 4);
        (whole.count() >= count).then_some(())
    });
    since.elapsed()
}

/// Ends all, and accounts for every rollout.
fn end(spread: &Spread, mut group: Process, mut host: Process) -> journal::Account {
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
    assert!(host.end().success(), "{}", host.stderr.text());
    let mut journals = journal::read(&spread.runs.run("spread").join("logs")).expect("journals");
    for host in spread.hosts() {
        journals.extend(journal::read(&host.join("logs")).expect("journals"));
    }
    let account = account(&journals);
    assert_eq!(account.uncounted, 0, "{account:?}");
    assert!(account.used > 0, "{account:?}");
    account
}

fn kill(pid: Pid) {
    kill_process(pid, Signal::KILL).expect("it was alive");
}

/// Waits until another process has a role.
fn another(run: &std::path::Path, role: &str, than: Pid) {
    until(&format!("another {role}"), || {
        holder(run, role).filter(|pid| *pid != than)
    });
}

#[test]
fn a_gate_that_is_killed_again_and_again_is_made_good() {
    let spread = Spread::new();
    let (group, host) = begin(&spread, "overlapped");
    let run = spread.runs.run("spread");
    for _ in 0..length("AMPCO_GATE_KILLS", 4.0) as usize {
        let gate = until("a gate", || holder(&run, "gate"));
        kill(gate);
        another(&run, "gate", gate);
        let took = whole_again(&spread, 2);
        assert!(took < Duration::from_secs(20), "{took:?}");
    }
    end(&spread, group, host);
}

#[test]
fn a_carrier_and_actors_that_are_killed_come_back() {
    let spread = Spread::new();
    let (group, host) = begin(&spread, "lockstep");
    let there = spread.hosts().remove(0);
    for role in ["carrier", "actor-2", "carrier", "actor-3"] {
        let pid = until(role, || holder(&there, role));
        kill(pid);
        another(&there, role, pid);
        whole_again(&spread, 2);
    }
    end(&spread, group, host);
}

#[test]
fn a_learner_that_stands_still_and_one_that_is_killed_are_waited_for() {
    let spread = Spread::new();
    let (group, host) = begin(&spread, "overlapped");
    let run = spread.runs.run("spread");
    let learner = holder(&run, "learner").expect("alive");
    kill_process(learner, Signal::STOP).expect("alive");
    thread::sleep(Duration::from_secs_f64(length("AMPCO_STANDSTILL", 4.0)));
    kill_process(learner, Signal::CONT).expect("alive");
    whole_again(&spread, 2);
    until_iteration(&run, 6);
    kill(learner);
    another(&run, "learner", learner);
    whole_again(&spread, 2);
    end(&spread, group, host);
}

#[test]
fn a_host_that_is_killed_whole_comes_back_with_its_numbers() {
    let spread = Spread::new();
    let (group, mut host) = begin(&spread, "overlapped");
    let there = spread.hosts().remove(0);
    let members = ["carrier", "actor-2", "actor-3"].map(|role| holder(&there, role));
    host.signal(Signal::KILL);
    for pid in members.into_iter().flatten() {
        // Told to end by the supervisor's death, it may have ended.
        let _ = kill_process(pid, Signal::KILL);
    }
    host.end();
    let host = spread.join("spread", 2);
    until("the same numbers", || {
        host.stderr.text().contains("actors 2, 3").then_some(())
    });
    whole_again(&spread, 2);
    end(&spread, group, host);
}

#[test]
fn a_run_whose_supervisor_is_killed_is_waited_for_by_its_hosts() {
    let spread = Spread::new();
    let (mut group, mut host) = begin(&spread, "overlapped");
    for _ in 0..length("AMPCO_SUPERVISOR_KILLS", 3.0) as usize {
        group.signal(Signal::KILL);
        group.end();
        group = spread.resume("spread", 2, &[]);
        // Of all four: nobody has left.
        whole_again(&spread, 2);
        assert!(host.is_alive(), "{}", host.stderr.text());
    }
    end(&spread, group, host);
}

#[test]
fn a_host_that_leaves_is_no_longer_counted_on() {
    let spread = Spread::new();
    let (mut group, mut host) = begin(&spread, "overlapped");
    let run = spread.runs.run("spread");
    let on = |role: &str| {
        let folder = run::Folder::open(&run).expect("a folder");
        folder.holder(role).expect("readable")
    };
    assert!(on("actor-3").expect("held").starts_with("on "));
    host.signal(Signal::INT);
    assert!(host.end().success(), "{}", host.stderr.text());
    until("the roles to be given up", || {
        on("actor-3").is_none().then_some(())
    });
    until("two actors", || {
        metrics(&run).pop().filter(|line| line["actors"] == 2)
    });
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
}
