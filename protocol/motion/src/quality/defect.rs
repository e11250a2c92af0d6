//! What can be wrong with a clip: the words in which `import`, `check` and `train` say it.
//!
//! Separate from the looking ([`super::defects`]) because reports, exit statuses and lines of a terminal share it.

mod kind;

pub use kind::Kind;

use crate::clip::FRAME_SECONDS;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display};

/// Whether a clip can be trained on all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Severity {
    /// Worth a look; a policy can learn from it.
    Odd,
    /// No robot could do it, or it shows something else than was recorded.
    Unfit,
}

/// The frames of a defect, counted from 1 at 50 Hz.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Frames {
    /// The first.
    pub first: usize,
    /// The last.
    pub last: usize,
    /// The worst.
    pub worst: usize,
    /// How many from first to last have the defect.
    pub count: usize,
}

impl Frames {
    /// Of indices from 0, ascending, each with how bad it is; `None` of none.
    pub(super) fn of(bad: &[(usize, f64)]) -> Option<Self> {
        let worst = bad.iter().max_by(|a, b| a.1.total_cmp(&b.1))?.0;
        Some(Self {
            first: bad[0].0 + 1,
            last: bad[bad.len() - 1].0 + 1,
            worst: worst + 1,
            count: bad.len(),
        })
    }

    /// All of a clip.
    fn all(count: usize) -> Self {
        Self {
            first: 1,
            last: count,
            worst: 1,
            count,
        }
    }
}

impl Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |frame: usize| format!("{frame} ({:.2} s)", (frame - 1) as f64 * FRAME_SECONDS);
        let Self {
            first,
            last,
            worst,
            count,
        } = *self;
        if count == 1 {
            return write!(f, "frame {}", at(first));
        }
        if last - first + 1 == count {
            write!(f, "frames {} to {}", at(first), at(last))?;
        } else {
            write!(f, "{count} frames from {} to {}", at(first), at(last))?;
        }
        if worst == first || worst == last {
            return Ok(());
        }
        write!(f, ", worst {}", at(worst))
    }
}

/// Something wrong with a clip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Defect {
    /// What it is.
    pub kind: Kind,
    /// How bad it is.
    pub severity: Severity,
    /// The joints or bones, the worst first.
    pub joints: Vec<String>,
    /// Where it is.
    pub frames: Frames,
    /// How much of it there is at the worst, in `unit`.
    pub value: f64,
    /// Unit of `value`.
    pub unit: &'static str,
    /// Whether the source had it and import mended it in the clip: only the account beside the clip still knows.
    pub of_source: bool,
    /// All that in words, but the remedy.
    pub says: String,
    /// What to do.
    pub remedy: &'static str,
}

impl Defect {
    /// A defect; `says` gets its frames here.
    pub(super) fn new(
        kind: Kind,
        severity: Severity,
        frames: Frames,
        value: (f64, &'static str),
        says: &str,
    ) -> Self {
        Self {
            frames,
            ..Self::throughout(kind, severity, 0, value, format!("{says} ({frames})"))
        }
    }

    /// A defect of a whole clip of so many frames.
    pub(super) fn throughout(
        kind: Kind,
        severity: Severity,
        frames: usize,
        (value, unit): (f64, &'static str),
        says: String,
    ) -> Self {
        Self {
            kind,
            severity,
            joints: Vec::new(),
            frames: Frames::all(frames),
            value,
            unit,
            of_source: false,
            says,
            remedy: kind.remedy(),
        }
    }

    /// The same, of joints or bones.
    pub(super) fn of_joints(self, joints: Vec<String>) -> Self {
        Self { joints, ..self }
    }
}

impl Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.says)
    }
}

/// A defect of a source as an account keeps it: unit and remedy are those of its kind.
#[derive(Debug, Deserialize)]
pub(super) struct Kept {
    kind: Kind,
    severity: Severity,
    #[serde(default)]
    joints: Vec<String>,
    frames: Frames,
    value: f64,
    says: String,
}

