//! From a study file to runs whose every value is known before anything starts.

use std::path::Path;

use ::study::{Cell, StudyFile, matrix};
use anyhow::{Context, Result};
use configuration::{presets, resolve};
use run::{Config, RunConfig};
use terminal::failure::usage;
use wording::count;

use super::folder::StudyFolder;

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
    }
    let mut earlier = Vec::new();
    for cell in folder.cells()? {
        let now = planned.iter().any(|run| run.name == cell.run_name());
        // Whoever removes a run's folder takes the run out of the study.
        if now || folder.run(&cell.run_name())?.is_some() {
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
    Ok(config.section::<RunConfig>("run")?.iterations)
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
        other.put("task.reward.track.kernel", 0.125, "a test");
        other.write(&run.config_path(), "a test").unwrap();
        let refused = check_unchanged(&planned[0], &folder)
            .unwrap_err()
            .to_string();
        assert!(
            refused.contains("kernel = 0.125") && refused.contains("--out"),
            "{refused}"
        );
    }

    #[test]
    fn earlier_runs_stay_in_the_study_unless_they_were_made_otherwise() {
        let place = tempfile::tempdir().unwrap();
        let folder = StudyFolder::create(place.path()).unwrap();
        let files = ours();
        let (_, smoke) = files.iter().find(|(name, _)| name == "smoke").unwrap();
        let here = Path::new(".");
        // As `study run` does, up to the runs themselves.
        let ask = |file: &StudyFile| -> Result<Vec<String>> {
            let planned = plan(file, here, "smoke")?;
            let all = together(file, &planned, &folder, here, "smoke")?;
            folder.begin(file, &planned, &all)?;
            for run in &planned {
                let made = run::Folder::create(&folder.runs(), &run.name)?;
                run.config.write(&made.config_path(), "a test")?;
            }
            Ok(all.iter().map(Cell::run_name).collect())
        };
        let with = |seeds: &[u64]| StudyFile {
            methods: vec!["ampco".into()],
            seeds: seeds.to_vec(),
            ..smoke.clone()
        };
        assert_eq!(ask(&with(&[1, 2])).unwrap(), ["ampco-seed1", "ampco-seed2"]);
        let all = ["ampco-seed1", "ampco-seed2", "ampco-seed3"];
        assert_eq!(ask(&with(&[3])).unwrap(), all);
        let asked: Vec<String> = folder.cells().unwrap().iter().map(Cell::run_name).collect();
        assert_eq!(asked, all);
        assert_eq!(
            folder.file().unwrap().seeds,
            [3],
            "as it was last asked for"
        );

        // Other values would mix what does not belong together, and nothing is written.
        let mut other = with(&[4]);
        other.iterations = Some(other.iterations.unwrap_or(0) + 1);
        let refused = format!("{:#}", ask(&other).unwrap_err());
        assert!(
            refused.contains("ampco-seed1") && refused.contains("iterations"),
            "{refused}"
        );
        assert_eq!(folder.file().unwrap().seeds, [3]);

        std::fs::remove_dir_all(folder.runs().join("ampco-seed2")).unwrap();
        assert_eq!(ask(&with(&[1])).unwrap(), ["ampco-seed1", "ampco-seed3"]);
        // A folder of an older program knows what was asked for last.
        std::fs::remove_file(place.path().join("runs.json")).unwrap();
        assert_eq!(ask(&with(&[5])).unwrap(), ["ampco-seed1", "ampco-seed5"]);
    }
}
