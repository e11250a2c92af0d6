//! The account of a retargeting, kept beside the table that came of it.
//!
//! Separate because a table holds no bones of a human: what `motions import` wrote in `<name>.json` is the only witness
//! of how far the robot's are off them, and a clip is checked and trained on long after its import.

use crate::import::Imported;
use retarget::Report;
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
    let is_table = file
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let beside = file.with_extension("json");
    let Some(bytes) = is_table.then(|| std::fs::read(&beside).ok()).flatten() else {
        return Account::None;
    };
    let written: Option<serde_json::Value> = serde_json::from_slice(&bytes).ok();
    // Without any it is a robot's own motion, or somebody else's file.
    let Some(retargeting) = written
        .and_then(|written| written.get("retargeting").cloned())
        .filter(|retargeting| !retargeting.is_null())
    else {
        return Account::None;
    };
    match serde_json::from_value::<Report>(retargeting) {
        Ok(report) if report.frames == frames => Account::Of(Box::new(report)),
        Ok(report) => Account::Misfit(format!(
            "{} is of {} frames, the table has {frames}",
            beside.display(),
            report.frames
        )),
        Err(error) => Account::Misfit(format!("{}: {error}", beside.display())),
    }
}

#[cfg(test)]
mod tests {
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
        for none in [r#"{"retargeting":null}"#, "{}", "[1]", "no json"] {
            assert_eq!(beside(none), Account::None, "{none}");
        }
        // Only tables have accounts: a capture's neighbour is not about the robot.
        assert_eq!(
            account_beside(Path::new("/nowhere/a.bvh"), 3),
            Account::None
        );
    }
}
