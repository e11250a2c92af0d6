//! `ampco motions check`: whether a set of clips is worth training on.
//!
//! Two things spoil a set: clips that no robot could do, and speeds of which it holds almost nothing,
//! so that the discriminator calls every command at them unhuman. What is odd is told; what is unfit also
//! decides the exit status.

use std::io::Write;

use anyhow::{Result, bail};
use motion::quality::{Defect, Examination, Severity, paragraph, severity, speeds};
use motion::strata::{STRATUM, stratum};
use motion::{Clip, FRAME_SECONDS};
use serde_json::{Value, json};
use terminal::console;
use wording::count;

use super::files::{Sources, describe};

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

/// What is wrong with a set.
#[derive(Debug, Default)]
struct Faults {
    /// Names of clips and what is wrong with each.
    clips: Vec<(String, Vec<Defect>)>,
    /// Files that cannot be used, and why.
    unreadable: Vec<(String, String)>,
    /// Clips that hold the same joint angles as another, and that said.
    doubles: Vec<(String, String)>,
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

impl Faults {
    fn with(&self, wanted: Severity) -> usize {
        let of = |(_, defects): &&(String, Vec<Defect>)| severity(defects) == Some(wanted);
        self.clips.iter().filter(of).count()
    }

    /// Why the set as it is should not be trained on.
    fn verdict(&self) -> Option<String> {
        let counts = [
            (self.with(Severity::Unfit), "unfit to train on"),
            (self.unreadable.len(), "unreadable"),
            (self.doubles.len(), "there twice"),
        ];
        let told: Vec<String> = counts
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, what)| format!("{count} {what}"))
            .collect();
        (!told.is_empty()).then(|| format!("of these clips {}", told.join(", ")))
    }

    /// An object per defect of a clip.
    fn rows(&self) -> Vec<Value> {
        let mut rows = Vec::new();
        for (clip, defects) in &self.clips {
            for defect in defects {
                let mut row = json!(defect);
                row["clip"] = json!(clip);
                rows.push(row);
            }
        }
        for (kind, faults) in [("unreadable", &self.unreadable), ("double", &self.doubles)] {
            rows.extend(faults.iter().map(
                |(clip, says)| json!({ "clip": clip, "kind": kind, "severity": "unfit", "says": says }),
            ));
        }
        rows
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

/// Clips that hold the same joint angles as one before them, and that said.
fn doubles(clips: &[Clip]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    for (i, a) in clips.iter().enumerate() {
        let same = clips[..i].iter().find(|b| {
            a.frames.len() == b.frames.len()
                && a.frames
                    .iter()
                    .zip(&b.frames)
                    .all(|(a, b)| a.joint_positions == b.joint_positions)
        });
        found.extend(same.map(|b| {
            let says = format!("{} holds the same joint angles as {}", a.name, b.name);
            (a.name.clone(), says)
        }));
    }
    found
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
            "unbalanced: draw every speed alike with --set motion.stratify=true, or add clips"
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
mod tests {
    use super::*;
    use motion::gait;

    #[test]
    fn speeds_are_counted_in_quarters_of_a_metre_per_second() {
        let clips = [
            gait::walk(0.6).unwrap().unrolled(10.0),
            gait::walk(1.6).unwrap().unrolled(1.0),
        ];
        let seconds = seconds_at(clips.iter());
        assert!(seconds[2] > 9.5 && seconds[6] > 0.9, "{seconds:?}");
        // Nothing from 0.75 to 1.5; a second at 1.6 is more than a fifth of an even share, 0.4 s.
        assert_eq!(rare(&seconds), [3, 4, 5]);
        assert!(rare(&[0.0, 3.0, 4.0]).is_empty());
        assert!(rare(&[]).is_empty());
    }

    /// What is found in a walk that is changed from a frame on.
    fn faults(from: usize, change: impl Fn(&mut g1::RobotState)) -> Faults {
        let mut clip = gait::walk(1.0).unwrap().unrolled(2.0);
        clip.frames[from..].iter_mut().for_each(change);
        let quality = motion::Quality::of(&clip);
        let found = motion::quality::defects(&clip, &quality, &motion::quality::Account::None);
        Faults {
            clips: vec![("a".into(), found)],
            ..Faults::default()
        }
    }

    #[test]
    fn what_is_unfit_decides_and_what_is_odd_is_told() {
        assert_eq!(Faults::default().verdict(), None);
        let unfit = faults(50, |frame| frame.position.y += 5.0);
        assert!(unfit.verdict().unwrap().contains("1 unfit"));
        let rows = unfit.rows();
        assert_eq!(rows[0]["clip"], "a");
        assert_eq!(rows[0]["kind"], "teleport");
        assert_eq!(rows[0]["severity"], "unfit");
        assert_eq!(rows[0]["frames"]["worst"], 51);
        let odd = faults(0, |frame| frame.position.z -= 0.02);
        assert_eq!((odd.verdict(), odd.with(Severity::Odd)), (None, 1));
        assert_eq!(odd.rows()[0]["kind"], "penetration");
        let mut out = Vec::new();
        show(&mut out, &[], &[], &[], &odd).unwrap();
        assert!(
            String::from_utf8(out)
                .unwrap()
                .contains("a: odd\n    soles are")
        );
    }

    #[test]
    fn no_clips_last_no_time_and_not_less() {
        let (mut out, faults) = (Vec::new(), Faults::default());
        show(&mut out, &[], &[], &[], &faults).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(text.starts_with("0 clips, 0.0 min\n"), "{text}");
        let text = summary(&[], &[], &[], &faults).to_string();
        assert!(text.contains("\"seconds\":0.0,"), "{text}");
    }

    #[test]
    fn rare_speeds_in_a_row_are_one_line() {
        let mut seconds = vec![5.0, 5.0];
        seconds.resize(400, 0.0);
        seconds.push(5.0);
        let mut out = Vec::new();
        let rare = rare(&seconds);
        show(&mut out, &[], &seconds, &rare, &Faults::default()).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(
            text.contains("0.50–100.00      0.0    0.0 %    rare"),
            "{text}"
        );
        assert_eq!(text.lines().count(), 2 + 2 + 1 + 1 + 1, "{text}"); // heads, even, rare, even, a remedy
    }

    #[test]
    fn files_that_cannot_be_used_and_doubles_are_defects_of_the_set() {
        let set = Faults {
            unreadable: vec![("b".into(), "b.csv: holds nothing".into())],
            doubles: vec![("c".into(), "c holds the same joint angles as a".into())],
            ..Faults::default()
        };
        assert_eq!(
            set.verdict().unwrap(),
            "of these clips 1 unreadable, 1 there twice"
        );
        let kinds: Vec<Value> = set.rows().iter().map(|row| row["kind"].clone()).collect();
        assert_eq!(kinds, ["unreadable", "double"]);
    }

    #[test]
    fn the_same_clip_twice_is_found() {
        let walk = gait::walk(1.0).unwrap();
        let other = gait::walk(1.1).unwrap();
        assert!(doubles(&[walk.clone(), other]).is_empty());
        assert_eq!(doubles(&[walk.clone(), walk]).len(), 1);
    }
}
