//! `motion.json`: which motion files a run has learned from, by their hashes.
//!
//! A run reads its motion where the user keeps it, and files come, go and change there. Separate because train writes this
//! down, and everybody who reads the motion again is to say when it is no longer the same.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::folder::{Folder, FolderError, io_error};
use crate::replace;

/// Name of the file, in a run's folder and in that of a shipped policy.
pub const FILE: &str = "motion.json";

/// A file and what was in it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Print {
    /// Where it was; of a shipped policy its name alone.
    pub file: PathBuf,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// What a run learned from, from an iteration on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Learned {
    /// Iterations done when it began to.
    pub since: u64,
    /// Every motion file.
    pub files: Vec<Print>,
}

impl Print {
    /// Of a file as it is now.
    pub fn of(file: &Path) -> Result<Self, FolderError> {
        let bytes = fs::read(file).map_err(|source| io_error(file, source))?;
        let digest = Sha256::digest(bytes);
        Ok(Self {
            file: file.to_owned(),
            sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
        })
    }

    /// Of several.
    pub fn of_all(files: &[PathBuf]) -> Result<Vec<Self>, FolderError> {
        files.iter().map(|file| Self::of(file)).collect()
    }

    fn name(&self) -> OsString {
        self.file.file_name().unwrap_or_default().to_owned()
    }
}

/// What is written down in a folder, oldest first; nothing where there is no such file, as of a run without motion files.
pub fn read(folder: &Path) -> Result<Vec<Learned>, FolderError> {
    let path = folder.join(FILE);
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(source) => return Err(io_error(&path, source)),
    };
    let refused = |error| {
        let words = format!("{error}; remove it, and nobody knows any more what was learned from");
        io_error(&path, io::Error::other(words))
    };
    serde_json::from_slice(&bytes).map_err(refused)
}

/// Writes it down; a reader sees the old file or the new one.
pub fn write(folder: &Path, learned: &[Learned]) -> Result<(), FolderError> {
    let path = folder.join(FILE);
    let mut text = serde_json::to_vec_pretty(learned).expect("names and numbers");
    text.push(b'\n');
    replace::replace_file(&path, &text).map_err(|source| io_error(&path, source))
}

/// What was learned from up to an iteration, of those that are written down.
pub fn at(learned: &[Learned], iteration: u64) -> Option<&[Print]> {
    let by_then = learned
        .iter()
        .rev()
        .find(|learned| learned.since <= iteration);
    by_then.map(|learned| learned.files.as_slice())
}

/// What differs between two sets of files, a file each; none if they hold the same. Files are told by name and content: a
/// folder that has moved as a whole is the same motion.
pub fn differences(before: &[Print], now: &[Print]) -> Vec<String> {
    let mut left: BTreeMap<OsString, Vec<&Print>> = BTreeMap::new();
    for print in before {
        left.entry(print.name()).or_default().push(print);
    }
    let mut unmatched = Vec::new();
    for print in now {
        let alike = left.get_mut(&print.name()).and_then(|known| {
            let same = known
                .iter()
                .position(|known| known.sha256 == print.sha256)?;
            Some(known.swap_remove(same))
        });
        if alike.is_none() {
            unmatched.push(print);
        }
    }
    let mut words = Vec::new();
    for print in unmatched {
        let known = left.get_mut(&print.name()).and_then(Vec::pop);
        let what = if known.is_some() {
            "has changed"
        } else {
            "is new"
        };
        words.push(format!("{} {what}", print.file.display()));
    }
    let gone = left.values().flatten();
    words.extend(gone.map(|print| format!("{} is gone", print.file.display())));
    words.sort();
    words
}

impl Folder {
    /// What this run has learned from.
    pub fn motion(&self) -> Result<Vec<Learned>, FolderError> {
        read(self.path())
    }

    /// Writes down that from an iteration on it learns from these files, and forgets what it is about to do anew.
    pub fn note_motion(&self, iteration: u64, files: Vec<Print>) -> Result<(), FolderError> {
        let before = self.motion()?;
        let mut learned = before.clone();
        learned.retain(|learned| learned.since < iteration);
        let newest = learned.last().map_or(&[][..], |learned| &learned.files);
        if newest != files.as_slice() {
            learned.push(Learned {
                since: iteration,
                files,
            });
        }
        if learned == before {
            return Ok(());
        }
        write(self.path(), &learned)
    }

