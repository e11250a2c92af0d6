//! Checkpoints: folders of named parts that are complete or absent, and known to be whole.
//!
//! A checkpoint is written beside (`.<iteration>.new`), made durable and renamed, so a crash at any
//! moment leaves the earlier ones as they were. Its manifest holds the length and CRC32 of every
//! part; opening one checks them all and refuses anything else than what was written, with the
//! reason and the newest good one. What the parts mean is their owners' business.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::config::{Config, ConfigError};
use crate::replace;

mod attachments;
mod manifest;
mod refusal;

pub use manifest::FORMAT_VERSION;
pub use refusal::{CheckpointError, Instead, Refusal};

use manifest::{Manifest, Part, is_part_name};

/// Name of the part that holds the configuration under which a checkpoint was trained. Not `config.toml`: that is put
/// beside the parts by hand, and a part may not be replaced.
pub const CONFIG: &str = "trained-with.toml";

/// A checkpoint in memory, every part checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// Iterations done when it was written.
    pub iteration: u64,
    /// The owner's description of the networks' shapes.
    pub shape: String,
    /// How good its owner finds it.
    pub score: Option<f64>,
    path: PathBuf,
    parts: BTreeMap<String, Vec<u8>>,
    awaited: Vec<String>,
}

/// What is written as a checkpoint.
#[derive(Clone, Copy, Debug, Default)]
pub struct Contents<'a> {
    /// The owner's description of the networks' shapes.
    pub shape: &'a str,
    /// Name and bytes of each part.
    pub parts: &'a [(&'a str, &'a [u8])],
    /// Files that other processes are about to attach: with them it is whole.
    pub awaited: &'a [String],
    /// How good it is, the more the better; the best is kept for good. None where that cannot be told.
    pub score: Option<f64>,
}

impl Checkpoint {
    /// Opens and checks the checkpoint in a folder, whatever its shape. Where it lies among others, a refusal names the
    /// newest good one before it.
    pub fn open(path: &Path) -> Result<Self, CheckpointError> {
        Self::inspect(path).map_err(|reason| {
            // Only the whole path tells which others there are, also for one who stands in the folder.
            let whole = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
            let name = whole.file_name().map(|name| name.to_string_lossy());
            let place = name.as_deref().and_then(iteration_of).zip(whole.parent());
            CheckpointError::Refused {
                path: path.to_owned(),
                reason,
                instead: place.map_or(Instead::NoneEarlier, |(iteration, folder)| {
                    Checkpoints::new(folder.to_owned()).before(iteration, None)
                }),
            }
        })
    }

    /// The configuration under which it was trained: its own part, or for one that was shipped or written by an older
    /// program the `config.toml` beside its parts, if there is any.
    pub fn config(&self) -> Result<Option<Config>, ConfigError> {
        if let Some(text) = self.part(CONFIG) {
            let origin = self.path.join(CONFIG).display().to_string();
            return Config::parse_written(&String::from_utf8_lossy(text), &origin).map(Some);
        }
        let beside = self.path.join("config.toml");
        let there = beside.is_file();
        there.then(|| Config::read(&beside)).transpose()
    }

    /// The bytes of a part, or `None` when the checkpoint has no such part.
    pub fn part(&self, name: &str) -> Option<&[u8]> {
        self.parts.get(name).map(Vec::as_slice)
    }

    fn inspect(path: &Path) -> Result<Self, Refusal> {
        let manifest = Manifest::read(path)?;
        let mut parts = BTreeMap::new();
        for part in &manifest.parts {
            let bytes =
                fs::read(path.join(&part.name)).map_err(|_| Refusal::Missing(part.name.clone()))?;
            part.check(&bytes)?;
            parts.insert(part.name.clone(), bytes);
        }
        Ok(Self {
            iteration: manifest.iteration,
            shape: manifest.shape,
            score: manifest.score,
            path: path.to_owned(),
            parts,
            awaited: manifest.awaited,
        })
    }
}

/// Name of the file that an actor attaches.
pub fn robots_of(actor: u32) -> String {
    format!("actor-{actor}.bin")
}

