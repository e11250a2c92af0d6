//! From the folder of a study to what its report is made of.

use std::collections::BTreeMap;

use ::study::{Benchmark, Evaluation, Measured, Record, Results, Run, State, matrix};
use anyhow::{Context, Result, anyhow};
use run::motion::{Print, differences};
use run::{FleetConfig, Folder, metrics};
use wording::count;

use super::folder::StudyFolder;
use super::judgement::Judgement;
use super::plan::target_of;

/// Reads every run of the study; `to_study` leads from the report to the study's folder.
pub(super) fn results(folder: &StudyFolder, to_study: &str) -> Result<Results> {
    let mut file = folder.file()?;
    let cells = folder.cells()?;
    file.seeds = matrix::seeds(&cells);
    let mut runs = Vec::new();
    let mut otherwise = 0;
    for cell in &cells {
        let name = cell.run_name();
        let mut run = Run {
            entry: cell.entry.name.clone(),
            seed: cell.seed,
            folder: format!("{to_study}runs/{name}"),
            state: State::Missing,
            target: 0,
            records: Vec::new(),
            measured: None,
            judged: Vec::new(),
            name,
        };
        if let Some(made) = folder.run(&run.name)? {
            let judged = fill(&mut run, &made, file.evaluate.as_ref());
            otherwise += usize::from(judged.with_context(|| format!("reading run {}", run.name))?);
        }
        if let Some(words) = folder.failure(&run.name)
            && run.state != State::Finished
        {
            run.state = State::Failed(words);
        }
        runs.push(run);
    }
    let benchmark = folder.json("overhead.json")?;
    let benchmark: Option<Benchmark> = benchmark
        .map(serde_json::from_value)
        .transpose()
        .map_err(|error| anyhow!("overhead.json: {}", wording::said(&error.to_string())))?;
    Ok(Results {
        entries: matrix::entries(&cells),
        facts: facts(folder, &runs, otherwise)?,
        file,
        runs,
        benchmark,
    })
}

/// What a run's folder tells; whether it was judged otherwise than `evaluate` asks, so that it does not count.
fn fill(run: &mut Run, folder: &Folder, evaluate: Option<&Evaluation>) -> Result<bool> {
    let config = folder.config()?;
    let fleet: FleetConfig = config.section("fleet")?;
    run.target = target_of(&config)?;
    run.records = metrics::read::<Record>(&folder.metrics_path())?;
    let reached = run.records.last().map_or(0, |record| record.iteration);
    run.state = if reached >= run.target {
        State::Finished
    } else {
        State::Unfinished
    };
    if run.state == State::Finished {
        run.measured = Measured::of(&run.records, fleet.steps as u64);
    }
    let there = Judgement::path(folder).is_file();
    let rows = Judgement::read(folder)?.and_then(|judgement| judgement.rows(folder, evaluate));
    let otherwise = there && evaluate.is_some() && rows.is_none();
    for row in rows.into_iter().flatten() {
        let judged = serde_json::from_value(row).map_err(|error| {
            let path = Judgement::path(folder);
            anyhow!("{}: {}", path.display(), wording::said(&error.to_string()))
        });
        run.judged.push(judged?);
    }
    Ok(otherwise)
}

