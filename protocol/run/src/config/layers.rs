//! Presets on presets: each says what it lies on, what it takes away from that, and what it sets.
//!
//! ```toml
//! on = "g1"                         # a preset that comes with the program, or a file beside this one
//! unset = ["randomization.impulse"] # what `g1` sets and this does not: back to the default
//! [ppo]
//! epochs = 3
//! ```
//!
//! Separate because a configuration knows values and where they were given; which files lie on one another is a matter
//! of its own, and ends here.

use std::path::{Path, PathBuf};

use toml::{Table, Value};

use super::{Config, ConfigError, table};
use wording::nearest;

/// The text of a preset.
#[derive(Clone, Debug)]
pub struct Source {
    /// How errors and origins name it: `preset smoke`, or the absolute path of a file.
    pub origin: String,
    /// TOML.
    pub text: String,
    /// From where relative paths start; `None` for one that is part of the program.
    pub folder: Option<PathBuf>,
}

impl Source {
    /// A file's.
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        let absolute = path.canonicalize().map_err(|source| ConfigError::Read {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            origin: absolute.display().to_string(),
            text: text(&absolute)?,
            folder: absolute.parent().map(Path::to_owned),
        })
    }
}

/// The text of a file that should be one.
pub(super) fn text(path: &Path) -> Result<String, ConfigError> {
    let bytes = std::fs::read(path).map_err(|source| ConfigError::Read {
        path: path.to_owned(),
        source,
    })?;
    wording::text(bytes).map_err(|foreign| ConfigError::Syntax {
        origin: path.display().to_string(),
        message: foreign.to_string(),
    })
}

/// Lays a preset, and first all that it lies on, over `config`; what is to be said of it, where it is accepted and odd.
/// `open` finds what `on` names, in the folder of the file that names it; it answers with the words of what is wrong.
/// `default` knows the value or table that a key has where nothing sets it.
pub fn lay(
    config: &mut Config,
    top: Source,
    open: impl Fn(&str, Option<&Path>) -> Result<Source, String>,
    default: impl Fn(&str) -> Option<Value>,
) -> Result<Vec<String>, ConfigError> {
    let mut layers: Vec<Layer> = Vec::new();
    let mut next = Some(top);
    while let Some(source) = next {
        let again = layers
            .iter()
            .position(|layer| layer.origin == source.origin);
        if let Some(first) = again {
            let circle = layers[first..].iter().map(|layer| layer.origin.as_str());
            let circle: Vec<&str> = circle.chain([source.origin.as_str()]).collect();
            return Err(refused(
                circle[0],
                format!(
                    "`on` leads in a circle, {}; take one of them away",
                    circle.join(" on ")
                ),
            ));
        }
        let layer = Layer::parse(&source)?;
        let below = layer.on.as_deref().map(|on| {
            let found = open(on, source.folder.as_deref());
            found.map_err(|problem| refused(&layer.origin, format!("on = {on:?}: {problem}")))
        });
        next = below.transpose()?;
        layers.push(layer);
    }
    let mut notices = Vec::new();
    for layer in layers.into_iter().rev() {
        layer.apply(config, &default, &mut notices)?;
    }
    Ok(notices)
}

/// Lays a preset's own part over `config`, whatever it says that it lies on; what is to be said of it.
pub fn lay_alone(
    config: &mut Config,
    source: &Source,
    default: impl Fn(&str) -> Option<Value>,
) -> Result<Vec<String>, ConfigError> {
    let mut notices = Vec::new();
    Layer::parse(source)?.apply(config, default, &mut notices)?;
    Ok(notices)
}

/// A preset by itself.
struct Layer {
    origin: String,
    on: Option<String>,
    unset: Vec<String>,
    sets: Config,
}

impl Layer {
    fn parse(source: &Source) -> Result<Self, ConfigError> {
        let origin = &source.origin;
        let mut table = table(&source.text, origin)?;
        let on = match table.remove("on") {
            None => None,
            Some(Value::String(on)) => Some(on),
            Some(other) => {
                let problem = format!(
                    "on = {}: write one preset's name or path, as in on = \"ampco\"",
                    shown(&other)
                );
                return Err(refused(origin, problem));
            }
        };
        let unset = unset(&mut table).map_err(|problem| refused(origin, problem))?;
        let mut sets = Config::of(table, origin);
        if let Some(folder) = &source.folder {
            sets.anchor_files(folder);
        }
        Ok(Self {
            on,
            unset,
            sets,
            origin: origin.clone(),
        })
    }

