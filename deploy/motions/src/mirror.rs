//! `ampco motions mirror`: clips with left and right swapped.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use motion::Clip;
use motion::import::Imported;
use motion::quality::{Account, Defect, Examination, paragraph};
use terminal::console;

use super::files::{Source, Sources, describe};
use super::output::{self, Output};
use super::report::{self, Made};
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
        let sources = self.sources.found()?;
        let outputs: Vec<Output> = sources.iter().map(|s| output(&self.out, s)).collect();
        output::claim(&self.out, &outputs, &self.sources.files(&sources))?;
        let reads = self.sources.read_found(sources);
        let mut out = console::results();
        writeln!(out, "{}", table::HEADING)?;
        let mut failures = Vec::new();
        for (read, output) in reads.into_iter().zip(&outputs) {
            let imported = match read.outcome {
                Ok(imported) => imported,
                Err(error) => {
                    failures.push(describe(&error));
                    continue;
                }
            };
            let source = &read.source.path;
            let image = mirrored(imported, source);
            let found = examined(&image, source);
            output.write_report(&report::report(Made::Mirrored, source, &image, &found))?;
            output.write(&image.clip, &[])?;
            let name = &image.clip.name;
            writeln!(out, "{}", table::line(name, &found.quality))?;
            if !found.defects.is_empty() {
                writeln!(out, "{}", paragraph(name, &found.defects))?;
            }
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

/// The mirror image of a clip, with the account of its retargeting if there is one: it is no better than the clip.
fn mirrored(imported: Imported, source: &Path) -> Imported {
    let account = Account::of(&imported, source);
    let mut decisions = imported.decisions;
    decisions.push("mirrored: left and right are swapped".into());
    Imported {
        clip: Clip {
            name: name(&imported.clip.name),
            ..imported.clip.mirrored()
        },
        retargeting: account.report().map(report::mirrored),
        decisions,
        ..imported
    }
}

/// What is wrong with a mirror image of the clip in a file, what the clip's source had among it.
fn examined(image: &Imported, source: &Path) -> Examination {
    let mut found = Examination::of(image, source);
    let exchanged = |defect: Defect| {
        if defect.of_source {
            report::mirrored_defect(defect)
        } else {
            defect
        }
    };
    found.defects = found.defects.into_iter().map(exchanged).collect();
    found
}

fn output(out: &Path, source: &Source) -> Output {
    let origin = Made::Mirrored.origin(&source.path);
    Output::new(out, &name(&source.name), origin).with_report()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;
    use motion::gait;
    use motion::import::{Options, import};
    use motion::quality::{Kind, Severity, severity};
    use serde_json::json;
    use std::fs;

    #[derive(Debug, Parser)]
    struct Line {
        #[command(flatten)]
        mirror: Mirror,
    }

    #[test]
    fn a_mirror_image_is_as_unfit_as_its_clip() {
        let folder = tempfile::tempdir().unwrap();
        let here = folder.path();
        let walk = gait::walk(1.0).unwrap().unrolled(2.0);
        let made = Output::new(here, "a", "made".into()).with_report();
        made.write(&walk, &[]).unwrap();
        let frames = walk.frames.len();
        let off = json!({
            "bone": "left shin", "frames": frames, "first": 1, "last": frames, "worst": 7, "by": 80.0
        });
        let account = json!({
            "frames": frames, "human_leg": 0.8, "scale": 0.8, "scaled_speed": 1.0, "speed": 1.0,
            "direction_error": 1.0, "direction_error_95": 6.0, "stances": 4, "feet_moved": 0.0,
            "lowered": 0.0, "lifted": 0.0, "at_limit": [], "at_speed": [], "bones_off": [off]
        });
        let jump = json!({
            "kind": "jump", "severity": "unfit", "joints": ["left_knee_joint"], "value": 1.4, "of_source": true,
            "frames": { "first": 3, "last": 3, "worst": 3, "count": 1 }, "says": "left_knee_joint jumps"
        });
        let report = json!({
            "retargeting": account, "quality": { "frames": frames }, "defects": [jump]
        });
        made.write_report(&report).unwrap();
        let mut clip = made.clip;
        // Mirrored twice it is the left again.
        for (round, side) in ["right", "left"].into_iter().enumerate() {
            let out = here.join(round.to_string());
            let line = [Path::new("mirror"), &clip, Path::new("--out"), &out];
            Line::try_parse_from(line).unwrap().mirror.run().unwrap();
            clip = out.join(clip.with_extension("").file_name().unwrap());
            clip.as_mut_os_string().push("_mirrored.csv");
            let imported = import(&clip, &Options::default()).unwrap();
            let defects = Examination::of(&imported, &clip).defects;
            assert_eq!(severity(&defects), Some(Severity::Unfit));
            let of = |kind: Kind| defects.iter().find(|defect| defect.kind == kind).unwrap();
            assert_eq!(of(Kind::Bones).joints, [format!("{side} shin")]);
            assert_eq!(of(Kind::Bones).frames.worst, 7);
            assert_eq!(of(Kind::Jump).joints, [format!("{side}_knee_joint")]);
            assert_eq!(of(Kind::Jump).says, format!("{side}_knee_joint jumps"));
        }
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