/// The checkpoints of one run: `checkpoints/<iteration:08>/`.
#[derive(Clone, Debug)]
pub struct Checkpoints {
    folder: PathBuf,
}

impl Checkpoints {
    /// The checkpoints in a folder, which need not exist yet.
    pub fn new(folder: PathBuf) -> Self {
        Self { folder }
    }

    /// Where the checkpoint of an iteration is or would be.
    pub fn path(&self, iteration: u64) -> PathBuf {
        self.folder.join(format!("{iteration:08}"))
    }

    /// The iterations that have one, oldest first; whether it is good shows when it is opened.
    pub fn list(&self) -> Vec<u64> {
        let Ok(entries) = fs::read_dir(&self.folder) else {
            return Vec::new();
        };
        let mut iterations: Vec<u64> = entries
            .filter_map(Result::ok)
            .filter_map(|entry| iteration_of(&entry.file_name().to_string_lossy()))
            .collect();
        iterations.sort_unstable();
        iterations
    }

    /// Writes a checkpoint of parts alone, see [`Checkpoints::write_contents`].
    pub fn write(
        &self,
        iteration: u64,
        shape: &str,
        parts: &[(&str, &[u8])],
    ) -> Result<PathBuf, CheckpointError> {
        let contents = Contents {
            shape,
            parts,
            ..Contents::default()
        };
        self.write_contents(iteration, &contents)
    }

    /// Writes a checkpoint whole or not at all; one of the same iteration is replaced.
    ///
    /// # Panics
    /// If a part's name is not a plain file name.
    pub fn write_contents(
        &self,
        iteration: u64,
        contents: &Contents<'_>,
    ) -> Result<PathBuf, CheckpointError> {
        let path = self.path(iteration);
        let draft = self.folder.join(format!(".{iteration:08}.new"));
        let written = write_draft(&draft, iteration, contents).and_then(|()| {
            // Rename cannot replace a folder with something in it. Between the two renames there
            // is no checkpoint of this iteration, but the older ones are all there.
            let aside = self.folder.join(format!(".{iteration:08}.old"));
            remove_folder(&aside)?;
            if path.exists() {
                fs::rename(&path, &aside)?;
            }
            fs::rename(&draft, &path)?;
            replace::sync_folder(&self.folder)?;
            remove_folder(&aside)
        });
        match written {
            Ok(()) => Ok(path),
            Err(source) => {
                // The first error is the one worth reporting; the next write clears the draft too.
                let _ = remove_folder(&draft);
                Err(CheckpointError::Io { path, source })
            }
        }
    }

    /// Opens the newest, which must be of this shape if one is given; a refusal names the newest good one.
    pub fn open_newest(&self, shape: Option<&str>) -> Result<Checkpoint, CheckpointError> {
        match self.list().last() {
            Some(newest) => self.open(*newest, shape),
            None => Err(CheckpointError::None(self.folder.clone())),
        }
    }

