//! Runs as they lie on the disk, gone on with.

use std::fs;

use terminal::Place;

use super::super::*;

/// A run with a checkpoint of iteration 10, which knows its configuration if `told`.
fn run(told: bool) -> (tempfile::TempDir, Folder) {
    let runs = tempfile::tempdir().unwrap();
    let folder = Folder::create(runs.path(), "walk").unwrap();
    let mut config = presets::find("smoke").unwrap().config;
    resolve::resolve(&mut config).unwrap();
    config.write(&folder.config_path(), "a test").unwrap();
    let text = config.to_toml();
    let parts: &[(&str, &[u8])] = if told {
        &[(CONFIG, text.as_bytes())]
    } else {
        &[("policy.bin", b"weights")]
    };
    folder.checkpoints().write(10, "a shape", parts).unwrap();
    (runs, folder)
}

/// `ampco train --resume` of it, up to where something would be written.
fn resumed(folder: &Folder, arguments: &[&str]) -> Result<Ready, String> {
    #[derive(clap::Parser)]
    struct Arguments {
        #[command(flatten)]
        train: Train,
    }
    let runs = folder.path().parent().unwrap().to_str().unwrap();
    let fixed = ["train", "--resume", "--run", "walk", "--runs-dir", runs];
    let arguments = fixed.iter().chain(arguments);
    let train = <Arguments as clap::Parser>::try_parse_from(arguments)
        .unwrap()
        .train;
    train.resumed().map_err(|error| format!("{error:#}"))
}

fn changed(ready: &Ready) -> Vec<String> {
    let changes = &ready.going_on.as_ref().unwrap().changes;
    changes.iter().map(ToString::to_string).collect()
}

#[test]
fn other_networks_are_refused_and_the_run_stays_as_it_was() {
    let (_runs, folder) = run(true);
    let before = fs::read(folder.config_path()).unwrap();
    for refused in [
        "policy.hidden=[32,32]",
        "policy.critic_hidden=[8]",
        "discriminator.frames=4",
        "discriminator.hidden=[8]",
        "discriminator.command_blur=[0.1,0.1,0.1]",
        "seed=7",
    ] {
        // Beside something that may change.
        let error = resumed(&folder, &["--set", "ppo.epochs=3", "--set", refused])
            .err()
            .unwrap();
        let key = refused.split('=').next().unwrap();
        assert!(error.contains(key) && !error.contains("epochs"), "{error}");
        assert_eq!(fs::read(folder.config_path()).unwrap(), before);
    }
}

#[test]
fn a_preset_is_laid_over_and_its_values_count_or_are_refused() {
    let (runs, folder) = run(true);
    assert_eq!(
        changed(&resumed(&folder, &["--preset", "smoke"]).unwrap()),
        [""; 0]
    );
    let preset = |text: &str| {
        let path = runs.path().join("mine.toml");
        fs::write(&path, text).unwrap();
        resumed(&folder, &["--preset", path.to_str().unwrap()])
    };
    let rates =
        preset("[ppo]\nlearning_rate = 2e-5\n[scheduler.method.amp]\nstyle_weight = 0.25").unwrap();
    assert_eq!(
        changed(&rates),
        [
            "ppo.learning_rate: 0.0003 → 0.00002",
            "scheduler.method: \"ampco\" → none",
            "scheduler.method.amp.style_weight: none → 0.25",
        ]
    );
    let refused = preset("[policy]\nhidden = [32, 32]").err().unwrap();
    assert!(
        refused.contains("policy.hidden: [16, 16] → [32, 32] from "),
        "{refused}"
    );
    assert!(refused.contains("mine.toml"), "{refused}");
}

#[test]
fn a_configuration_edited_by_hand_is_held_against_the_checkpoint() {
    let (_runs, folder) = run(true);
    let mut config = folder.config().unwrap();
    config.put("policy.hidden", vec![32], "a test");
    config.write(&folder.config_path(), "edited").unwrap();
    let refused = resumed(&folder, &[]).err().unwrap();
    assert!(
        refused.contains("policy.hidden: [16, 16] → [32]"),
        "{refused}"
    );
    // What was broken can be mended.
    let mended = resumed(&folder, &["--set", "policy.hidden=[16,16]"]).unwrap();
    assert_eq!(changed(&mended), [""; 0]);
}

#[test]
fn a_checkpoint_without_a_configuration_gets_that_of_its_run_before_it_is_replaced() {
    let (_runs, folder) = run(false);
    assert!(resumed(&folder, &["--set", "policy.hidden=[32]"]).is_err());
    let ready = resumed(&folder, &["--set", "ppo.learning_rate=2e-5"]).unwrap();
    assert_eq!(changed(&ready), ["ppo.learning_rate: 0.0003 → 0.00002"]);
    ready.tell().unwrap();
    let kept = folder
        .checkpoints()
        .open_newest(None)
        .unwrap()
        .config()
        .unwrap()
        .unwrap();
    assert_eq!(
        kept.given("ppo.learning_rate").unwrap().as_float(),
        Some(0.0003)
    );
}

#[test]
fn the_schedule_of_a_run_in_phase_two_stays() {
    let (_runs, folder) = run(true);
    let other = ["--set", "scheduler.window=5"];
    let metrics = |lines: &str| fs::write(folder.metrics_path(), lines).unwrap();
    // Phase II of iteration 11 is behind the checkpoint and will be forgotten.
    metrics("{\"iteration\":10,\"phase\":1}\n{\"iteration\":11,\"phase\":2}\n");
    assert_eq!(
        changed(&resumed(&folder, &other).unwrap()),
        ["scheduler.window: 4 → 5"]
    );
    metrics("{\"iteration\":9,\"phase\":2}\n{\"iteration\":10,\"fault\":\"NaN\"}\n");
    let refused = resumed(&folder, &other).err().unwrap();
    assert!(
        refused.contains("scheduler.window") && refused.contains("Phase II"),
        "{refused}"
    );
}

