//! The configuration of a run: sections of TOML, and where each value came from.
//!
//! It knows no section's fields: each crate declares its own struct, and [`Config::section`] reads
//! it strictly. What this file adds is the origin of every value (a preset, a file, `--set`), so
//! that an error names the place to mend.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;

use toml::{Table, Value};
use vocabulary::Section;
use wording::nearest;

use crate::{assignment, replace};

mod blame;
mod complaint;
mod error;
mod layers;
mod moved;
mod older;
mod probe;
mod tables;

pub use error::ConfigError;
pub use layers::{Source, lay, lay_alone};
pub use moved::{gone, moved};
use tables::{collect, mark, merge_tables};

/// A configuration: what was given, over the defaults that each section's owner declares.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Config {
    table: Table,
    /// Dotted path of every given leaf → the words for where it was given.
    origins: BTreeMap<String, String>,
    /// Dotted path of what a preset has taken away and nothing has set again → which preset.
    unset: BTreeMap<String, String>,
}

impl Config {
    /// Parses TOML; `origin` is how errors name it ("preset smoke", a path).
    pub fn parse(text: &str, origin: &str) -> Result<Self, ConfigError> {
        Ok(Self::of(table(text, origin)?, origin))
    }

    /// Parses what a program has written for a run; of an older program, in today's words.
    pub fn parse_written(text: &str, origin: &str) -> Result<Self, ConfigError> {
        let mut table = table(text, origin)?;
        older::in_todays_words(&mut table);
        Ok(Self::of(table, origin))
    }

