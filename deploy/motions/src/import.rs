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
use serde_json::Value;
use terminal::console;
use terminal::failure::usage;
use wording::count;

use super::files::{Read, Source, Sources, describe, shown};
use super::output::{self, Output};
use super::report::{self, Made};
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
    let report = report::report(Made::Imported, &source.path, &imported, &found);
    if let Err(error) = write(output, &imported, &report) {
        return failed(format!("{}: {error:#}", shown(&source.path)));
    }
    Outcome::Written(Box::new(Written {
        quality: found.quality,
        defects: found.defects,
        imported,
        report,
        seconds: read.seconds,
    }))
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
            let out = shown(&self.out);
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
    Output::new(out, &source.name, Made::Imported.origin(&source.path)).with_report()
}

fn write(output: &Output, imported: &Imported, report: &Value) -> Result<()> {
    output.write_report(report)?;
    output.write(&imported.clip, &[format!("format {}", imported.format)])
}

#[cfg(test)]
mod tests;
