//! `ampco motions synth`: the built-in gait as clips.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Result;
use motion::{Clip, Quality, gait};
use terminal::console;
use terminal::failure::usage;

use super::output::{self, Output};
use super::table;

/// The arguments.
#[derive(Debug, clap::Args)]
pub(super) struct Synth {
    /// Walking speeds in m/s, -0.6 (backward) to 1.8; 0 is stepping on the spot
    #[arg(
        long,
        value_name = "M/S,…",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    walk: Vec<f64>,
    /// Running speeds in m/s, 1.8 to 2.7
    #[arg(long, value_name = "M/S,…", value_delimiter = ',')]
    run: Vec<f64>,
    /// Standing still too
    #[arg(long)]
    stand: bool,
    /// Duration of each clip, rounded up to whole strides
    #[arg(long, value_name = "S", default_value_t = 10.0)]
    seconds: f64,
    /// Folder for the clips; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Synth {
    pub(super) fn run(&self) -> Result<()> {
        if !(0.1..=3600.0).contains(&self.seconds) {
            return Err(usage(format!(
                "--seconds {}: give 0.1 to 3600",
                self.seconds
            )));
        }
        let clips = self.clips()?;
        let outputs: Vec<Output> = clips.iter().map(|c| self.output(c)).collect();
        output::claim(&self.out, &outputs, &[])?;
        let mut out = console::results();
        writeln!(out, "{}", table::HEADING)?;
        for (clip, output) in clips.iter().zip(&outputs) {
            output.write(clip, &[])?;
            writeln!(out, "{}", table::line(&clip.name, &Quality::of(clip)))?;
        }
        Ok(())
    }

    fn output(&self, clip: &Clip) -> Output {
        let origin = format!("the built-in gait {}", clip.name);
        Output::new(&self.out, &clip.name, origin)
    }

    fn clips(&self) -> Result<Vec<Clip>> {
        let mut clips = Vec::new();
        for (name, speeds, range, make) in [
            (
                "walk",
                &self.walk,
                gait::WALKING_SPEEDS,
                gait::walk as fn(f64) -> Option<Clip>,
            ),
            ("run", &self.run, gait::RUNNING_SPEEDS, gait::run),
        ] {
            for &speed in speeds {
                let clip = make(speed).ok_or_else(|| {
                    let (low, high) = (range.start(), range.end());
                    usage(format!(
                        "--{name} {speed}: give speeds from {low} to {high} m/s"
                    ))
                })?;
                clips.push(Clip {
                    name: named(name, speed),
                    ..clip.unrolled(self.seconds)
                });
            }
        }
        if self.stand {
            clips.push(gait::stand().unrolled(self.seconds));
        }
        if clips.is_empty() {
            return Err(usage(
                "say what to make: --walk 0.6,0.8,1.0, --run 2.2 or --stand",
            ));
        }
        Ok(clips)
    }
}

/// Two decimals, or as many as tell the speed from its neighbours.
fn named(name: &str, speed: f64) -> String {
    let short = format!("{speed:.2}");
    if short.parse() == Ok(speed) {
        format!("{name}_{short}")
    } else {
        format!("{name}_{speed}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use std::fs;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        synth: Synth,
    }

    fn synth(arguments: &[&str]) -> Result<(), String> {
        let line = Line::try_parse_from(std::iter::once(&"synth").chain(arguments)).unwrap();
        line.synth.run().map_err(|e| e.to_string())
    }

    #[test]
    fn speeds_that_differ_have_names_that_differ() {
        assert_eq!(named("walk", 0.5), "walk_0.50");
        assert_eq!(named("walk", 0.98), "walk_0.98");
        assert_eq!(named("walk", 0.501), "walk_0.501");
        assert_eq!(named("walk", -0.3), "walk_-0.30");
    }

    #[test]
    fn what_is_there_is_not_written_over() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let clip = folder.path().join("walk_0.50.csv");
        let arguments = ["--walk", "0.5,0.501", "--seconds", "0.5", "--out", out];
        fs::write(&clip, "mine").unwrap();
        let message = synth(&arguments).unwrap_err();
        assert!(
            message.contains("walk_0.50.csv is there and was not"),
            "{message}"
        );
        assert_eq!(fs::read_to_string(&clip).unwrap(), "mine");
        assert_eq!(fs::read_dir(out).unwrap().count(), 1);
        fs::remove_file(&clip).unwrap();
        synth(&arguments).unwrap();
        synth(&arguments).unwrap();
        assert_eq!(fs::read_dir(out).unwrap().count(), 2);
        let message = synth(&["--walk", "0.5,0.5", "--out", out]).unwrap_err();
        assert!(
            message.contains("walk_0.50.csv would hold two clips"),
            "{message}"
        );
    }
}
