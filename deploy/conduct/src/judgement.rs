//! What `ampco evaluate` said of a finished run, and under which conditions.
//!
//! Separate because figures may only stand beside each other that were found alike: one that was found under another
//! `[evaluate]`, or of another checkpoint, is found anew and not shown.

use std::path::{Path, PathBuf};

use ::study::Evaluation;
use anyhow::{Context, Result};
use run::Folder;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// An answer of `ampco evaluate --json` with what was asked.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Judgement {
    evaluate: Evaluation,
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
    pub(super) fn keep(run: &Folder, evaluate: &Evaluation, draft: &Path) -> Result<()> {
        let context = || format!("reading the judgement in {}", draft.display());
        let bytes = std::fs::read(draft).with_context(context)?;
        let judgement = Self {
            evaluate: evaluate.clone(),
            iteration: newest(run),
            rows: serde_json::from_slice(&bytes).with_context(context)?,
        };
        let path = Self::path(run);
        let mut text = serde_json::to_vec_pretty(&judgement)?;
        text.push(b'\n');
        run::replace_file(&path, &text).with_context(|| format!("writing {}", path.display()))?;
        std::fs::remove_file(draft).with_context(|| format!("removing {}", draft.display()))
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
        }
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
        Judgement::keep(&run, &evaluation(4), &draft).unwrap();
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
        assert!(Judgement::keep(&run, &evaluation(4), &draft).is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"[{\"survival\"");
    }
}
