//! `ampco motions check`: whether a set of clips is worth training on.
//!
//! Two things spoil a set: clips that no robot could do, and speeds of which it holds almost nothing,
//! so that the discriminator calls every command at them unhuman.

use std::io::Write;

use anyhow::{Result, bail};
use motion::quality::speeds;
use motion::strata::{STRATUM, stratum};
use motion::{Clip, FRAME_SECONDS, Quality};
use serde_json::{Value, json};

use super::files::Sources;

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
        let (mut clips, mut defects) = (Vec::new(), Vec::new());
        for read in self.sources.read()? {
            match read.outcome {
                Ok(imported) => {
                    let found = Quality::of(&imported.clip).defects();
                    defects.extend(
                        found
                            .into_iter()
                            .map(|d| format!("{}: {d}", read.source.name)),
                    );
                    clips.push(imported.clip);
                }
                Err(error) => defects.push(format!("{:#}", anyhow::Error::from(error))),
            }
        }
        defects.extend(doubles(&clips));
        let seconds = seconds_at(&clips);
        let rare = rare(&seconds);
        let mut out = std::io::stdout().lock();
        if self.json {
            writeln!(out, "{}", summary(&clips, &seconds, &rare, &defects))?;
        } else {
            show(&mut out, &clips, &seconds, &rare, &defects)?;
        }
        match defects.len() {
            0 => Ok(()),
            count => bail!("{count} defects in {} clips", clips.len()),
        }
    }
}

/// Seconds at each stratum of speed.
fn seconds_at(clips: &[Clip]) -> Vec<f64> {
    let mut seconds = Vec::new();
    for speed in clips.iter().flat_map(speeds) {
        let stratum = stratum(speed);
        if seconds.len() <= stratum {
            seconds.resize(stratum + 1, 0.0);
        }
        seconds[stratum] += FRAME_SECONDS;
    }
    seconds
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

/// Clips that hold the same frames.
fn doubles(clips: &[Clip]) -> Vec<String> {
    let mut found = Vec::new();
    for (i, a) in clips.iter().enumerate() {
        let same = clips[..i].iter().find(|b| {
            a.frames.len() == b.frames.len()
                && a.frames
                    .iter()
                    .zip(&b.frames)
                    .all(|(a, b)| a.joint_positions == b.joint_positions)
        });
        found.extend(same.map(|b| format!("{} holds the same frames as {}", a.name, b.name)));
    }
    found
}

fn show(
    out: &mut impl Write,
    clips: &[Clip],
    seconds: &[f64],
    rare: &[usize],
    defects: &[String],
) -> Result<()> {
    let total: f64 = seconds.iter().sum();
    writeln!(out, "{} clips, {:.1} min", clips.len(), total / 60.0)?;
    writeln!(out, "      m/s        s   share")?;
    for (i, s) in seconds.iter().enumerate() {
        let share = s / total.max(f64::MIN_POSITIVE);
        let bar = "#".repeat((40.0 * share).round() as usize);
        let note = if rare.contains(&i) { "  rare" } else { "" };
        let (low, high) = (STRATUM * i as f64, STRATUM * (i + 1) as f64);
        writeln!(
            out,
            "{low:4.2}–{high:4.2} {s:8.1}  {:5.1} %  {bar}{note}",
            100.0 * share
        )?;
    }
    if !rare.is_empty() {
        writeln!(
            out,
            "unbalanced: draw every speed alike with --set motion.stratify=true, or add clips"
        )?;
    }
    for defect in defects {
        writeln!(out, "defect: {defect}")?;
    }
    Ok(())
}

fn summary(clips: &[Clip], seconds: &[f64], rare: &[usize], defects: &[String]) -> Value {
    let low = |i: &usize| STRATUM * *i as f64;
    json!({
        "clips": clips.len(),
        "seconds": seconds.iter().sum::<f64>(),
        "stratum": STRATUM,
        "seconds_by_stratum": seconds,
        "rare_from": rare.iter().map(low).collect::<Vec<_>>(),
        "defects": defects,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use motion::gait;

    #[test]
    fn speeds_are_counted_in_quarters_of_a_metre_per_second() {
        let clips = [
            gait::walk(0.6).unwrap().unrolled(10.0),
            gait::walk(1.6).unwrap().unrolled(1.0),
        ];
        let seconds = seconds_at(&clips);
        assert!(seconds[2] > 9.5 && seconds[6] > 0.9, "{seconds:?}");
        // Nothing from 0.75 to 1.5; a second at 1.6 is more than a fifth of an even share, 0.4 s.
        assert_eq!(rare(&seconds), [3, 4, 5]);
        assert!(rare(&[0.0, 3.0, 4.0]).is_empty());
        assert!(rare(&[]).is_empty());
    }

    #[test]
    fn the_same_clip_twice_is_found() {
        let walk = gait::walk(1.0).unwrap();
        let other = gait::walk(1.1).unwrap();
        assert!(doubles(&[walk.clone(), other]).is_empty());
        assert_eq!(doubles(&[walk.clone(), walk]).len(), 1);
    }
}
