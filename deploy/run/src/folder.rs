//! `runs/<name>/`: where things are, and who is alive in it.
//!
//! Aliveness is an advisory lock on a file, not a process id in it: the system releases the lock
//! when the process ends, however it ends, so a crash leaves nothing that must be cleaned.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::checkpoint::Checkpoints;
use crate::config::{Config, ConfigError};
use crate::nearest;

/// Why a run's folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// There is no such run.
    #[error("no run `{run}` in {}; {remedy}", runs.display())]
    Missing {
        /// The name asked for.
        run: String,
        /// The folder of runs.
        runs: PathBuf,
        /// The runs there are.
        remedy: String,
    },
    /// The name cannot be a folder's name.
    #[error("`{0}` is not a run's name; use letters, digits, `.`, `-` and `_`, at most 64")]
    Name(String),
    /// Another process holds this role in this run.
    #[error(
        "run `{run}` already has a {role}: process {pid} is alive; stop it or use another --run name"
    )]
    Held {
        /// The run.
        run: String,
        /// `learner`, `actor-1`, …
        role: String,
        /// The holder's process id as it wrote it, or "unknown".
        pid: String,
    },
    /// The system refused.
    #[error("cannot use {}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: io::Error,
    },
}

/// The folder of one run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    path: PathBuf,
}

/// A role held in a run, for as long as this value or its process lives.
#[derive(Debug)]
#[must_use = "the role is given up when this is dropped"]
pub struct Lock {
    _file: File,
}

impl Folder {
    /// The folder at `path`, which must exist: what a process is given with `--run-dir`.
    pub fn open(path: &Path) -> Result<Self, FolderError> {
        // Absolute, so that the run has one identity whatever folder a process was started in.
        let path = fs::canonicalize(path).map_err(|source| FolderError::Io {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self { path })
    }

    /// The run `name` in the folder `runs`; an unknown name is answered with the closest ones.
    pub fn find(runs: &Path, name: &str) -> Result<Self, FolderError> {
        check_name(name)?;
        if runs.join(name).is_dir() {
            return Self::open(&runs.join(name));
        }
        let known = list(runs);
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        Err(FolderError::Missing {
            run: name.to_owned(),
            runs: runs.to_owned(),
            remedy: match names.as_slice() {
                [] => "there are no runs yet".to_owned(),
                names => nearest::remedy(name, names),
            },
        })
    }

    /// Makes `runs/<name>/` with its inner folders; what is there already stays.
    pub fn create(runs: &Path, name: &str) -> Result<Self, FolderError> {
        check_name(name)?;
        let path = runs.join(name);
        for folder in [path.join("logs"), path.join("checkpoints")] {
            fs::create_dir_all(&folder).map_err(|source| FolderError::Io {
                path: folder,
                source,
            })?;
        }
        Self::open(&path)
    }

    /// The run's name: the folder's.
    pub fn name(&self) -> String {
        self.path.file_name().map_or_else(
            || "run".to_owned(),
            |name| name.to_string_lossy().into_owned(),
        )
    }

    /// The folder itself, absolute.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// `config.toml`.
    pub fn config_path(&self) -> PathBuf {
        self.path.join("config.toml")
    }

    /// `metrics.jsonl`.
    pub fn metrics_path(&self) -> PathBuf {
        self.path.join("metrics.jsonl")
    }

    /// `logs/`.
    pub fn logs(&self) -> PathBuf {
        self.path.join("logs")
    }

    /// `checkpoints/`.
    pub fn checkpoints(&self) -> Checkpoints {
        Checkpoints::new(self.path.join("checkpoints"))
    }

    /// Reads `config.toml`.
    pub fn config(&self) -> Result<Config, ConfigError> {
        Config::read(&self.config_path())
    }

    /// Takes a role (`learner`, `scheduler`, `actor-0`) or says who holds it.
    pub fn lock(&self, role: &str) -> Result<Lock, FolderError> {
        // `holder` takes the lock for a moment to look; that must not turn a starting process away.
        let patience = Instant::now() + Duration::from_millis(250);
        loop {
            match self.try_lock(role)? {
                Some(lock) => return Ok(lock),
                None if Instant::now() < patience => std::thread::sleep(Duration::from_millis(5)),
                None => {
                    return Err(FolderError::Held {
                        run: self.name(),
                        role: role.to_owned(),
                        pid: self.written_pid(role),
                    });
                }
            }
        }
    }

    /// Takes the free role `actor-<index>` with the lowest index from `first` on, and says which.
    pub fn lock_free_actor(&self, first: u32) -> Result<(u32, Lock), FolderError> {
        for index in first.. {
            if let Some(lock) = self.try_lock(&format!("actor-{index}"))? {
                return Ok((index, lock));
            }
        }
        unreachable!("more actors than indices")
    }

    /// The process id of whoever holds a role, or `None` when nobody does.
    pub fn holder(&self, role: &str) -> Result<Option<String>, FolderError> {
        let path = self.lock_path(role);
        if !path.exists() {
            return Ok(None);
        }
        let file = File::open(&path).map_err(|source| io_error(&path, source))?;
        match file.try_lock_shared() {
            Ok(()) => Ok(None),
            Err(TryLockError::WouldBlock) => Ok(Some(self.written_pid(role))),
            Err(TryLockError::Error(source)) => Err(io_error(&path, source)),
        }
    }

    /// Every role that is held now, with its process id, by name.
    pub fn holders(&self) -> Result<Vec<(String, String)>, FolderError> {
        let entries = fs::read_dir(&self.path).map_err(|source| io_error(&self.path, source))?;
        let mut held = Vec::new();
        for entry in entries.filter_map(Result::ok) {
            let name = entry.file_name().to_string_lossy().into_owned();
            if let Some(role) = name.strip_suffix(".lock")
                && let Some(pid) = self.holder(role)?
            {
                held.push((role.to_owned(), pid));
            }
        }
        held.sort();
        Ok(held)
    }

    fn try_lock(&self, role: &str) -> Result<Option<Lock>, FolderError> {
        let path = self.lock_path(role);
        let opened = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path);
        let mut file = opened.map_err(|source| io_error(&path, source))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(source)) => return Err(io_error(&path, source)),
        }
        // The number is only for the reader of an error; the lock is what counts.
        let written = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| writeln!(file, "{}", std::process::id()));
        written.map_err(|source| io_error(&path, source))?;
        Ok(Some(Lock { _file: file }))
    }

    fn lock_path(&self, role: &str) -> PathBuf {
        self.path.join(format!("{role}.lock"))
    }

    fn written_pid(&self, role: &str) -> String {
        let mut text = String::new();
        let read = File::open(self.lock_path(role)).and_then(|mut f| f.read_to_string(&mut text));
        match text.trim() {
            pid if read.is_ok() && !pid.is_empty() => pid.to_owned(),
            _ => "unknown".to_owned(),
        }
    }
}

