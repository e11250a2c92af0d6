//! A run that goes on: what changes counts, what cannot is refused and harms nothing, and files that went do not matter to
//! who judges.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::harness::{Runs, bytes, finish, metrics, program};

/// `ampco` on a run of `runs`, with further arguments.
fn ampco(runs: &Runs, what: &str, run: &str, arguments: &[&str]) -> (bool, String) {
    let mut command = Command::new(program("ampco"));
    command
        .args([what, run, "--runs-dir"])
        .arg(runs.path())
        .args(arguments);
    let (success, _, said) = finish(command);
    (success, said)
}

/// Judges, plays, exports and ships a run, all of which must succeed.
fn is_usable(runs: &Runs, run: &str) {
    let place = |name: &str| runs.path().join(name).display().to_string();
    let out = [place("exported"), place("shipped"), place("page.html")];
    let _ = fs::remove_dir_all(&out[1]);
    for (what, arguments) in [
        (
            "evaluate",
            vec!["--episodes", "2", "--seconds", "0.1", "--from-reference"],
        ),
        (
            "play",
            vec!["--seconds", "0.1", "--html", &out[2], "--from-reference"],
        ),
        ("export", vec!["--out", &out[0]]),
        ("export", vec!["--out", &out[1], "--ship"]),
    ] {
        let (success, said) = ampco(runs, what, run, &arguments);
        assert!(success, "{what} {arguments:?}: {said}");
    }
}

#[test]
fn what_a_resume_changes_counts_and_what_it_may_not_change_is_refused() {
    let runs = Runs::new();
    let fixed = [
        "--actors",
        "1",
        "--iterations",
        "2",
        "--set",
        "ppo.schedule=fixed",
    ];
    let mut group = runs.train("rate", &fixed);
    assert!(group.end().success(), "{}", group.stderr.text());
    let run = runs.run("rate");
    let go_on = |arguments: &[&str]| {
        let mut group = runs.resume("rate", arguments);
        let success = group.end().success();
        (success, group.stderr.text())
    };

    let (success, said) = go_on(&["--iterations", "3", "--set", "ppo.learning_rate=2e-5"]);
    assert!(success, "{said}");
    assert!(
        said.contains("from iteration 3 on: ppo.learning_rate: 0.0003 → 0.00002"),
        "{said}"
    );

    let config = bytes(&run.join("config.toml"));
    let preset = runs.path().join("other.toml");
    fs::write(&preset, "[discriminator]\nframes = 4\n").expect("written");
    let preset = preset.to_str().expect("text");
    for (refused, key) in [
        (["--set", "policy.hidden=[32,32]"], "policy.hidden"),
        (["--set", "discriminator.frames=4"], "discriminator.frames"),
        (["--preset", preset], "discriminator.frames"),
        (["--set", "seed=5"], "run.seed"),
    ] {
        let (success, said) = go_on(&refused);
        assert!(!success && said.contains(key), "{refused:?}: {said}");
        assert!(bytes(&run.join("config.toml")) == config, "{refused:?}");
        assert_eq!(metrics(&run).len(), 3, "{refused:?}");
    }
    is_usable(&runs, "rate");
    let (success, said) = go_on(&["--iterations", "4"]);
    assert!(success, "{said}");
    let rates: Vec<f64> = metrics(&run)
        .iter()
        .map(|line| line["learning_rate"].as_f64().expect("a rate"))
        .collect();
    let [first, then] = [3e-4_f32, 2e-5].map(f64::from);
    assert_eq!(rates, [first, first, then, then]);

    // A configuration that was spoilt by hand does not reach a checkpoint, which has its own.
    let text = String::from_utf8(config).expect("text");
    let spoilt = text.replace("hidden = [16, 16]", "hidden = [32, 32]");
    assert_ne!(spoilt, text);
    fs::write(run.join("config.toml"), &spoilt).expect("written");
    is_usable(&runs, "rate");
    let (success, said) = go_on(&["--iterations", "5"]);
    assert!(!success && said.contains("[16, 16] → [32, 32]"), "{said}");
    fs::write(run.join("config.toml"), &text).expect("written");

    // What an actor added to the newest checkpoint is damaged: the one before it is gone on from, and that is said.
    let robots = run.join("checkpoints/00000004/actor-0.bin");
    let whole = bytes(&robots);
    fs::write(&robots, &whole[..whole.len() / 2]).expect("written");
    let (success, said) = go_on(&["--iterations", "4"]);
    assert!(
        success
            && said.contains("checkpoint 4 is passed over (actor-0.bin")
            && said.contains("from iteration 3"),
        "{said}"
    );

    // The newest checkpoint is damaged: everybody names the one before it, which is good.
    let newest = run.join("checkpoints/00000004/policy.bin");
    let mut damaged = bytes(&newest);
    damaged[100] ^= 1;
    fs::write(&newest, damaged).expect("written");
    let page = runs.path().join("page.html");
    let page = page.to_str().expect("text");
    for (what, arguments) in [
        ("evaluate", &["--episodes", "1"][..]),
        ("export", &["--out", "/nowhere"]),
        ("play", &["--html", page]),
    ] {
        let (success, said) = ampco(&runs, what, "rate", arguments);
        assert!(
            !success && said.contains("policy.bin") && said.contains("00000003"),
            "{what}: {said}"
        );
    }
    fs::remove_file(run.join("checkpoints/00000004/manifest.json")).expect("removed");
    for name in [
        "rate",
        run.join("checkpoints/00000004").to_str().expect("text"),
    ] {
        let (success, said) = ampco(&runs, "evaluate", name, &["--episodes", "1"]);
        assert!(
            !success && said.contains("manifest.json") && said.contains("00000003"),
            "{name}: {said}"
        );
    }
    let good = run.join("checkpoints/00000003");
    let (success, said) = ampco(
        &runs,
        "evaluate",
        good.to_str().expect("text"),
        &["--episodes", "1", "--seconds", "0.1"],
    );
    assert!(success, "{said}");
}

