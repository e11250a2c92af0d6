//! The exported policy elsewhere: the Python tests of `deploy/transfer` and `deploy/robot`, on a policy that the program has
//! just exported.

use std::path::Path;
use std::process::Command;

use crate::harness::{program, repository};

/// A command of the program on the policy `walk` that writes to `place`.
fn made(arguments: &[&str], out: &str, place: &Path) {
    let mut command = Command::new(program("ampco"));
    let policy = repository().join("deploy/policies/walk");
    command.args(arguments).arg(policy).arg(out).arg(place);
    done(&mut command);
}

fn done(command: &mut Command) {
    let output = command.output().unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

/// The tests in `deploy/<package>`, which find the export under `AMPCO_EXPORT`.
fn tests_of(package: &str, python: &str, export: &Path) -> Command {
    let mut command = Command::new(python);
    command
        .args(["-m", "unittest", "discover", "--start-directory", package])
        .args(["--top-level-directory", "."])
        .current_dir(repository().join("deploy"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("AMPCO_EXPORT", export);
    command
}

#[test]
fn what_is_exported_walks_in_mujoco_by_the_tests_of_the_transfer() {
    let modules = ["mujoco", "numpy", "onnxruntime", "matplotlib", "yaml"];
    let Some(python) = needs::python(&modules) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (export, recording) = (
        folder.path().join("policy"),
        folder.path().join("play.json"),
    );
    made(&["export"], "--out", &export);
    made(&["play", "--seconds", "2"], "--json", &recording);
    done(tests_of("transfer", &python, &export).env("AMPCO_RECORDING", &recording));
}

#[test]
fn what_is_exported_walks_over_dds_by_the_tests_of_the_controller() {
    let Some(python) = needs::python(&["cyclonedds.idl", "mujoco", "numpy", "onnxruntime"]) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let export = folder.path().join("policy");
    made(&["export"], "--out", &export);
    done(&mut tests_of("robot", &python, &export));
}
