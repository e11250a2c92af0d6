//! `ampco config`: a configuration with every value written out, what each is for, and where it was given.
//!
//! Separate because it only reads: of a preset what it would train with, of a run what it was trained with. What a key is
//! for is said once, by the doc comment of its field (see [`configuration::keys`]).

mod show;

use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;
use configuration::keys::Key;
use configuration::{keys, presets, resolve};
use observation::ObservationConfig;
use run::Config;
use serde_json::json;
use terminal::console::say;
use terminal::failure::usage;
use terminal::{Place, console};

/// Show a configuration: every value, what it is for, its unit, and where it was given
///
/// What is printed is TOML: as a file it is a preset; with --diff one on the other, if that is no run. Names after # are a value's unit and where it was given: a preset, a
/// file, a run, or nowhere (default).
#[derive(Debug, Args)]
pub(crate) struct Show {
    /// A preset, a TOML file (- reads it from standard input), or a run's name or folder [default: ampco]
    #[arg(value_name = "PRESET|FILE|RUN")]
    of: Option<String>,
    /// Only what is another in this one
    #[arg(long, value_name = "PRESET|FILE|RUN")]
    diff: Option<String>,
    /// Only how many keys there are, or would be shown, besides lists. A value that moves is one, so is a method with its
    /// parameters; what each of several terms has, as the weight of a reward, is one for all of them
    #[arg(long)]
    count: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    place: Place,
}

/// A configuration with all values, and what it is of.
struct Shown {
    /// `preset ampco`, a file's path, `run walk`.
    name: String,
    /// What a preset that lies on it would say; a run is none.
    on: Option<String>,
    config: Config,
    /// What is to be said of values that the run's own file holds.
    run: Option<String>,
}

impl Show {
    pub(crate) fn run(&self) -> Result<()> {
        let keys = keys::all();
        let shown = self.open(self.of.as_deref().unwrap_or("ampco"))?;
        let other = self.diff.as_deref().map(|name| self.open(name));
        let other = other.transpose()?;
        let entries = show::entries(&keys, &shown, other.as_ref());
        if self.count {
            let all = self.of.is_none() && other.is_none();
            return self.tell_count(if all {
                keys.iter().collect()
            } else {
                entries.iter().map(|entry| entry.key).collect()
            });
        }
        console::print(&if self.json {
            show::json(&entries, &shown, other.as_ref())
        } else {
            show::toml(&entries, &shown, other.as_ref())
        })
    }

    fn tell_count(&self, keys: Vec<&Key>) -> Result<()> {
        let lists = keys.iter().filter(|key| key.list).count();
        let count = keys::count(keys);
        console::print(&if self.json {
            format!("{}\n", json!({ "keys": count, "lists": lists }))
        } else {
            format!("{count}\n")
        })
    }

    /// What is meant by a name, with its defaults filled in.
    fn open(&self, given: &str) -> Result<Shown> {
        let mut shown = self.find(given)?;
        resolve::settle_all(&mut shown.config)?;
        let observation: ObservationConfig = shown.config.section()?;
        let tables = observation.tables().context("section [observation]")?;
        tables.oddities().iter().for_each(|oddity| say(oddity));
        Ok(shown)
    }

    /// A preset, else a file, else a run. What else has the same name is told.
    fn find(&self, given: &str) -> Result<Shown> {
        let runs = run::folder::list(&self.place.runs_dir);
        let path = Path::new(given);
        let plain = path.components().count() == 1 && path.file_name().is_some();
        let is_run = plain && runs.iter().any(|run| run == given);
        let ours = presets::names().contains(&given);
        let is_file = path.is_file();
        let run = self.place.runs_dir.join(given);
        let stdin = given == presets::STANDARD_INPUT;
        if ours || is_file || stdin || given.is_empty() {
            let mut others = Vec::new();
            if ours && is_file {
                others.push(format!("the file is ./{given}"));
            }
            if is_run {
                others.push(format!("the run is {}", run.display()));
            }
            let preset = presets::find(given)?;
            preset.notices.iter().for_each(|notice| say(notice));
            if !others.is_empty() {
                let what = if ours { "preset" } else { "file" };
                say(&format!(
                    "`{given}` is the {what} here; {}",
                    others.join(", ")
                ));
            }
            return Ok(Shown {
                name: preset.origin,
                on: (!stdin).then(|| given.to_owned()),
                config: preset.config,
                run: None,
            });
        }
        // A folder beside us, where no run of the folder of runs has its name.
        let beside = plain && !is_run && path.is_dir();
        if !is_run && path.exists() && !path.join("config.toml").is_file() {
            let what = if path.is_dir() {
                "a folder without config.toml, neither a preset nor a run; give a TOML file, or a run's name or folder"
            } else {
                presets::no_file(path).unwrap_or("no preset and no run")
            };
            return Err(usage(format!("`{}` is {what}", wording::line(given))));
        }
        if plain && !is_run && !beside {
            let runs = runs.iter().map(String::as_str);
            let known: Vec<&str> = presets::names().into_iter().chain(runs).collect();
            return Err(usage(format!(
                "there is no preset, no file and no run `{}`; {}",
                wording::line(given),
                wording::nearest::remedy(given, &known)
            )));
        }
        let place = if beside {
            format!("./{given}")
        } else {
            given.to_owned()
        };
        let folder = self.place.find(Some(&place))?;
        let name = format!("run {}", folder.name());
        Ok(Shown {
            config: folder.config()?,
            run: Some(name.clone()),
            on: None,
            name,
        })
    }
}

impl Shown {
    /// Whether anything of a table is given.
    fn has(&self, table: &str) -> bool {
        self.config.given(table).is_some()
    }

    /// In words, where a value was given.
    fn origin(&self, path: &str) -> String {
        let origins = self.config.origins(path);
        match (&self.run, origins.is_empty()) {
            (_, true) => "default".to_owned(),
            (Some(run), false) => run.clone(),
            (None, false) => origins.join(" with "),
        }
    }
}
