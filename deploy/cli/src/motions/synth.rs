//! `ampco motions synth`: the built-in gait as clips.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Result;
use motion::{Clip, Quality, gait};

use super::{files, table};
use crate::failure::usage;

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
        files::make_folder(&self.out)?;
        let mut out = std::io::stdout().lock();
        writeln!(out, "{}", table::HEADING)?;
        for clip in clips {
            files::write_clip(&self.out, &clip, &["the built-in gait".into()])?;
            writeln!(out, "{}", table::line(&clip.name, &Quality::of(&clip)))?;
        }
        Ok(())
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
                    name: format!("{name}_{speed:.2}"),
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
