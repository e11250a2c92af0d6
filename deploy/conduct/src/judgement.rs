//! What `ampco evaluate` said of a finished run, and under which conditions.
//!
//! Separate because figures may only stand beside each other that were found alike: one that was found under another
//! `[evaluate]`, or of another checkpoint, is found anew and not shown.

use std::path::{Path, PathBuf};

use ::study::record::sha256;
use ::study::{Evaluation, StudyFile};
use anyhow::{Context, Result};
use run::Folder;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use terminal::failure::usage;

/// What a study asks of its finished runs.
#[derive(Debug)]
pub(super) struct Judging {
    pub(super) evaluation: Evaluation,
    /// The checkpoint whose discriminator judges style, if one is given.
    pub(super) judge: Option<PathBuf>,
    /// The hash of that discriminator.
    pub(super) sha256: Option<String>,
}

impl Judging {
    /// Of a study file that lies in the folder `beside`; none if its runs are not judged.
    pub(super) fn of(file: &StudyFile, beside: &Path) -> Result<Option<Self>> {
        let Some(evaluation) = file.evaluate.clone() else {
            return Ok(None);
        };
        let judge = evaluation.judge.as_ref().map(|judge| beside.join(judge));
        let sha256 = judge.as_ref().map(|judge| hash(judge)).transpose()?;
        Ok(Some(Self {
            evaluation,
            judge,
            sha256,
        }))
    }
}

/// The hash of a checkpoint's discriminator: of a shipped policy's alone, else of the learner that it is part of.
fn hash(judge: &Path) -> Result<String> {
    let named = ["judge.bin", "learning.bin"].map(|name| judge.join(name));
    let Some(path) = named.iter().find(|path| path.is_file()) else {
        return Err(usage(format!(
            "evaluate.judge: {} holds no discriminator; give the folder of a shipped policy or of a checkpoint, from the \
             folder of the study file",
            judge.display()
        )));
    };
    let bytes = std::fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    Ok(sha256(&bytes))
}

/// An answer of `ampco evaluate --json` with what was asked.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Judgement {
    evaluate: Evaluation,
    /// Hash of the discriminator that judged style, if one was given.
    #[serde(default)]
    judge_sha256: Option<String>,
    /// Iterations of the checkpoint that was judged.
    iteration: u64,
    /// A row per command.
    rows: Vec<Value>,
}

impl Judgement {
    /// Where that of a run lies.
    pub(super) fn path(run: &Folder) -> PathBuf {
        run.path().join("evaluation").join("study.json")
    }

    /// That of a run if there is one that tells its conditions.
    pub(super) fn read(run: &Folder) -> Result<Option<Self>> {
        let path = Self::path(run);
        if !path.is_file() {
            return Ok(None);
        }
        let bytes = std::fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
        let value: Value = serde_json::from_slice(&bytes).with_context(|| {
            format!(
                "reading {}; remove it to have the run judged anew",
                path.display()
            )
        })?;
        // Of an older program there are rows alone: nobody knows how they were found.
        Ok(serde_json::from_value(value).ok())
    }

    /// Keeps an answer, which lies in `draft`.
    pub(super) fn keep(run: &Folder, asked: &Judging, draft: &Path) -> Result<()> {
        let context = || format!("reading the judgement in {}", draft.display());
        let bytes = std::fs::read(draft).with_context(context)?;
        let judgement = Self {
            evaluate: asked.evaluation.clone(),
            judge_sha256: asked.sha256.clone(),
            iteration: newest(run),
            rows: serde_json::from_slice(&bytes).with_context(context)?,
        };
        let path = Self::path(run);
        let mut text = serde_json::to_vec_pretty(&judgement)?;
        text.push(b'\n');
        run::replace_file(&path, &text).with_context(|| format!("writing {}", path.display()))?;
        std::fs::remove_file(draft).with_context(|| format!("removing {}", draft.display()))
    }

    /// Whether it was found as is asked, by the same judge, of the run as it is.
    pub(super) fn is_as_asked(&self, run: &Folder, asked: &Judging) -> bool {
        self.evaluate == asked.evaluation
            && self.judge_sha256 == asked.sha256
            && self.iteration == newest(run)
    }

