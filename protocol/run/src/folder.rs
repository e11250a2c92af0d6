//! `runs/<name>/`: where things are. Who is alive in it is told by [`crate::roles`].

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::checkpoint::Checkpoints;
use crate::config::{Config, ConfigError};
use wording::nearest;

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

pub(crate) fn io_error(path: &Path, source: io::Error) -> FolderError {
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
