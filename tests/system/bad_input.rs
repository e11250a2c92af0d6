//! Bad input: one clear error that names the place and the remedy, and a non-zero exit.

use std::fs;
use std::process::Command;

use crate::harness::{
    Alone, Process, Runs, enclosed, finish, has_no_namespaces, program, until_iteration,
};

/// Runs `ampco train --preset smoke` with `arguments`, which must be refused before anything starts.
fn refused(arguments: &[&str]) -> String {
    let runs = Runs::new();
    let mut process = runs.train("bad", arguments);
    let status = process.end();
    let said = process.stderr.text();
    assert!(!status.success(), "{arguments:?} was accepted: {said}");
    assert!(
        !runs.run("bad").join("metrics.jsonl").exists(),
        "something was started before the refusal"
    );
    let complaint: Vec<&str> = said
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    assert_eq!(complaint.len(), 1, "one clear error, not {said}");
    said
}

fn assert_says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "{said:?} does not say {part:?}");
    }
}

#[test]
fn an_unknown_key_is_answered_with_the_closest() {
    let said = refused(&["--set", "ppo.gama=0.9"]);
    assert_says(&said, &["ppo", "gama", "gamma"]);
}

#[test]
fn an_unknown_key_of_a_preset_file_names_the_file() {
    let runs = Runs::new();
    let preset = runs.path().join("mine.toml");
    fs::write(&preset, "[ppo]\nepohcs = 3\n").expect("written");
    let mut command = Command::new(program("ampco"));
    command
        .args(["train", "--run", "bad", "--runs-dir"])
        .arg(runs.path());
    command.arg("--preset").arg(&preset);
    let (success, _, said) = finish(command);
    assert!(!success);
    assert_says(&said, &["mine.toml", "epohcs", "epochs"]);
}

#[test]
fn a_deviation_that_no_actor_could_draw_with_is_refused_before_anything_starts() {
    for key in ["sigma", "waist_factor"] {
        let said = refused(&["--set", &format!("exploration.{key}=1e-30")]);
        assert_says(&said, &["--set", key, "1e-6"]);
    }
}

#[test]
fn a_seed_of_a_study_is_not_set_aside_in_silence() {
    let mut command = Command::new(program("ampco"));
    let file = crate::harness::repository().join("deploy/studies/smoke.toml");
    command.args(["study", "run", "--dry-run", "--set", "seed=4"]);
    command.arg(file);
    let (success, _, said) = finish(command);
    assert!(!success);
    assert_says(&said, &["seed=4", "--seeds"]);
}

#[test]
fn a_policy_to_begin_with_has_to_be_there() {
    assert_says(&refused(&["--from", "nobody"]), &["nobody"]);
    let shipped = crate::harness::repository().join("deploy/policies/walk");
    let shipped = shipped.to_str().expect("text");
    assert_says(
        &refused(&["--from", shipped]),
        &["walk", "policy.hidden=[256, 128, 64]"],
    );
}

#[test]
fn files_that_are_something_else_are_named_and_not_echoed() {
    let runs = Runs::new();
    let page = format!("<!DOCTYPE html><html>{}", "A\x1b[2J".repeat(400_000));
    let path = |name: &str| runs.path().join(name).display().to_string();
    for name in ["wrong.toml", "wrong.npz", "wrong.csv", "wrong.2.bvh"] {
        fs::write(path(name), &page).expect("written");
    }
    let clip = format!("motion.clips=[{{file={:?}}}]", path("wrong.csv"));
    let (toml, npz, bvh) = (path("wrong.toml"), path("wrong.npz"), path("wrong.2.bvh"));
    let new = path("new");
    let commands: [&[&str]; 8] = [
        &["train", "--preset", &toml, "--runs-dir", &new],
        &[
            "train",
            "--preset",
            "smoke",
            "--set",
            &clip,
            "--runs-dir",
            &new,
        ],
        &["study", "run", &toml, "--out", &new],
        &["stages", &toml],
        &["motions", "import", &npz, "--out", &new],
        &["motions", "import", &npz, &bvh, "--out", &new],
        &["motions", "check", &npz],
        &["play", &bvh, "--html", &new],
    ];
    for arguments in commands {
        let mut command = Command::new(program("ampco"));
        command.args(arguments);
        let mut process = Process::start(command);
        let status = process.end();
        let said = process.stderr.text() + &process.stdout.text();
        assert!(
            matches!(status.code(), Some(1 | 2)),
            "{arguments:?}: {status}"
        );
        assert_says(&said, &["wrong.", "a web page (HTML)"]);
        assert!(said.len() < 2_000, "{arguments:?}: {} bytes", said.len());
        assert!(!said.contains('\x1b'), "{said:?}");
        assert!(
            !runs.path().join("new").exists(),
            "{arguments:?} left a folder behind"
        );
    }
}

