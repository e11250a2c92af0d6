//! What some tests need of the machine beside a Rust toolchain: a browser, a Python with certain packages,
//! namespaces of the kernel.
//!
//! Separate because the rule is one for all of them. A test that lacks something returns early, and the absence is
//! written to the file that `AMPCO_SKIPPED` names, a line each, which `deploy/check.sh` counts at its end. With
//! `AMPCO_NEEDS=all`, as in continuous integration, the test fails instead.

#![forbid(unsafe_code)]

use std::ffi::OsStr;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names under which a Chromium is installed.
const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// A Chromium on the path, or nothing after a word about it.
///
/// # Panics
/// Without one, where everything has to run.
pub fn browser() -> Option<PathBuf> {
    let found = std::env::var_os("PATH").and_then(|path| on_path(&path));
    if found.is_none() {
        absent(&format!("no {} on the path", BROWSERS.join(", ")));
    }
    found
}

/// A Python that can import all `modules`, `AMPCO_PYTHON` or `python3`; or nothing after a word about it.
///
/// # Panics
/// Without one, where everything has to run.
pub fn python(modules: &[&str]) -> Option<String> {
    let python = std::env::var("AMPCO_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let has = Command::new(&python)
        .args(["-c", &format!("import {}", modules.join(", "))])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has {
        absent(&format!(
            "{python} cannot import {}; name a Python that can with AMPCO_PYTHON",
            modules.join(", ")
        ));
    }
    has.then_some(python)
}

fn on_path(path: &OsStr) -> Option<PathBuf> {
    std::env::split_paths(path)
        .flat_map(|folder| BROWSERS.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// Says that the running test is skipped, and why.
///
/// # Panics
/// Where everything has to run.
pub fn absent(reason: &str) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    assert!(
        std::env::var("AMPCO_NEEDS").as_deref() != Ok("all"),
        "{test} has to run here (AMPCO_NEEDS=all): {reason}"
    );
    eprintln!("skipped: {reason}");
    if let Some(file) = std::env::var_os("AMPCO_SKIPPED") {
        note(Path::new(&file), test, reason);
    }
}

/// Adds a line to the list of skipped tests, in one write, as tests run beside each other.
fn note(file: &Path, test: &str, reason: &str) {
    let line = format!("{test}: {reason}\n");
    let opened = OpenOptions::new().create(true).append(true).open(file);
    let written = opened.and_then(|mut file| file.write_all(line.as_bytes()));
    written.unwrap_or_else(|error| panic!("writing {}: {error}", file.display()));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_browser_is_found_by_any_of_its_names_and_a_folder_is_none() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(on_path(folder.path().as_os_str()), None);
        std::fs::create_dir(folder.path().join("chromium")).unwrap();
        assert_eq!(on_path(folder.path().as_os_str()), None);
        let file = folder.path().join("google-chrome");
        std::fs::write(&file, "").unwrap();
        assert_eq!(on_path(folder.path().as_os_str()), Some(file));
    }

    #[test]
    fn every_skipped_test_is_a_line() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("skipped");
        note(&file, "one", "no browser");
        note(&file, "two", "no Python");
        let text = std::fs::read_to_string(file).unwrap();
        assert_eq!(text, "one: no browser\ntwo: no Python\n");
    }
}
