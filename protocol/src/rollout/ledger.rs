//! What became of the rollouts, as the learner sees it.
//!
//! Separate because it is bookkeeping on headers, and a loss that nobody counts looks like an
//! experiment that went slowly.

use std::collections::BTreeMap;

use crate::rollout::RolloutHeader;

/// Counts of one actor or of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Rollouts that arrived, the stale and duplicated ones included.
    pub received: u64,
    /// Rollouts that were sent and never arrived: gaps in the sequence.
    pub dropped: u64,
    /// Rollouts that arrived again.
    pub duplicated: u64,
    /// Rollouts of weights that are no longer wanted.
    pub stale: u64,
}

/// What to do with a rollout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entry {
    /// Learn from it.
    Fresh,
    /// Its weights are another learner's or too old: leave it.
    Stale,
    /// It was entered before: leave it.
    Duplicate,
}

/// Sequence numbers of every life of every actor.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    pages: BTreeMap<(u32, u64), Page>,
}

#[derive(Clone, Debug)]
struct Page {
    next: u64,
    totals: Totals,
}

impl Ledger {
    /// Enters a rollout. It is fresh when it used weights of the learner with incarnation
    /// `learner`, of version `oldest` or later.
    pub fn enter(&mut self, header: &RolloutHeader, learner: u64, oldest: u64) -> Entry {
        let page = self
            .pages
            .entry((header.actor, header.incarnation))
            // What an actor sent before this learner began is nobody's loss.
            .or_insert(Page {
                next: header.sequence,
                totals: Totals::default(),
            });
        page.totals.received += 1;
        // A stream keeps order, so a smaller number can only be a repetition.
        if header.sequence < page.next {
            page.totals.duplicated += 1;
            return Entry::Duplicate;
        }
        page.totals.dropped = page
            .totals
            .dropped
            .saturating_add(header.sequence - page.next);
        page.next = header.sequence.saturating_add(1);
        if header.learner != learner || header.policy_version < oldest {
            page.totals.stale += 1;
            return Entry::Stale;
        }
        Entry::Fresh
    }

    /// Counts of all actors together.
    pub fn totals(&self) -> Totals {
        self.sum(|_| true)
    }

    /// Counts of all lives of one actor.
    pub fn totals_of(&self, actor: u32) -> Totals {
        self.sum(|candidate| candidate == actor)
    }

    /// How often an actor began anew: lives seen beyond each actor's first.
    pub fn restarts(&self) -> u64 {
        let mut actors: Vec<u32> = self.pages.keys().map(|&(actor, _)| actor).collect();
        actors.dedup(); // keys are sorted by actor
        (self.pages.len() - actors.len()) as u64
    }

    fn sum(&self, wanted: impl Fn(u32) -> bool) -> Totals {
        let pages = self.pages.iter().filter(|((actor, _), _)| wanted(*actor));
        pages.fold(Totals::default(), |sum, (_, page)| Totals {
            received: sum.received + page.totals.received,
            dropped: sum.dropped.saturating_add(page.totals.dropped),
            duplicated: sum.duplicated + page.totals.duplicated,
            stale: sum.stale + page.totals.stale,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEARNER: u64 = 77;

    fn header(actor: u32, incarnation: u64, sequence: u64, policy_version: u64) -> RolloutHeader {
        RolloutHeader {
            actor,
            incarnation,
            sequence,
            policy_version,
            learner: LEARNER,
            ..RolloutHeader::default()
        }
    }

    #[test]
    fn a_gap_counts_every_missing_rollout_once() {
        let mut ledger = Ledger::default();
        for sequence in [0, 1, 4] {
            assert_eq!(
                ledger.enter(&header(0, 1, sequence, 5), LEARNER, 5),
                Entry::Fresh
            );
        }
        // 2 and 3 are missing.
        let expected = Totals {
            received: 3,
            dropped: 2,
            ..Totals::default()
        };
        assert_eq!(ledger.totals(), expected);
    }

    #[test]
    fn a_repetition_is_a_duplicate_and_no_gap() {
        let mut ledger = Ledger::default();
        ledger.enter(&header(0, 1, 0, 5), LEARNER, 5);
        ledger.enter(&header(0, 1, 1, 5), LEARNER, 5);
        assert_eq!(
            ledger.enter(&header(0, 1, 0, 5), LEARNER, 5),
            Entry::Duplicate
        );
        let expected = Totals {
            received: 3,
            duplicated: 1,
            ..Totals::default()
        };
        assert_eq!(ledger.totals(), expected);
    }

    #[test]
    fn old_weights_and_weights_of_another_learner_are_stale() {
        let mut ledger = Ledger::default();
        assert_eq!(ledger.enter(&header(0, 1, 0, 4), LEARNER, 5), Entry::Stale);
        assert_eq!(
            ledger.enter(&header(0, 1, 1, 9), LEARNER + 1, 5),
            Entry::Stale
        );
        assert_eq!(ledger.enter(&header(0, 1, 2, 5), LEARNER, 5), Entry::Fresh);
        assert_eq!(ledger.totals().stale, 2);
        assert_eq!(ledger.totals().dropped, 0);
    }

    #[test]
    fn a_new_life_of_an_actor_starts_its_own_page() {
        let mut ledger = Ledger::default();
        ledger.enter(&header(3, 100, 8, 5), LEARNER, 5);
        ledger.enter(&header(3, 200, 0, 5), LEARNER, 5);
        ledger.enter(&header(3, 200, 2, 5), LEARNER, 5);
        ledger.enter(&header(4, 100, 6, 5), LEARNER, 5);
        // First contact at 8 and at 6 is the base; only 200/1 is missing.
        assert_eq!(ledger.totals().dropped, 1);
        assert_eq!(ledger.totals_of(3).received, 3);
        assert_eq!(ledger.totals_of(4).received, 1);
        assert_eq!(ledger.restarts(), 1);
    }
}
