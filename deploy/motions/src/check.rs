//! `ampco motions check`: whether a set of clips is worth training on.
//!
//! Two things spoil a set: clips that no robot could do, and speeds of which it holds almost nothing,
//! so that the discriminator calls every command at them unhuman. What is odd is told; what is unfit also
//! decides the exit status.

mod faults;

use std::io::Write;

use anyhow::{Result, bail};
use motion::quality::{Examination, Severity, paragraph, severity, speeds};
use motion::strata::{STRATUM, stratum};
use motion::{Clip, FRAME_SECONDS};
use serde_json::{Value, json};
use terminal::console;
use wording::count;

use super::files::{Sources, describe};
use faults::{Faults, doubles};

/// A speed within the set's range with less than this share of an even share is rare.
const RARE: f64 = 0.2;

/// The arguments.
#[derive(Debug, clap::Args)]
pub(super) struct Check {
    #[command(flatten)]
    sources: Sources,
    /// End with one JSON object
    #[arg(long)]
    json: bool,
}

impl Check {
    pub(super) fn run(&self) -> Result<()> {
        let (mut clips, mut fit, mut faults) = (Vec::new(), Vec::new(), Faults::default());
        for read in self.sources.read()? {
            match read.outcome {
                Ok(imported) => {
                    let found = Examination::of(&imported, &read.source.path).defects;
                    fit.push(severity(&found) != Some(Severity::Unfit));
                    if !found.is_empty() {
                        faults.clips.push((read.source.name, found));
                    }
                    clips.push(imported.clip);
                }
                Err(error) => {
                    faults.unreadable.push((read.source.name, describe(&error)));
                }
            }
        }
        faults.doubles = doubles(&clips);
        // Whatever speed an unfit clip seems to have, nobody moves at it.
        let seconds = seconds_at(
            clips
                .iter()
                .zip(fit)
                .filter(|(_, fit)| *fit)
                .map(|(clip, _)| clip),
        );
        let rare = rare(&seconds);
        let mut out = console::results();
        if self.json {
            writeln!(out, "{}", summary(&clips, &seconds, &rare, &faults))?;
        } else {
            show(&mut out, &clips, &seconds, &rare, &faults)?;
        }
        match faults.verdict() {
            None => Ok(()),
            Some(verdict) => bail!("{verdict}"),
        }
    }
}

/// Seconds at each stratum of speed.
fn seconds_at<'a>(clips: impl Iterator<Item = &'a Clip>) -> Vec<f64> {
    let mut seconds = Vec::new();
    for speed in clips.flat_map(speeds) {
        let stratum = stratum(speed);
        if seconds.len() <= stratum {
            seconds.resize(stratum + 1, 0.0);
        }
        seconds[stratum] += FRAME_SECONDS;
    }
    seconds
}

/// The sum; of nothing it is 0, where the library's is -0.
fn total(seconds: &[f64]) -> f64 {
    seconds.iter().sum::<f64>() + 0.0
}

/// Strata between the slowest and the fastest that hold too little.
fn rare(seconds: &[f64]) -> Vec<usize> {
    let first = seconds.iter().position(|s| *s > 0.0).unwrap_or(0);
    let inside = &seconds[first..];
    let even = inside.iter().sum::<f64>() / inside.len().max(1) as f64;
    (first..seconds.len())
        .filter(|&i| seconds[i] < RARE * even)
        .collect()
}

fn show(
    out: &mut impl Write,
    clips: &[Clip],
    seconds: &[f64],
    rare: &[usize],
    faults: &Faults,
) -> Result<()> {
    let total = total(seconds);
    let without = match faults.with(Severity::Unfit) {
        0 => String::new(),
        unfit => format!("; {unfit} of them unfit and not counted below"),
    };
    writeln!(
        out,
        "{}{without}, {:.1} min",
        count(clips.len(), "clip"),
        total / 60.0
    )?;
    writeln!(out, "      m/s        s    share")?;
    let is_rare: Vec<bool> = (0..seconds.len()).map(|i| rare.contains(&i)).collect();
    let strata: Vec<usize> = (0..seconds.len()).collect();
    // Rare strata in a row are a line: most of them hold nothing.
    for run in strata.chunk_by(|&i, &j| is_rare[i] && is_rare[j]) {
        let (first, last) = (run[0], run[run.len() - 1]);
        let s: f64 = seconds[first..=last].iter().sum();
        let share = s / total.max(f64::MIN_POSITIVE);
        let bar = "#".repeat((40.0 * share).round() as usize);
        let note = if is_rare[first] { "  rare" } else { "" };
        let (low, high) = (STRATUM * first as f64, STRATUM * (last + 1) as f64);
        writeln!(
            out,
            "{low:4.2}–{high:4.2} {s:8.1}  {:5.1} %  {bar}{note}",
            100.0 * share
        )?;
    }
    if !rare.is_empty() {
        writeln!(
            out,
            "unbalanced: draw every speed alike with --set motion.draw=speeds, or add clips"
        )?;
    }
    for (name, defects) in &faults.clips {
        writeln!(out, "{}", paragraph(name, defects))?;
    }
    for (_, says) in faults.unreadable.iter().chain(&faults.doubles) {
        writeln!(out, "{says}")?;
    }
    Ok(())
}

fn summary(clips: &[Clip], seconds: &[f64], rare: &[usize], faults: &Faults) -> Value {
    let low = |i: &usize| STRATUM * *i as f64;
    json!({
        "clips": clips.len(),
        "seconds": total(seconds),
        "stratum": STRATUM,
        "seconds_by_stratum": seconds,
        "rare_from": rare.iter().map(low).collect::<Vec<_>>(),
        "unfit": faults.with(Severity::Unfit),
        "odd": faults.with(Severity::Odd),
        "defects": faults.rows(),
    })
}

#[cfg(test)]
mod tests;
