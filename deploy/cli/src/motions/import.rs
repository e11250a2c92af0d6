//! `ampco motions import`: motion files in, a folder of clips out.
//!
//! Beside every clip `<name>.json` says where it comes from, what was decided and done, and how good
//! it is, so that a training set can be judged years later.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use motion::import::Imported;
use motion::quality::{Examination, paragraph};
use serde_json::{Value, json};

use super::files::{Read, Source, Sources};
use super::output::{self, Output, WRITTEN_BY};
use super::table;
use crate::failure::usage;

/// Decisions are printed for so many files; for more they are in the reports only.
const TOLD: usize = 6;

/// The arguments.
#[derive(Debug, clap::Args)]
pub(super) struct Import {
    #[command(flatten)]
    sources: Sources,
    /// Folder for the clips; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Tell what was decided and done for every file, however many
    #[arg(long)]
    verbose: bool,
    /// End with one JSON array, an object per clip
    #[arg(long)]
    json: bool,
}

impl Import {
    pub(super) fn run(&self) -> Result<()> {
        let sources = self.found()?;
        let outputs: Vec<Output> = sources.iter().map(|s| output(&self.out, s)).collect();
        output::claim(&self.out, &outputs, &self.sources.files(&sources))?;
        let reads = self.sources.read_found(sources);
        let mut out = std::io::stdout().lock();
        let verbose = self.verbose || reads.len() <= TOLD;
        let (mut rows, mut failures) = (Vec::new(), Vec::new());
        if !self.json && reads.iter().any(|read| read.outcome.is_ok()) {
            writeln!(out, "{}", table::HEADING)?;
        }
        for (read, output) in reads.iter().zip(&outputs) {
            let imported = match &read.outcome {
                Ok(imported) => imported,
                Err(error) => {
                    failures.push(describe(error));
                    continue;
                }
            };
            let found = Examination::of(imported, &read.source.path);
            let report = report(read, imported, &found);
            write(output, imported, &report)?;
            if self.json {
                rows.push(report);
                continue;
            }
            writeln!(out, "{}", table::line(&imported.clip.name, &found.quality))?;
            if verbose {
                tell(&mut out, imported)?;
            }
            if !found.defects.is_empty() {
                writeln!(out, "{}", paragraph(&imported.clip.name, &found.defects))?;
            }
        }
        if self.json {
            writeln!(out, "{}", Value::Array(rows))?;
        } else if failures.len() < reads.len() {
            summary(&mut out, &reads, &self.out, verbose)?;
        }
        match failures.as_slice() {
            [] => Ok(()),
            [only] if reads.len() == 1 => bail!("{only}"),
            _ => bail!(
                "{} of {} files were not imported:\n{}",
                failures.len(),
                reads.len(),
                failures.join("\n")
            ),
        }
    }
}

/// An error and its causes in a line.
fn describe(error: &motion::MotionError) -> String {
    let mut text = error.to_string();
    let mut cause = std::error::Error::source(error);
    while let Some(error) = cause {
        text = format!("{text}: {error}");
        cause = error.source();
    }
    text
}

impl Import {
    /// The files without those that an earlier import into the same folder wrote there.
    fn found(&self) -> Result<Vec<Source>> {
        let (written, sources): (Vec<Source>, Vec<Source>) = self
            .sources
            .found()?
            .into_iter()
            .partition(|s| s.searched && output::is_output(&s.path, &self.out));
        if !written.is_empty() {
            let (count, out) = (written.len(), self.out.display());
            if sources.is_empty() {
                return Err(usage(format!(
                    "only clips that were written to {out} before are there; give motion files, or \
                     another --out"
                )));
            }
            writeln!(
                std::io::stderr(),
                "passed over: {count} of the files were written to {out} before"
            )?;
        }
        Ok(sources)
    }
}

fn output(out: &Path, source: &Source) -> Output {
    Output::new(out, &source.name, output::origin("from", &source.path)).with_report()
}

/// The report first: a clip without one is what a folder of clips must not hold.
fn write(output: &Output, imported: &Imported, report: &Value) -> Result<()> {
    if let Some(path) = &output.report {
        let text = serde_json::to_string_pretty(report).context("writing a report")?;
        run::replace_file(path, text.as_bytes())
            .with_context(|| format!("writing {}", path.display()))?;
    }
    output.write(&imported.clip, &[format!("format {}", imported.format)])
}

fn report(read: &Read, imported: &Imported, found: &Examination) -> Value {
    // A table that was imported before brings its account along.
    let retargeting = found.account.report();
    let (written_by, this) = WRITTEN_BY;
    json!({
        written_by: this,
        "name": imported.clip.name,
        "source": read.source.path.display().to_string(),
        "format": imported.format,
        "frames": imported.frames,
        "fps": imported.fps,
        "decisions": imported.decisions,
        "retargeting": retargeting,
        "actions": retargeting.map(retarget::Report::actions),
        "quality": found.quality,
        "defects": found.defects,
        "frames_per_second_and_core": found.quality.frames as f64 / read.seconds,
    })
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

fn summary(out: &mut impl Write, reads: &[Read], folder: &Path, verbose: bool) -> Result<()> {
    let done = reads
        .iter()
        .filter_map(|read| Some((read.outcome.as_ref().ok()?, read.seconds)));
    let (mut clips, mut frames, mut seconds) = (0, 0, 0.0);
    for (imported, time) in done {
        clips += 1;
        frames += imported.clip.frames.len();
        seconds += time;
    }
    let rate = frames as f64 / f64::max(seconds, 1e-9);
    let minutes = frames as f64 / 50.0 / 60.0;
    writeln!(
        out,
        "{clips} clips, {minutes:.1} min, in {}; {rate:.0} frames a second and core",
        folder.display()
    )?;
    if !verbose {
        writeln!(
            out,
            "what was decided and done is in the .json beside each clip"
        )?;
    }
    writeln!(
        out,
        "train on them: ampco train --set 'motion.clips=[{{folder=\"{}\"}}]'",
        folder.display()
    )?;
    Ok(())
}

#[cfg(test)]
mod tests;
