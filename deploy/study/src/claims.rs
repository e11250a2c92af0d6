//! What the paper says, and whether the runs bear it out: said plainly, also where they cannot tell.
//!
//! A claim that one method is better is *supported* where the exact test finds it at the level of 0.05, *contradicted*
//! where the test finds the opposite. A claim that two are alike is contradicted where the first is found worse. All
//! else is *undecided*: with fewer than six common seeds no outcome of the test can count, and runs whose metric was
//! still moving, or that had not reached the phase that the claim is about, are too short. Where a claim compares with
//! several, that one of them contradicts it counts by Holm's corrected p.

mod finding;
mod list;

use crate::results::Results;

/// Whether a claim stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// The runs bear it out.
    Supported,
    /// The runs speak against it.
    Contradicted,
    /// The runs are too few, too short, or show no difference.
    Undecided,
}

impl Verdict {
    /// In a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Supported => "supported",
            Self::Contradicted => "contradicted",
            Self::Undecided => "undecided",
        }
    }
}

/// A claim with what the runs say to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Where the paper says it.
    pub section: &'static str,
    /// What it says.
    pub text: &'static str,
    /// Whether it stands.
    pub verdict: Verdict,
    /// Why, with numbers.
    pub evidence: String,
}

/// Every claim that runs can be held against.
pub fn claims(results: &Results) -> Vec<Claim> {
    list::all(results)
}
