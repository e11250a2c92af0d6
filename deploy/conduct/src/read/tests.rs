//! Folders of studies, read.

use super::*;
use ::study::StudyFile;
use run::motion::Print;
use serde_json::{Value, json};

use super::judgement::{Judgement, Judging};

/// As from the report's own folder.
fn up(path: &str) -> String {
    format!("../{path}")
}

#[test]
fn a_folder_is_read_whatever_its_runs_came_to() {
    let place = tempfile::tempdir().unwrap();
    let folder = StudyFolder::create(place.path()).unwrap();
    let text = "title = 't'\nmethods = ['ampco']\nseeds = [1, 2, 3, 4]\niterations = 3";
    folder.write("study.toml", text).unwrap();
    for (seed, lines) in [(1, 3), (2, 2), (3, 1)] {
        let run = Folder::create(&folder.runs(), &format!("ampco-seed{seed}")).unwrap();
        let config = "[run]\niterations = 3\n[fleet]\nsteps = 1000";
        std::fs::write(run.config_path(), config).unwrap();
        let mut metrics = run::Metrics::open(&run.metrics_path()).unwrap();
        for iteration in 1..=lines {
            let line: Value = json!({
                "iteration": iteration, "samples": 10 * iteration, "rmse": 0.5, "energy_j": 100.0,
                "style_mean": 0.25, "timing": { "seconds": 2.0 },
            });
            metrics.append(&line).unwrap();
        }
    }
    folder.note("ampco-seed3", Some("it fell over")).unwrap();
    let results = results(&folder, up).unwrap();
    let states: Vec<&State> = results.runs.iter().map(|run| &run.state).collect();
    let failed = State::Failed("it fell over".to_owned());
    assert_eq!(
        states,
        [
            &State::Finished,
            &State::Unfinished,
            &failed,
            &State::Missing
        ]
    );
    assert!(results.runs[0].measured.is_some() && results.runs[1].measured.is_none());
    assert_eq!(results.runs[0].link, "../runs/ampco-seed1");
    let rate = results
        .facts
        .iter()
        .find(|fact| fact.0.starts_with("transitions"));
    assert_eq!(rate.unwrap().1, "10"); // the middle of 15, 10 and 5 a second
}

#[test]
fn judgements_of_another_kind_are_left_out_and_earlier_seeds_stay() {
    let place = tempfile::tempdir().unwrap();
    let folder = StudyFolder::create(place.path()).unwrap();
    let text = |episodes: u32, seeds: &str| {
        format!(
            "title = 't'\nmethods = ['ampco']\nseeds = {seeds}\niterations = 1\n\
             [evaluate]\ncommands = [[0.5, 0.0, 0.0]]\nepisodes = {episodes}"
        )
    };
    let file = |episodes, seeds| StudyFile::parse(&text(episodes, seeds)).unwrap();
    folder
        .begin(&file(4, "[1, 2]"), &[], &file(4, "[1, 2]").cells())
        .unwrap();
    for seed in [1, 2] {
        let run = Folder::create(&folder.runs(), &format!("ampco-seed{seed}")).unwrap();
        std::fs::write(run.config_path(), "[run]\niterations = 1").unwrap();
        let draft = Judgement::path(&run).with_extension("draft");
        std::fs::create_dir_all(draft.parent().unwrap()).unwrap();
        let row = json!([{ "command": [0.5, 0.0, 0.0], "survival": 1.0, "rmse": 0.1, "rmse_yaw_rate": 0.2, "energy_j": 9.0, "gait": "walk" }]);
        std::fs::write(&draft, row.to_string()).unwrap();
        let found = Judging::of(&file(3 + seed, "[1]"), place.path())
            .unwrap()
            .unwrap();
        Judgement::keep(&run, &found, &draft).unwrap();
    }
    // Seed 1 was judged by four episodes, seed 2 by five.
    let judged = |results: &Results| {
        let runs = results.runs.iter();
        runs.map(|run| run.judged.len()).collect::<Vec<_>>()
    };
    let left_out = |results: &Results| {
        results
            .facts
            .iter()
            .find(|fact| fact.0 == "judgements left out")
            .map(|fact| fact.1.clone())
    };
    let first = results(&folder, up).unwrap();
    assert_eq!(judged(&first), [1, 0]);
    assert!(left_out(&first).unwrap().starts_with("of 1 run,"));

    let all = matrix::together(&folder.cells().unwrap(), &file(5, "[3]").cells());
    folder.begin(&file(5, "[3]"), &[], &all).unwrap();
    let second = results(&folder, up).unwrap();
    assert_eq!(judged(&second), [0, 1, 0]);
    assert_eq!(second.file.seeds, [1, 2, 3]);
    assert_eq!(second.entries.len(), 1);

    folder
        .write(
            "study.toml",
            &text(4, "[1]").replace("[evaluate]", "[evaluate]\nseconds = 2.0"),
        )
        .unwrap();
    assert_eq!(judged(&results(&folder, up).unwrap()), [0, 0, 0]);
    let without = text(4, "[1]")
        .split("[evaluate]")
        .next()
        .unwrap()
        .to_owned();
    folder.write("study.toml", &without).unwrap();
    let none = results(&folder, up).unwrap();
    assert_eq!((judged(&none), left_out(&none)), (vec![0, 0, 0], None));
}

#[test]
fn runs_of_a_method_that_learned_from_other_files_are_named() {
    let place = tempfile::tempdir().unwrap();
    let folder = StudyFolder::create(place.path()).unwrap();
    let text = "title = 't'\nmethods = ['ampco', 'amp-0.5']\nseeds = [1, 2]\niterations = 1";
    folder.write("study.toml", text).unwrap();
    let print = |sha256: &str| Print {
        file: "/walks/a.csv".into(),
        sha256: sha256.into(),
    };
    for (name, files) in [
        ("ampco-seed1", vec![print("1")]),
        ("ampco-seed2", vec![print("2")]),
        // Another method may have other motion, or none from files.
        ("amp-0.5-seed1", vec![]),
        ("amp-0.5-seed2", vec![]),
    ] {
        let run = Folder::create(&folder.runs(), name).unwrap();
        std::fs::write(run.config_path(), "[run]\niterations = 1").unwrap();
        run.note_motion(0, files).unwrap();
    }
    let facts = results(&folder, up).unwrap().facts;
    let told: Vec<&str> = facts.iter().map(|fact| fact.1.as_str()).collect();
    assert_eq!(told, ["ampco-seed2 and ampco-seed1: a.csv has changed"]);
}
