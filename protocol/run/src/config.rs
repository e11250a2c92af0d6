//! The configuration of a run: sections of TOML, and where each value came from.
//!
//! It knows no section's fields: each crate declares its own struct, and [`Config::section`] reads
//! it strictly. What this file adds is the origin of every value (a preset, a file, `--set`), so
//! that an error names the place to mend.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::{Table, Value};
use vocabulary::Checked;

use crate::{assignment, nearest, replace};

mod complaint;
mod error;
mod moved;
mod tables;

use complaint::{misspelt_path, quoted_names};
pub use error::ConfigError;
pub use moved::moved;
use tables::{collect, mark, merge_tables};

/// A configuration: what was given, over the defaults that each section's owner declares.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Config {
    table: Table,
    /// Dotted path of every given leaf → the words for where it was given.
    origins: BTreeMap<String, String>,
}

impl Config {
    /// Parses TOML; `origin` is how errors name it ("preset smoke", a path).
    pub fn parse(text: &str, origin: &str) -> Result<Self, ConfigError> {
        let table: Table = toml::from_str(text).map_err(|error| ConfigError::Syntax {
            origin: origin.to_owned(),
            message: wording::refusal(text, error.span(), error.message()),
        })?;
        let mut config = Self {
            table,
            origins: BTreeMap::new(),
        };
        mark(&config.table, "", origin, &mut config.origins);
        Ok(config)
    }

