//! What is wrong with a clip, looked for in one place: `import`, `check` and the start of `train` say the same.
//!
//! Every threshold says where it comes from. The built-in gaits and captures that retarget well have none of these.

mod bones;
mod ground;
mod joints;
mod moves;
mod posture;
mod source;
mod touch;
mod way;

pub(crate) use source::of as of_source;

use super::defect::{Defect, Kind, Severity};
use super::{Account, Feet, Quality};
use crate::clip::Clip;
use crate::import::Imported;
use std::path::Path;

/// Shortest clip that shows a step of a walk, s: a fast walker takes two a second.
const SHORTEST: f64 = 0.5;

/// What a clip is like and what is wrong with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Examination {
    /// Its measures.
    pub quality: Quality,
    /// What is known of its retargeting.
    pub account: Account,
    /// Its defects, the unfit first.
    pub defects: Vec<Defect>,
}

impl Examination {
    /// Of a clip that was read from a file.
    pub fn of(imported: &Imported, file: &Path) -> Self {
        let quality = Quality::of(&imported.clip);
        let account = Account::of(imported, file);
        let source = of_source(imported, file);
        let defects = all(&imported.clip, &quality, &account, &source);
        Self {
            quality,
            account,
            defects,
        }
    }
}

/// All defects of a clip, the unfit first; `quality` is its own, `account` that of its retargeting.
///
/// # Panics
/// If the clip has no frames.
pub fn defects(clip: &Clip, quality: &Quality, account: &Account) -> Vec<Defect> {
    all(clip, quality, account, &[])
}

/// The same with those that its source had ([`of_source`]).
pub(crate) fn all(
    clip: &Clip,
    quality: &Quality,
    account: &Account,
    source: &[Defect],
) -> Vec<Defect> {
    let feet: Vec<Feet> = clip.frames.iter().map(Feet::of).collect();
    let mut found = Vec::new();
    if quality.seconds < SHORTEST {
        found.push(Defect::throughout(
            Kind::Short,
            Severity::Unfit,
            quality.frames,
            (quality.seconds, "s"),
            format!("lasts {:.2} s only", quality.seconds),
        ));
    }
    let jumps = moves::teleport(&clip.frames);
    let lies = posture::lying(&clip.frames, &feet);
    let down = lies
        .as_ref()
        .is_some_and(|lies| lies.severity == Severity::Unfit);
    let ground = if down {
        Vec::new() // where the soles are says nothing about the ground
    } else {
        ground::of(&feet, quality)
    };
    found.extend(jumps);
    found.extend(moves::acceleration(&clip.frames));
    found.extend(joints::of(&clip.frames, quality));
    found.extend(match account {
        Account::None => None,
        Account::Of(report) => bones::off(report),
        Account::Misfit(why) => Some(Defect::throughout(
            Kind::Account,
            Severity::Odd,
            quality.frames,
            (0.0, ""),
            format!("the account beside it is not this clip's: {why}"),
        )),
    });
    found.extend(touch::of(&clip.frames));
    found.extend(way::backward(clip, &feet));
    found.extend(lies);
    found.extend(ground);
    source::join(&mut found, source, down);
    // A stable sort: within a severity the order above stays, from causes to what follows from them.
    found.sort_by_key(|defect| std::cmp::Reverse(defect.severity));
    found
}

#[cfg(test)]
mod tests;
