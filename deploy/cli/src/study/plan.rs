//! From a study file to runs whose every value is known before anything starts.

use std::path::Path;

use ::study::{Cell, StudyFile};
use anyhow::{Context, Result};
use run::{Config, RunConfig};

use super::folder::StudyFolder;
use crate::failure::usage;
use crate::{presets, resolve};

/// A run that is to be made.
#[derive(Debug)]
pub(super) struct Planned {
    pub(super) name: String,
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
    file.cells()
        .iter()
        .map(|cell| {
            let planned = planned(file, cell, beside, origin);
            planned.with_context(|| format!("planning {}", cell.run_name()))
        })
        .collect()
}

fn planned(study: &StudyFile, cell: &Cell, beside: &Path, origin: &str) -> Result<Planned> {
    let given = &cell.entry.preset;
    let own = beside.join(given);
    let own = own.is_file().then(|| own.display().to_string());
    let preset = presets::find(own.as_deref().unwrap_or(given))?;
    let mut config = preset.config;
    config.merge(Config::parse(&toml::to_string(&study.overrides)?, origin)?);
    for (key, value) in &cell.entry.values {
        config.put(key, value.clone(), origin);
    }
    config.put("run.seed", i64::try_from(cell.seed)?, origin);
    config.put("run.minutes", 0.0, origin);
    resolve::anchor_files(&mut config, preset.file.as_deref())?;
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
        target,
        rows,
        cores: resolved
            .fleet
            .actors
            .max(threads.unwrap_or(1).unsigned_abs() as usize),
        config,
    })
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
    Ok(config.section::<RunConfig>("run")?.iterations)
}

/// What would be run, for --dry-run.
pub(super) fn describe(planned: &[Planned]) -> String {
    let mut lines: Vec<String> = planned
        .iter()
        .map(|run| {
            let samples = run.target * run.rows;
            format!(
                "{}: {} iterations of {} transitions, {samples} in all",
                run.name, run.target, run.rows
            )
        })
        .collect();
    let all: u64 = planned.iter().map(|run| run.target * run.rows).sum();
    lines.push(format!("{} runs, {all} transitions", planned.len()));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The study files that come with the project.
    fn ours() -> Vec<(String, StudyFile)> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../studies");
        let mut files = Vec::new();
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let path = entry.path();
            if path
                .extension()
                .is_some_and(|extension| extension == "toml")
            {
                let text = std::fs::read_to_string(&path).unwrap();
                let name = path.file_stem().unwrap().to_string_lossy().into_owned();
                files.push((name, StudyFile::parse(&text).unwrap()));
            }
        }
        files.sort_by(|a, b| a.0.cmp(&b.0));
        files
    }

    #[test]
    fn every_study_of_ours_can_be_planned() {
        let counts: Vec<(String, usize)> = ours()
            .iter()
            .map(|(name, file)| {
                let planned = plan(file, Path::new("."), name).unwrap();
                (name.clone(), planned.len())
            })
            .collect();
        let counts: Vec<(&str, usize)> =
            counts.iter().map(|(name, n)| (name.as_str(), *n)).collect();
        // 8 × 10, 8 × 3, 8 × 10, 9 settings × 3, 3 × 2
        let expected = [
            ("desktop", 80),
            ("laptop", 24),
            ("paper", 80),
            ("sensitivity", 27),
            ("smoke", 6),
        ];
        assert_eq!(counts, expected);
    }

    #[test]
    fn the_papers_study_has_its_sizes() {
        let files = ours();
        let (_, file) = files.iter().find(|(name, _)| name == "paper").unwrap();
        let planned = plan(file, Path::new("."), "paper").unwrap();
        assert_eq!((planned[0].target, planned[0].rows), (20_000, 4096 * 24));
        let window = planned[0].config.given("scheduler.window").unwrap();
        assert_eq!(window.as_integer(), Some(1000));
    }

    #[test]
    fn a_run_that_was_made_otherwise_is_not_gone_on_with() {
        let place = tempfile::tempdir().unwrap();
        let folder = StudyFolder::create(place.path()).unwrap();
        let files = ours();
        let (_, smoke) = files.iter().find(|(name, _)| name == "smoke").unwrap();
        let planned = plan(smoke, Path::new("."), "smoke").unwrap();
        let run = run::Folder::create(&folder.runs(), &planned[0].name).unwrap();
        check_unchanged(&planned[0], &folder).unwrap();
        planned[0]
            .config
            .write(&run.config_path(), "a test")
            .unwrap();
        check_unchanged(&planned[0], &folder).unwrap();

        let mut other = planned[0].config.clone();
        other.put("task.kernel", 0.125, "a test");
        other.write(&run.config_path(), "a test").unwrap();
        let refused = check_unchanged(&planned[0], &folder)
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("kernel = 0.125") && refused.contains("--out"),
            "{refused}"
        );
    }
}