    /// Reads a TOML file.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let bytes = std::fs::read(path).map_err(|source| ConfigError::Read {
            path: path.to_owned(),
            source,
        })?;
        let origin = path.display().to_string();
        match wording::text(bytes) {
            Ok(text) => Self::parse(&text, &origin),
            Err(foreign) => Err(ConfigError::Syntax {
                origin,
                message: foreign.to_string(),
            }),
        }
    }

    /// Lays `over` on top: its values win, what it does not mention stays.
    pub fn merge(&mut self, over: Self) {
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

    /// Removes the value at a dotted path, if there is one.
    pub fn remove(&mut self, path: &str) {
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

    /// Refuses a section that is not one of `known`, and a value outside every section.
    pub fn check_sections(&self, known: &[&str]) -> Result<(), ConfigError> {
        for (section, value) in &self.table {
            if !known.contains(&section.as_str()) {
                return Err(ConfigError::UnknownSection {
                    origin: self.origin_of_section(section),
                    section: section.clone(),
                    remedy: nearest::remedy(section, known),
                });
            }
            if !value.is_table() {
                return Err(ConfigError::Value {
                    origin: self.origin_of_section(section),
                    section: section.clone(),
                    key: section.clone(),
                    value: value.to_string(),
                    problem: "this is the name of a section, which holds keys".to_owned(),
                });
            }
        }
        Ok(())
    }

    /// One section as its owner's struct, defaults filled in, unknown keys refused.
    pub fn section<T: DeserializeOwned + Default>(&self, name: &str) -> Result<T, ConfigError> {
        let Some(given) = self.table.get(name) else {
            return Ok(T::default());
        };
        serde_path_to_error::deserialize(given.clone())
            .map_err(|error| self.explain(name, &error.path().to_string(), error.inner().message()))
    }

    /// One section that its owner has also checked: [`Config::section`], then `validate`.
    pub fn checked<T>(
        &self,
        name: &str,
        validate: impl FnOnce(&T) -> Checked,
    ) -> Result<T, ConfigError>
    where
        T: DeserializeOwned + Default,
    {
        let section = self.section(name)?;
        validate(&section).map_err(|invalid| ConfigError::Refused {
            origin: self.origin_of_value(name, &invalid.path),
            section: name.to_owned(),
            problem: invalid.to_string(),
        })?;
        Ok(section)
    }

    /// The error for a section that cannot be used as a whole; the origin is that of a key that is mentioned.
    pub fn refuse(&self, section: &str, problem: impl Display) -> ConfigError {
        let problem = problem.to_string();
        let words: Vec<&str> = problem
            .split(|c: char| !(c.is_alphanumeric() || c == '_'))
            .collect();
        let prefix = format!("{section}.");
        let mentioned = self.origins.iter().find(|(path, _)| {
            path.strip_prefix(&prefix)
                .and_then(|key| key.rsplit('.').next())
                .is_some_and(|key| words.contains(&key))
        });
        let origin = mentioned.map(|(_, origin)| origin.clone());
        ConfigError::Refused {
            origin: origin.unwrap_or_else(|| self.origin_of_section(section)),
            section: section.to_owned(),
            problem,
        }
    }

    /// Replaces a section by the owner's struct, every default written out.
    ///
    /// # Panics
    /// If the struct cannot be written as a TOML table, which is a bug of its owner.
    pub fn resolve<T: Serialize>(&mut self, name: &str, section: &T) {
        // By way of text: it writes an f32 with its own shortest digits (0.95, not 0.949999988).
        let text = toml::to_string(section).expect("a section is a TOML table");
        let table: Table = toml::from_str(&text).expect("the text was written by the same library");
        self.table.insert(name.to_owned(), Value::Table(table));
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

    /// serde's complaint about one section, in our words.
    fn explain(&self, section: &str, path: &str, message: &str) -> ConfigError {
        let key = if path == "." { "" } else { path };
        let names = quoted_names(message);
        if message.starts_with("unknown field") && !names.is_empty() {
            let key = misspelt_path(key, names[0]);
            return ConfigError::UnknownKey {
                origin: self.origin_of(section, &key),
                section: section.to_owned(),
                value: self.value_text(section, &key),
                remedy: moved::remedy(section, &key)
                    .unwrap_or_else(|| nearest::remedy(names[0], &names[1..])),
                key,
            };
        }
        let problem = if message.starts_with("unknown variant") && !names.is_empty() {
            let remedy = nearest::remedy(names[0], &names[1..]);
            format!("unknown choice `{}`; {remedy}", names[0])
        } else if message.starts_with("missing field") {
            format!("{message}; give it as well")
        } else {
            message.to_owned()
        };
        ConfigError::Value {
            origin: self.origin_of_value(section, key),
            section: section.to_owned(),
            key: if key.is_empty() { section } else { key }.to_owned(),
            value: self.value_text(section, key),
            problem,
        }
    }

    fn origin_of(&self, section: &str, key: &str) -> String {
        let found = self.origin(&format!(
            "{section}.{}",
            key.replace('[', ".").replace(']', "")
        ));
        found.map_or_else(|| self.origin_of_section(section), str::to_owned)
    }

    /// The origin of a value, of an entry of a list, or of anything inside a table.
    fn origin_of_value(&self, section: &str, path: &str) -> String {
        let path = path.split('[').next().unwrap_or(path);
        let whole = format!("{section}.{path}");
        let inside = format!("{whole}.");
        let mut given = self.origins.iter();
        let found = given.find(|(given, _)| **given == whole || given.starts_with(&inside));
        found.map_or_else(
            || self.origin_of_section(section),
            |(_, origin)| origin.clone(),
        )
    }

    /// The origin of anything given in the section: right when there is one file, honest otherwise.
    fn origin_of_section(&self, section: &str) -> String {
        let prefix = format!("{section}.");
        let mut found: Vec<&String> = self
            .origins
            .iter()
            .filter(|(path, _)| *path == section || path.starts_with(&prefix))
            .map(|(_, origin)| origin)
            .collect();
        found.sort();
        found.dedup();
        match found.as_slice() {
            [] => "the defaults".to_owned(),
            [one] => (*one).clone(),
            several => several
                .iter()
                .map(|o| o.as_str())
                .collect::<Vec<_>>()
                .join(" with "),
        }
    }

    fn value_text(&self, section: &str, key: &str) -> String {
        let mut value = self.table.get(section);
        for part in key.split(['.', '[', ']']).filter(|part| !part.is_empty()) {
            value = value.and_then(|inner| match part.parse::<usize>() {
                Ok(index) => inner.get(index),
                Err(_) => inner.get(part),
            });
        }
        let text = value.map_or_else(|| "(none)".to_owned(), Value::to_string);
        // A whole list of clips would bury the message.
        wording::line(&text)
    }

    /// Forgets what was known of `path` and below, and marks the new value.
    fn remark(&mut self, path: &str, value: &Value, origin: &str) {
        let below = format!("{path}.");
        self.origins
            .retain(|known, _| known != path && !known.starts_with(&below));
        match value {
            Value::Table(table) => mark(table, &below, origin, &mut self.origins),
            _ => {
                self.origins.insert(path.to_owned(), origin.to_owned());
            }
        }
    }
}
