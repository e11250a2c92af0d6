//! Files that cannot be read at all, in the words of someone who typed their names.
//!
//! Separate because the errors of motion speak of a configuration, and because a pipe must be refused before it is opened.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use motion::MotionError;
use motion::import::Options;

use super::shown;

/// Refuses what is no regular file among all that reading a file opens: a pipe would be waited at for ever.
pub(super) fn check(path: &Path, options: &Options) -> Result<(), MotionError> {
    let is_table = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let report = is_table.then(|| path.with_extension("json"));
    let files = [Some(path), options.skeleton.as_deref(), report.as_deref()];
    for file in files.into_iter().flatten() {
        // One that is not there, or a folder, is told, or passed over, by who opens it.
        if fs::metadata(file).is_ok_and(|facts| !facts.is_file() && !facts.is_dir()) {
            return Err(MotionError::File {
                path: file.to_owned(),
                problem: "is a pipe, a socket or a device and no regular file".into(),
                remedy: "write what it gives into a file, and name that".into(),
            });
        }
    }
    Ok(())
}

/// The error with the path as it was typed, in a line.
pub(super) fn told(mut error: MotionError) -> MotionError {
    if let MotionError::Read { path, source } = error {
        let remedy = match source.kind() {
            ErrorKind::NotFound => "check its name",
            ErrorKind::PermissionDenied => "ask for the permission to read it",
            _ => "name another file",
        };
        error = MotionError::File {
            path,
            problem: format!("cannot be read: {source}"),
            remedy: remedy.into(),
        };
    }
    match &mut error {
        MotionError::Cell { path, .. }
        | MotionError::Frame { path, .. }
        | MotionError::File { path, .. } => *path = shown(path).into(),
        MotionError::Config(_) | MotionError::Read { .. } => {}
    }
    error
}
