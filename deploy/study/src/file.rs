//! A study file: which methods, which seeds, how long, and what every run has on top of its preset.

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

/// A study as its author wrote it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyFile {
    /// What it is, in one line.
    pub title: String,
    /// What a reader of the report should know of it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub note: String,
    /// The preset that every method lies on in place of its own base: of a method its own differences are taken, of this
    /// one all but its method.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on: Option<String>,
    /// Presets: names of ours or files beside this one.
    #[serde(default)]
    pub methods: Vec<String>,
    /// A run of each method with each.
    pub seeds: Vec<u64>,
    /// Length of each run in iterations; this or [`Self::samples`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub iterations: Option<u64>,
    /// Length of each run in transitions, rounded up to a whole iteration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<u64>,
    /// Process groups at a time; 0 = as many as the cores allow.
    #[serde(default = "one")]
    pub jobs: usize,
    /// How finished runs are judged without exploration noise; none are if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub evaluate: Option<Evaluation>,
    /// Methods with several values of some keys, every combination within each sweep.
    #[serde(default, rename = "sweep", skip_serializing_if = "Vec::is_empty")]
    pub sweeps: Vec<Sweep>,
    /// Sections of a configuration that every run has on top of its preset.
    #[serde(default, rename = "override", skip_serializing_if = "Table::is_empty")]
    pub overrides: Table,
}

/// How finished runs are judged: `ampco evaluate`, in rapier whatever they were trained in.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluation {
    /// vx, vy (m/s, heading frame), yaw rate (rad/s).
    pub commands: Vec<[f64; 3]>,
    /// Episodes per command.
    #[serde(default = "episodes")]
    pub episodes: usize,
    /// Length of an episode, s.
    #[serde(default = "seconds")]
    pub seconds: f64,
    /// Whose discriminator judges style, of every run the same: a shipped policy or a checkpoint, from the folder of the
    /// study file. Each run's own does if absent, and no two runs can then be compared by it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub judge: Option<String>,
}

/// One method with several values of some keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// The preset that is varied.
    pub preset: String,
    /// Dotted keys with the values that each takes.
    pub values: Table,
}

/// How long each run is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// So many iterations.
    Iterations(u64),
    /// At least so many transitions.
    Samples(u64),
}

/// What is wrong with a study file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// Not TOML, or a key that there is not.
    #[error("{0}")]
    Syntax(String),
    /// A value that cannot be used.
    #[error("{field}: {problem}")]
    Value {
        /// The key.
        field: &'static str,
        /// What is wrong, and what to write instead.
        problem: String,
    },
}

impl StudyFile {
    /// Reads and checks the text of a study file.
    ///
    /// # Errors
    /// Names the key, what is wrong with it and what would be right.
    pub fn parse(text: &str) -> Result<Self, FileError> {
        let file: Self = toml::from_str(text).map_err(|error| {
            FileError::Syntax(wording::refusal(
                text,
                error.span(),
                &wording::plain(error.message()),
            ))
        })?;
        file.check()?;
        Ok(file)
    }

    /// As the text of a study file.
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("a study file is a TOML table")
    }

    /// The length of each run.
    pub fn budget(&self) -> Budget {
        match (self.iterations, self.samples) {
            (Some(iterations), _) => Budget::Iterations(iterations),
            (None, samples) => Budget::Samples(samples.unwrap_or(0)),
        }
    }

    /// Refuses what cannot be run.
    pub fn check(&self) -> Result<(), FileError> {
        let refuse = |field, problem: &str| {
            let problem = problem.to_owned();
            Err(FileError::Value { field, problem })
        };
        if self.methods.is_empty() && self.sweeps.is_empty() {
            return refuse(
                "methods",
                "none is given; name presets, or give a [[sweep]]",
            );
        }
        if self.seeds.is_empty() {
            return refuse(
                "seeds",
                "none is given; write at least one, as in [1, 2, 3]",
            );
        }
        for (field, twice) in [
            ("methods", has_twice(&self.methods)),
            ("seeds", has_twice(&self.seeds)),
        ] {
            if twice {
                return refuse(field, "one is given twice; a run is made once");
            }
        }
        match (self.iterations, self.samples) {
            (Some(1..), None) | (None, Some(1..)) => {}
            (Some(_), Some(_)) => {
                return refuse("samples", "iterations are given as well; keep one of them");
            }
            _ => {
                return refuse(
                    "iterations",
                    "no length is given; use 1 or more, or samples",
                );
            }
        }
        if let Some(evaluation) = &self.evaluate {
            if evaluation.commands.is_empty() || evaluation.episodes == 0 {
                return refuse(
                    "evaluate",
                    "nothing would be tried; give commands and episodes",
                );
            }
            if evaluation.seconds.is_nan() || evaluation.seconds <= 0.0 {
                return refuse("evaluate.seconds", "use more than 0");
            }
        }
        for sweep in &self.sweeps {
            let list = |value: &Value| value.as_array().is_some_and(|list| !list.is_empty());
            if sweep.values.is_empty() || !sweep.values.values().all(list) {
                return refuse(
                    "sweep.values",
                    "each key takes a list, as in \"scheduler.alpha\" = [0.9, 0.95]",
                );
            }
        }
        let entries = self.entries();
        let names: Vec<&str> = entries.iter().map(|entry| entry.name.as_str()).collect();
        if has_twice(&names) {
            return refuse(
                "methods",
                "two of them, or of the combinations of [[sweep]], have the same name; a run is made once",
            );
        }
        Ok(())
    }
}

