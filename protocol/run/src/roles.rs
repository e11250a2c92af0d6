//! Who is alive in a run, and whether it has come to work.
//!
//! Aliveness is an advisory lock on a file, not a process id in it: the system releases the lock
//! when the process ends, however it ends, so a crash leaves nothing that must be cleaned. The file
//! says which process it was, and whether it ever did its work: who dies before that dies on the
//! way up, and starting it again and again would not help.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::folder::{Folder, FolderError, io_error};

/// The second line of a role's file.
const AT_WORK: &str = "at work";

/// A role held in a run, for as long as this value or its process lives.
#[derive(Debug)]
#[must_use = "the role is given up when this is dropped"]
pub struct Lock {
    file: File,
    at_work: bool,
}

impl Lock {
    /// Says, once, that the holder has done what it is for: a rollout, an iteration, an answer.
    pub fn at_work(&mut self) {
        if !self.at_work {
            self.at_work = true;
            // On a full disk nobody learns of it, which harms nobody but a process that dies soon.
            let _ = writeln!(self.file, "{AT_WORK}");
        }
    }

    /// Holds the role for somebody who has no process here, such as an actor on another machine: `holder` is written
    /// where the process id would be.
    pub fn stand_for(&mut self, holder: &str) {
        // For readers alone, as above.
        let _ = self
            .file
            .set_len(0)
            .and_then(|()| self.file.rewind())
            .and_then(|()| writeln!(self.file, "{holder}"));
    }
}

impl Folder {
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
        let file = match File::open(&path) {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(io_error(&path, source)),
        };
        match file.try_lock_shared() {
            Ok(()) => Ok(None),
            Err(TryLockError::WouldBlock) => Ok(Some(self.written_pid(role))),
            Err(TryLockError::Error(source)) => Err(io_error(&path, source)),
        }
    }

    /// Every role that is held now, with its process id, by name.
    pub fn holders(&self) -> Result<Vec<(String, String)>, FolderError> {
        let path = self.path();
        let entries = fs::read_dir(path).map_err(|source| io_error(path, source))?;
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

    /// Whether process `pid`, the last to hold `role`, has come to work, alive or not.
    pub fn has_worked(&self, role: &str, pid: u32) -> bool {
        let text = self.written(role);
        let mut lines = text.lines();
        lines.next() == Some(pid.to_string().as_str()) && lines.next() == Some(AT_WORK)
    }

    fn try_lock(&self, role: &str) -> Result<Option<Lock>, FolderError> {
        let path = self.lock_path(role);
        let mut file = open(&path).map_err(|source| io_error(&path, source))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(source)) => return Err(io_error(&path, source)),
        }
        // What is written is for readers; the lock is what counts, also where nothing can be written.
        let _ = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| writeln!(file, "{}", std::process::id()));
        Ok(Some(Lock {
            file,
            at_work: false,
        }))
    }

    fn lock_path(&self, role: &str) -> PathBuf {
        self.path().join(format!("{role}.lock"))
    }

    fn written(&self, role: &str) -> String {
        fs::read_to_string(self.lock_path(role)).unwrap_or_default()
    }

    fn written_pid(&self, role: &str) -> String {
        match self.written(role).lines().next() {
            Some(pid) if !pid.is_empty() => wording::line(pid),
            _ => "unknown".to_owned(),
        }
    }
}

/// Opens a role's file to be locked; where the folder has become read-only, an old one will do.
fn open(path: &Path) -> io::Result<File> {
    let opened = OpenOptions::new()
        .read(true)
        .write(true)
        .create(true)
        .truncate(false)
        .open(path);
    match opened {
        Err(error)
            if matches!(
                error.kind(),
                ErrorKind::PermissionDenied
                    | ErrorKind::ReadOnlyFilesystem
                    | ErrorKind::StorageFull
            ) =>
        {
            File::open(path).map_err(|_| error)
        }
        opened => opened,
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
    fn who_has_come_to_work_is_known_also_after_its_death() {
        let (_runs, folder) = folder();
        let mut learner = folder.lock("learner").unwrap();
        let pid = std::process::id();
        assert!(!folder.has_worked("learner", pid));
        learner.at_work();
        learner.at_work();
        assert!(folder.has_worked("learner", pid));
        let holder = folder.holder("learner").unwrap();
        assert_eq!(holder, Some(pid.to_string()));
        drop(learner);
        assert!(folder.has_worked("learner", pid));
        assert!(!folder.has_worked("learner", pid + 1));
        // The next life has to come to work itself.
        let _next = folder.lock("learner").unwrap();
        assert!(!folder.has_worked("learner", pid));
    }
}