/// A table of the robot standing with bent knees, a second long.
fn table(path: &Path, knees: f32) {
    let mut row = [0.0_f32; 30];
    (row[2], row[3]) = (0.78, 1.0);
    (row[10], row[16]) = (knees, knees);
    let row = row.map(|x| x.to_string()).join(",");
    fs::write(path, format!("{row}\n").repeat(50)).expect("written");
}

#[test]
fn motion_that_changed_is_told_and_motion_that_went_is_not_missed() {
    let runs = Runs::new();
    let walks = runs.path().join("walks");
    fs::create_dir(&walks).expect("made");
    table(&walks.join("a.csv"), 0.2);
    table(&walks.join("b.csv"), 0.3);
    let folder = walks.display().to_string();
    let clips = format!("motion.clips=[{{folder={folder:?},fps=50.0,quaternion=\"wxyz\"}}]");
    let mut group = runs.train(
        "files",
        &["--actors", "1", "--iterations", "1", "--set", &clips],
    );
    assert!(group.end().success(), "{}", group.stderr.text());

    table(&walks.join("c.csv"), 0.4);
    let mut group = runs.resume("files", &["--iterations", "2"]);
    assert!(group.end().success(), "{}", group.stderr.text());
    let said = group.stderr.text();
    assert!(
        said.contains("the reference motion is another") && said.contains("c.csv is new"),
        "{said}"
    );
    assert!(!said.contains("a.csv"), "{said}");

    fs::remove_dir_all(&walks).expect("removed");
    is_usable(&runs, "files");
    let (success, said) = ampco(
        &runs,
        "evaluate",
        "files",
        &["--episodes", "1", "--seconds", "0.1"],
    );
    assert!(
        success && said.contains("built-in gaits stand in"),
        "{said}"
    );
    for file in fs::read_dir(runs.path().join("shipped")).expect("shipped") {
        let path = file.expect("an entry").path();
        let whole = bytes(&path);
        let found = whole
            .windows(folder.len())
            .any(|part| part == folder.as_bytes());
        assert!(!found, "{} has a path of this machine", path.display());
    }
    let mut group = runs.resume("files", &["--iterations", "3"]);
    assert!(!group.end().success());
    assert!(
        group.stderr.text().contains("walks"),
        "{}",
        group.stderr.text()
    );
}
