//! From a study file to runs whose every value is known before anything starts.

use std::path::Path;

use ::study::{Cell, StudyFile, matrix};
use anyhow::{Context, Result};
use configuration::{presets, resolve};
use run::{Config, RunConfig};
use terminal::failure::usage;
use wording::count;

use super::folder::StudyFolder;
use super::records;

/// A run that is to be made.
#[derive(Debug)]
pub(super) struct Planned {
    pub(super) name: String,
    /// Which run of the study it is.
    pub(super) cell: Cell,
    /// Every value, defaults included.
    pub(super) config: Config,
    /// Iterations.
    pub(super) target: u64,
    /// Transitions of an iteration.
    pub(super) rows: u64,
    /// Cores that it uses: actors and learner take turns.
    pub(super) cores: usize,
}

/// All runs in their order; `beside` is the folder that the file's own presets are looked for in.
pub(super) fn plan(file: &StudyFile, beside: &Path, origin: &str) -> Result<Vec<Planned>> {
    plan_cells(&file.cells(), file, beside, origin)
}

/// These runs, made as `file` makes its own.
fn plan_cells(
    cells: &[Cell],
    file: &StudyFile,
    beside: &Path,
    origin: &str,
) -> Result<Vec<Planned>> {
    cells
        .iter()
        .map(|cell| {
            let planned = planned(file, cell, beside, origin);
            planned.with_context(|| format!("planning {}", cell.run_name()))
        })
        .collect()
}

fn planned(study: &StudyFile, cell: &Cell, beside: &Path, origin: &str) -> Result<Planned> {
    // A file beside the study, or a preset of ours.
    let found = |given: &str| {
        let own = beside.join(given);
        let own = own.is_file().then(|| own.display().to_string());
        own.unwrap_or_else(|| given.to_owned())
    };
    let given = found(&cell.entry.preset);
    let preset = match &study.on {
        Some(base) => presets::find_on(&given, &found(base))?,
        None => presets::find(&given)?,
    };
    let mut config = preset.config;
    config.merge(Config::parse(&toml::to_string(&study.overrides)?, origin)?);
    for (key, value) in &cell.entry.values {
        config.put(key, value.clone(), origin);
    }
    config.put("run.seed", i64::try_from(cell.seed)?, origin);
    config.put("run.minutes", 0.0, origin);
    resolve::anchor_files(&mut config)?;
    // First for the fleet, whose size turns transitions into iterations.
    let fleet = resolve::resolve(&mut config)?.fleet;
    let rows = (fleet.actors * fleet.environments_per_actor() * fleet.steps) as u64;
    let target = study.budget().iterations(rows);
    config.put("run.iterations", i64::try_from(target)?, origin);
    let resolved = resolve::resolve(&mut config)?;
    let threads = config
        .given("ppo.threads")
        .and_then(|threads| threads.as_integer());
    Ok(Planned {
        name: cell.run_name(),
        cell: cell.clone(),
        target,
        rows,
        cores: resolved
            .fleet
            .actors
            .max(threads.unwrap_or(1).unsigned_abs() as usize),
        config,
    })
}

/// All runs that belong to the study: those that were asked for earlier and have been made, and those of `file`. Refuses
/// `file` if any of those that are there was made with other values than it now gives.
pub(super) fn together(
    file: &StudyFile,
    planned: &[Planned],
    folder: &StudyFolder,
    beside: &Path,
    origin: &str,
) -> Result<Vec<Cell>> {
    for run in planned {
        check_unchanged(run, folder)?;
        records::check(run, &folder.records())?;
    }
    let mut earlier = Vec::new();
    for cell in folder.cells()? {
        let now = planned.iter().any(|run| run.name == cell.run_name());
        // Whoever removes a run's folder and its record takes the run out of the study.
        let name = cell.run_name();
        if now || folder.run(&name)?.is_some() || folder.records().path(&name).is_file() {
            earlier.push((cell, now));
        }
    }
    let not_now = earlier
        .iter()
        .filter(|(_, now)| !now)
        .map(|(cell, _)| cell.clone());
    let not_now: Vec<Cell> = not_now.collect();
    for run in &plan_cells(&not_now, file, beside, origin)? {
        check_unchanged(run, folder)?;
        records::check(run, &folder.records())?;
    }
    let earlier: Vec<Cell> = earlier.into_iter().map(|(cell, _)| cell).collect();
    Ok(matrix::together(&earlier, &file.cells()))
}

/// Refuses to go on with a run that was made with other values: it would stand in a table beside what it is not.
pub(super) fn check_unchanged(planned: &Planned, folder: &StudyFolder) -> Result<()> {
    let Some(run) = folder.run(&planned.name)? else {
        return Ok(());
    };
    let Some((theirs, ours)) = resolve::difference(&run.config()?, &planned.config) else {
        return Ok(());
    };
    let name = &planned.name;
    Err(usage(format!(
        "run {name} was made with `{theirs}` and the study now says `{ours}`; use another --out, or remove the run"
    )))
}

/// The target of a run that was made, from its own configuration.
pub(super) fn target_of(config: &Config) -> Result<u64> {
    Ok(config.section::<RunConfig>()?.iterations)
}

/// What would be run, for --dry-run.
pub(super) fn describe(planned: &[Planned]) -> String {
    let mut lines: Vec<String> = planned
        .iter()
        .map(|run| {
            let samples = run.target * run.rows;
            format!(
                "{}: {} of {}, {samples} in all",
                run.name,
                count(run.target, "iteration"),
                count(run.rows, "transition")
            )
        })
        .collect();
    let all: u64 = planned.iter().map(|run| run.target * run.rows).sum();
    lines.push(format!(
        "{}, {}",
        count(planned.len(), "run"),
        count(all, "transition")
    ));
    lines.join("\n")
}

#[cfg(test)]
mod tests;