fn has_twice<T: PartialEq>(list: &[T]) -> bool {
    (1..list.len()).any(|index| list[..index].contains(&list[index]))
}

fn one() -> usize {
    1
}

fn episodes() -> usize {
    32
}

fn seconds() -> f64 {
    20.0
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "title = 'a study'\nmethods = ['ampco', 'amp-0.5']\nseeds = [1, 2]\nsamples = 1000\n\
                        [override.fleet]\nphysics = 'batched'\n";

    #[test]
    fn a_file_comes_back_as_it_was() {
        let file = StudyFile::parse(GOOD).unwrap();
        assert_eq!(file.budget(), Budget::Samples(1000));
        assert_eq!(file.jobs, 1);
        assert_eq!(file.overrides["fleet"]["physics"].as_str(), Some("batched"));
        assert_eq!(StudyFile::parse(&file.to_toml()).unwrap(), file);
    }

    #[test]
    fn what_is_no_study_is_named_and_not_echoed() {
        let refused = |text: &str| {
            let parsed = StudyFile::parse(text).map(drop);
            parsed.unwrap_err().to_string()
        };
        let page = refused(&format!("<html>{}", "A".repeat(1_800_000)));
        assert!(page.starts_with("it is a web page (HTML); "), "{page}");
        let long = refused(&"A".repeat(1_800_000));
        assert!(
            long.chars().count() < 400 && long.starts_with("line 1, "),
            "{long:.500}"
        );
        let key = refused(&format!("{} = 1\n{GOOD}", "A".repeat(1_800_000)));
        assert!(
            key.chars().count() < 900 && !key.contains('\n'),
            "{key:.1000}"
        );
    }

    #[test]
    fn what_cannot_be_run_is_refused_by_its_key() {
        let refused = |from: &str, to: &str| {
            let text = GOOD.replacen(from, to, 1);
            assert_ne!(text, GOOD);
            StudyFile::parse(&text).unwrap_err().to_string()
        };
        assert!(refused("['ampco', 'amp-0.5']", "[]").starts_with("methods: none"));
        assert!(refused("[1, 2]", "[]").starts_with("seeds: none"));
        assert!(refused("[1, 2]", "[1, 1]").contains("twice"));
        assert!(refused("samples = 1000", "").starts_with("iterations: no length"));
        assert!(refused("samples", "iterations = 5\nsamples").starts_with("samples: iterations"));
        assert!(refused("seeds", "sedes").contains("sedes"));
        assert!(refused("[override", "[evaluate]\ncommands = []\n[override").contains("evaluate"));
        let sweep = "[[sweep]]\npreset = 'ampco'\nvalues = { x = 1 }\n[override";
        assert!(refused("[override", sweep).contains("sweep.values"));
        let twice = "[[sweep]]\npreset = 'ampco'\nvalues = { x = [1] }\n[[sweep]]\npreset = 'ampco'\n\
                     values = { x = [2, 1] }\n[override";
        assert!(refused("[override", twice).contains("same name"));
        assert!(
            refused("['ampco', 'amp-0.5']", "['ampco', 'mine/ampco.toml']").contains("same name")
        );
    }
}
