//! The presets that come with the program, and those that are files: each says itself what it lies on.

use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use run::Config;
use run::config::{METHOD, Source, lay, lay_alone};
use terminal::failure::usage;

use crate::resolve;

/// Those of ours, by name: part of the program, so they need no folder beside it.
const EMBEDDED: [(&str, &str); 14] = [
    ("ampco", include_str!("../../presets/ampco.toml")),
    (
        "ampco-literal",
        include_str!("../../presets/ampco-literal.toml"),
    ),
    ("g1", include_str!("../../presets/g1.toml")),
    ("g1-robot", include_str!("../../presets/g1-robot.toml")),
    ("pair", include_str!("../../presets/pair.toml")),
    ("recipe", include_str!("../../presets/recipe.toml")),
    ("amp-0.5", include_str!("../../presets/amp-0.5.toml")),
    ("amp-0.7", include_str!("../../presets/amp-0.7.toml")),
    ("amp-0.8", include_str!("../../presets/amp-0.8.toml")),
    ("adamimic", include_str!("../../presets/adamimic.toml")),
    ("amp-roger", include_str!("../../presets/amp-roger.toml")),
    (
        "ampco-without-aig",
        include_str!("../../presets/ampco-without-aig.toml"),
    ),
    (
        "ampco-without-roger",
        include_str!("../../presets/ampco-without-roger.toml"),
    ),
    ("smoke", include_str!("../../presets/smoke.toml")),
];

/// As whose name a preset is read from standard input.
pub const STANDARD_INPUT: &str = "-";

/// A preset with all that it lies on.
#[derive(Debug)]
pub struct Preset {
    /// Stem of the names of its runs.
    pub name: String,
    /// How errors name it.
    pub origin: String,
    /// What it sets, and what those set that it lies on.
    pub config: Config,
    /// What is to be said of it: accepted, and odd.
    pub notices: Vec<String>,
}

/// The names, for help and errors.
pub fn names() -> Vec<&'static str> {
    EMBEDDED.iter().map(|(name, _)| *name).collect()
}

/// One of ours by its name, else a file; `-` is standard input.
pub fn find(given: &str) -> Result<Preset> {
    let source = top(given)?;
    let name = match &source.folder {
        Some(_) => run_stem(Path::new(&source.origin)),
        None if given == STANDARD_INPUT => "run".to_owned(),
        None => given.to_owned(),
    };
    let (mut config, origin) = (Config::default(), source.origin.clone());
    let notices = lay_source(&mut config, source)?;
    Ok(Preset {
        name,
        origin,
        config,
        notices,
    })
}

/// The same on another base than its own: of `base` and all that it lies on everything but the method, and over that what
/// `given` itself sets and takes away. What stands between `given` and its own base is left out.
pub fn find_on(given: &str, base: &str) -> Result<Preset> {
    let mut preset = find(given)?;
    let mut config = Config::default();
    let mut notices = lay_over(&mut config, base)?;
    config.remove(METHOD);
    notices.extend(lay_alone(&mut config, &top(given)?, resolve::default)?);
    // One that only names its base, as `ampco` does, has the method of that.
    if let (None, Some(method)) = (config.given(METHOD), preset.config.given(METHOD)) {
        config.put(METHOD, method.clone(), &preset.origin);
    }
    preset.config = config;
    preset.notices = notices;
    Ok(preset)
}

/// Lays a preset, and all that it lies on, over a configuration; what is to be said of it.
pub fn lay_over(config: &mut Config, given: &str) -> Result<Vec<String>> {
    lay_source(config, top(given)?)
}

/// The same, of a text.
pub fn lay_source(config: &mut Config, source: Source) -> Result<Vec<String>> {
    Ok(lay(config, source, open, resolve::default)?)
}

/// What was typed: a name, a file, or what is written to us.
fn top(given: &str) -> Result<Source> {
    if given != STANDARD_INPUT {
        return open(given, None).map_err(usage);
    }
    let mut bytes = Vec::new();
    std::io::stdin()
        .read_to_end(&mut bytes)
        .context("reading standard input")?;
    let text =
        wording::text(bytes).map_err(|foreign| usage(format!("standard input: {foreign}")))?;
    Ok(Source {
        origin: "standard input".to_owned(),
        text,
        folder: None,
    })
}

/// The text of one of ours by its name, else of a file, whose relative path starts from `folder`.
pub fn open(given: &str, folder: Option<&Path>) -> Result<Source, String> {
    if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == given) {
        return Ok(Source {
            origin: format!("preset {name}"),
            text: (*text).to_owned(),
            folder: None,
        });
    }
    let path: PathBuf = folder.map_or(given.into(), |folder| folder.join(given));
    if given.is_empty() {
        return Err("the name of the preset is empty; give a preset's name or a file".to_owned());
    }
    if let Some(what) = no_file(&path) {
        return Err(format!("`{}` is {what}", wording::line(given)));
    }
    if !path.is_file() {
        let remedy = wording::nearest::remedy(given, &names());
        return Err(format!(
            "there is no preset and no file `{}`; {remedy}",
            wording::line(given)
        ));
    }
    Source::read(&path).map_err(|error| format!("{:#}", anyhow::Error::from(error)))
}

/// What a path is that is there and no file, and what to give; none for a file, or where nothing is.
pub fn no_file(path: &Path) -> Option<&'static str> {
    let kind = std::fs::metadata(path).ok()?;
    if kind.is_file() {
        return None;
    }
    Some(if kind.is_dir() {
        "a folder and no preset; give the TOML file in it"
    } else {
        "no file but a pipe or a device; give its text on standard input, as `-`"
    })
}

/// A file's name as a run's name may be.
fn run_stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || c == '.' {
            c
        } else {
            '-'
        }
    };
    let stem: String = stem.chars().take(40).map(plain).collect();
    let stem = stem.trim_matches(['-', '.']);
    if stem.is_empty() { "run" } else { stem }.to_owned()
}

#[cfg(test)]
mod tests;
