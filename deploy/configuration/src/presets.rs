//! The presets that come with the program, and those that are files: each says itself what it lies on.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use run::Config;
use run::config::{Source, lay};
use terminal::failure::usage;

/// Those of ours, by name: part of the program, so they need no folder beside it.
const EMBEDDED: [(&str, &str); 16] = [
    ("ampco", include_str!("../../presets/ampco.toml")),
    (
        "ampco-literal",
        include_str!("../../presets/ampco-literal.toml"),
    ),
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
    ("agile", include_str!("../../presets/agile.toml")),
    ("sprint", include_str!("../../presets/sprint.toml")),
    ("runner", include_str!("../../presets/runner.toml")),
    ("athlete", include_str!("../../presets/athlete.toml")),
    (
        "athlete-robust",
        include_str!("../../presets/athlete-robust.toml"),
    ),
    ("smoke", include_str!("../../presets/smoke.toml")),
];

/// As whose name a preset is read from standard input.
const STANDARD_INPUT: &str = "-";

/// A preset with all that it lies on.
#[derive(Debug)]
pub struct Preset {
    /// Stem of the names of its runs.
    pub name: String,
    /// How errors name it.
    pub origin: String,
    /// What it sets, and what those set that it lies on.
    pub config: Config,
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
    lay(&mut config, source, open)?;
    Ok(Preset {
        name,
        origin,
        config,
    })
}

/// Lays a preset, and all that it lies on, over a configuration.
pub fn lay_over(config: &mut Config, given: &str) -> Result<()> {
    Ok(lay(config, top(given)?, open)?)
}

