//! `ampco motions inspect`: what clips are like.

use std::io::Write;
use std::path::PathBuf;

use anyhow::{Result, bail};
use g1::{JOINT_TABLE, JOINTS};
use motion::Clip;
use motion::quality::{Examination, paragraph};
use serde_json::{Value, json};
use terminal::console;

use super::files::{Source, Sources, describe};
use super::output::{self, Output};
use super::table;

/// The arguments.
#[derive(Debug, clap::Args)]
pub(super) struct Inspect {
    #[command(flatten)]
    sources: Sources,
    /// Write an SVG per clip into this folder: speeds, feet, joints over time
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// End with one JSON array, an object per clip
    #[arg(long)]
    json: bool,
}

impl Inspect {
    pub(super) fn run(&self) -> Result<()> {
        let (reads, figures) = match &self.plots {
            None => (self.sources.read()?, Vec::new()),
            Some(folder) => {
                let sources = self.sources.found()?;
                let figure =
                    |s: &Source| Output::figure(folder, &s.name, output::origin("from", &s.path));
                let figures: Vec<Output> = sources.iter().map(figure).collect();
                output::claim(folder, &figures, &self.sources.files(&sources))?;
                (self.sources.read_found(sources), figures)
            }
        };
        let mut out = console::results();
        let (mut rows, mut failures) = (Vec::new(), Vec::new());
        if !self.json {
            writeln!(out, "{}", table::HEADING)?;
        }
        let few = reads.len() <= 3;
        for (i, read) in reads.into_iter().enumerate() {
            let imported = match read.outcome {
                Ok(imported) => imported,
                Err(error) => {
                    failures.push(describe(&error));
                    continue;
                }
            };
            let found = Examination::of(&imported, &read.source.path);
            let clip = imported.clip;
            if self.json {
                rows.push(json!({
                    "name": clip.name,
                    "quality": found.quality,
                    "defects": found.defects,
                    "ranges": ranges(&clip),
                }));
            } else {
                writeln!(out, "{}", table::line(&clip.name, &found.quality))?;
                if few {
                    details(&mut out, &clip, &found)?;
                }
            }
            if let Some(figure) = figures.get(i) {
                figure.draw(&clip)?;
            }
        }
        if self.json {
            writeln!(out, "{}", Value::Array(rows))?;
        }
        if !failures.is_empty() {
            bail!("{}", failures.join("\n"));
        }
        Ok(())
    }
}

/// Ranges of joints, rad: least, greatest, and greatest speed (rad/s).
fn ranges(clip: &Clip) -> Value {
    let range = |j: usize| {
        let [low, high, speed] = range(clip, j);
        (JOINT_TABLE[j].name.to_owned(), json!([low, high, speed]))
    };
    Value::Object((0..JOINTS).map(range).collect())
}

fn range(clip: &Clip, joint: usize) -> [f32; 3] {
    let angles = || clip.frames.iter().map(|f| f.joint_positions[joint]);
    let speeds = clip.frames.iter().map(|f| f.joint_velocities[joint].abs());
    [
        angles().fold(f32::INFINITY, f32::min),
        angles().fold(f32::NEG_INFINITY, f32::max),
        speeds.fold(0.0, f32::max),
    ]
}

/// Rounded to what is shown: what is hardly below 0 is not shown as -0.00.
fn hundredths(value: f64) -> f64 {
    (100.0 * value).round() / 100.0 + 0.0
}

fn details(out: &mut impl Write, clip: &Clip, found: &Examination) -> Result<()> {
    let quality = &found.quality;
    let [slow, fast] = quality.speed_range;
    let [low, high] = quality.height;
    writeln!(
        out,
        "    speed {slow:.2}–{fast:.2} m/s, turning {:.2} rad/s, pelvis {low:.2}–{high:.2} m",
        hundredths(quality.yaw_rate)
    )?;
    writeln!(
        out,
        "    a robot that moves exactly so is off its command by {:.3} m/s, {:.3} m/s of it aside, and by {:.3} rad/s",
        quality.tracking.rmse, quality.tracking.rmse_lateral, quality.tracking.rmse_yaw_rate
    )?;
    writeln!(
        out,
        "    left foot down {:.0} %, right {:.0} %, none {:.0} %; slip 95 % below {:.2} m/s",
        100.0 * quality.duty[0],
        100.0 * quality.duty[1],
        100.0 * quality.flight,
        quality.slip_95
    )?;
    writeln!(
        out,
        "    {:<28} {:>15} {:>17} {:>8}",
        "joint", "rad", "of rad", "rad/s"
    )?;
    for (j, joint) in JOINT_TABLE.iter().enumerate() {
        let [low, high, speed] = range(clip, j).map(f64::from);
        let (low, high) = (hundredths(low), hundredths(high));
        writeln!(
            out,
            "    {:<28} {low:6.2} to {high:5.2} {:7.2} to {:6.2} {speed:8.1}",
            joint.name, joint.lower, joint.upper
        )?;
    }
    if !found.defects.is_empty() {
        writeln!(out, "{}", paragraph(&clip.name, &found.defects))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
