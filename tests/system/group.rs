//! The whole group, through the script that users call.

use std::fs;
use std::process::Command;

use protocol::Domain;
use rustix::process::{Signal, kill_process};

use crate::harness::{
    Process, Runs, finish, holder, metrics, program, repository, until, until_iteration,
};

const ROLES: [&str; 4] = ["scheduler", "learner", "actor-0", "actor-1"];

fn local_sh(runs: &Runs, name: &str, arguments: &[&str]) -> Process {
    let mut command = Command::new(repository().join("deploy/local.sh"));
    command
        .args([
            "--preset",
            "smoke",
            "--actors",
            "2",
            "--run",
            name,
            "--runs-dir",
        ])
        .arg(runs.path())
        .args(["--set", "run.iterations=0"])
        .args(arguments);
    Process::start(command)
}

fn assert_nothing_is_left(runs: &Runs, name: &str) {
    let run = runs.run(name);
    for role in ROLES {
        assert_eq!(holder(&run, role), None, "{role} is alive");
    }
    let left = Domain::for_run(&run)
        .expect("a domain")
        .leftovers()
        .expect("readable");
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn local_sh_trains_the_smoke_preset_to_its_end() {
    let runs = Runs::new();
    let mut group = local_sh(&runs, "smoke", &["--iterations", "5"]);
    assert!(group.end().success(), "{}", group.stderr.text());
    let lines = metrics(&runs.run("smoke"));
    assert_eq!(lines.len(), 5);
    let config = fs::read_to_string(runs.run("smoke").join("config.toml")).expect("readable");
    for section in [
        "[run]",
        "[ppo]",
        "[discriminator]",
        "[scheduler]",
        "[motion",
        "[task.reward.track]",
    ] {
        assert!(
            config.contains(section),
            "{section} is missing in the resolved configuration"
        );
    }
    assert_nothing_is_left(&runs, "smoke");

    let mut evaluate = Command::new(program("ampco"));
    evaluate
        .args([
            "evaluate",
            "smoke",
            "--command",
            "0.5,0,0",
            "--seconds",
            "1",
        ])
        .args(["--episodes", "2", "--json", "--runs-dir"])
        .arg(runs.path());
    let (success, out, err) = finish(evaluate);
    assert!(success, "{err}");
    let rows: serde_json::Value =
        serde_json::from_str(out.lines().last().expect("a line")).expect("JSON");
    for key in ["survival", "rmse", "energy_j", "style_reward"] {
        assert!(rows[0][key].is_number(), "{key} in {rows}");
    }
    assert_eq!(rows[0]["command"], serde_json::json!([0.5, 0.0, 0.0]));

    let mut status = Command::new(program("ampco"));
    status
        .args(["status", "smoke", "--runs-dir"])
        .arg(runs.path());
    let (success, out, err) = finish(status);
    assert!(success && out.contains('5'), "{out}{err}");
}

#[test]
fn ctrl_c_leaves_a_checkpoint_and_nothing_else() {
    let runs = Runs::new();
    let mut group = local_sh(&runs, "smoke", &[]);
    until_iteration(&runs.run("smoke"), 2);
    group.signal(Signal::INT);
    assert!(group.end().success(), "{}", group.stderr.text());
    let last = metrics(&runs.run("smoke")).len() as u64;
    let checkpoints = runs.run("smoke").join("checkpoints");
    let newest = checkpoints.join(format!("{last:08}"));
    assert!(
        newest.join("manifest.json").is_file(),
        "no checkpoint of iteration {last}"
    );
    assert!(
        newest.join("actor-1.bin").is_file(),
        "the actors saved their robots"
    );
    assert_nothing_is_left(&runs, "smoke");
}

#[test]
fn whoever_is_killed_comes_back_and_the_run_goes_on() {
    let runs = Runs::new();
    let run = runs.run("killed");
    let mut group = runs.train("killed", &["--actors", "2", "--set", "checkpoint_every=2"]);
    let mut reached = 3;
    for role in ["actor-1", "scheduler", "learner", "actor-0"] {
        until_iteration(&run, reached);
        let pid = until("a living process", || holder(&run, role));
        kill_process(pid, Signal::KILL).expect("alive");
        until("another life", || {
            holder(&run, role).filter(|other| *other != pid)
        });
        let now = metrics(&run)
            .last()
            .and_then(|line| line["iteration"].as_u64());
        reached = now.unwrap_or(0) + 2;
    }
    until_iteration(&run, reached);
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
    assert_nothing_is_left(&runs, "killed");
}

#[test]
fn an_actor_may_join_and_leave_a_running_group() {
    let runs = Runs::new();
    let run = runs.run("elastic");
    let mut group = runs.train("elastic", &["--actors", "1"]);
    until_iteration(&run, 1);
    let mut command = Command::new(program("ampco"));
    command
        .args(["actor", "--run", "elastic", "--runs-dir"])
        .arg(runs.path());
    let mut guest = Process::start(command);
    let with_guest = |count: u64| {
        until("another number of actors", || {
            metrics(&run).pop().filter(|line| line["rollouts"] == count)
        })
    };
    with_guest(2);
    guest.signal(Signal::TERM);
    assert!(guest.end().success(), "{}", guest.stderr.text());
    with_guest(1);
    group.signal(Signal::TERM);
    assert!(group.end().success(), "{}", group.stderr.text());
    assert_nothing_is_left(&runs, "elastic");
}

#[test]
fn children_end_with_a_killed_supervisor() {
    let runs = Runs::new();
    let run = runs.run("orphans");
    let mut group = runs.train("orphans", &["--actors", "2"]);
    until_iteration(&run, 2);
    group.signal(Signal::KILL);
    group.end();
    until("the end of all children", || {
        ROLES
            .iter()
            .all(|role| holder(&run, role).is_none())
            .then_some(())
    });
    // The next start finds the run as it was left and cleans up what the first could not.
    let mut again = runs.resume("orphans", &["--iterations", "60"]);
    assert!(again.end().success(), "{}", again.stderr.text());
    assert_nothing_is_left(&runs, "orphans");
}