    /// In which files the motion is no longer what is written down last; nothing where nothing is written down.
    pub fn motion_differences(&self, files: &[PathBuf]) -> Result<Vec<String>, FolderError> {
        let learned = self.motion()?;
        let Some(newest) = learned.last() else {
            return Ok(Vec::new());
        };
        Ok(differences(&newest.files, &Print::of_all(files)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn print(file: &str, sha256: &str) -> Print {
        Print {
            file: file.into(),
            sha256: sha256.into(),
        }
    }

    #[test]
    fn a_file_is_known_by_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        fs::write(&path, "abc").unwrap();
        // FIPS 180-2, appendix B.1.
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(Print::of(&path).unwrap().sha256, expected);
        let missing = Print::of(&folder.path().join("b.csv")).unwrap_err();
        assert!(missing.to_string().contains("b.csv"), "{missing}");
    }

    #[test]
    fn files_that_came_went_and_changed_are_told_by_name() {
        let before = [
            print("/m/a.csv", "1"),
            print("/m/b.csv", "2"),
            print("/m/c.csv", "3"),
        ];
        let now = [
            print("/m/a.csv", "1"),
            print("/m/b.csv", "9"),
            print("/m/d.csv", "4"),
        ];
        assert_eq!(
            differences(&before, &now),
            [
                "/m/b.csv has changed",
                "/m/c.csv is gone",
                "/m/d.csv is new"
            ]
        );
        let moved: Vec<Print> = before
            .iter()
            .map(|p| print(&p.file.display().to_string().replace("/m", "/n"), &p.sha256))
            .collect();
        assert_eq!(differences(&before, &moved), [""; 0]);
        // Two of one name in two folders are two.
        let twice = [print("/m/a.csv", "1"), print("/n/a.csv", "5")];
        assert_eq!(differences(&twice, &twice[..1]), ["/n/a.csv is gone"]);
        assert_eq!(differences(&twice[..1], &twice), ["/n/a.csv is new"]);
    }

    #[test]
    fn a_run_knows_what_it_learned_from_and_since_when() {
        let runs = tempfile::tempdir().unwrap();
        let folder = Folder::create(runs.path(), "walk").unwrap();
        folder.note_motion(0, Vec::new()).unwrap();
        assert!(
            !runs.path().join("walk").join(FILE).exists(),
            "no files, nothing to write"
        );
        let (one, two) = (
            vec![print("a", "1")],
            vec![print("a", "1"), print("b", "2")],
        );
        folder.note_motion(0, one.clone()).unwrap();
        folder.note_motion(10, one.clone()).unwrap();
        folder.note_motion(20, two.clone()).unwrap();
        let learned = folder.motion().unwrap();
        assert_eq!(learned.iter().map(|l| l.since).collect::<Vec<_>>(), [0, 20]);
        assert_eq!(at(&learned, 19), Some(&one[..]));
        assert_eq!(at(&learned, 20), Some(&two[..]));
        // From 15 on anew, with what it was before.
        folder.note_motion(15, one.clone()).unwrap();
        assert_eq!(folder.motion().unwrap(), learned[..1]);
        assert_eq!(at(&[], 5), None);
    }

    #[test]
    fn a_run_says_in_which_files_its_motion_is_another() {
        let runs = tempfile::tempdir().unwrap();
        let folder = Folder::create(runs.path(), "walk").unwrap();
        let path = |name: &str| runs.path().join(name);
        fs::write(path("a.csv"), "1").unwrap();
        let files = [path("a.csv")];
        assert_eq!(folder.motion_differences(&files).unwrap(), [""; 0]);
        folder
            .note_motion(0, Print::of_all(&files).unwrap())
            .unwrap();
        assert_eq!(folder.motion_differences(&files).unwrap(), [""; 0]);
        fs::write(path("a.csv"), "2").unwrap();
        fs::write(path("b.csv"), "2").unwrap();
        let said = folder
            .motion_differences(&[path("a.csv"), path("b.csv")])
            .unwrap();
        assert!(
            said[0].ends_with("a.csv has changed") && said[1].ends_with("b.csv is new"),
            "{said:?}"
        );
    }

    #[test]
    fn what_is_no_record_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(FILE), "[{\"since\": 1").unwrap();
        let error = read(folder.path()).unwrap_err();
        assert!(error.to_string().contains(FILE), "{error}");
    }
}
