//! Where clips are written, and what is never written over.
//!
//! Separate because every subcommand that writes clips must ask the same, and ask it of all files before
//! it reads or writes the first: whether a name is free, or holds what the same command wrote before.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::io::{self, Read};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use motion::{Clip, export};
use serde_json::Value;
use terminal::failure::usage;

use super::files::shown;
use super::{plots, report};

/// Reports are a few kilobytes; what is larger is none.
const LARGEST_REPORT: u64 = 16 << 20;
/// Conflicts are shown up to this many.
const SHOWN: usize = 5;

/// A clip, or the figure of one, that is to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Output {
    /// The table, or the figure.
    pub(super) clip: PathBuf,
    /// The report beside it, if there is to be one.
    pub(super) report: Option<PathBuf>,
    /// What the clip is made from: a table of another origin is not written over.
    pub(super) origin: String,
    /// Whether it is a figure and no table.
    is_figure: bool,
}

impl Output {
    /// The clip of some name in a folder, without a report.
    pub(super) fn new(out: &Path, name: &str, origin: String) -> Self {
        Self {
            clip: place(out, name, "csv"),
            report: None,
            origin,
            is_figure: false,
        }
    }

    /// The figure of a clip of some name.
    pub(super) fn figure(out: &Path, name: &str, origin: String) -> Self {
        Self {
            clip: place(out, name, "svg"),
            is_figure: true,
            ..Self::new(out, name, origin)
        }
    }

    /// With a report beside it.
    pub(super) fn with_report(self) -> Self {
        let report = Some(self.clip.with_extension("json"));
        Self { report, ..self }
    }

    /// Writes the clip; `notes` follow its origin.
    pub(super) fn write(&self, clip: &Clip, notes: &[String]) -> Result<()> {
        let notes = [std::slice::from_ref(&self.origin), notes].concat();
        replace(&self.clip, &export::to_csv(clip, &notes))
    }

    /// Writes the report, before the clip: one without is what a folder of clips must not hold.
    pub(super) fn write_report(&self, report: &Value) -> Result<()> {
        let text = serde_json::to_string_pretty(report).context("writing a report")?;
        self.report
            .as_deref()
            .map_or(Ok(()), |path| replace(path, &text))
    }

    /// Draws the figure.
    pub(super) fn draw(&self, clip: &Clip) -> Result<()> {
        replace(&self.clip, &plots::svg(clip, &self.origin))
    }

    /// The argument that its folder comes from.
    fn option(&self) -> &'static str {
        if self.is_figure { "--plots" } else { "--out" }
    }

    /// The origin of a table or figure that begins like this; `None` if it is none that was written here.
    fn origin_of(&self, beginning: &str) -> Option<String> {
        if self.is_figure {
            plots::origin(beginning)
        } else {
            export::origin(beginning).map(str::to_owned)
        }
    }
}

fn place(out: &Path, name: &str, ending: &str) -> PathBuf {
    out.join(format!("{}.{ending}", name.replace(['/', '\\'], "_")))
}

fn replace(path: &Path, text: &str) -> Result<()> {
    run::replace_file(path, text.as_bytes()).with_context(|| format!("writing {}", shown(path)))
}

/// The origin of a clip that is imported from a file, or its mirror image.
pub(super) fn origin(verb: &str, source: &Path) -> String {
    // As the table's note has it, in a line.
    format!("{verb} {}", source.display()).replace(char::is_control, " ")
}

