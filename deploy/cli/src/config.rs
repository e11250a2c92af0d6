//! `ampco config`: a configuration with every value written out, what each is for, and where it was given.
//!
//! Separate because it only reads: of a preset what it would train with, of a run what it was trained with. What a key is
//! for is said once, by the doc comment of its field (see [`configuration::keys`]).

mod show;

use std::path::Path;

use anyhow::Result;
use clap::Args;
use configuration::keys::Key;
use configuration::{keys, presets, resolve};
use run::Config;
use serde_json::json;
use terminal::failure::usage;
use terminal::{Place, console};

/// Show a configuration: every value, what it is for, its unit, and where it was given
///
/// What is printed is TOML: as a file it is a preset; with --diff one on the other, if that is no run. Names after # are a value's unit and where it was given: a preset, a
/// file, a run, or nowhere (default).
#[derive(Debug, Args)]
pub(crate) struct Show {
    /// A preset, a TOML file, or a run's name or folder [default: ampco]
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
        Ok(shown)
    }

    fn find(&self, given: &str) -> Result<Shown> {
        if presets::names().contains(&given) || Path::new(given).is_file() {
            let preset = presets::find(given)?;
            return Ok(Shown {
                name: preset.origin,
                on: Some(given.to_owned()),
                config: preset.config,
                run: None,
            });
        }
        let runs = run::folder::list(&self.place.runs_dir);
        let is_path = Path::new(given).components().count() > 1;
        if !is_path && !runs.iter().any(|run| run == given) {
            let runs = runs.iter().map(String::as_str);
            let known: Vec<&str> = presets::names().into_iter().chain(runs).collect();
            return Err(usage(format!(
                "there is no preset, no file and no run `{}`; {}",
                wording::line(given),
                run::nearest::remedy(given, &known)
            )));
        }
        let folder = self.place.find(Some(given))?;
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
