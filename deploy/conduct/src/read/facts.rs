//! What all runs of a study have in common, for the head of its report, and where they differ though they should not.

use std::collections::BTreeMap;
use std::path::Path;

use ::study::{Record, Run};
use anyhow::Result;
use run::motion::{Print, differences};
use run::{Config, Folder};
use wording::count;

use crate::folder::StudyFolder;
use crate::records;

/// How a run was made, by its record or in its folder.
pub(super) struct Made {
    config: Config,
    /// Processor, and how many cores; known of a record.
    machine: Option<(String, usize)>,
    /// Motion files by name and hash.
    motion: Vec<(String, String)>,
}

impl Made {
    pub(super) fn of_record(record: &Record, path: &Path) -> Result<Self> {
        Ok(Self {
            config: records::configuration(record, path)?,
            machine: Some((record.origin.processor.clone(), record.origin.cores)),
            motion: record.origin.motion.clone(),
        })
    }

    pub(super) fn of_run(run: &Folder) -> Result<Self> {
        Ok(Self {
            config: run.config()?,
            machine: None,
            motion: records::motion(run)?,
        })
    }
}

/// What all runs have in common, for the head of the report; `made` is beside `runs`.
pub(super) fn of(
    folder: &StudyFolder,
    runs: &[Run],
    made: &[Option<Made>],
    otherwise: usize,
) -> Result<Vec<(String, String)>> {
    let mut facts = Vec::new();
    let mut tell = |name: &str, value: String| facts.push((name.to_owned(), value));
    if otherwise > 0 {
        tell(
            "judgements left out",
            format!(
                "of {}, found under another [evaluate], by another judge or before it went on; `ampco study run` with \
                 their seeds and methods finds them anew",
                count(otherwise, "run")
            ),
        );
    }
    for words in machines(folder, made)? {
        tell("machine", words);
    }
    for words in other_motion(runs, made) {
        tell("reference motion not the same", words);
    }
    let begun = runs
        .iter()
        .zip(made)
        .find(|(run, _)| run.told.iteration > 0);
    let Some((run, first)) = begun else {
        return Ok(facts);
    };
    if let Some(Made { config, .. }) = first {
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
        tell("physics in training", value("fleet.physics"));
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
    let seconds: f64 = runs.iter().map(|run| run.told.seconds).sum();
    if seconds > 0.0 {
        tell(
            "training of all runs, hours",
            format!("{:.2}", seconds / 3600.0),
        );
    }
    let rates: Vec<f64> = runs
        .iter()
        .map(|run| &run.told)
        .filter(|told| told.seconds > 0.0)
        .map(|told| told.samples as f64 / told.seconds)
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

/// Which machines made the runs: by their records, else the one that conducts the study.
fn machines(folder: &StudyFolder, made: &[Option<Made>]) -> Result<Vec<String>> {
    let mut runs_of: BTreeMap<&(String, usize), usize> = BTreeMap::new();
    for machine in made
        .iter()
        .flatten()
        .filter_map(|made| made.machine.as_ref())
    {
        *runs_of.entry(machine).or_default() += 1;
    }
    let words = |processor: &str, cores: u64| format!("{processor}, {}", count(cores, "core"));
    if runs_of.is_empty() {
        let origin = folder.json("origin.json")?;
        return Ok(origin
            .iter()
            .map(|origin| {
                let processor = origin["processor"].as_str().unwrap_or("unknown");
                words(processor, origin["cores"].as_u64().unwrap_or(0))
            })
            .collect());
    }
    Ok(runs_of
        .into_iter()
        .map(|((processor, cores), runs)| {
            format!(
                "{} ({})",
                words(processor, *cores as u64),
                count(runs, "run")
            )
        })
        .collect())
}

/// Which runs have learned from other motion files than the first run of their method: the mean over such is of neither.
fn other_motion(runs: &[Run], made: &[Option<Made>]) -> Vec<String> {
    let prints = |motion: &[(String, String)]| -> Vec<Print> {
        let print = |(file, sha256): &(String, String)| Print {
            file: file.into(),
            sha256: sha256.clone(),
        };
        motion.iter().map(print).collect()
    };
    let mut first: BTreeMap<&str, (&str, Vec<Print>)> = BTreeMap::new();
    let mut said = Vec::new();
    for (run, made) in runs.iter().zip(made) {
        let Some(made) = made else {
            continue;
        };
        let files = prints(&made.motion);
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
    said
}
