//! The records of a study's runs as files: `records/<run>.json` in its folder.
//!
//! Separate because they outlive the folder: who comes later, in another clone, has them and not the runs.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use ::study::measure::Line;
use ::study::record::{Origin, sha256};
use ::study::{Judgement as Found, Measured, Record, Told};
use anyhow::{Context, Result, anyhow};
use configuration::resolve;
use run::{Config, FleetConfig, Folder, metrics};
use terminal::failure::usage;
use terminal::file;

use crate::folder::StudyFolder;
use crate::judgement::{Judgement, Judging};
use crate::plan::Planned;

/// Name of the folder.
pub(super) const FOLDER: &str = "records";
/// The policy in a checkpoint of a run.
const POLICY: &str = "policy.bin";

/// A folder of records.
#[derive(Clone, Debug)]
pub(super) struct Records(PathBuf);

impl Records {
    pub(super) fn new(folder: PathBuf) -> Self {
        Self(folder)
    }

    /// Where that of a run lies.
    pub(super) fn path(&self, run: &str) -> PathBuf {
        self.0.join(format!("{run}.json"))
    }

    /// That of a run, if there is one.
    pub(super) fn read(&self, run: &str) -> Result<Option<Record>> {
        let path = self.path(run);
        path.is_file().then(|| read(&path)).transpose()
    }

    /// All of them, by their names.
    pub(super) fn all(&self) -> Result<Vec<Record>> {
        if !self.0.is_dir() {
            return Ok(Vec::new());
        }
        let reading = || format!("reading the folder {}", self.0.display());
        let mut paths = Vec::new();
        for entry in std::fs::read_dir(&self.0).with_context(reading)? {
            let path = entry.with_context(reading)?.path();
            // A draft is what a killed program left, and nobody's record.
            if path
                .extension()
                .is_some_and(|extension| extension == "json")
            {
                paths.push(path);
            }
        }
        paths.sort();
        paths.iter().map(|path| read(path)).collect()
    }

    /// Keeps one; a reader sees the old file or the new one.
    pub(super) fn write(&self, record: &Record) -> Result<()> {
        let path = self.path(&record.run_name());
        let text = record
            .to_text()
            .map_err(|error| anyhow!("{}: {error}", path.display()))?;
        std::fs::create_dir_all(&self.0)
            .with_context(|| format!("making the folder {}", self.0.display()))?;
        run::replace_file(&path, text.as_bytes())
            .with_context(|| format!("writing {}", path.display()))
    }
}

fn read(path: &Path) -> Result<Record> {
    let shown = path.display();
    let text = file::read_text(path)?;
    let record = Record::parse(&text).map_err(|error| usage(format!("{shown}: {error}")))?;
    let name = record.run_name();
    if path.file_stem().is_none_or(|stem| stem != name.as_str()) {
        return Err(usage(format!(
            "{shown}: it is the record of {}; rename it to {}.json",
            wording::quoted(&name),
            wording::line(&name)
        )));
    }
    Ok(record)
}

/// The configuration of a record, in today's words and with the defaults of keys that came later.
pub(super) fn configuration(record: &Record, path: &Path) -> Result<Config> {
    let text = toml::to_string(&record.configuration)?;
    let mut config = Config::parse_written(&text, &path.display().to_string())?;
    resolve::settle_all(&mut config)?;
    Ok(config)
}

/// Refuses a record of a run that the study would now make otherwise: it would stand in a table beside what it is not.
pub(super) fn check(planned: &Planned, records: &Records) -> Result<()> {
    let Some(record) = records.read(&planned.name)? else {
        return Ok(());
    };
    let path = records.path(&planned.name);
    match resolve::difference(&configuration(&record, &path)?, &planned.config) {
        None => Ok(()),
        Some((theirs, ours)) => Err(usage(format!(
            "{}: this run was made with `{theirs}` and the study now says `{ours}`; use another --out or --records, or \
             move the record away to have the run made anew",
            path.display()
        ))),
    }
}

/// Whether a record is judged as is asked.
fn is_judged(record: &Record, judging: Option<&Judging>) -> bool {
    match (judging, &record.judgement) {
        (None, _) => true,
        (Some(asked), Some(found)) => {
            found.evaluate == asked.evaluation && found.judge_sha256 == asked.sha256
        }
        (Some(_), None) => false,
    }
}

