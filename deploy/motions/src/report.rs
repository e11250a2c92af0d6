//! The report beside a clip: `<name>.json`, where it comes from, what was done, how good it is.
//!
//! Separate because a clip keeps its account whoever writes it anew: a mirror image is as far off the bones of the human
//! as the clip that it is made from.

use std::fs;
use std::path::Path;

use g1::JOINT_TABLE;
use motion::import::Imported;
use motion::quality::{Account, Defect, Examination};
use retarget::Report;
use serde_json::{Value, json};

use super::output;

/// The key that says who wrote a report.
const WRITTEN_BY: &str = "written_by";

/// How a clip came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Made {
    Imported,
    Mirrored,
}

impl Made {
    fn written_by(self) -> &'static str {
        match self {
            Self::Imported => "ampco motions import",
            Self::Mirrored => "ampco motions mirror",
        }
    }

    /// The origin of a clip that is made from a file.
    pub(super) fn origin(self, source: &Path) -> String {
        let verb = match self {
            Self::Imported => "from",
            Self::Mirrored => "mirrored",
        };
        output::origin(verb, source)
    }
}

/// The report of a clip that is made from a file.
pub(super) fn report(made: Made, source: &Path, imported: &Imported, found: &Examination) -> Value {
    // A table that was imported before brings its account along, and one that is not its own is no less so afterwards.
    let retargeting = match &found.account {
        Account::None => Value::Null,
        Account::Of(report) => json!(report),
        Account::Misfit(why) => match beside(source) {
            Value::Null => json!({ "misfit": why }),
            kept => kept,
        },
    };
    json!({
        WRITTEN_BY: made.written_by(),
        "name": imported.clip.name,
        "source": source.display().to_string(),
        "format": imported.format,
        "frames": imported.frames,
        "fps": imported.fps,
        "decisions": imported.decisions,
        "retargeting": retargeting,
        "actions": found.account.report().map(Report::actions),
        "quality": found.quality,
        "defects": found.defects,
    })
}

/// The account that stands beside a table, as it is.
fn beside(table: &Path) -> Value {
    let bytes = fs::read(table.with_extension("json")).unwrap_or_default();
    let written: Value = serde_json::from_slice(&bytes).unwrap_or_default();
    written["retargeting"].clone()
}

/// The origin of the clip that a report is about; `None` if it is no report.
pub(super) fn origin(bytes: &[u8]) -> Option<String> {
    let report: Value = serde_json::from_slice(bytes).ok()?;
    let source = report["source"].as_str()?;
    [Made::Imported, Made::Mirrored]
        .into_iter()
        .find(|made| report[WRITTEN_BY] == made.written_by())
        .map(|made| made.origin(Path::new(source)))
}

/// The account of a mirror image: what the left did, the right does. Lists keep the order of the robot.
pub(super) fn mirrored(report: &Report) -> Report {
    let mut report = report.clone();
    for off in &mut report.bones_off {
        off.bone = other_side(&off.bone);
    }
    report
        .bones_off
        .sort_by_key(|off| off.bone.starts_with("right"));
    let place = |joint: &str| JOINT_TABLE.iter().position(|known| known.name == joint);
    for held in [&mut report.at_limit, &mut report.at_speed] {
        for held in held.iter_mut() {
            held.joint = other_side(&held.joint);
        }
        held.sort_by_key(|held| place(&held.joint));
    }
    for sharpest in &mut report.sharpest {
        sharpest.joint = other_side(&sharpest.joint);
    }
    report.sharpest.sort_by_key(|sharp| place(&sharp.joint));
    report
}

/// A defect that the source had, of the mirror image.
pub(super) fn mirrored_defect(defect: Defect) -> Defect {
    Defect {
        joints: defect.joints.iter().map(|name| other_side(name)).collect(),
        says: other_side(&defect.says),
        ..defect
    }
}

/// "left shin" of "right shin" and the other way round, wherever these are words; what has no side stays.
fn other_side(text: &str) -> String {
    let exchanged = |piece: &str| {
        let word = piece.trim_end_matches(|c: char| !c.is_alphabetic());
        let after = &piece[word.len()..];
        match word {
            "left" => format!("right{after}"),
            "right" => format!("left{after}"),
            _ => piece.to_owned(),
        }
    };
    text.split_inclusive(|c: char| !c.is_alphabetic())
        .map(exchanged)
        .collect()
}

#[cfg(test)]
mod tests;
