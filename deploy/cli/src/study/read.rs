//! From the folder of a study to what its report is made of.

use ::study::{Benchmark, Judged, Measured, Record, Results, Run, State};
use anyhow::{Context, Result};
use run::{FleetConfig, Folder, metrics};

use super::folder::StudyFolder;
use super::plan::target_of;

/// Reads every run of the study; `to_study` leads from the report to the study's folder.
pub(super) fn results(folder: &StudyFolder, to_study: &str) -> Result<Results> {
    let file = folder.file()?;
    let mut runs = Vec::new();
    for cell in file.cells() {
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
            fill(&mut run, &made).with_context(|| format!("reading run {}", run.name))?;
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
        .context("reading overhead.json")?;
    Ok(Results {
        entries: file.entries(),
        facts: facts(folder, &runs)?,
        file,
        runs,
        benchmark,
    })
}

/// What a run's folder tells.
fn fill(run: &mut Run, folder: &Folder) -> Result<()> {
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
    let evaluation = StudyFolder::evaluation(folder);
    if evaluation.is_file() {
        let bytes = std::fs::read(&evaluation)
            .with_context(|| format!("reading {}", evaluation.display()))?;
        run.judged = serde_json::from_slice::<Vec<Judged>>(&bytes)
            .with_context(|| format!("reading {}", evaluation.display()))?;
    }
    Ok(())
}

/// What all runs have in common, for the head of the report.
fn facts(folder: &StudyFolder, runs: &[Run]) -> Result<Vec<(String, String)>> {
    let mut facts = Vec::new();
    let mut tell = |name: &str, value: String| facts.push((name.to_owned(), value));
    if let Some(origin) = folder.json("origin.json")? {
        let text = |key: &str| origin[key].as_str().unwrap_or("unknown").to_owned();
        tell("command", text("command"));
        tell(
            "machine",
            format!("{}, {} cores", text("processor"), origin["cores"]),
        );
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
        tell("kernel of Eq. 14", value("task.kernel"));
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

#[cfg(test)]
mod tests {
    use super::*;
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
}
