//! The account of a retargeting, kept beside the table that came of it.
//!
//! Separate because a table holds no bones of a human: what `motions import` wrote in `<name>.json` is the only witness
//! of how far the robot's are off them, and a clip is checked and trained on long after its import.

use super::defect::{Defect, Kept};
use crate::import::Imported;
use retarget::Report;
use serde_json::Value;
use std::io::ErrorKind;
use std::path::Path;

/// What stands beside a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Account {
    /// Nothing about retargeting: a robot's own motion, or a file that is none of ours.
    None,
    /// The account of this table.
    Of(Box<Report>),
    /// An account that is not this table's, or that cannot be read; why.
    Misfit(String),
}

impl Account {
    /// The account of a clip that was read from a file: its own retargeting, or what stands beside the file.
    pub fn of(imported: &Imported, file: &Path) -> Self {
        match &imported.retargeting {
            Some(report) => Self::Of(Box::new(report.clone())),
            None => account_beside(file, imported.clip.frames.len()),
        }
    }

    /// The account, if it is this table's.
    pub fn report(&self) -> Option<&Report> {
        match self {
            Self::Of(report) => Some(report),
            Self::None | Self::Misfit(_) => None,
        }
    }
}

/// What `motions import` wrote beside a table (`.csv`) of so many frames at 50 Hz.
fn account_beside(file: &Path, frames: usize) -> Account {
    let written = match written_beside(file) {
        Ok(Some(written)) => written,
        Ok(None) => return Account::None,
        Err(why) => return Account::Misfit(why),
    };
    let beside = file.with_extension("json");
    // Without any it is a robot's own motion, or somebody else's file.
    let Some(retargeting) = written.get("retargeting").filter(|value| !value.is_null()) else {
        return match source_beside(file, frames) {
            Ok(_) => Account::None,
            Err(why) => Account::Misfit(why),
        };
    };
    match serde_json::from_value::<Report>(retargeting.clone()) {
        Ok(report) if report.frames == frames => Account::Of(Box::new(report)),
        Ok(report) => Account::Misfit(format!(
            "{} is of {} frames, the table has {frames}",
            beside.display(),
            report.frames
        )),
        Err(error) => Account::Misfit(format!("{}: {error}", beside.display())),
    }
}

/// What stands in the `.json` beside a table; `None` if there is none, or the file is no table.
///
/// # Errors
/// Why it cannot be read, or that it is no object: no account begins so.
fn written_beside(file: &Path) -> Result<Option<Value>, String> {
    let is_table = file
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    if !is_table {
        return Ok(None);
    }
    let beside = file.with_extension("json");
    let damaged = |why: &str| format!("{} is damaged: {why}", beside.display());
    let bytes = match std::fs::read(&beside) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(format!("{}: {error}", beside.display())),
    };
    match serde_json::from_slice::<Value>(&bytes) {
        Ok(written) if written.is_object() => Ok(Some(written)),
        Ok(_) => Err(damaged("it holds no object")),
        Err(error) => Err(damaged(&error.to_string())),
    }
}