/// What all runs have in common, for the head of the report.
fn facts(folder: &StudyFolder, runs: &[Run], otherwise: usize) -> Result<Vec<(String, String)>> {
    let mut facts = Vec::new();
    let mut tell = |name: &str, value: String| facts.push((name.to_owned(), value));
    if otherwise > 0 {
        tell(
            "judgements left out",
            format!(
                "of {}, found under another [evaluate] or before it went on; `ampco study run` with their seeds and \
                 methods finds them anew",
                count(otherwise, "run")
            ),
        );
    }
    if let Some(origin) = folder.json("origin.json")? {
        let text = |key: &str| origin[key].as_str().unwrap_or("unknown").to_owned();
        tell("command", text("command"));
        tell(
            "machine",
            format!(
                "{}, {}",
                text("processor"),
                count(origin["cores"].as_u64().unwrap_or(0), "core")
            ),
        );
    }
    for words in other_motion(folder, runs)? {
        tell("reference motion not the same", words);
    }
    let begun = runs.iter().find(|run| !run.records.is_empty());
    let Some(run) = begun else {
        return Ok(facts);
    };
    if let Some(made) = folder.run(&run.name)? {
        let config = made.config()?;
        let value = |key: &str| {
            let given = config.given(key);
            given.map_or_else(
                || "–".to_owned(),
                |value| value.to_string().replace('"', ""),
            )
        };
        tell(
            "robots, control steps per iteration",
            format!("{}, {}", value("fleet.environments"), value("fleet.steps")),
        );
        tell("iterations of a run", run.target.to_string());
        tell("physics in training", value("task.physics"));
        tell("scheduler's window, iterations", value("scheduler.window"));
        tell(
            "percentile, alpha",
            format!(
                "{}, {}",
                value("scheduler.percentile"),
                value("scheduler.alpha")
            ),
        );
        tell("kernel of Eq. 14", value("task.reward.track.kernel"));
    }
    let rates: Vec<f64> = runs
        .iter()
        .filter_map(|run| run.records.last())
        .filter(|newest| newest.timing.seconds > 0.0)
        .map(|newest| newest.samples as f64 / newest.timing.seconds)
        .collect();
    let middle = ::study::statistics::median(&rates);
    if middle.is_finite() {
        tell(
            "transitions per second, median of the runs",
            format!("{middle:.0}"),
        );
    }
    Ok(facts)
}

/// Which runs have learned from other motion files than the first run of their method: the mean over such is of neither.
fn other_motion(folder: &StudyFolder, runs: &[Run]) -> Result<Vec<String>> {
    let mut first: BTreeMap<&str, (&str, Vec<Print>)> = BTreeMap::new();
    let mut said = Vec::new();
    for run in runs {
        let Some(made) = folder.run(&run.name)? else {
            continue;
        };
        let newest = made.motion()?.pop();
        let files = newest.map_or_else(Vec::new, |learned| learned.files);
        match first.get(run.entry.as_str()) {
            None => {
                first.insert(&run.entry, (&run.name, files));
            }
            Some((name, expected)) => {
                let differences = differences(expected, &files);
                if let Some(one) = differences.first() {
                    said.push(format!("{} and {name}: {one}", run.name));
                }
            }
        }
    }
    Ok(said)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::study::StudyFile;
    use serde_json::{Value, json};

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
        let results = results(&folder, "../").unwrap();
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
        assert_eq!(results.runs[0].folder, "../runs/ampco-seed1");
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
            let found = file(3 + seed, "[1]").evaluate.unwrap();
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
        let first = results(&folder, "../").unwrap();
        assert_eq!(judged(&first), [1, 0]);
        assert!(left_out(&first).unwrap().starts_with("of 1 run,"));

        let all = matrix::together(&folder.cells().unwrap(), &file(5, "[3]").cells());
        folder.begin(&file(5, "[3]"), &[], &all).unwrap();
        let second = results(&folder, "../").unwrap();
        assert_eq!(judged(&second), [0, 1, 0]);
        assert_eq!(second.file.seeds, [1, 2, 3]);
        assert_eq!(second.entries.len(), 1);

        folder
            .write(
                "study.toml",
                &text(4, "[1]").replace("[evaluate]", "[evaluate]\nseconds = 2.0"),
            )
            .unwrap();
        assert_eq!(judged(&results(&folder, "../").unwrap()), [0, 0, 0]);
        let without = text(4, "[1]")
            .split("[evaluate]")
            .next()
            .unwrap()
            .to_owned();
        folder.write("study.toml", &without).unwrap();
        let none = results(&folder, "../").unwrap();
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
        let facts = results(&folder, "../").unwrap().facts;
        let told: Vec<&str> = facts.iter().map(|fact| fact.1.as_str()).collect();
        assert_eq!(
            told,
            ["ampco-seed2 and ampco-seed1: /walks/a.csv has changed"]
        );
    }
}