    /// The iteration of the one with the highest score; of equals the oldest. Scores are of a task, so only those count
    /// that were trained under the `[task]` of the newest.
    pub fn best(&self) -> Option<u64> {
        let score = |at: u64| Manifest::read(&self.path(at)).ok()?.score;
        let task = |at: u64| -> Option<toml::Value> {
            let text = fs::read_to_string(self.path(at).join(CONFIG)).ok()?;
            let config = Config::parse_written(&text, CONFIG).ok()?;
            config.given("task").cloned()
        };
        let scored = self.list().into_iter().rev();
        let scored: Vec<(u64, f64)> = scored.filter_map(|at| Some((at, score(at)?))).collect();
        let newest = task(scored.first()?.0);
        let alike = scored.into_iter().filter(|(at, _)| task(*at) == newest);
        alike
            .max_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(at, _)| at)
    }

    /// Opens the one of an iteration, which must be of this shape if one is given.
    pub fn open(&self, iteration: u64, shape: Option<&str>) -> Result<Checkpoint, CheckpointError> {
        self.inspect(iteration, shape)
            .map_err(|reason| CheckpointError::Refused {
                path: self.path(iteration),
                reason,
                instead: self.before(iteration, shape),
            })
    }

    /// What can be used in place of the one of an iteration.
    fn before(&self, iteration: u64, shape: Option<&str>) -> Instead {
        let mut earlier = self.list();
        earlier.retain(|other| *other < iteration);
        let is_good = |other: &u64| self.inspect(*other, shape).is_ok();
        match earlier.iter().rev().copied().find(is_good) {
            Some(good) => Instead::Earlier(self.path(good)),
            None if earlier.is_empty() => Instead::NoneEarlier,
            None => Instead::NoneGood,
        }
    }

    /// Removes all but the `keep` newest and the best, and drafts that a crash left.
    pub fn prune(&self, keep: usize) -> Result<(), CheckpointError> {
        let iterations = self.list();
        let best = self.best();
        let old = &iterations[..iterations.len().saturating_sub(keep)];
        for at in old.iter().filter(|at| Some(**at) != best) {
            self.forget(*at)?;
        }
        let mut unwanted: Vec<PathBuf> = Vec::new();
        if let Ok(entries) = fs::read_dir(&self.folder) {
            let hidden = |path: &PathBuf| {
                path.file_name()
                    .is_some_and(|name| name.to_string_lossy().starts_with('.'))
            };
            unwanted.extend(
                entries
                    .filter_map(Result::ok)
                    .map(|e| e.path())
                    .filter(hidden),
            );
        }
        for path in unwanted {
            remove_folder(&path).map_err(|source| CheckpointError::Io { path, source })?;
        }
        Ok(())
    }

    /// Removes those of later iterations: a run that goes on from an earlier one will write them anew,
    /// and until then they must not pass for the newest.
    pub fn forget_after(&self, iteration: u64) -> Result<(), CheckpointError> {
        let mut later = self.list().into_iter().filter(|at| *at > iteration);
        later.try_for_each(|at| self.forget(at))
    }

    /// Removes one. It is renamed first: an actor may be adding its robots at this moment, and a folder in which files
    /// appear cannot be removed.
    fn forget(&self, iteration: u64) -> Result<(), CheckpointError> {
        let path = self.path(iteration);
        let aside = self.folder.join(format!(".{iteration:08}.old"));
        remove_folder(&aside)
            .and_then(|()| match fs::rename(&path, &aside) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
                _ => remove_folder(&aside),
            })
            .map_err(|source| CheckpointError::Io { path, source })
    }

    fn inspect(&self, iteration: u64, shape: Option<&str>) -> Result<Checkpoint, Refusal> {
        let checkpoint = Checkpoint::inspect(&self.path(iteration))?;
        match shape {
            Some(shape) if checkpoint.shape != shape => Err(Refusal::Shape {
                expected: shape.to_owned(),
                found: checkpoint.shape,
            }),
            _ => Ok(checkpoint),
        }
    }
}

/// The iteration that a folder's name says.
fn iteration_of(name: &str) -> Option<u64> {
    let digits = name.len() >= 8 && name.bytes().all(|byte| byte.is_ascii_digit());
    digits.then(|| name.parse().ok()).flatten()
}

fn write_draft(draft: &Path, iteration: u64, contents: &Contents<'_>) -> io::Result<()> {
    remove_folder(draft)?;
    fs::create_dir_all(draft)?;
    let mut written = Vec::with_capacity(contents.parts.len());
    for (name, bytes) in contents.parts {
        assert!(is_part_name(name), "{name:?} is not a plain file name");
        replace::write_durably(&draft.join(name), bytes)?;
        written.push(Part::of(name, bytes));
    }
    let text = serde_json::to_vec_pretty(&Manifest::new(iteration, contents, written))?;
    replace::write_durably(&draft.join(manifest::FILE), &text)?;
    replace::sync_folder(draft)
}

fn remove_folder(path: &Path) -> io::Result<()> {
    match fs::remove_dir_all(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}