/// The names of all runs in a folder, by name; none when the folder does not exist.
pub fn list(runs: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(runs) else {
        return Vec::new();
    };
    let mut names: Vec<String> = entries
        .filter_map(Result::ok)
        .filter(|entry| entry.path().join("config.toml").is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn check_name(name: &str) -> Result<(), FolderError> {
    let letters = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '_');
    let good = !name.is_empty() && name.len() <= 64 && name.chars().all(letters);
    if good && !name.starts_with('.') {
        Ok(())
    } else {
        Err(FolderError::Name(name.to_owned()))
    }
}

fn io_error(path: &Path, source: io::Error) -> FolderError {
    FolderError::Io {
        path: path.to_owned(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, Folder) {
        let runs = tempfile::tempdir().unwrap();
        let folder = Folder::create(runs.path(), "walk").unwrap();
        (runs, folder)
    }

    #[test]
    fn a_second_learner_is_refused_by_name_and_pid() {
        let (_runs, folder) = folder();
        let first = folder.lock("learner").unwrap();
        let refusal = folder.lock("learner").unwrap_err().to_string();
        assert!(
            refusal.contains("run `walk` already has a learner"),
            "{refusal}"
        );
        assert!(
            refusal.contains(&std::process::id().to_string()),
            "{refusal}"
        );
        drop(first);
        let _second = folder.lock("learner").unwrap();
    }

    #[test]
    fn actors_get_the_lowest_free_index() {
        let (_runs, folder) = folder();
        let (zero, _held) = folder.lock_free_actor(0).unwrap();
        let (one, freed) = folder.lock_free_actor(0).unwrap();
        let (two, _also_held) = folder.lock_free_actor(0).unwrap();
        assert_eq!((zero, one, two), (0, 1, 2));
        drop(freed);
        assert_eq!(folder.lock_free_actor(2).unwrap().0, 3);
        assert_eq!(folder.lock_free_actor(0).unwrap().0, 1);
    }

    #[test]
    fn holders_are_those_alive_and_not_those_that_left_a_file() {
        let (_runs, folder) = folder();
        let _learner = folder.lock("learner").unwrap();
        drop(folder.lock("scheduler").unwrap());
        let pid = std::process::id().to_string();
        assert_eq!(folder.holders().unwrap(), [("learner".to_owned(), pid)]);
    }

    #[test]
    fn names_that_would_leave_the_folder_are_refused() {
        let runs = tempfile::tempdir().unwrap();
        for name in ["", "..", "a/b", ".hidden", "with space"] {
            let refused = Folder::create(runs.path(), name);
            assert!(matches!(refused, Err(FolderError::Name(_))), "{name:?}");
        }
    }

    #[test]
    fn an_unknown_run_is_answered_with_the_closest() {
        let (runs, folder) = folder();
        fs::write(folder.config_path(), "").unwrap();
        let error = Folder::find(runs.path(), "wakl").unwrap_err().to_string();
        assert!(error.contains("did you mean `walk`?"), "{error}");
    }
}
