//! `ampco motions import`: motion files in, a folder of clips out.
//!
//! Beside every clip `<name>.json` says where it comes from, what was decided and done, and how good
//! it is, so that a training set can be judged years later.

mod outcome;

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use motion::import::Imported;
use motion::quality::Examination;
use serde_json::{Value, json};
use wording::count;

use super::files::{Read, Source, Sources};
use super::output::{self, Output, WRITTEN_BY};
use crate::console;
use crate::failure::usage;
use outcome::{Outcome, Written};

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
    /// End with one JSON array, an object per file: what it became, or why it failed
    #[arg(long)]
    json: bool,
}

impl Import {
    pub(super) fn run(&self) -> Result<()> {
        let sources = self.found()?;
        let outputs: Vec<Output> = sources.iter().map(|s| output(&self.out, s)).collect();
        let is_new = !self.out.exists();
        output::claim(&self.out, &outputs, &self.sources.files(&sources))?;
        let outcomes = self
            .sources
            .each(&sources, |i, read| carry_out(read, &outputs[i]));
        if is_new && outcomes.iter().all(|outcome| outcome.written().is_none()) {
            // Nothing came into it. It is not ours any more if somebody else put something there.
            let _ = std::fs::remove_dir(&self.out);
        }
        let mut out = console::results();
        if self.json {
            let rows = outcomes.iter().map(Outcome::row).collect();
            writeln!(out, "{}", Value::Array(rows))?;
        } else {
            outcome::show(&mut out, &outcomes, &self.out, self.verbose)?;
        }
        out.flush().context("writing to standard output")?;
        let failures: Vec<&str> = outcomes.iter().filter_map(Outcome::problem).collect();
        match (failures.as_slice(), outcomes.len()) {
            ([], _) => Ok(()),
            ([only], 1) => bail!("{only}"),
            (failures, all) => bail!(
                "{} of {} not imported:\n  {}",
                failures.len(),
                count(all, "file"),
                failures.join("\n  ")
            ),
        }
    }
}

/// Everything that is to be done with a file; done by many threads at once.
fn carry_out(read: Read, output: &Output) -> Outcome {
    let source = read.source;
    let failed = |problem| Outcome::Failed {
        source: source.clone(),
        problem,
    };
    let imported = match read.outcome {
        Ok(imported) => imported,
        Err(error) => return failed(describe(&error)),
    };
    let found = Examination::of(&imported, &source.path);
    let report = report(&source, &imported, &found);
    if let Err(error) = write(output, &imported, &report) {
        return failed(format!("{}: {error:#}", source.path.display()));
    }
    Outcome::Written(Box::new(Written {
        quality: found.quality,
        defects: found.defects,
        imported,
        report,
        seconds: read.seconds,
    }))
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
            let out = self.out.display();
            if sources.is_empty() {
                return Err(usage(format!(
                    "only clips that were written to {out} before are there; give motion files, or \
                     another --out"
                )));
            }
            console::say(&format!(
                "passed over: {} of the files written to {out} before",
                written.len()
            ));
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

fn report(source: &Source, imported: &Imported, found: &Examination) -> Value {
    // A table that was imported before brings its account along.
    let retargeting = found.account.report();
    let (written_by, this) = WRITTEN_BY;
    json!({
        written_by: this,
        "name": imported.clip.name,
        "source": source.path.display().to_string(),
        "format": imported.format,
        "frames": imported.frames,
        "fps": imported.fps,
        "decisions": imported.decisions,
        "retargeting": retargeting,
        "actions": retargeting.map(retarget::Report::actions),
        "quality": found.quality,
        "defects": found.defects,
    })
}

#[cfg(test)]
mod tests;
