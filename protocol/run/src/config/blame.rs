//! Where a value was given, and what is said of one that cannot be used.
//!
//! Separate from the values because an error has to name the place to mend, whatever was laid over what.

use toml::Value;
use vocabulary::Section;
use wording::{nearest, plain};

use super::complaint::{misspelt_path, quoted_names};
use super::tables::mark;
use super::{Config, ConfigError, moved, probe};
use crate::assignment::LAYERING;

impl Config {
    /// serde's complaint about one section, in our words.
    pub(super) fn explain<T: Section>(&self, path: &str, message: &str) -> ConfigError {
        let section = T::NAME;
        let key = if path == "." { "" } else { path };
        let names = quoted_names(message);
        if message.starts_with("unknown field") && !names.is_empty() {
            let key = misspelt_path(key, names[0]);
            let remedy = if LAYERING.contains(&names[0]) {
                format!(
                    "write `{}` above the first [section] of a preset's file",
                    names[0]
                )
            } else {
                moved::remedy(section, &key)
                    .unwrap_or_else(|| nearest::remedy(names[0], &names[1..]))
            };
            return ConfigError::UnknownKey {
                origin: self.origin_of(section, &key),
                section: section.to_owned(),
                value: self.value_text(section, &key),
                remedy,
                key,
            };
        }
        let given = self.table.get(section);
        let wanted = given.and_then(|given| probe::wanted::<T>(given, key, message));
        let problem = wanted.unwrap_or_else(|| plain(message));
        // Of what is missing, that is the key to look for.
        let missing = message.strip_prefix("missing field ").and(names.first());
        let place = match missing {
            Some(name) => misspelt_path(key, name),
            None => key.to_owned(),
        };
        let (origin, problem) = self.blamed(section, &place, problem);
        let key = self.existing(section, key);
        ConfigError::Value {
            origin,
            section: section.to_owned(),
            value: self.value_text(section, key),
            key: if key.is_empty() { section } else { key }.to_owned(),
            problem,
        }
    }

    /// Refuses a number that is finite and so great or so small that the program's numbers have no place for it: it would be
    /// told as infinite, or as 0.
    pub(super) fn check_sizes(&self, section: &str, given: &Value) -> Result<(), ConfigError> {
        let Some((path, value)) = unfit("", given) else {
            return Ok(());
        };
        let key = path.trim_start_matches('.');
        let problem = if value.abs() > 1.0 {
            "too large for a number of the program; the greatest is 3.4e38"
        } else {
            "too small for a number of the program; give 0, or at least 1.2e-38"
        };
        Err(ConfigError::Value {
            origin: self.origin_of_value(section, key),
            section: section.to_owned(),
            key: key.to_owned(),
            // In digits it would be a line of zeros.
            value: format!("{value:e}"),
            problem: problem.to_owned(),
        })
    }