    /// Reads the file of a run, which a program has written, as [`Config::parse_written`] does. Presets are read by [`lay`].
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let origin = path.display().to_string();
        Self::parse_written(&layers::text(path)?, &origin)
    }

    /// A table of sections with one origin.
    pub fn of(table: Table, origin: &str) -> Self {
        let mut origins = BTreeMap::new();
        mark(&table, "", origin, &mut origins);
        Self {
            table,
            origins,
            unset: BTreeMap::new(),
        }
    }

    /// Lays `over` on top: its values win, what it does not mention stays.
    pub fn merge(&mut self, over: Self) {
        if let (Some(ours), Some(theirs)) = (self.given(METHOD), over.given(METHOD))
            && other_choice(ours, theirs)
        {
            self.remove(METHOD);
        }
        // A value in place of a table, or of one with other keys: nothing is left of those below.
        for (path, value) in over.leaves() {
            let around = path.match_indices('.').map(|(end, _)| &path[..end]);
            around.for_each(|path| self.forget(path, false));
            self.forget(&path, !value.is_table());
        }
        merge_tables(&mut self.table, over.table);
        self.origins.extend(over.origins);
    }

    /// Applies one `--set key.path=value`; a key without a dot is one of `[run]`.
    pub fn set(&mut self, given: &str) -> Result<(), ConfigError> {
        let refused = |problem| ConfigError::Assignment {
            given: given.to_owned(),
            problem,
        };
        let assignment = assignment::parse(given).map_err(refused)?;
        let (path, value) = (assignment.path, assignment.value);
        assignment::put(&mut self.table, &path, value.clone()).map_err(refused)?;
        self.remark(
            &path.join("."),
            &value,
            &format!("--set {}", wording::line(given)),
        );
        Ok(())
    }

    /// Puts one value at a dotted path, as an option such as `--iterations 50` does.
    ///
    /// # Panics
    /// If the path enters a list; paths given here are constants of the program.
    pub fn put(&mut self, path: &str, value: impl Into<Value>, origin: &str) {
        let value = value.into();
        let parts: Vec<String> = path.split('.').map(str::to_owned).collect();
        assignment::put(&mut self.table, &parts, value.clone()).expect("a path of the program's");
        self.remark(path, &value, origin);
    }

    /// Makes the motion files that it names absolute; relative ones start from `folder`.
    pub fn anchor_files(&mut self, folder: &Path) {
        const CLIPS: &str = "motion.clips";
        let Some(Value::Array(clips)) = self.given(CLIPS) else {
            return;
        };
        let (mut clips, origin) = (clips.clone(), self.origin(CLIPS).unwrap_or_default());
        let origin = origin.to_owned();
        for clip in &mut clips {
            for key in ["file", "folder"] {
                if let Some(Value::String(path)) = clip.get_mut(key) {
                    *path = folder.join(&*path).to_string_lossy().into_owned();
                }
            }
        }
        self.put(CLIPS, clips, &origin);
    }

    /// The given value at a dotted path, if any was given.
    pub fn given(&self, path: &str) -> Option<&Value> {
        let mut parts = path.split('.');
        let first = self.table.get(parts.next()?)?;
        parts.try_fold(first, |value, name| value.get(name))
    }

    /// Every value by its dotted path; a list is one value, and so is an empty table.
    pub fn leaves(&self) -> BTreeMap<String, Value> {
        let mut leaves = BTreeMap::new();
        collect(&self.table, "", &mut leaves);
        leaves
    }

    /// Samples after which no ramp moves any more but those of some sections; 0 where none does.
    pub fn settled_but(&self, sections: &[&str]) -> f64 {
        let leaves = self.leaves();
        let arrivals = leaves.iter().filter_map(|(path, value)| {
            let ramp = path.strip_suffix(".samples")?;
            let section = ramp.split('.').next()?;
            (!sections.contains(&section)).then_some(())?;
            leaves.contains_key(&format!("{ramp}.from")).then_some(())?;
            let arrives = value.as_array()?.last()?;
            arrives
                .as_float()
                .or(arrives.as_integer().map(|whole| whole as f64))
        });
        arrivals.fold(0.0, f64::max)
    }

    /// Removes the value or table at a dotted path, if there is one.
    pub fn remove(&mut self, path: &str) {
        self.forget(path, true);
        self.cut(path);
    }

    /// The same, as the `unset` of a preset does.
    pub(crate) fn unset(&mut self, path: &str, origin: &str) {
        self.remove(path);
        self.unset.insert(path.to_owned(), origin.to_owned());
    }

    fn cut(&mut self, path: &str) {
        let Some((parent, name)) = path.rsplit_once('.') else {
            self.table.remove(path);
            return;
        };
        let mut table = Some(&mut self.table);
        for part in parent.split('.') {
            table = table.and_then(|table| table.get_mut(part)?.as_table_mut());
        }
        if let Some(table) = table {
            table.remove(name);
        }
    }

    /// The dotted path of every value that was given.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.origins.keys().map(String::as_str)
    }

    /// Where the value at a dotted path was given, if it was.
    pub fn origin(&self, path: &str) -> Option<&str> {
        let mut path = path;
        loop {
            if let Some(origin) = self.origins.get(path) {
                return Some(origin);
            }
            // A part of a list or of a table given as one value has the origin of the whole.
            path = &path[..path.rfind('.')?];
        }
    }

    /// Where a value was given, or all that is given in a table: each place once; none where nothing was.
    pub fn origins(&self, path: &str) -> Vec<&str> {
        let inside = format!("{path}.");
        let given = self.origins.iter();
        let below = given.filter(|(given, _)| given.starts_with(&inside));
        let below = below.map(|(_, origin)| origin.as_str());
        let mut found: Vec<&str> = self.origin(path).into_iter().chain(below).collect();
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Refuses a section that is not one of `known`.
    pub fn check_sections(&self, known: &[&str]) -> Result<(), ConfigError> {
        for section in self.table.keys() {
            if !known.contains(&section.as_str()) {
                return Err(ConfigError::UnknownSection {
                    origin: self.origin_of_section(section),
                    section: section.clone(),
                    remedy: nearest::remedy(section, known),
                });
            }
        }
        Ok(())
    }

    /// One section as its owner's struct: defaults filled in, unknown keys refused, checked by its owner.
    pub fn section<T: Section>(&self) -> Result<T, ConfigError> {
        let name = T::NAME;
        let section: T = match self.table.get(name) {
            None => T::default(),
            Some(given) => {
                self.check_sizes(name, given)?;
                serde_path_to_error::deserialize(given.clone()).map_err(|error| {
                    self.explain::<T>(&error.path().to_string(), error.inner().message())
                })?
            }
        };
        let checked = section.validate();
        checked.map_err(|invalid| self.refuse(name, &invalid.path, &invalid))?;
        Ok(section)
    }

    /// The error for a value at `path` in a section that turns out to be of no use, as a file that cannot be read.
    pub fn refuse(&self, section: &str, path: &str, problem: impl Display) -> ConfigError {
        let (origin, problem) = self.blamed(section, path, problem.to_string());
        ConfigError::Refused {
            origin,
            section: section.to_owned(),
            problem,
        }
    }

    /// Replaces a section by the owner's struct, every default written out.
    ///
    /// # Panics
    /// If the struct cannot be written as a TOML table, which is a bug of its owner.
    pub fn resolve<T: Section>(&mut self, section: &T) {
        // By way of text: it writes an f32 with its own shortest digits (0.95, not 0.949999988).
        let text = toml::to_string(section).expect("a section is a TOML table");
        let table: Table = toml::from_str(&text).expect("the text was written by the same library");
        self.table.insert(T::NAME.to_owned(), Value::Table(table));
    }

    /// The configuration as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.table).expect("a table of TOML values")
    }

    /// Writes it under a comment; a reader sees the old file or the new one.
    pub fn write(&self, path: &Path, comment: &str) -> Result<(), ConfigError> {
        let mut text = String::new();
        for line in comment.lines() {
            text.push_str(&format!("# {line}\n"));
        }
        text.push('\n');
        text.push_str(&self.to_toml());
        replace::replace_file(path, text.as_bytes()).map_err(|source| ConfigError::Write {
            path: path.to_owned(),
            source,
        })
    }
}

/// The one value of a configuration that is one of several tables: of two methods, the later is meant.
pub const METHOD: &str = "scheduler.method";

/// Whether two values of [`METHOD`] are of different methods.
fn other_choice(ours: &Value, theirs: &Value) -> bool {
    let name = |value: &Value| match value {
        Value::Table(table) => table.keys().next().cloned(),
        other => other.as_str().map(str::to_owned),
    };
    name(ours) != name(theirs)
}

/// TOML, or what is wrong with it.
fn table(text: &str, origin: &str) -> Result<Table, ConfigError> {
    toml::from_str(text).map_err(|error| ConfigError::Syntax {
        origin: origin.to_owned(),
        message: wording::refusal(text, error.span(), error.message()),
    })
}
