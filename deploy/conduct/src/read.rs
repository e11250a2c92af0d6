//! From the folder of a study to what its report is made of.

mod facts;

use ::study::{Benchmark, Evaluation, Measured, Record, Results, Run, State, matrix};
use anyhow::{Context, Result, anyhow};
use run::{FleetConfig, Folder, metrics};

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
        facts: facts::of(folder, &runs, otherwise)?,
        file,
        runs,
        benchmark,
    })
}

/// What a run's folder tells; whether it was judged otherwise than `evaluate` asks, so that it does not count.
fn fill(run: &mut Run, folder: &Folder, evaluate: Option<&Evaluation>) -> Result<bool> {
    let config = folder.config()?;
    let fleet: FleetConfig = config.section()?;
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

#[cfg(test)]
mod tests;
