//! `ampco motions mirror`: clips with left and right swapped.

use std::io::Write;
use std::path::PathBuf;

use anyhow::{Result, bail};
use motion::{Clip, Quality};

use super::files::{self, Sources};
use super::table;

/// The arguments.
#[derive(Debug, clap::Args)]
pub(super) struct Mirror {
    #[command(flatten)]
    sources: Sources,
    /// Folder for the clips; made if it is not there
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Mirror {
    pub(super) fn run(&self) -> Result<()> {
        let reads = self.sources.read()?;
        files::make_folder(&self.out)?;
        let mut out = std::io::stdout().lock();
        writeln!(out, "{}", table::HEADING)?;
        let mut failures = Vec::new();
        for read in reads {
            let clip = match read.outcome {
                Ok(imported) => imported.clip,
                Err(error) => {
                    failures.push(format!("{:#}", anyhow::Error::from(error)));
                    continue;
                }
            };
            let mirrored = Clip {
                name: format!("{}_mirrored", clip.name),
                ..clip.mirrored()
            };
            files::write_clip(&self.out, &mirrored, &[format!("{} mirrored", clip.name)])?;
            writeln!(
                out,
                "{}",
                table::line(&mirrored.name, &Quality::of(&mirrored))
            )?;
        }
        if !failures.is_empty() {
            bail!("{}", failures.join("\n"));
        }
        Ok(())
    }
}
