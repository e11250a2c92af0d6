//! From a file of stages to runs whose every value is known before anything starts.

use std::path::Path;

use anyhow::{Context, Result};
use configuration::{presets, resolve};
use run::Config;
use serde::Deserialize;
use terminal::failure::usage;
use terminal::file;
use wording::count;

/// Those that come with the program, by name.
const EMBEDDED: [(&str, &str); 3] = [
    ("athlete", include_str!("../../../stages/athlete.toml")),
    (
        "athlete-robust",
        include_str!("../../../stages/athlete-robust.toml"),
    ),
    ("strider", include_str!("../../../stages/strider.toml")),
];

/// A file of stages as its author wrote it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    /// What comes of it, in one line.
    title: String,
    /// Those of ours, by name, whose stages come before these.
    after: Option<String>,
    stages: Vec<Stage>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Stage {
    /// Last part of the run's name.
    name: String,
    /// A preset's name, or a file beside this one. Default: the stage's name.
    preset: Option<String>,
    /// Length of the run.
    iterations: u32,
    /// What differs from the preset, as of `ampco train --set`.
    #[serde(default)]
    set: Vec<String>,
}

/// A stage with all that it is trained with.
#[derive(Debug)]
pub(super) struct Planned {
    /// Name of its run.
    pub(super) run: String,
    /// As for `ampco train --preset`.
    pub(super) preset: String,
    pub(super) iterations: u32,
    pub(super) set: Vec<String>,
    /// Every value, defaults included.
    pub(super) config: Config,
    /// Transitions of an iteration.
    rows: u64,
}

/// The stages in their order.
#[derive(Debug)]
pub(super) struct Plan {
    title: String,
    pub(super) actors: Option<u32>,
    pub(super) stages: Vec<Planned>,
}

impl Plan {
    /// Of one of ours or a file. Everything is looked at, so that the fifth stage's mistake costs no hour.
    pub(super) fn new(
        which: &str,
        run: Option<&str>,
        actors: Option<u32>,
        set: &[String],
    ) -> Result<Self> {
        let path = Path::new(which);
        let own = EMBEDDED.iter().find(|(name, _)| *name == which);
        let (text, beside) = match own {
            Some((_, text)) => ((*text).to_owned(), None),
            None if path.is_file() => {
                let text = file::read_text(path)?;
                (text, Some(path.parent().unwrap_or(Path::new("."))))
            }
            None => {
                let names = EMBEDDED.map(|(name, _)| name);
                let remedy = run::nearest::remedy(which, &names);
                return Err(usage(format!(
                    "there are no stages and no file `{which}`; {remedy}"
                )));
            }
        };
        let file = parse(&text).map_err(|problem| usage(format!("{which}: {problem}")))?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let stem = run.unwrap_or(&stem);
        let stages = file.stages.iter().map(|stage| {
            let planned = stage.planned(stem, beside, actors, set);
            planned.with_context(|| format!("{which}: stage {}", stage.name))
        });
        Ok(Self {
            title: file.title,
            actors,
            stages: stages.collect::<Result<_>>()?,
        })
    }

    /// What would be run, for --dry-run.
    pub(super) fn describe(&self) -> String {
        let mut lines = vec![self.title.clone()];
        for stage in &self.stages {
            lines.push(format!(
                "{}: preset {}{}, {} of {}",
                stage.run,
                stage.preset,
                stage
                    .set
                    .iter()
                    .fold(String::new(), |all, one| all + " " + one),
                count(stage.iterations, "iteration"),
                count(stage.rows, "transition"),
            ));
        }
        let all: u64 = self
            .stages
            .iter()
            .map(|stage| u64::from(stage.iterations) * stage.rows)
            .sum();
        lines.push(format!(
            "{}, {}",
            count(self.stages.len(), "run"),
            count(all, "transition")
        ));
        lines.join("\n")
    }
}

impl Stage {
    fn planned(
        &self,
        stem: &str,
        beside: Option<&Path>,
        actors: Option<u32>,
        set: &[String],
    ) -> Result<Planned> {
        let preset = self.preset.as_deref().unwrap_or(&self.name);
        let own = beside.map(|folder| folder.join(preset));
        let own = own.filter(|path| path.is_file());
        let preset = own.map_or(preset.to_owned(), |path| path.display().to_string());
        let set: Vec<String> = self.set.iter().chain(set).cloned().collect();
        let found = presets::find(&preset)?;
        let mut config = found.config;
        for assignment in &set {
            config.set(assignment)?;
        }
        config.put("run.iterations", i64::from(self.iterations), "iterations");
        config.put("run.minutes", 0.0, "iterations");
        if let Some(actors) = actors {
            config.put("fleet.actors", i64::from(actors), "--actors");
        }
        resolve::anchor_files(&mut config)?;
        let fleet = resolve::resolve(&mut config)?.fleet;
        Ok(Planned {
            run: format!("{stem}-{}", self.name),
            preset,
            iterations: self.iterations,
            set,
            config,
            rows: (fleet.actors * fleet.environments_per_actor() * fleet.steps) as u64,
        })
    }
}

impl Planned {
    /// The first line of a run's configuration that is not what this stage would give it, and what it would give.
    pub(super) fn differs_from(&self, theirs: &Config) -> Option<(String, String)> {
        let mut ours = self.config.clone();
        // Where a run began is known only once the stage before has ended.
        if let Some(from) = theirs.given("run.from") {
            ours.put("run.from", from.clone(), "the run");
        }
        resolve::difference(theirs, &ours)
    }
}

/// Those that come with the program, a line each.
pub(super) fn list() -> String {
    let line = |(name, text): &(&str, &str)| match parse(text) {
        Ok(file) => {
            let stages: Vec<_> = file
                .stages
                .iter()
                .map(|stage| stage.name.as_str())
                .collect();
            format!("{name}: {} ({})", file.title, stages.join(", "))
        }
        Err(problem) => format!("{name}: {problem}"),
    };
    EMBEDDED.iter().map(line).collect::<Vec<_>>().join("\n")
}

fn parse(text: &str) -> Result<File, String> {
    let mut file: File = toml::from_str(text)
        .map_err(|error| wording::refusal(text, error.span(), error.message()))?;
    if file.stages.is_empty() {
        return Err("stages: none; write at least one".into());
    }
    if let Some(after) = &file.after {
        let ours = EMBEDDED.iter().find(|(name, _)| name == after);
        let (_, text) = ours.ok_or_else(|| {
            let remedy = run::nearest::remedy(after, &EMBEDDED.map(|(name, _)| name));
            format!("after: there are no stages `{after}`; {remedy}")
        })?;
        file.stages.splice(0..0, parse(text)?.stages);
    }
    for (i, stage) in file.stages.iter().enumerate() {
        let name = &stage.name;
        if stage.iterations == 0 {
            return Err(format!("stage {name}: iterations = 0; a stage has to end"));
        }
        if file.stages[..i].iter().any(|other| other.name == *name) {
            return Err(format!(
                "stage {name}: there are two; give one another name"
            ));
        }
    }
    Ok(file)
}

#[cfg(test)]
mod tests;