/// What was typed: a name, a file, or what is written to us.
fn top(given: &str) -> Result<Source> {
    if given != STANDARD_INPUT {
        return open(given, None).map_err(usage);
    }
    let text = std::io::read_to_string(std::io::stdin()).context("reading standard input")?;
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
    if !path.is_file() {
        let remedy = run::nearest::remedy(given, &names());
        return Err(format!(
            "there is no preset and no file `{given}`; {remedy}"
        ));
    }
    Source::read(&path).map_err(|error| format!("{:#}", anyhow::Error::from(error)))
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

    /// What a preset of ours lies on, and what it sets itself.
    fn layer(text: &str) -> (Config, Config) {
        let mut table: toml::Table = toml::from_str(text).unwrap();
        let mut below = Config::default();
        if let Some(on) = table.remove("on") {
            lay_over(&mut below, on.as_str().unwrap()).unwrap();
        }
        for path in table
            .remove("unset")
            .iter()
            .flat_map(|list| list.as_array().unwrap())
        {
            below.remove(path.as_str().unwrap());
        }
        let own = Config::parse(&toml::to_string(&table).unwrap(), "a layer").unwrap();
        (below, own)
    }

    #[test]
    fn a_preset_holds_only_what_differs_from_what_it_lies_on() {
        let mut defaults = Config::default();
        crate::resolve::resolve(&mut defaults).unwrap();
        // The default is "one per core"; what that comes to is this machine's business.
        defaults.put("fleet.actors", 0, "the test");
        for (name, text) in EMBEDDED {
            let (below, own) = layer(text);
            for path in own.paths() {
                // What moves is one value.
                let ends = [".from", ".to", ".samples"];
                let path = ends
                    .iter()
                    .find_map(|end| path.strip_suffix(end))
                    .unwrap_or(path);
                let given = own.given(path);
                let before = below.given(path).or_else(|| defaults.given(path));
                assert_ne!(given, before, "preset {name}: {path}");
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
        let origin = path.canonicalize().unwrap().display().to_string();
        assert_eq!(preset.config.origin("run.seed"), Some(&*origin));
    }

    /// A folder with presets that are files.
    struct Files(tempfile::TempDir);

    impl Files {
        fn new(files: &[(&str, &str)]) -> Self {
            let folder = tempfile::tempdir().unwrap();
            for (name, text) in files {
                let path = folder.path().join(name);
                std::fs::create_dir_all(path.parent().unwrap()).unwrap();
                std::fs::write(path, text).unwrap();
            }
            Self(folder)
        }

        fn path(&self, name: &str) -> String {
            let path = self.0.path().canonicalize().unwrap().join(name);
            path.display().to_string()
        }

        fn find(&self, name: &str) -> Result<Config> {
            find(&self.path(name)).map(|preset| preset.config)
        }

        fn refused(&self, name: &str) -> String {
            format!("{:#}", self.find(name).unwrap_err())
        }
    }

    #[test]
    fn a_file_lies_on_another_beside_it_and_that_on_one_of_ours() {
        let files = Files::new(&[
            (
                "deep/top.toml",
                "on = \"../base.toml\"\nunset = [\"task.gate.effort\", \"motion.clips\"]\n[ppo]\nepochs = 7",
            ),
            (
                "base.toml",
                "on = \"agile\"\n[ppo]\nepochs = 5\nminibatch = 64\n[motion]\nclips = [{ file = \"x.csv\" }]",
            ),
        ]);
        let (top, base) = (
            files.find("deep/top.toml").unwrap(),
            files.find("base.toml").unwrap(),
        );
        let number = |config: &Config, path: &str| config.given(path).and_then(|v| v.as_integer());
        assert_eq!(number(&top, "ppo.epochs"), Some(7));
        assert_eq!(number(&top, "ppo.minibatch"), Some(64));
        // `agile` has 1024 robots, an effort gate and clips of its own.
        assert_eq!(number(&top, "fleet.environments"), Some(1024));
        assert!(
            base.given("task.gate.effort").is_some() && top.given("task.gate.effort").is_none()
        );
        assert!(top.given("motion.clips").is_none());
        for (path, origin) in [
            ("ppo.epochs", files.path("deep/top.toml")),
            ("ppo.minibatch", files.path("base.toml")),
            ("fleet.environments", "preset agile".to_owned()),
        ] {
            assert_eq!(top.origin(path), Some(&*origin), "{path}");
        }
        // What a file names lies beside that file, not beside the one on top of it.
        let clip = base.given("motion.clips").unwrap()[0]["file"]
            .as_str()
            .unwrap()
            .to_owned();
        assert_eq!(clip, files.path("x.csv"));
        // A mistake below is told of the file that it stands in.
        let mut wrong = top;
        wrong.put("ppo.epochs", -1, "the test");
        assert!(crate::resolve::resolve(&mut wrong).is_err());
    }

    #[test]
    fn a_circle_is_told_with_all_that_are_in_it() {
        let files = Files::new(&[
            ("a.toml", "on = \"./b.toml\""),
            ("b.toml", "on = \"c/../a.toml\""),
            ("c/self.toml", "on = \"self.toml\""),
        ]);
        let told = files.refused("a.toml");
        let (a, b) = (files.path("a.toml"), files.path("b.toml"));
        assert!(
            told.contains(&format!("`on` leads in a circle, {a} on {b} on {a}")),
            "{told}"
        );
        assert!(files.refused("c/self.toml").contains("circle"));
    }

    #[test]
    fn what_is_not_there_is_named_with_the_closest() {
        let files = Files::new(&[
            ("on.toml", "on = \"agil\""),
            (
                "unset.toml",
                "on = \"agile\"\nunset = [\"task.gate.efort\"]",
            ),
            ("nothing.toml", "unset = [\"ppo.epochs\"]"),
            ("kind.toml", "on = [\"agile\"]"),
            ("list.toml", "on = \"agile\"\nunset = \"task.gate\""),
            ("mixed.toml", "on = \"agile\"\nunset = [1]"),
            ("broken.toml", "on = \"below.toml\""),
            ("below.toml", "[ppo\n"),
        ]);
        for (name, parts) in [
            ("on.toml", ["on = \"agil\"", "did you mean `agile`"]),
            (
                "unset.toml",
                ["task.gate.efort", "did you mean `task.gate.effort`"],
            ),
            ("nothing.toml", ["ppo.epochs", "take the line away"]),
            ("kind.toml", ["on = ", "on = \"ampco\""]),
            (
                "list.toml",
                ["unset = \"task.gate\"", "write a list of keys"],
            ),
            ("mixed.toml", ["unset = [1]", "write a list of keys"]),
            ("broken.toml", ["below.toml: not valid TOML", "line 1"]),
        ] {
            let told = files.refused(name);
            assert!(
                parts.iter().all(|part| told.contains(part)),
                "{name}: {told}"
            );
        }
    }

    #[test]
    fn another_method_takes_the_place_of_the_one_below() {
        let files = Files::new(&[
            (
                "other.toml",
                "on = \"agile\"\n[scheduler.method.amp_roger]\nlower = 0.1\nupper = 0.6",
            ),
            (
                "same.toml",
                "on = \"other.toml\"\n[scheduler.method.amp_roger]\nupper = 0.7",
            ),
            (
                "plain.toml",
                "on = \"same.toml\"\n[scheduler]\nmethod = \"adamimic\"",
            ),
        ]);
        let method = |name| {
            let mut config = files.find(name).unwrap();
            crate::resolve::resolve(&mut config).unwrap();
            config.given("scheduler.method").unwrap().to_string()
        };
        // `agile` has the method amp.
        assert_eq!(
            method("other.toml"),
            "{ amp_roger = { lower = 0.1, upper = 0.6 } }"
        );
        assert_eq!(
            method("same.toml"),
            "{ amp_roger = { lower = 0.1, upper = 0.7 } }"
        );
        assert_eq!(method("plain.toml"), "\"adamimic\"");
        let config = files.find("plain.toml").unwrap();
        assert_eq!(
            config.origin("scheduler.method"),
            Some(&*files.path("plain.toml"))
        );
    }
}
