//! Which files of a folder are motion.
//!
//! Separate because folders hold much else, and links that lead in circles.

use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};
use std::{fs, io};

use motion::import;

use super::super::output::identity;
use super::{Source, name};

/// What motion files end in: a folder is searched for these.
pub(super) const EXTENSIONS: [&str; 8] = ["npz", "bvh", "amc", "csv", "pkl", "npy", "motion", "pt"];
/// What clips of frames end in, and much else: these are looked into.
const TEXTS: [&str; 2] = ["json", "txt"];

/// What a folder holds, sorted by path.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) sources: Vec<Source>,
    /// Files of a body's shape without motion.
    pub(super) passed: Vec<PathBuf>,
}

/// Motion files below a folder, each once, whatever leads to it; their names carry the folders between.
pub(super) fn search(root: &Path) -> io::Result<Found> {
    let mut found = Found::default();
    let mut known = HashSet::new();
    // Links come last: what is below the folder keeps the name that it has there.
    let mut pending = BTreeSet::from([root.to_owned()]);
    let mut links = BTreeSet::new();
    while let Some(path) = pending.pop_first().or_else(|| links.pop_first()) {
        if !known.insert(key(&path)) {
            continue;
        }
        if !path.is_dir() {
            found.take(root, path);
            continue;
        }
        for entry in fs::read_dir(&path)? {
            let entry = entry?;
            let is_link = entry.file_type()?.is_symlink();
            let next = if is_link { &mut links } else { &mut pending };
            next.insert(entry.path());
        }
    }
    found.sources.sort_by(|a, b| a.path.cmp(&b.path));
    found.passed.sort();
    Ok(found)
}

/// What is the same for all names of a file or folder; of one that is not there its path.
pub(super) fn key(path: &Path) -> (Option<(u64, u64)>, PathBuf) {
    match identity(path) {
        Some(identity) => (Some(identity), PathBuf::new()),
        None => (None, path.to_owned()),
    }
}

impl Found {
    /// Takes a file if it is motion.
    fn take(&mut self, root: &Path, path: PathBuf) {
        let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
        let ending = ending.as_deref().unwrap_or_default();
        if ending == "npz" && import::is_body_shape(&path) {
            self.passed.push(path);
            return;
        }
        // A pipe would be waited at for ever.
        let is_text =
            || TEXTS.contains(&ending) && path.is_file() && import::is_text_of_frames(&path);
        if !EXTENSIONS.contains(&ending) && !is_text() {
            return;
        }
        let inner = path.strip_prefix(root).unwrap_or(&path);
        let folders = inner.parent().unwrap_or(Path::new(""));
        let folders = folders
            .to_string_lossy()
            .replace(|c: char| c == '/' || c.is_control(), "_");
        let name = match (folders.as_str(), name(inner)) {
            ("", name) => name,
            (folders, name) => format!("{folders}_{name}"),
        };
        self.sources.push(Source {
            path,
            name,
            searched: true,
        });
    }
}
