//! What became of every file of an import, for a person and for a program.
//!
//! Separate because a hundred files, good and bad, have to end in something that one can read.

use std::io::Write;
use std::path::Path;

use anyhow::Result;
use motion::Quality;
use motion::import::Imported;
use motion::quality::{Defect, Severity, paragraph, severity};
use serde_json::{Value, json};
use terminal::console;
use wording::count;

use super::super::files::{Source, shown};
use super::super::table;

/// Decisions are printed for so many files; for more they are in the reports only.
const TOLD: usize = 6;

/// What became of a file.
pub(super) enum Outcome {
    Written(Box<Written>),
    Failed { source: Source, problem: String },
}

/// A clip that lies in the folder.
pub(super) struct Written {
    pub(super) imported: Imported,
    pub(super) quality: Quality,
    pub(super) defects: Vec<Defect>,
    pub(super) report: Value,
    /// Time of reading and retargeting on one core, s.
    pub(super) seconds: f64,
}

impl Outcome {
    pub(super) fn written(&self) -> Option<&Written> {
        match self {
            Self::Written(written) => Some(written),
            Self::Failed { .. } => None,
        }
    }

    pub(super) fn problem(&self) -> Option<&str> {
        match self {
            Self::Written(_) => None,
            Self::Failed { problem, .. } => Some(problem),
        }
    }

    /// For a program that reads what became of the file.
    pub(super) fn row(&self) -> Value {
        match self {
            Self::Written(written) => {
                let mut row = written.report.clone();
                row["outcome"] = "imported".into();
                row
            }
            Self::Failed { source, problem } => json!({
                "name": source.name,
                "source": source.path.display().to_string(),
                "outcome": "failed",
                "problem": problem,
            }),
        }
    }
}

/// A line per clip, a paragraph for one with defects, and what to know of all of them.
pub(super) fn show(
    out: &mut impl Write,
    outcomes: &[Outcome],
    folder: &Path,
    verbose: bool,
) -> Result<()> {
    let verbose = verbose || outcomes.len() <= TOLD;
    let written: Vec<&Written> = outcomes.iter().filter_map(Outcome::written).collect();
    if !written.is_empty() {
        writeln!(out, "{}", table::HEADING)?;
    }
    for clip in &written {
        let name = &clip.imported.clip.name;
        writeln!(out, "{}", table::line(name, &clip.quality))?;
        if verbose {
            tell(out, &clip.imported)?;
        }
        if !clip.defects.is_empty() {
            writeln!(out, "{}", paragraph(name, &clip.defects))?;
        }
    }
    if outcomes.len() > 1 {
        writeln!(out, "{}", counts(outcomes.len(), &written))?;
    }
    if written.is_empty() {
        return Ok(());
    }
    close(out, &written, folder, verbose)
}

/// Where clips are, how fast it went, what to do next.
fn close(out: &mut impl Write, written: &[&Written], folder: &Path, verbose: bool) -> Result<()> {
    let folder = shown(folder);
    let frames = |clip: &&Written| clip.imported.clip.frames.len();
    let frames: usize = written.iter().map(frames).sum();
    let seconds: f64 = written.iter().map(|clip| clip.seconds).sum();
    let minutes = frames as f64 / 50.0 / 60.0;
    writeln!(
        out,
        "{}, {minutes:.1} min, in {folder}",
        count(written.len(), "clip")
    )?;
    if !verbose {
        writeln!(
            out,
            "what was decided and done is in the .json beside each clip"
        )?;
    }
    writeln!(
        out,
        "train on them: ampco train --set 'motion.clips=[{{folder=\"{folder}\"}}]'"
    )?;
    // Not among the results: these are the same every time.
    let rate = frames as f64 / f64::max(seconds, 1e-9);
    console::say(&format!("{rate:.0} frames a second and core"));
    Ok(())
}

/// "30 files: 20 imported without defects, 3 odd, 1 unfit to train on, 6 failed".
fn counts(files: usize, written: &[&Written]) -> String {
    let with = |wanted: Option<Severity>| {
        let of = |clip: &&&Written| severity(&clip.defects) == wanted;
        written.iter().filter(of).count()
    };
    let outcomes = [
        (with(None), "imported without defects"),
        (with(Some(Severity::Odd)), "odd"),
        (with(Some(Severity::Unfit)), "unfit to train on"),
        (files - written.len(), "failed"),
    ];
    let said: Vec<String> = outcomes
        .into_iter()
        .filter(|(number, _)| *number > 0)
        .map(|(number, outcome)| format!("{number} {outcome}"))
        .collect();
    format!("{}: {}", count(files, "file"), said.join(", "))
}

/// What was decided and done.
fn tell(out: &mut impl Write, imported: &Imported) -> Result<()> {
    for decision in &imported.decisions {
        writeln!(out, "    {decision}")?;
    }
    if let Some(report) = &imported.retargeting {
        for action in report.actions() {
            writeln!(out, "    {action}")?;
        }
        writeln!(
            out,
            "    tracking: bones are off by {:.1}° (median), {:.1}° (95 %); speed {:.2} m/s of {:.2} m/s scaled",
            report.direction_error, report.direction_error_95, report.speed, report.scaled_speed
        )?;
    }
    Ok(())
}
