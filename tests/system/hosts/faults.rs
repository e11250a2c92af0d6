//! Whoever is killed or stopped on whichever machine: the run goes on, and every rollout is accounted for.

use std::fs;
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

/// Resident memory of a process, kB: `VmRSS` as it is, `VmHWM` the most so far (proc_pid_status(5)).
fn memory(pid: Pid, which: &str) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/status", pid.as_raw_pid()));
    let status = status.expect("the process is alive");
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix(which)?.strip_prefix(':'));
    let number = line.and_then(|line| line.split_whitespace().next());
    number.and_then(|kb| kb.parse().ok()).expect("kB")
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
    let carrier = holder(&spread.hosts()[0], "carrier").expect("alive");
    let rest = memory(carrier, "VmRSS");
    let mut longest = Duration::ZERO;
    let kills = length("AMPCO_GATE_KILLS", 4.0) as usize;
    for _ in 0..kills {
        let gate = until("a gate", || holder(&run, "gate"));
        let killed = Instant::now();
        kill(gate);
        another(&run, "gate", gate);
        whole_again(&spread, 2);
        longest = longest.max(killed.elapsed());
    }
    assert!(longest < Duration::from_secs(20), "{longest:?}");
    let most = memory(carrier, "VmHWM");
    assert!(
        most <= 2 * rest,
        "carrier: {rest} kB at rest, {most} at most"
    );
    let account = end(&spread, group, host);
    println!(
        "{kills} gates killed: whole again after at most {longest:?}; carrier {rest} kB at rest, {most} at most; {account:?}"
    );
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
    let carrier = holder(&spread.hosts()[0], "carrier").expect("alive");
    let passing = [holder(&run, "gate").expect("alive"), carrier];
    let rest = passing.map(|pid| memory(pid, "VmRSS"));
    kill_process(learner, Signal::STOP).expect("alive");
    thread::sleep(Duration::from_secs_f64(length("AMPCO_STANDSTILL", 4.0)));
    kill_process(learner, Signal::CONT).expect("alive");
    let took = whole_again(&spread, 2);
    let most = passing.map(|pid| memory(pid, "VmHWM"));
    for (rest, most) in rest.iter().zip(&most) {
        assert!(*most <= 2 * rest, "{rest} kB at rest, {most} at most");
    }
    println!("whole again after {took:?}; gate and carrier {rest:?} kB at rest, {most:?} at most");
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
    let began = Instant::now();
    let host = spread.join("spread", 2);
    until("the same numbers", || {
        host.stderr.text().contains("actors 2, 3").then_some(())
    });
    whole_again(&spread, 2);
    println!("whole again {:?} after its start", began.elapsed());
    end(&spread, group, host);
}

#[test]
fn a_run_whose_supervisor_is_killed_is_waited_for_by_its_hosts() {
    let spread = Spread::new();
    let (mut group, mut host) = begin(&spread, "overlapped");
    for _ in 0..length("AMPCO_SUPERVISOR_KILLS", 3.0) as usize {
        group.signal(Signal::KILL);
        group.end();
        let began = Instant::now();
        group = spread.resume("spread", 2, &[]);
        // Of all four: nobody has left.
        whole_again(&spread, 2);
        println!("whole again {:?} after the resume", began.elapsed());
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