impl Kept {
    /// The defect; `None` if its frames are none of a clip of so many.
    pub(super) fn defect(self, frames: usize) -> Option<Defect> {
        let Frames {
            first, last, worst, ..
        } = self.frames;
        let within = (1..=worst).contains(&first) && (worst..=frames).contains(&last);
        let unit = if self.kind == Kind::Drift { "m" } else { "rad" };
        within.then_some(Defect {
            kind: self.kind,
            severity: self.severity,
            joints: self.joints,
            frames: self.frames,
            value: self.value,
            unit,
            of_source: true,
            says: self.says,
            remedy: self.kind.remedy(),
        })
    }
}

/// The worst of a clip's defects.
pub fn severity(defects: &[Defect]) -> Option<Severity> {
    defects.iter().map(|defect| defect.severity).max()
}

/// What is wrong with a clip in one line; empty if nothing is.
pub fn line(name: &str, defects: &[Defect]) -> String {
    let Some(severity) = severity(defects) else {
        return String::new();
    };
    let verdict = match severity {
        Severity::Unfit => "UNFIT to train on",
        Severity::Odd => "odd",
    };
    let said: Vec<String> = defects.iter().map(Defect::to_string).collect();
    format!("{name}: {verdict}: {}", said.join("; "))
}

/// The same with a remedy each, a line per defect below the clip's name.
pub fn paragraph(name: &str, defects: &[Defect]) -> String {
    let Some(severity) = severity(defects) else {
        return String::new();
    };
    let mut text = match severity {
        Severity::Unfit => format!("{name}: UNFIT to train on"),
        Severity::Odd => format!("{name}: odd"),
    };
    for Defect {
        severity: own,
        says,
        remedy,
        ..
    } in defects
    {
        let odd = if *own < severity { "odd: " } else { "" };
        text.push_str(&format!("\n    {odd}{says}; {remedy}"));
    }
    text
}

/// Names in a few words: the first three, and how many more there are.
pub(super) fn few(names: &[String]) -> String {
    const SHOWN: usize = 3;
    let shown = names[..names.len().min(SHOWN)].join(", ");
    match names.len().saturating_sub(SHOWN) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_count_from_one_and_say_the_time() {
        let frames = |bad: &[(usize, f64)]| Frames::of(bad).unwrap().to_string();
        assert_eq!(frames(&[(25, 1.0)]), "frame 26 (0.50 s)");
        assert_eq!(
            frames(&[(0, 1.0), (1, 2.0), (2, 1.0)]),
            "frames 1 (0.00 s) to 3 (0.04 s), worst 2 (0.02 s)"
        );
        assert_eq!(
            frames(&[(0, 1.0), (50, 2.0)]),
            "2 frames from 1 (0.00 s) to 51 (1.00 s)"
        );
        assert_eq!(Frames::of(&[]), None);
    }

    #[test]
    fn a_clip_is_as_bad_as_its_worst_defect_and_says_each_once() {
        let defect =
            |kind, severity| Defect::throughout(kind, severity, 3, (1.0, "m"), "it does so".into());
        let defects = [
            defect(Kind::Drift, Severity::Odd),
            defect(Kind::Slip, Severity::Unfit),
        ];
        assert_eq!(severity(&[]), None);
        assert_eq!(severity(&defects), Some(Severity::Unfit));
        assert_eq!(line("a", &[]), "");
        assert_eq!(line("a", &defects[..1]), "a: odd: it does so");
        let text = paragraph("a", &defects);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert_eq!(lines[0], "a: UNFIT to train on");
        assert!(lines[1].starts_with("    odd: it does so"));
        assert!(lines[2].ends_with(Kind::Slip.remedy()));
    }

    #[test]
    fn many_joints_are_few_words() {
        let names: Vec<String> = (0..23).map(|i| i.to_string()).collect();
        assert_eq!(few(&names), "0, 1, 2 and 20 more");
        assert_eq!(few(&names[..2]), "0, 1");
    }
}
