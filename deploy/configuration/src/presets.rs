//! The presets that come with the program, and those that are files.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use run::Config;
use terminal::failure::usage;

/// What all methods that are meant to walk begin from.
const RECIPE: &str = include_str!("../../presets/recipe.toml");

/// Every direction; also what its further stages begin from.
const AGILE: &str = include_str!("../../presets/agile.toml");

/// Every direction, and a run; also what its stage under Table I begins from.
const ATHLETE: &str = include_str!("../../presets/athlete.toml");

/// One of ours: part of the program, so it needs no folder beside it.
struct Embedded {
    name: &'static str,
    text: &'static str,
    /// What it lies on top of, the lowest first.
    on: &'static [&'static str],
}

const EMBEDDED: [Embedded; 15] = [
    Embedded {
        name: "ampco",
        text: include_str!("../../presets/ampco.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "ampco-literal",
        text: include_str!("../../presets/ampco-literal.toml"),
        on: &[],
    },
    Embedded {
        name: "amp-0.5",
        text: include_str!("../../presets/amp-0.5.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "amp-0.7",
        text: include_str!("../../presets/amp-0.7.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "amp-0.8",
        text: include_str!("../../presets/amp-0.8.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "adamimic",
        text: include_str!("../../presets/adamimic.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "amp-roger",
        text: include_str!("../../presets/amp-roger.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "ampco-without-aig",
        text: include_str!("../../presets/ampco-without-aig.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "ampco-without-roger",
        text: include_str!("../../presets/ampco-without-roger.toml"),
        on: &[RECIPE],
    },
    Embedded {
        name: "agile",
        text: AGILE,
        on: &[],
    },
    Embedded {
        name: "sprint",
        text: include_str!("../../presets/sprint.toml"),
        on: &[AGILE],
    },
    Embedded {
        name: "runner",
        text: include_str!("../../presets/runner.toml"),
        on: &[AGILE],
    },
    Embedded {
        name: "athlete",
        text: ATHLETE,
        on: &[AGILE],
    },
    Embedded {
        name: "athlete-robust",
        text: include_str!("../../presets/athlete-robust.toml"),
        on: &[AGILE, ATHLETE],
    },
    Embedded {
        name: "smoke",
        text: include_str!("../../presets/smoke.toml"),
        on: &[],
    },
];

impl Embedded {
    fn config(&self) -> Result<Config> {
        let mut config = self.beneath()?;
        config.merge(Config::parse(self.text, &format!("preset {}", self.name))?);
        Ok(config)
    }

    /// What it lies on top of; nothing if that are the defaults alone.
    fn beneath(&self) -> Result<Config> {
        let name = format!("what preset {} begins from", self.name);
        let mut config = Config::default();
        for text in self.on {
            config.merge(Config::parse(text, &name)?);
        }
        Ok(config)
    }
}

/// A preset: what differs from the defaults.
#[derive(Debug)]
pub struct Preset {
    /// Stem of the names of its runs.
    pub name: String,
    /// What it sets.
    pub config: Config,
    /// The file, from whose folder its relative paths start; `None` for one of ours, which has none.
    pub file: Option<PathBuf>,
}

/// The names, for help and errors.
pub fn names() -> Vec<&'static str> {
    EMBEDDED.iter().map(|preset| preset.name).collect()
}

/// One of ours by its name, else a file.
pub fn find(given: &str) -> Result<Preset> {
    if let Some(preset) = EMBEDDED.iter().find(|preset| preset.name == given) {
        return Ok(Preset {
            name: preset.name.to_owned(),
            config: preset.config()?,
            file: None,
        });
    }
    let path = Path::new(given);
    if !path.is_file() {
        let remedy = run::nearest::remedy(given, &names());
        return Err(usage(format!(
            "there is no preset and no file `{given}`; {remedy}"
        )));
    }
    let path = path
        .canonicalize()
        .with_context(|| format!("resolving {given}"))?;
    Ok(Preset {
        name: run_stem(&path),
        config: Config::read(&path)?,
        file: Some(path),
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
mod tests {
    use super::*;

    #[test]
    fn a_preset_holds_only_what_differs_from_what_it_lies_on() {
        let mut defaults = Config::default();
        crate::resolve::resolve(&mut defaults).unwrap();
        // The default is "one per core"; what that comes to is this machine's business.
        defaults.put("fleet.actors", 0, "the test");
        for preset in &EMBEDDED {
            let mut below = Config::default();
            for text in preset.on.iter().chain([&preset.text]) {
                let layer = Config::parse(text, "a layer").unwrap();
                for path in layer.paths() {
                    // What moves is one value.
                    let ends = [".from", ".to", ".samples"];
                    let path = ends
                        .iter()
                        .find_map(|end| path.strip_suffix(end))
                        .unwrap_or(path);
                    let given = layer.given(path);
                    let before = below.given(path).or_else(|| defaults.given(path));
                    assert_ne!(given, before, "preset {}: {path}", preset.name);
                }
                below.merge(layer);
            }
        }
    }

    #[test]
    fn a_misspelt_preset_is_answered_with_the_closest() {
        let error = find("smok").unwrap_err().to_string();
        assert!(error.contains("did you mean `smoke`?"), "{error}");
    }

    #[test]
    fn a_file_is_a_preset_and_names_its_runs() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("my walk.toml");
        std::fs::write(&path, "[run]\nseed = 3").unwrap();
        let preset = find(path.to_str().unwrap()).unwrap();
        assert_eq!(preset.name, "my-walk");
        assert_eq!(
            preset.config.given("run.seed").and_then(|v| v.as_integer()),
            Some(3)
        );
        assert_eq!(preset.file, Some(path.canonicalize().unwrap()));
    }
}