/// Whether a run has a record that counts: nothing is left to do for it.
pub(super) fn stands(folder: &StudyFolder, name: &str, judging: Option<&Judging>) -> Result<bool> {
    let record = folder.records().read(name)?;
    Ok(record.is_some_and(|record| is_judged(&record, judging)))
}

/// Takes over the records that lie in `known` of runs that are to be made, and refuses those that cannot count.
pub(super) fn bring(
    folder: &StudyFolder,
    planned: &[Planned],
    known: Option<&Records>,
    judging: Option<&Judging>,
) -> Result<()> {
    let ours = folder.records();
    for run in planned {
        check(run, &ours)?;
        if let Some(known) = known
            && ours.read(&run.name)?.is_none()
        {
            check(run, known)?;
            if let Some(record) = known.read(&run.name)? {
                may_count(&record, known, folder, judging)?;
                ours.write(&record)?;
            }
        }
        if let Some(record) = ours.read(&run.name)? {
            may_count(&record, &ours, folder, judging)?;
        }
    }
    Ok(())
}

/// A record that was judged otherwise counts only where the run is there to be judged anew.
fn may_count(
    record: &Record,
    records: &Records,
    folder: &StudyFolder,
    judging: Option<&Judging>,
) -> Result<()> {
    let name = record.run_name();
    if is_judged(record, judging) || folder.run(&name)?.is_some() {
        return Ok(());
    }
    Err(usage(format!(
        "{}: it was judged otherwise than [evaluate] asks, or by another judge, and the run is not here to be judged \
         anew; leave [evaluate] as it was, or move the record away to have the run made again",
        records.path(&name).display()
    )))
}

/// What is kept of a run that has done all its iterations, and is judged if that is asked.
pub(super) fn of(run: &Folder, planned: &Planned, judging: Option<&Judging>) -> Result<Record> {
    let lines = metrics::read::<Line>(&run.metrics_path())?;
    let fleet: FleetConfig = planned.config.section()?;
    let newest = run.checkpoints().open(planned.target, None)?;
    let policy = newest
        .part(POLICY)
        .with_context(|| format!("{} has no {POLICY}", run.path().display()))?;
    Ok(Record {
        entry: planned.cell.entry.clone(),
        seed: planned.cell.seed,
        target: planned.target,
        configuration: toml::from_str(&planned.config.to_toml())?,
        origin: Origin {
            policy_sha256: sha256(policy),
            motion: motion(run)?,
            ..here()?.clone()
        },
        told: Told::of(&lines, planned.target),
        measured: Measured::of(&lines, fleet.steps as u64),
        judgement: judging.map(|asked| judgement(run, asked)).transpose()?,
    })
}

fn judgement(run: &Folder, asked: &Judging) -> Result<Found> {
    let path = Judgement::path(run);
    let found = Judgement::read(run)?.and_then(|found| found.rows(run, Some(&asked.evaluation)));
    let found =
        found.with_context(|| format!("{} is no judgement as was asked", path.display()))?;
    let rows: Result<_, _> = found.into_iter().map(serde_json::from_value).collect();
    Ok(Found {
        evaluate: asked.evaluation.clone(),
        judge_sha256: asked.sha256.clone(),
        rows: rows.map_err(|error| {
            anyhow!("{}: {}", path.display(), wording::said(&error.to_string()))
        })?,
    })
}

/// The motion files that a run has learned from, by their names: where they lay is of no use elsewhere.
pub(super) fn motion(run: &Folder) -> Result<Vec<(String, String)>> {
    let files = run
        .motion()?
        .pop()
        .map_or_else(Vec::new, |learned| learned.files);
    let name = |file: &Path| {
        file.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    Ok(files
        .into_iter()
        .map(|print| (name(&print.file), print.sha256))
        .collect())
}

/// The program and the machine.
fn here() -> Result<&'static Origin> {
    static HERE: OnceLock<Origin> = OnceLock::new();
    if let Some(here) = HERE.get() {
        return Ok(here);
    }
    let program = std::env::current_exe().context("finding this program's own path")?;
    let bytes =
        std::fs::read(&program).with_context(|| format!("reading {}", program.display()))?;
    let facts = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = facts
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(": "))
        .map_or("unknown", |(_, model)| model);
    Ok(HERE.get_or_init(|| Origin {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        program_sha256: sha256(&bytes),
        policy_sha256: String::new(),
        processor: model.to_owned(),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        motion: Vec::new(),
    }))
}

#[cfg(test)]
pub(crate) mod tests;
