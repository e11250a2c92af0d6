//! What is wrong with a set of clips, and whether that forbids training on it.

use motion::Clip;
use motion::quality::{Defect, Severity, severity};
use serde_json::{Value, json};

/// What is wrong with a set.
#[derive(Debug, Default)]
pub(super) struct Faults {
    /// Names of clips and what is wrong with each.
    pub(super) clips: Vec<(String, Vec<Defect>)>,
    /// Files that cannot be used, and why.
    pub(super) unreadable: Vec<(String, String)>,
    /// Clips that hold the same joint angles as another, and that said.
    pub(super) doubles: Vec<(String, String)>,
}

impl Faults {
    pub(super) fn with(&self, wanted: Severity) -> usize {
        let of = |(_, defects): &&(String, Vec<Defect>)| severity(defects) == Some(wanted);
        self.clips.iter().filter(of).count()
    }

    /// Why the set as it is should not be trained on.
    pub(super) fn verdict(&self) -> Option<String> {
        let counts = [
            (self.with(Severity::Unfit), "unfit to train on"),
            (self.unreadable.len(), "unreadable"),
            (self.doubles.len(), "there twice"),
        ];
        let told: Vec<String> = counts
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        (!told.is_empty()).then(|| format!("of these clips {}", told.join(", ")))
    }

    /// An object per defect of a clip.
    pub(super) fn rows(&self) -> Vec<Value> {
        let mut rows = Vec::new();
        for (clip, defects) in &self.clips {
            for defect in defects {
                let mut row = json!(defect);
                row["clip"] = json!(clip);
                rows.push(row);
            }
        }
        for (kind, faults) in [("unreadable", &self.unreadable), ("double", &self.doubles)] {
            rows.extend(faults.iter().map(
                |(clip, says)| json!({ "clip": clip, "kind": kind, "severity": "unfit", "says": says }),
            ));
        }
        rows
    }
}

/// Clips that hold the same joint angles as one before them, and that said.
pub(super) fn doubles(clips: &[Clip]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (i, a) in clips.iter().enumerate() {
        let same = clips[..i].iter().find(|b| {
            a.frames.len() == b.frames.len()
                && a.frames
                    .iter()
                    .zip(&b.frames)
                    .all(|(a, b)| a.joint_positions == b.joint_positions)
        });
        found.extend(same.map(|b| {
            let says = format!("{} holds the same joint angles as {}", a.name, b.name);
            (a.name.clone(), says)
        }));
    }
    found
}