    fn apply(
        self,
        config: &mut Config,
        default: impl Fn(&str) -> Option<Value>,
        notices: &mut Vec<String>,
    ) -> Result<(), ConfigError> {
        // A section alone says nothing; a table in one lists a term.
        let says = self.sets.leaves().keys().any(|path| path.contains('.'));
        if self.on.is_none() && self.unset.is_empty() && !says {
            let origin = &self.origin;
            notices.push(format!(
                "{origin}: nothing is set in it, so it changes nothing"
            ));
        }
        for path in &self.unset {
            let default = default(path);
            if config.given(path).is_none() {
                let remedy = unset_in_vain(config, path, default.as_ref());
                let path = wording::line(path);
                let problem = format!("unset: nothing that it lies on sets `{path}`; {remedy}");
                return Err(refused(&self.origin, problem));
            }
            config.unset(path, &self.origin);
            let again = || self.sets.given(path).is_some();
            if default.as_ref().is_some_and(is_term) && !again() {
                let origin = &self.origin;
                notices.push(format!("{origin}: unset: `{path}` {}", stays(path)));
            }
        }
        config.merge(self.sets);
        Ok(())
    }
}

/// What to do about a key to unset that nothing has set.
fn unset_in_vain(config: &Config, path: &str, default: Option<&Value>) -> String {
    match default {
        Some(term) if is_term(term) => return format!("it {}", stays(path)),
        Some(value @ Value::Table(_))
            if value.as_table().is_some_and(|table| !table.is_empty()) =>
        {
            return "it is what it is by default; take the line away".to_owned();
        }
        Some(value) => {
            let value = shown(value);
            return format!("it is {value} by default; take the line away, or set another value");
        }
        None => {}
    }
    let known = paths(config);
    let depth = path.matches('.').count();
    let known = known.iter().map(String::as_str);
    // A table that the key would stand in is not what was meant.
    let known: Vec<&str> = known
        .filter(|known| known.matches('.').count() == depth)
        .collect();
    match nearest::remedy(path, &known) {
        // All that is set would bury the message.
        all if all.starts_with("known") => "take the line away".to_owned(),
        close => close,
    }
}

/// Whether a table is a term of the task that weighs something.
fn is_term(table: &Value) -> bool {
    table.get("weight").is_some()
}

/// What becomes of a term that is there by default.
fn stays(path: &str) -> String {
    format!("is there by default, and stays; to do without it set {path}.weight = 0")
}

/// Takes the keys to unset out of a preset.
fn unset(table: &mut Table) -> Result<Vec<String>, String> {
    let Some(given) = table.remove("unset") else {
        return Ok(Vec::new());
    };
    let paths = match &given {
        Value::Array(paths) => paths.iter().map(Value::as_str).collect(),
        _ => None,
    };
    let paths: Option<Vec<&str>> = paths;
    let paths = paths.ok_or_else(|| {
        let given = shown(&given);
        format!("unset = {given}: write a list of keys, as in unset = [\"task.gate.effort\", \"motion.clips\"]")
    })?;
    Ok(paths.into_iter().map(str::to_owned).collect())
}

/// All that can be unset: every value given, and every table around one.
fn paths(config: &Config) -> Vec<String> {
    let mut paths = Vec::new();
    for path in config.leaves().keys() {
        let ends = path.match_indices('.').map(|(end, _)| end);
        for end in ends.chain([path.len()]) {
            let path = path[..end].to_owned();
            if !paths.contains(&path) {
                paths.push(path);
            }
        }
    }
    paths
}

fn shown(value: &Value) -> String {
    wording::line(&value.to_string())
}

fn refused(origin: &str, problem: String) -> ConfigError {
    ConfigError::Preset {
        origin: origin.to_owned(),
        problem,
    }
}
