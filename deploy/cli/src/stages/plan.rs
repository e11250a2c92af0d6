//! From a file of stages to runs whose every value is known before anything starts.

use std::path::Path;

use anyhow::{Context, Result};
use configuration::{presets, resolve};
use run::Config;
use run::config::Source;
use serde::Deserialize;
use terminal::failure::usage;
use terminal::file;
use toml::{Table, Value};
use wording::count;

/// Those that come with the program, by name.
const EMBEDDED: [(&str, &str); 1] = [("pushed", include_str!("../../../stages/pushed.toml"))];

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

/// A preset with a name and a length.
#[derive(Debug, Deserialize)]
struct Stage {
    /// Last part of the run's name.
    name: String,
    /// Length of the run.
    iterations: u32,
    /// What a preset says: `on`, without which it lies on the stage before, `unset`, and sections.
    #[serde(flatten)]
    preset: Table,
}

/// A stage with all that it is trained with.
#[derive(Debug)]
pub(super) struct Planned {
    /// Name of its run.
    pub(super) run: String,
    pub(super) iterations: u32,
    /// Every value, defaults included.
    pub(super) config: Config,
    /// What it lies on and what it sets, in a line.
    differs: String,
    /// Transitions of an iteration.
    rows: u64,
}

/// The stages in their order.
#[derive(Debug)]
pub(super) struct Plan {
    title: String,
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
        let (text, folder) = match own {
            Some((_, text)) => ((*text).to_owned(), None),
            None if path.is_file() => {
                let folder = path.canonicalize().context("finding the stages' folder")?;
                (file::read_text(path)?, folder.parent().map(Path::to_owned))
            }
            None => {
                let names = EMBEDDED.map(|(name, _)| name);
                let remedy = wording::nearest::remedy(which, &names);
                return Err(usage(format!(
                    "there are no stages and no file `{which}`; {remedy}"
                )));
            }
        };
        let file = parse(&text).map_err(|problem| usage(format!("{which}: {problem}")))?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let stem = run.unwrap_or(&stem);
        let mut stages = Vec::new();
        let mut before = Config::default();
        for stage in &file.stages {
            if stage.preset.contains_key("on") {
                before = Config::default();
            }
            let source = stage.source(which, folder.as_deref())?;
            presets::lay_source(&mut before, source)?;
            let planned = stage.planned(stem, before.clone(), actors, set);
            stages.push(planned.with_context(|| format!("{which}: stage {}", stage.name))?);
        }
        Ok(Self {
            title: file.title,
            stages,
        })
    }

    /// What would be run, for --dry-run.
    pub(super) fn describe(&self) -> String {
        let mut lines = vec![self.title.clone()];
        for stage in &self.stages {
            lines.push(format!(
                "{}: {}, {} of {}",
                stage.run,
                stage.differs,
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
    /// Its preset; that of one of ours has no folder.
    fn source(&self, which: &str, folder: Option<&Path>) -> Result<Source> {
        Ok(Source {
            origin: format!("{which}: stage {}", self.name),
            text: toml::to_string(&self.preset).context("writing a stage as a preset")?,
            folder: folder.map(Path::to_owned),
        })
    }

    /// What it lies on and what it sets, in a line.
    fn differs(&self) -> String {
        let on = self.preset.get("on").and_then(Value::as_str);
        let on = on.unwrap_or("the stage before");
        let mut sets = self.preset.clone();
        sets.remove("on");
        let unset = sets.remove("unset").into_iter();
        let unset = unset.map(|keys| format!("unset = {keys}"));
        let sets = Config::of(sets, &self.name).leaves();
        let sets = sets.iter().map(|(path, value)| format!("{path} = {value}"));
        let all: Vec<String> = [format!("on {on}")]
            .into_iter()
            .chain(unset)
            .chain(sets)
            .collect();
        all.join(", ")
    }

    /// With what it is trained, of all that it and what it lies on give.
    fn planned(
        &self,
        stem: &str,
        mut config: Config,
        actors: Option<u32>,
        set: &[String],
    ) -> Result<Planned> {
        for assignment in set {
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
            iterations: self.iterations,
            config,
            differs: self.differs(),
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
        .map_err(|error| wording::refusal(text, error.span(), &wording::plain(error.message())))?;
    if file.stages.is_empty() {
        return Err("stages: none; write at least one".into());
    }
    if let Some(after) = &file.after {
        let ours = EMBEDDED.iter().find(|(name, _)| name == after);
        let (_, text) = ours.ok_or_else(|| {
            let remedy = wording::nearest::remedy(after, &EMBEDDED.map(|(name, _)| name));
            format!("after: there are no stages `{after}`; {remedy}")
        })?;
        file.stages.splice(0..0, parse(text)?.stages);
    }
    for (i, stage) in file.stages.iter().enumerate() {
        let name = &stage.name;
        for (key, now) in [
            ("preset", "on = \"athlete\""),
            ("set", "ppo.epochs = 9, a line for each key"),
        ] {
            if stage.preset.contains_key(key) {
                return Err(format!(
                    "stage {name}: `{key}` is spelt otherwise now, as in {now}"
                ));
            }
        }
        if i == 0 && !stage.preset.contains_key("on") {
            return Err(format!(
                "stage {name}: no stage is before it; say on which preset it lies, as in on = \"ampco\""
            ));
        }
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