/// Makes the folder if all outputs may be written, and removes half-written files of a command that was killed; changes
/// nothing otherwise.
///
/// # Errors
/// Two outputs of one name (whatever their case: some file systems see none), or one whose place is taken
/// by a source, by a file of somebody else, or by a clip of another origin.
pub(super) fn claim(out: &Path, outputs: &[Output], sources: &[&Path]) -> Result<()> {
    // What is a file, or below one, can be no folder.
    if out.ancestors().any(Path::is_file) {
        let option = outputs.first().map_or("--out", Output::option);
        return Err(usage(format!("{option} {} is no folder", shown(out))));
    }
    let sources: HashSet<(u64, u64)> = sources.iter().filter_map(|path| identity(path)).collect();
    let mut known: BTreeMap<String, &Output> = BTreeMap::new();
    let mut conflicts = Vec::new();
    for output in outputs {
        let name = output.clip.to_string_lossy().to_lowercase();
        if let Some(other) = known.insert(name, output) {
            conflicts.push(format!(
                "{} would hold two clips: {}, and {}; give each a folder of its own",
                shown(&output.clip),
                other.origin,
                output.origin
            ));
        }
        for path in std::iter::once(&output.clip).chain(&output.report) {
            let taken = taken(path, output, &sources)
                .with_context(|| format!("looking at {}", shown(path)))?;
            conflicts.extend(taken.map(|why| format!("{} {why}", shown(path))));
        }
    }
    if conflicts.is_empty() {
        fs::create_dir_all(out).with_context(|| format!("making the folder {}", shown(out)))?;
        run::remove_drafts(out, |file| {
            [".csv", ".json", ".svg"]
                .iter()
                .any(|ending| file.ends_with(ending))
        });
        return Ok(());
    }
    let more = conflicts.len().saturating_sub(SHOWN);
    conflicts.truncate(SHOWN);
    if more > 0 {
        conflicts.push(format!("and {more} more"));
    }
    Err(usage(format!(
        "nothing was written: {}",
        conflicts.join("\n")
    )))
}

/// Why nothing may be written to a path; `None` if it is free.
fn taken(
    path: &Path,
    output: &Output,
    sources: &HashSet<(u64, u64)>,
) -> io::Result<Option<String>> {
    let there = match fs::symlink_metadata(path) {
        Ok(there) => there,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    if identity(path).is_some_and(|file| sources.contains(&file)) {
        return Ok(Some(format!(
            "is one of the files that are read, and would be written over; give another {}",
            output.option()
        )));
    }
    if !there.is_file() {
        let what = if there.is_dir() { "a folder" } else { "a link" };
        let option = output.option();
        return Ok(Some(format!(
            "is {what}; move it, or give another {option}"
        )));
    }
    if Some(path) == output.report.as_deref() {
        let small = there.len() <= LARGEST_REPORT;
        let report = if small { fs::read(path)? } else { Vec::new() };
        return Ok(other(report::origin(&report).as_deref(), output));
    }
    let text = beginning(path)?;
    Ok(other(output.origin_of(&text).as_deref(), output))
}

/// Why a file of some origin is not replaced; of none if somebody else wrote it.
fn other(origin: Option<&str>, output: &Output) -> Option<String> {
    let option = output.option();
    match origin {
        None => Some(format!(
            "is there and was not written by this command; move it, or give another {option}"
        )),
        Some(before) if same_origin(before, &output.origin) => None,
        Some(before) => Some(format!(
            "is of another clip ({before}); remove it, or give another {option}"
        )),
    }
}

/// Whether two origins are the same, however the path in them is spelt.
fn same_origin(a: &str, b: &str) -> bool {
    let file = |origin: &str| {
        let (verb, path) = origin.split_once(' ')?;
        Some((verb.to_owned(), identity(Path::new(path))?))
    };
    a == b || file(a).is_some_and(|a| file(b) == Some(a))
}

/// What a file is under all of its names and links; `None` if it is not there.
pub(super) fn identity(path: &Path) -> Option<(u64, u64)> {
    let file = fs::metadata(path).ok()?;
    Some((file.dev(), file.ino()))
}

/// Whether a file is a clip that was written into `out`.
pub(super) fn is_output(path: &Path, out: &Path) -> bool {
    let inside = || {
        let folder = fs::canonicalize(path.parent()?).ok()?;
        let out = fs::canonicalize(out).ok()?;
        Some(folder == out)
    };
    inside() == Some(true)
        && path.extension().is_some_and(|ending| ending == "csv")
        && beginning(path).is_ok_and(|text| export::is_marked(&text))
}

/// The first lines of a file.
fn beginning(path: &Path) -> io::Result<String> {
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::other("no regular file")); // a pipe would be waited at for ever
    }
    let mut bytes = Vec::new();
    fs::File::open(path)?
        .take(64 << 10)
        .read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests;