#[test]
fn a_run_without_a_checkpoint_begins_anew_with_whatever_is_asked_for() {
    let (_runs, folder) = run(true);
    fs::remove_dir_all(folder.checkpoints().path(10)).unwrap();
    let ready = resumed(&folder, &["--set", "policy.hidden=[32]"]).unwrap();
    assert!(ready.going_on.is_none());
    assert_eq!(
        ready.config.given("policy.hidden").unwrap().to_string(),
        "[32]"
    );
}

#[test]
fn a_damaged_checkpoint_is_refused_before_anything_is_written() {
    let (_runs, folder) = run(true);
    let before = fs::read(folder.config_path()).unwrap();
    fs::write(folder.checkpoints().path(10).join(CONFIG), "[ppo]").unwrap();
    let refused = resumed(&folder, &["--set", "ppo.epochs=3"]).err().unwrap();
    assert!(
        refused.contains("trained-with.toml") && refused.contains("truncated"),
        "{refused}"
    );
    assert_eq!(fs::read(folder.config_path()).unwrap(), before);
    assert_eq!(
        Place {
            runs_dir: folder.path().parent().unwrap().to_owned()
        }
        .find(Some("walk"))
        .unwrap(),
        folder
    );
}

#[test]
fn motion_that_is_another_than_was_learned_from_is_told() {
    let (runs, folder) = run(true);
    let walks = runs.path().join("walks");
    fs::create_dir(&walks).unwrap();
    let table = |name: &str, knee: f32| {
        let mut row = [0.0_f32; 30];
        // Upright at the height of standing; a leg that bends a little.
        (row[2], row[3], row[10]) = (0.78, 1.0, knee);
        let row = row.map(|x| x.to_string()).join(",");
        fs::write(walks.join(name), format!("{row}\n").repeat(60)).unwrap();
    };
    table("a.csv", 0.3);
    table("b.csv", 0.4);
    let clips = format!(
        "motion.clips=[{{folder={:?},fps=50.0,quaternion=\"wxyz\"}}]",
        walks.display().to_string()
    );
    let go_on = |set: &[&str]| {
        let ready = resumed(&folder, set).unwrap();
        let said = ready.motion_differences().unwrap();
        folder
            .note_motion(ready.iteration(), ready.motion.clone())
            .unwrap();
        ready.config.write(&folder.config_path(), "a test").unwrap();
        said
    };
    // Other clips by --set are a change of the configuration; there was nothing to compare them with.
    assert_eq!(go_on(&["--set", &clips]), [""; 0]);
    assert_eq!(go_on(&[]), [""; 0]);
    table("c.csv", 0.5);
    table("b.csv", 0.6);
    let said = go_on(&[]);
    assert_eq!(said.len(), 2, "{said:?}");
    assert!(
        said[0].ends_with("b.csv has changed") && said[1].ends_with("c.csv is new"),
        "{said:?}"
    );
    assert_eq!(go_on(&[]), [""; 0], "told once");
    fs::remove_file(walks.join("a.csv")).unwrap();
    assert!(go_on(&[])[0].ends_with("a.csv is gone"));
}

#[test]
fn a_damaged_configuration_is_refused_with_the_one_to_mend_it_by() {
    let (_runs, folder) = run(true);
    fs::write(folder.config_path(), "[run\niterations = ").unwrap();
    let refused = resumed(&folder, &[]).err().unwrap();
    assert!(refused.contains("config.toml: not valid TOML"), "{refused}");
    let own = folder.checkpoints().path(10).join(CONFIG);
    assert!(
        refused.contains(&format!("{}: copy that over it", own.display())),
        "{refused}"
    );
    fs::copy(own, folder.config_path()).unwrap();
    assert_eq!(changed(&resumed(&folder, &[]).unwrap()), [""; 0]);
    // Where there is no other, the error is all there is to say.
    let (_runs, folder) = run(false);
    fs::remove_file(folder.config_path()).unwrap();
    let refused = resumed(&folder, &[]).err().unwrap();
    assert!(
        refused.contains("config.toml") && !refused.contains("copy"),
        "{refused}"
    );
}

#[test]
fn robots_that_do_not_fit_are_left_behind_in_a_sentence() {
    let (_runs, folder) = run(true);
    let anew = |set: &[&str]| resumed(&folder, set).unwrap().going_on.unwrap().anew;
    // The smoke preset: 16 environments of two actors in rapier.
    let both = anew(&["--actors", "1", "--set", "physics=batched"]).unwrap();
    assert_eq!(
        both,
        "the checkpoint's robots are left behind, new episodes begin: they are in rapier, and it is batched now; each \
         actor had 8 environments, and it has 16 now"
    );
    for (set, left) in [
        (&[][..], false),
        (&["--set", "fleet.steps=16"], false),
        (&["--actors", "4", "--set", "fleet.environments=32"], false),
        (&["--set", "fleet.environments=8"], true),
    ] {
        assert_eq!(anew(set).is_some(), left, "{set:?}");
    }
}

#[test]
fn an_end_that_is_passed_is_refused_with_the_iteration() {
    let (_runs, folder) = run(true);
    let refused = resumed(&folder, &["--iterations", "9"]).err().unwrap();
    for part in ["at iteration 10", "run.iterations = 9", "--iterations 9"] {
        assert!(refused.contains(part), "{refused}");
    }
    for open in [
        &["--iterations", "10"][..],
        &["--iterations", "11"],
        &["--minutes", "1"],
    ] {
        assert!(resumed(&folder, open).is_ok(), "{open:?}");
    }
}