/// The defects that the source of a table of so many frames had, by what stands beside it.
///
/// # Errors
/// As [`written_beside`]; a defect that cannot be read, or one of another clip.
pub(super) fn source_beside(file: &Path, frames: usize) -> Result<Vec<Defect>, String> {
    let Some(written) = written_beside(file)? else {
        return Ok(Vec::new());
    };
    let beside = file.with_extension("json");
    let of_source = |defect: &&Value| defect["of_source"] == true;
    let kept: Vec<&Value> = written["defects"]
        .as_array()
        .map(|defects| defects.iter().filter(of_source).collect())
        .unwrap_or_default();
    let of = written["quality"]["frames"].as_u64();
    if !kept.is_empty() && of != Some(frames as u64) {
        let of = of.map_or("an unknown number of".into(), |of| of.to_string());
        return Err(format!(
            "{} is of {of} frames, the table has {frames}",
            beside.display()
        ));
    }
    let read = |value: &Value| {
        let kept = serde_json::from_value::<Kept>(value.clone());
        let kept = kept.map_err(|error| format!("{}: {error}", beside.display()))?;
        let none = || format!("{}: a defect in no frame of the table", beside.display());
        kept.defect(frames).ok_or_else(none)
    };
    kept.into_iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use super::super::{Frames, Kind, Severity};
    use super::*;

    fn beside(json: &str) -> Account {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("a.json"), json).unwrap();
        account_beside(&folder.path().join("a.csv"), 30)
    }

    fn report(frames: usize) -> String {
        format!(
            r#"{{"retargeting":{{"frames":{frames},"human_leg":0.8,"scale":0.8,"scaled_speed":1.0,"speed":1.0,
            "direction_error":1.0,"direction_error_95":6.0,"stances":4,"feet_moved":0.01,"lowered":0.0,"lifted":0.0,
            "at_limit":[],"at_speed":[]}}}}"#
        )
    }

    #[test]
    fn an_account_of_as_many_frames_is_the_tables() {
        let account = beside(&report(30));
        assert_eq!(account.report().unwrap().direction_error_95, 6.0);
        assert!(account.report().unwrap().bones_off.is_empty()); // written before there were any
    }

    #[test]
    fn another_clips_account_is_told_and_a_strangers_file_is_none() {
        assert!(matches!(beside(&report(31)), Account::Misfit(why) if why.contains("31")));
        let broken = r#"{"retargeting":{"frames":30}}"#;
        assert!(matches!(beside(broken), Account::Misfit(why) if why.contains("a.json")));
        for none in [r#"{"retargeting":null}"#, "{}"] {
            assert_eq!(beside(none), Account::None, "{none}");
        }
        let whole = report(30);
        for damaged in ["[1,2]", "{broken", "", "7", &whole[..whole.len() / 2]] {
            let Account::Misfit(why) = beside(damaged) else {
                panic!("{damaged:?} is taken for an account");
            };
            assert!(why.contains("a.json is damaged"), "{why}");
        }
        // What is there and cannot be read is no less damaged.
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a.json")).unwrap();
        let account = account_beside(&folder.path().join("a.csv"), 30);
        assert!(matches!(account, Account::Misfit(_)), "{account:?}");
        // Only tables have accounts: a capture's neighbour is not about the robot.
        assert_eq!(
            account_beside(Path::new("/nowhere/a.bvh"), 3),
            Account::None
        );
    }

    #[test]
    fn what_the_source_had_is_kept() {
        let frames = Frames::of(&[(20, 3.5)]).unwrap();
        let jump = Defect {
            of_source: true,
            ..Defect::new(Kind::Jump, Severity::Unfit, frames, (1.4, "rad"), "jumps")
        };
        let own = Defect::new(Kind::Slip, Severity::Odd, frames, (0.2, "m/s"), "slips");
        let kept = |defects: &[Defect], frames: usize| {
            let folder = tempfile::tempdir().unwrap();
            let written = serde_json::json!({
                "retargeting": null,
                "quality": { "frames": 30 },
                "defects": defects,
            });
            std::fs::write(folder.path().join("a.json"), written.to_string()).unwrap();
            let table = folder.path().join("a.csv");
            let account = account_beside(&table, frames);
            (source_beside(&table, frames), account)
        };
        let both = [jump.clone(), own];
        assert_eq!(kept(&both, 30), (Ok(vec![jump.clone()]), Account::None));
        // Of another table, and in frames that it has not.
        let (found, account) = kept(&both, 31);
        assert!(found.is_err() && matches!(account, Account::Misfit(why) if why.contains("31")));
        let elsewhere = Frames {
            last: 31,
            ..jump.frames
        };
        let outside = Defect {
            frames: elsewhere,
            ..jump
        };
        assert!(kept(&[outside], 30).0.is_err());
    }
}
