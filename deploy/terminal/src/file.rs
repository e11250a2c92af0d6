//! A file that somebody named: read as text, or written whole.
//!
//! Separate because every command that takes a file's name says the same things about it.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};

use crate::failure::usage;

/// The text of a file; one that is no text is named for what it is.
pub fn read_text(path: &Path) -> Result<String> {
    let shown = path.display();
    let bytes = std::fs::read(path).map_err(|error| usage(format!("{shown}: {error}")))?;
    wording::text(bytes).map_err(|foreign| usage(format!("{shown}: {foreign}")))
}

/// Refuses a place that nothing can be written to, before there is anything that would be lost.
pub fn check_place(path: &Path) -> Result<()> {
    let shown = path.display();
    if path.is_dir() {
        return Err(usage(format!("{shown} is a folder; name a file in it")));
    }
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => Err(usage(format!(
            "{shown}: there is no folder {}; make it first, or name another",
            folder.display()
        ))),
        _ => Ok(()),
    }
}

/// Writes beside, then renames: a file of that name is always whole.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    check_place(path)?;
    let writing = || format!("writing {}", path.display());
    if std::fs::metadata(path).is_ok_and(|facts| !facts.is_file()) {
        // A pipe or /dev/stdout stays what it is.
        let opened = std::fs::OpenOptions::new().write(true).open(path);
        return opened
            .and_then(|mut file| file.write_all(bytes))
            .with_context(writing);
    }
    run::replace_file(path, bytes).with_context(writing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    #[test]
    fn a_place_that_cannot_be_written_to_is_refused_in_words() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |path: PathBuf| check_place(&path).unwrap_err().to_string();
        assert!(refused(folder.path().to_owned()).ends_with("is a folder; name a file in it"));
        let missing = refused(folder.path().join("no/x.svg"));
        assert!(missing.contains("there is no folder") && missing.contains("make it first"));
        check_place(Path::new("x.svg")).unwrap();
        check_place(&folder.path().join("x.svg")).unwrap();
    }

    #[test]
    fn what_is_no_plain_file_is_written_into_and_stays() {
        let (mut reader, writer) = std::io::pipe().unwrap();
        let descriptor = std::os::fd::AsRawFd::as_raw_fd(&writer);
        let path = PathBuf::from(format!("/proc/self/fd/{descriptor}"));
        write(&path, b"whole").unwrap();
        drop(writer);
        let mut read = String::new();
        std::io::Read::read_to_string(&mut reader, &mut read).unwrap();
        assert_eq!(read, "whole");
    }

    #[test]
    fn a_file_that_is_no_text_is_named_for_what_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.toml");
        std::fs::write(&path, b"\x89PNG\r\n\x1a\n\xff").unwrap();
        let refused = read_text(&path).unwrap_err().to_string();
        assert!(
            refused.contains("study.toml: it is a picture (PNG)"),
            "{refused}"
        );
    }
}
