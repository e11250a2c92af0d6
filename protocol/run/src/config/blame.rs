//! Where a value was given, and what is said of one that cannot be used.
//!
//! Separate from the values because an error has to name the place to mend, whatever was laid over what.

use toml::Value;

use super::complaint::{misspelt_path, quoted_names};
use super::tables::mark;
use super::{Config, ConfigError, moved};
use crate::nearest;

impl Config {
    /// serde's complaint about one section, in our words.
    pub(super) fn explain(&self, section: &str, path: &str, message: &str) -> ConfigError {
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
        found.map_or_else(
            || self.origin_of_section(section),
            |(_, origin)| origin.clone(),
        )
    }

    /// The origin of anything given in the section: right when there is one file, honest otherwise.
    pub(super) fn origin_of_section(&self, section: &str) -> String {
        match self.origins(section).as_slice() {
            [] => "the defaults".to_owned(),
            several => several.join(" with "),
        }
    }

    pub(super) fn value_text(&self, section: &str, key: &str) -> String {
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
    pub(super) fn remark(&mut self, path: &str, value: &Value, origin: &str) {
        self.forget(path, true);
        match value {
            Value::Table(table) => mark(table, &format!("{path}."), origin, &mut self.origins),
            _ => {
                self.origins.insert(path.to_owned(), origin.to_owned());
            }
        }
    }

    /// Forgets where a value was given that another takes the place of; all below it as well if `below`.
    pub(super) fn forget(&mut self, path: &str, below: bool) {
        let inside = format!("{path}.");
        self.origins
            .retain(|known, _| known != path && !(below && known.starts_with(&inside)));
    }
}
