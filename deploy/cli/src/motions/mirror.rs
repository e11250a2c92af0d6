//! `ampco motions mirror`: clips with left and right swapped.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use motion::{Clip, Quality};

use super::files::{Source, Sources};
use super::output::{self, Output};
use super::table;
use crate::console;

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
        let sources = self.sources.found()?;
        let outputs: Vec<Output> = sources.iter().map(|s| output(&self.out, s)).collect();
        output::claim(&self.out, &outputs, &self.sources.files(&sources))?;
        let reads = self.sources.read_found(sources);
        let mut out = console::results();
        writeln!(out, "{}", table::HEADING)?;
        let mut failures = Vec::new();
        for (read, output) in reads.into_iter().zip(&outputs) {
            let clip = match read.outcome {
                Ok(imported) => imported.clip,
                Err(error) => {
                    failures.push(format!("{:#}", anyhow::Error::from(error)));
                    continue;
                }
            };
            let mirrored = Clip {
                name: name(&clip.name),
                ..clip.mirrored()
            };
            output.write(&mirrored, &[])?;
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

fn name(source: &str) -> String {
    format!("{source}_mirrored")
}

fn output(out: &Path, source: &Source) -> Output {
    let origin = output::origin("mirrored", &source.path);
    Output::new(out, &name(&source.name), origin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use motion::gait;
    use std::fs;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        mirror: Mirror,
    }

    #[test]
    fn mirror_images_never_replace_what_they_are_made_from() {
        let folder = tempfile::tempdir().unwrap();
        let walks = folder.path();
        let made = Output::new(walks, "a", "the built-in gait a".into());
        made.write(&gait::walk(1.0).unwrap(), &[]).unwrap();
        let mirror = |from: &str, out: &str| {
            let line = ["mirror", from, "--out", out];
            Line::try_parse_from(line).unwrap().mirror.run()
        };
        let (here, file) = (walks.to_str().unwrap(), walks.join("a.csv"));
        let before = fs::read(&file).unwrap();
        mirror(file.to_str().unwrap(), here).unwrap();
        mirror(file.to_str().unwrap(), here).unwrap(); // the same again
        let image = fs::read(walks.join("a_mirrored.csv")).unwrap();
        // The folder holds the image now, and the image of a.csv would be written over it.
        let message = mirror(here, here).unwrap_err().to_string();
        assert!(
            message.contains("a_mirrored.csv is one of the files"),
            "{message}"
        );
        assert_eq!(fs::read(&file).unwrap(), before);
        assert_eq!(fs::read(walks.join("a_mirrored.csv")).unwrap(), image);
        // Mirrored twice it is what it was, to the last digit.
        let twice = folder.path().join("twice");
        let image = walks.join("a_mirrored.csv");
        mirror(image.to_str().unwrap(), twice.to_str().unwrap()).unwrap();
        let numbers = |path: &Path| {
            let text = fs::read_to_string(path).unwrap();
            let rows = text.lines().filter(|line| !line.starts_with('#'));
            rows.map(|row| row.replace("-0.000000", "0.000000"))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            numbers(&twice.join("a_mirrored_mirrored.csv")),
            numbers(&file)
        );
    }
}
