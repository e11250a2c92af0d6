//! Replacing a file so that a reader, or the next start after a crash, sees the old one or the new one and nothing else.
//!
//! Separate because configuration, metrics, checkpoints and imported motion all need it and it is easy to get half right.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// Writes `bytes` beside `path`, makes them durable, and renames them over it.
///
/// # Errors
/// What the file system refused; the old file is then untouched.
pub fn replace_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let folder = match path.parent() {
        // A bare name has the empty path as its folder, which the system does not know.
        Some(folder) if folder.as_os_str().is_empty() => Path::new("."),
        Some(folder) => folder,
        None => return Err(io::Error::other("a path without a folder")),
    };
    let name = path
        .file_name()
        .ok_or_else(|| io::Error::other("a path without a file name"))?;
    // The process id keeps two writers of the same file (two actors that save at once) from meeting in one draft.
    let draft = folder.join(format!(
        ".{}.{}.new",
        name.to_string_lossy(),
        std::process::id()
    ));
    let written = write_durably(&draft, bytes).and_then(|()| fs::rename(&draft, path));
    if written.is_err() {
        // The first error is the one worth reporting; a draft that cannot be removed harms nobody.
        let _ = fs::remove_file(&draft);
    }
    written?;
    sync_folder(folder)
}

/// Creates or truncates `path`, writes `bytes`, and returns once they are on the disk.
pub(crate) fn write_durably(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Makes the names in a folder durable: a rename survives a power cut only after this.
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}
