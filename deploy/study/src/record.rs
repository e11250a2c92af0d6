//! The record of a run: what is kept of it when its folder is gone, and all that a report needs of it.
//!
//! A run's folder is as large as its checkpoints; a record is a file of some ten kilobytes that lies in the repository, so
//! that a study goes on in another clone and its report stands on files that everybody has.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use toml::Table;

use crate::judged::Judgement;
use crate::matrix::{Cell, Entry};
use crate::measure::Measured;
use crate::told::Told;

/// Bytes that a record has at most: a study of 80 is then smaller than a picture or two.
pub const LIMIT: usize = 60_000;
/// Of the form of the file.
const VERSION: u64 = 1;

/// A finished run, judged if its study judges.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// What was run.
    pub entry: Entry,
    /// With which seed.
    pub seed: u64,
    /// Iterations that it was to do and has done.
    pub target: u64,
    /// Every value, defaults included.
    pub configuration: Table,
    /// Which programs made it, and which policy came of it.
    pub origin: Origin,
    /// What its lines of metrics came to.
    pub told: Told,
    /// The metrics of III-F, if it is long enough.
    pub measured: Option<Measured>,
    /// What it did without exploration noise, if its study asks.
    pub judgement: Option<Judgement>,
}

/// Where a run comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Version of the programs.
    pub version: String,
    /// SHA-256 of the program that conducted it.
    pub program_sha256: String,
    /// SHA-256 of the policy in its last checkpoint.
    pub policy_sha256: String,
    /// The processor's name.
    pub processor: String,
    /// How many cores the run could have.
    pub cores: usize,
    /// Motion files that it learned from, by name and SHA-256.
    pub motion: Vec<(String, String)>,
}

/// Why a text is no record.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RecordError {
    /// Torn, or something else.
    #[error(
        "it is no whole record of a run: {0}; fetch it anew, or remove it to have the run made again"
    )]
    Foreign(String),
    /// Of a newer program.
    #[error(
        "it is a record of form {0} and this program reads form {VERSION}; use the program that wrote it"
    )]
    Version(u64),
    /// A record is not edited.
    #[error(
        "its configuration is not the one that its hash is of; fetch it anew, or remove it to have the run made again"
    )]
    Edited,
    /// It would be too long.
    #[error(
        "it would take {0} bytes of at most {LIMIT}; give fewer commands in [evaluate], or a shorter list of clips"
    )]
    TooLong(usize),
}

impl Record {
    /// The run's name: that of the file.
    pub fn run_name(&self) -> String {
        self.cell().run_name()
    }

    /// Which run of a study it is.
    pub fn cell(&self) -> Cell {
        Cell {
            entry: self.entry.clone(),
            seed: self.seed,
        }
    }

    /// As the text of a file: a line per subject.
    ///
    /// # Errors
    /// If it is longer than [`LIMIT`].
    pub fn to_text(&self) -> Result<String, RecordError> {
        let lines = [
            ("version", written(&VERSION)),
            ("entry", written(&self.entry)),
            ("seed", written(&self.seed)),
            ("target", written(&self.target)),
            ("measured", written(&self.measured)),
            ("judgement", written(&self.judgement)),
            ("origin", written(&self.origin)),
            ("configuration_sha256", written(&self.hash())),
            ("configuration", written(&self.configuration)),
            ("told", written(&self.told)),
        ];
        let lines = lines.map(|(name, value)| format!("  \"{name}\": {value}"));
        let text = format!("{{\n{}\n}}\n", lines.join(",\n"));
        if text.len() > LIMIT {
            return Err(RecordError::TooLong(text.len()));
        }
        Ok(text)
    }

    /// From the text of a file.
    ///
    /// # Errors
    /// Says what is wrong with it and what to do.
    pub fn parse(text: &str) -> Result<Self, RecordError> {
        let foreign =
            |error: serde_json::Error| RecordError::Foreign(wording::said(&error.to_string()));
        let mut parts: Map<String, Value> = serde_json::from_str(text).map_err(foreign)?;
        match part::<u64>(&mut parts, "version")? {
            VERSION => {}
            other => return Err(RecordError::Version(other)),
        }
        let hash: String = part(&mut parts, "configuration_sha256")?;
        let record = Self {
            entry: part(&mut parts, "entry")?,
            seed: part(&mut parts, "seed")?,
            target: part(&mut parts, "target")?,
            configuration: part(&mut parts, "configuration")?,
            origin: part(&mut parts, "origin")?,
            told: part(&mut parts, "told")?,
            measured: part(&mut parts, "measured")?,
            judgement: part(&mut parts, "judgement")?,
        };
        if let Some(name) = parts.keys().next() {
            let name = wording::quoted(name);
            return Err(RecordError::Foreign(format!("there is no part {name}")));
        }
        if record.hash() != hash {
            return Err(RecordError::Edited);
        }
        Ok(record)
    }