#[test]
fn values_out_of_range_name_field_and_value() {
    assert_says(&refused(&["--set", "ppo.gamma=1.5"]), &["gamma", "1.5"]);
    assert_says(&refused(&["--set", "fleet.steps=0"]), &["steps", "0"]);
    assert_says(
        &refused(&["--set", "scheduler.percentile=95"]),
        &["percentile", "95"],
    );
    assert_says(
        &refused(&["--set", "task.termination.fall.height=high"]),
        &["termination.fall.height"],
    );
}

#[test]
fn motion_files_that_cannot_be_used_are_named() {
    let said = refused(&["--set", "motion.clips=[{file=\"no-such.csv\",fps=50}]"]);
    assert_says(&said, &["no-such.csv"]);

    let runs = Runs::new();
    let broken = runs.path().join("broken.csv");
    fs::write(&broken, "0,0,0.78,1,0,0,0,what\n").expect("written");
    let clips = format!(
        "motion.clips=[{{file={:?},fps=50}}]",
        broken.display().to_string()
    );
    let said = refused(&["--set", &clips]);
    assert_says(&said, &["broken.csv"]);
}

#[test]
fn a_checkpoint_of_another_shape_is_refused() {
    let runs = Runs::new();
    let mut group = runs.train("shape", &["--actors", "1", "--iterations", "1"]);
    assert!(group.end().success(), "{}", group.stderr.text());
    let mut resumed = runs.resume(
        "shape",
        &["--set", "policy.hidden=[48, 24]", "--iterations", "2"],
    );
    let status = resumed.end();
    let said = resumed.stderr.text();
    assert!(!status.success(), "{said}");
    assert_says(&said, &["shape", "48"]);
}

#[test]
fn a_second_learner_of_a_run_is_refused() {
    let run = Alone::new(1);
    let _first = run.start("ampco-learner", &[]);
    let _actor = run.start("ampco-actor", &["--index", "0"]);
    until_iteration(run.path(), 1);
    let mut second = run.start("ampco-learner", &[]);
    assert!(!second.end().success());
    assert_says(&second.stderr.text(), &["learner", "alone"]);
}

#[test]
fn a_second_group_of_a_run_is_refused() {
    let runs = Runs::new();
    let _first = runs.train("same", &["--actors", "1"]);
    until_iteration(&runs.run("same"), 1);
    let mut second = runs.train("same", &["--actors", "1"]);
    assert!(!second.end().success());
    assert_says(&second.stderr.text(), &["same"]);
    let mut resumed = runs.resume("same", &[]);
    assert!(!resumed.end().success());
}

#[test]
fn a_full_shared_memory_is_said_and_kills_nobody_by_a_bus_error() {
    // A file system of one megabyte over /dev/shm, in places of the test's own.
    let place = Runs::new();
    let train = r#"
mount -t tmpfs -o size=1m tmpfs /dev/shm || exit 9
exec "$AMPCO" train --preset smoke --run full --runs-dir /tmp
"#;
    let command = enclosed(place.path(), train);
    let mut process = Process::start(command);
    let status = process.end();
    let said = process.stderr.text();
    if has_no_namespaces(&said) {
        return;
    }
    assert_eq!(status.code(), Some(1), "{said}");
    assert_says(&said, &["shared memory", "/dev/shm"]);
}
