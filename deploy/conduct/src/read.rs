//! From the folder of a study to what its report is made of.

mod facts;

use std::collections::BTreeMap;

use ::study::{
    Benchmark, Cell, Evaluation, Judgement, Line, Measured, Record, Results, Run, State, Told,
    matrix,
};
use anyhow::{Context, Result, anyhow};
use run::{FleetConfig, Folder, metrics};

use super::folder::StudyFolder;
use super::judgement;
use super::plan::target_of;
use super::records;
use facts::Made;

/// Reads every run of the study, by its record if it has one; `link` makes of a path in the study's folder what the report
/// links to.
pub(super) fn results(folder: &StudyFolder, link: impl Fn(&str) -> String) -> Result<Results> {
    let mut file = folder.file()?;
    let records = folder.records();
    let kept = records.all()?;
    let of_records: Vec<Cell> = kept.iter().map(Record::cell).collect();
    let cells = matrix::ordered(
        matrix::together(&of_records, &folder.cells()?),
        &file.entries(),
    );
    file.seeds = matrix::seeds(&cells);
    let mut kept: BTreeMap<String, Record> = kept
        .into_iter()
        .map(|record| (record.run_name(), record))
        .collect();
    let judge = kept
        .values()
        .find_map(|record| Some(record.judgement.as_ref()?.judge_sha256.clone()));
    let (mut runs, mut made) = (Vec::new(), Vec::new());
    let mut otherwise = 0;
    for cell in &cells {
        let name = cell.run_name();
        if let Some(mut record) = kept.remove(&name) {
            made.push(Some(Made::of_record(&record, &records.path(&name))?));
            // Found otherwise than what stands beside it.
            let alike = |found: &Judgement| {
                Some(&found.evaluate) == file.evaluate.as_ref()
                    && Some(&found.judge_sha256) == judge.as_ref()
            };
            let there = record.judgement.is_some() && file.evaluate.is_some();
            record.judgement = record.judgement.filter(alike);
            otherwise += usize::from(there && record.judgement.is_none());
            runs.push(Run::of(
                record,
                link(&format!("{}/{name}.json", records::FOLDER)),
            ));
            continue;
        }
        let mut run = Run {
            entry: cell.entry.name.clone(),
            seed: cell.seed,
            link: link(&format!("runs/{name}")),
            state: State::Missing,
            target: 0,
            told: Told::default(),
            measured: None,
            judged: Vec::new(),
            name,
        };
        let there = folder.run(&run.name)?;
        if let Some(there) = &there {
            let judged = fill(&mut run, there, file.evaluate.as_ref());
            otherwise += usize::from(judged.with_context(|| format!("reading run {}", run.name))?);
        }
        made.push(there.as_ref().map(Made::of_run).transpose()?);
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
        facts: facts::of(folder, &runs, &made, otherwise)?,
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
    let lines = metrics::read::<Line>(&folder.metrics_path())?;
    run.told = Told::of(&lines, run.target);
    run.state = if run.told.iteration >= run.target {
        State::Finished
    } else {
        State::Unfinished
    };
    if run.state == State::Finished {
        run.measured = Measured::of(&lines, fleet.steps as u64);
    }
    let path = judgement::Judgement::path(folder);
    let rows = judgement::Judgement::read(folder)?;
    let rows = rows.and_then(|judgement| judgement.rows(folder, evaluate));
    let otherwise = path.is_file() && evaluate.is_some() && rows.is_none();
    for row in rows.into_iter().flatten() {
        let judged = serde_json::from_value(row)
            .map_err(|error| anyhow!("{}: {}", path.display(), wording::said(&error.to_string())));
        run.judged.push(judged?);
    }
    Ok(otherwise)
}

#[cfg(test)]
mod tests;
