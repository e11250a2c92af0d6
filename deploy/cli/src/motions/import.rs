//! `ampco motions import`: motion files in, a folder of clips out.
//!
//! Beside every clip `<name>.json` says where it comes from, what was decided and done, and how good
//! it is, so that a training set can be judged years later.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use motion::Quality;
use motion::import::Imported;
use serde_json::{Value, json};

use super::files::{self, Read, Sources};
use super::table;

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
        let reads = self.sources.read()?;
        files::make_folder(&self.out)?;
        let mut out = std::io::stdout().lock();
        let verbose = self.verbose || reads.len() <= TOLD;
        let (mut rows, mut failures) = (Vec::new(), Vec::new());
        if !self.json && reads.iter().any(|read| read.outcome.is_ok()) {
            writeln!(out, "{}", table::HEADING)?;
        }
        for read in &reads {
            let imported = match &read.outcome {
                Ok(imported) => imported,
                Err(error) => {
                    failures.push(describe(error));
                    continue;
                }
            };
            let quality = Quality::of(&imported.clip);
            let report = report(read, imported, &quality);
            write(&self.out, imported, &report)?;
            if self.json {
                rows.push(report);
                continue;
            }
            writeln!(out, "{}", table::line(&imported.clip.name, &quality))?;
            if verbose {
                tell(&mut out, imported, &quality)?;
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

fn write(out: &Path, imported: &Imported, report: &Value) -> Result<()> {
    let source = report["source"].as_str().unwrap_or_default();
    let notes = [format!(
        "{} from {source} ({})",
        imported.clip.name, imported.format
    )];
    let path = files::write_clip(out, &imported.clip, &notes)?.with_extension("json");
    let text = serde_json::to_string_pretty(report).context("writing a report")?;
    run::replace_file(&path, text.as_bytes()).with_context(|| format!("writing {}", path.display()))
}

fn report(read: &Read, imported: &Imported, quality: &Quality) -> Value {
    let actions = imported.retargeting.as_ref().map(retarget::Report::actions);
    json!({
        "name": imported.clip.name,
        "source": read.source.path.display().to_string(),
        "format": imported.format,
        "frames": imported.frames,
        "fps": imported.fps,
        "decisions": imported.decisions,
        "retargeting": imported.retargeting,
        "actions": actions,
        "quality": quality,
        "defects": quality.defects(),
        "frames_per_second_and_core": quality.frames as f64 / read.seconds,
    })
}

/// What was decided and done, and what is left.
fn tell(out: &mut impl Write, imported: &Imported, quality: &Quality) -> Result<()> {
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
    for defect in quality.defects() {
        writeln!(out, "    left: {defect}")?;
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
