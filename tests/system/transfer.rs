//! The exported policy in MuJoCo: the Python tests of `deploy/transfer`, on a policy that the program has just exported.

use std::process::Command;

use crate::harness::{program, repository};

#[test]
fn what_is_exported_walks_in_mujoco_by_the_tests_of_the_transfer() {
    let Some(python) = needs::python(&["mujoco", "numpy", "onnxruntime", "matplotlib", "yaml"])
    else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let (export, recording) = (
        folder.path().join("policy"),
        folder.path().join("play.json"),
    );
    let policy = repository().join("deploy/policies/walk");
    let made = |arguments: &[&str], out: &str, place: &std::path::Path| {
        let mut command = Command::new(program("ampco"));
        command.args(arguments).arg(&policy).arg(out).arg(place);
        let output = command.output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    };
    made(&["export"], "--out", &export);
    made(&["play", "--seconds", "2"], "--json", &recording);
    let output = Command::new(python)
        .args([
            "-m",
            "unittest",
            "discover",
            "--start-directory",
            "transfer",
            "--top-level-directory",
            ".",
        ])
        .current_dir(repository().join("deploy"))
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .env("AMPCO_EXPORT", &export)
        .env("AMPCO_RECORDING", &recording)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}