    /// SHA-256 of the configuration as TOML.
    fn hash(&self) -> String {
        let text = toml::to_string(&self.configuration).expect("a table of TOML values");
        sha256(text.as_bytes())
    }
}

/// SHA-256 in hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn written(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("names, numbers and lists of them")
}

fn part<T: DeserializeOwned>(parts: &mut Map<String, Value>, name: &str) -> Result<T, RecordError> {
    let value = parts
        .remove(name)
        .ok_or_else(|| RecordError::Foreign(format!("it has no `{name}`")))?;
    serde_json::from_value(value).map_err(|error| {
        RecordError::Foreign(format!("{name}: {}", wording::said(&error.to_string())))
    })
}

/// A record for the tests of other files.
#[cfg(test)]
pub(crate) fn sample(lines: &[crate::measure::Line]) -> Record {
    let target = lines.len() as u64;
    Record {
        entry: Entry {
            name: "ampco".into(),
            preset: "ampco".into(),
            values: vec![("scheduler.alpha".into(), toml::Value::Float(1.0))],
        },
        seed: 3,
        target,
        configuration: toml::from_str(
            "[run]\nseed = 3\n[ppo]\nclip = 0.2\ngamma = 1.0\nname = 'x'",
        )
        .unwrap(),
        origin: Origin {
            version: "0.1.0".into(),
            program_sha256: sha256(b"program"),
            policy_sha256: sha256(b"policy"),
            processor: "a processor".into(),
            cores: 2,
            motion: vec![("walk.csv".into(), sha256(b"walk"))],
        },
        told: Told::of(lines, target),
        measured: Measured::of(lines, 24),
        judgement: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::Evaluation;
    use crate::judged::{Judged, Reference};
    use crate::measure::Line;

    fn lines(count: u64) -> Vec<Line> {
        (1..=count)
            .map(|iteration| Line {
                iteration,
                samples: 98_304 * iteration,
                phase: Some(1),
                rmse: Some(1.0 / iteration as f64),
                energy_j: Some(12_345.678_9 / 7.0),
                style_mean: Some(0.123_456_789_012),
                episode_share: Some(1.0 / 3.0),
                ..Line::default()
            })
            .collect()
    }

    #[test]
    fn a_record_comes_back_as_it_was() {
        let record = sample(&lines(500));
        let text = record.to_text().unwrap();
        assert_eq!(Record::parse(&text).unwrap(), record);
        assert_eq!(record.run_name(), "ampco-seed3");
        // `echo -n abc | sha256sum`
        assert!(sha256(b"abc").starts_with("ba7816bf8f01cfea"));
    }

    #[test]
    fn the_longest_run_with_the_most_commands_stays_within_the_limit() {
        let mut record = sample(&lines(20_000));
        let row = Judged {
            gait: "a gait that is told in a sentence of a hundred letters or so, as of one that hops and slips".into(),
            style_reward: Some(1.0 / 3.0),
            stride_rate_hz: Some(1.0 / 3.0),
            duty_factor: Some(1.0 / 3.0),
            hip_correlation: Some(-1.0 / 3.0),
            foot_slip: Some(1.0 / 3.0),
            reference: Some(Reference { stride_rate_hz: 1.0 / 3.0 }),
            ..Judged::default()
        };
        let evaluate = Evaluation {
            commands: vec![[1.0 / 3.0; 3]; 32],
            episodes: 32,
            seconds: 20.0,
            judge: None,
        };
        record.judgement = Some(Judgement {
            evaluate,
            judge_sha256: None,
            rows: vec![row; 32],
        });
        // As long as a configuration with some two hundred clips.
        let long = "x".repeat(16_000);
        record.configuration.insert("motion".into(), long.into());
        let text = record.to_text().unwrap();
        assert!(text.len() <= LIMIT, "{} bytes", text.len());
        record
            .configuration
            .insert("more".into(), "x".repeat(LIMIT).into());
        let told = record.to_text().unwrap_err().to_string();
        assert!(
            told.contains("60000") && told.contains("[evaluate]"),
            "{told}"
        );
    }

    #[test]
    fn torn_foreign_and_edited_texts_are_refused() {
        let text = sample(&lines(100)).to_text().unwrap();
        let refused = |text: &str| Record::parse(text).unwrap_err().to_string();
        for cut in [0, 1, text.len() / 2, text.len() - 3] {
            assert!(refused(&text[..cut]).contains("no whole record"), "{cut}");
        }
        assert!(refused("{}").contains("`version`"));
        assert!(refused("[1]").contains("no whole record"));
        assert!(refused(&text.replace("\"version\": 1", "\"version\": 2")).contains("form 2"));
        assert!(refused(&text.replacen("\"seed\": 3", "\"sead\": 3", 1)).contains("`seed`"));
        let more = text.replacen("{\n", "{\n  \"mine\": 1,\n", 1);
        assert!(refused(&more).contains("mine"));
        let edited = text.replace("\"clip\":0.2", "\"clip\":0.25");
        assert_ne!(edited, text);
        assert!(refused(&edited).contains("hash"));
    }
}
