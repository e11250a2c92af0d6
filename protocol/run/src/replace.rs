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

/// Removes from a folder the drafts of [`replace_file`] whose process is gone, as of one that was killed; `of` says of
/// which files, by their names. A draft that cannot be removed harms nobody.
pub fn remove_drafts(folder: &Path, of: impl Fn(&str) -> bool) {
    let processes = Path::new("/proc");
    if !processes.join("self").exists() {
        return; // nobody says which processes there are
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let Some((file, process)) = name.to_str().and_then(drafted) else {
            continue;
        };
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if is_file && of(file) && !processes.join(process.to_string()).exists() {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The file that a draft of some name would replace, and the process that writes it.
fn drafted(name: &str) -> Option<(&str, u32)> {
    let inner = name.strip_prefix('.')?.strip_suffix(".new")?;
    let (file, process) = inner.rsplit_once('.')?;
    Some((file, process.parse().ok()?))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drafts_of_processes_that_are_gone_are_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let mut ended = std::process::Command::new("true").spawn().unwrap();
        let (gone, here) = (ended.id(), std::process::id());
        ended.wait().unwrap();
        let draft = format!(".a.json.{gone}.new");
        let mut kept = [
            format!(".a.json.{here}.new"),
            format!(".a.toml.{gone}.new"),
            format!("a.json.{gone}.new"),
            ".a.json.new".into(),
            ".a.json.x.new".into(),
            "a.json".into(),
        ];
        for name in kept.iter().chain([&draft]) {
            fs::write(folder.path().join(name), "").unwrap();
        }
        remove_drafts(folder.path(), |file| file.ends_with(".json"));
        let mut left: Vec<String> = fs::read_dir(folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        kept.sort();
        assert_eq!(left, kept);
    }
}
