//! What the rows of a rollout hold: how wide they are, and what each number means.
//!
//! Separate because sizes alone do not tell two lists of terms apart: a header carries the lists' print, and whoever has
//! others is told the difference in words.

use iceoryx2::prelude::ZeroCopySend;
use observation::print::LISTED;
use observation::{Print, Tables, Widths};

/// What the rows of a run's rollouts hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lists {
    /// Numbers of a row of each kind.
    pub widths: Widths,
    /// What each of them means.
    pub print: Print,
}

impl From<&Tables> for Lists {
    fn from(tables: &Tables) -> Self {
        Self {
            widths: tables.widths(),
            print: Print::of(tables),
        }
    }
}

impl Default for Lists {
    /// The paper's.
    fn default() -> Self {
        Self::from(&Tables::default())
    }
}

/// A [`Print`] as a header carries it; zeros before it is sent.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, ZeroCopySend)]
#[type_name("ampco.ListsPrint")]
pub struct SentPrint([u64; LISTED]);

impl Default for SentPrint {
    fn default() -> Self {
        Self([0; LISTED])
    }
}

impl From<Lists> for SentPrint {
    fn from(lists: Lists) -> Self {
        Self(lists.print.0)
    }
}

impl SentPrint {
    /// Its numbers, for one who only carries it.
    pub fn numbers(&self) -> &[u64; LISTED] {
        &self.0
    }

    /// What [`Self::numbers`] gave; none of another count.
    pub fn from_numbers(numbers: &[u64]) -> Option<Self> {
        numbers.try_into().ok().map(Self)
    }

    /// How the lists that were sent differ from these, in words; none if they do not.
    pub fn difference(&self, lists: &Lists) -> Option<String> {
        lists.print.difference(&Print(self.0))
    }
}