    /// The rows, if they were found as is asked and of the run as it is.
    pub(super) fn rows(self, run: &Folder, evaluate: Option<&Evaluation>) -> Option<Vec<Value>> {
        let alike = Some(&self.evaluate) == evaluate && self.iteration == newest(run);
        alike.then_some(self.rows)
    }
}

/// The iteration of the checkpoint that `ampco evaluate` takes.
fn newest(run: &Folder) -> u64 {
    run.checkpoints().list().last().copied().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn evaluation(episodes: usize) -> Evaluation {
        Evaluation {
            commands: vec![[0.5, 0.0, 0.0]],
            episodes,
            seconds: 2.5,
            judge: None,
        }
    }

    fn asked(episodes: usize) -> Judging {
        Judging {
            evaluation: evaluation(episodes),
            judge: None,
            sha256: None,
        }
    }

    #[test]
    fn a_judge_is_known_by_its_hash_and_has_to_be_there() {
        let place = tempfile::tempdir().unwrap();
        let text = "title = 't'\nmethods = ['ampco']\nseeds = [1]\niterations = 1\n[evaluate]\ncommands = [[0.5, 0.0, 0.0]]\n";
        let file = StudyFile::parse(&format!("{text}judge = 'walk'")).unwrap();
        let refused = Judging::of(&file, place.path()).unwrap_err().to_string();
        assert!(
            refused.starts_with("evaluate.judge: ") && refused.contains("no discriminator"),
            "{refused}"
        );
        std::fs::create_dir(place.path().join("walk")).unwrap();
        std::fs::write(place.path().join("walk/judge.bin"), "abc").unwrap();
        let judging = Judging::of(&file, place.path()).unwrap().unwrap();
        assert!(judging.sha256.unwrap().starts_with("ba7816bf"));
        let plain = StudyFile::parse(text).unwrap();
        assert!(
            Judging::of(&plain, place.path())
                .unwrap()
                .unwrap()
                .sha256
                .is_none()
        );
    }

    #[test]
    fn only_what_was_found_as_is_asked_counts() {
        let runs = tempfile::tempdir().unwrap();
        let run = Folder::create(runs.path(), "ampco-seed1").unwrap();
        run.checkpoints().write(120, "a shape", &[]).unwrap();
        assert_eq!(Judgement::read(&run).unwrap(), None);

        let draft = Judgement::path(&run).with_extension("draft");
        std::fs::create_dir_all(draft.parent().unwrap()).unwrap();
        std::fs::write(&draft, "[{\"survival\": 1.0}]").unwrap();
        Judgement::keep(&run, &asked(4), &draft).unwrap();
        assert!(!draft.exists());
        let rows = |evaluate: Option<&Evaluation>| {
            Judgement::read(&run).unwrap().unwrap().rows(&run, evaluate)
        };
        assert_eq!(
            rows(Some(&evaluation(4))),
            Some(vec![json!({"survival": 1.0})])
        );
        assert_eq!(rows(Some(&evaluation(5))), None);
        assert_eq!(rows(None), None);
        let kept = Judgement::read(&run).unwrap().unwrap();
        assert!(kept.is_as_asked(&run, &asked(4)) && !kept.is_as_asked(&run, &asked(5)));
        let other = Judging {
            sha256: Some("0".into()),
            ..asked(4)
        };
        assert!(!kept.is_as_asked(&run, &other));
        // The run went on.
        run.checkpoints().write(130, "a shape", &[]).unwrap();
        assert_eq!(rows(Some(&evaluation(4))), None);
    }

    #[test]
    fn rows_without_conditions_are_no_judgement_and_torn_ones_an_error() {
        let runs = tempfile::tempdir().unwrap();
        let run = Folder::create(runs.path(), "ampco-seed1").unwrap();
        let path = Judgement::path(&run);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, "[{\"survival\": 1.0}]").unwrap();
        assert_eq!(Judgement::read(&run).unwrap(), None);
        std::fs::write(&path, "[{\"survival\"").unwrap();
        let error = Judgement::read(&run).unwrap_err().to_string();
        assert!(error.contains("study.json; remove it"), "{error}");
        // An answer that is none is not kept, and what was there stays.
        let draft = path.with_extension("draft");
        std::fs::write(&draft, "").unwrap();
        assert!(Judgement::keep(&run, &asked(4), &draft).is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"[{\"survival\"");
    }
}