    /// Where something is wrong, and what: the preset that has taken away what is missing there, if one has.
    pub(super) fn blamed(&self, section: &str, path: &str, problem: String) -> (String, String) {
        let whole = format!("{section}.{}", path.split('[').next().unwrap_or(path));
        let lies_in = |inner: &str, outer: &str| {
            let rest = inner.strip_prefix(outer);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let here = |path: &str| lies_in(path, &whole) || lies_in(&whole, path);
        let taken = self.unset.iter().find(|(path, _)| here(path));
        if let Some((taken, origin)) = taken {
            let around = taken.rsplit_once('.').map(|(around, _)| around);
            // To give it is part of what follows.
            let problem = problem.trim_end_matches("; give it as well");
            let or = around.filter(|around| around.contains('.'));
            let or = or.map_or(String::new(), |around| {
                format!(", or unset all of \"{around}\"")
            });
            let remedy = format!("unset takes \"{taken}\" away there: give it another value{or}");
            return (origin.clone(), format!("{problem}; {remedy}"));
        }
        let origin = self.origin_of_value(section, path);
        // At odds with another value, it may be with one that is no longer there.
        let named = |path: &str| {
            let key = path.strip_prefix(section)?.strip_prefix('.')?;
            Some(problem.contains(key))
        };
        let near = self
            .unset
            .iter()
            .find(|(path, _)| named(path) == Some(true));
        let note = near.map_or(String::new(), |(taken, by)| {
            format!("; unset of {by} takes \"{taken}\" away")
        });
        (origin, problem + &note)
    }

    /// The part of a path in a section at which there is a value.
    fn existing<'a>(&self, section: &str, key: &'a str) -> &'a str {
        let mut key = key;
        while !key.is_empty() && self.value(section, key).is_none() {
            key = key.rsplit_once('.').map_or("", |(around, _)| around);
        }
        key
    }

    pub(super) fn origin_of(&self, section: &str, key: &str) -> String {
        let found = self.origin(&format!(
            "{section}.{}",
            key.replace('[', ".").replace(']', "")
        ));
        found.map_or_else(|| self.origin_of_section(section), str::to_owned)
    }

    /// The origin of a value, of an entry of a list, or of anything inside a table.
    pub(super) fn origin_of_value(&self, section: &str, path: &str) -> String {
        let path = path.split('[').next().unwrap_or(path);
        let whole = format!("{section}.{path}");
        let inside = format!("{whole}.");
        let mut given = self.origins.iter();
        let found = given.find(|(given, _)| **given == whole || given.starts_with(&inside));
        let found = found.map(|(_, origin)| origin.as_str());
        // What is missing is looked for where the table was given that it is missing in.
        let found = found.or_else(|| self.origin(&whole));
        found.map_or_else(|| self.origin_of_section(section), str::to_owned)
    }

    /// The origin of anything given in the section: right when there is one file, honest otherwise.
    pub(super) fn origin_of_section(&self, section: &str) -> String {
        match self.origins(section).as_slice() {
            [] => "the defaults".to_owned(),
            several => several.join(" with "),
        }
    }

    fn value(&self, section: &str, key: &str) -> Option<&Value> {
        let steps = key.split(['.', '[', ']']).filter(|part| !part.is_empty());
        steps.fold(self.table.get(section), |value, part| {
            value.and_then(|inner| match part.parse::<usize>() {
                Ok(index) => inner.get(index),
                Err(_) => inner.get(part),
            })
        })
    }

    pub(super) fn value_text(&self, section: &str, key: &str) -> String {
        let text = self
            .value(section, key)
            .map_or_else(|| "(none)".to_owned(), Value::to_string);
        // A whole list of clips would bury the message.
        wording::line(&text)
    }

    /// Forgets what was known of `path` and below, and marks the new value.
    pub(super) fn remark(&mut self, path: &str, value: &Value, origin: &str) {
        self.forget(path, true);
        match value {
            Value::Table(table) if !table.is_empty() => {
                mark(table, &format!("{path}."), origin, &mut self.origins);
            }
            _ => {
                self.origins.insert(path.to_owned(), origin.to_owned());
            }
        }
    }

    /// Forgets where a value was given that another takes the place of; all below it as well if `below`.
    pub(super) fn forget(&mut self, path: &str, below: bool) {
        let inside = format!("{path}.");
        let stays = |known: &String| known != path && !(below && known.starts_with(&inside));
        self.origins.retain(|known, _| stays(known));
        self.unset.retain(|known, _| stays(known));
    }
}

/// The path of the first number that is finite and has no place among numbers of 32 bits, and the number.
fn unfit(path: &str, value: &Value) -> Option<(String, f64)> {
    match value {
        Value::Float(number) => {
            let size = number.abs();
            let fits = (f64::from(f32::MIN_POSITIVE)..=f64::from(f32::MAX)).contains(&size);
            let unfit = size.is_finite() && size != 0.0 && !fits;
            unfit.then(|| (path.to_owned(), *number))
        }
        Value::Array(values) => {
            let mut inside = values.iter().enumerate();
            inside.find_map(|(i, value)| unfit(&format!("{path}[{i}]"), value))
        }
        Value::Table(table) => {
            let mut inside = table.iter();
            inside.find_map(|(name, value)| unfit(&format!("{path}.{name}"), value))
        }
        _ => None,
    }
}
