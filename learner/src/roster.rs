//! Who is awaited: the actors whose rollouts make up the next batch.
//!
//! In lock-step a batch holds one rollout of every member, in the order of their numbers, so that
//! the same actors give the same batch whatever order their rollouts arrive in.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// The actors that are expected to answer a broadcast, and when each was last heard.
#[derive(Clone, Debug, Default)]
pub(crate) struct Roster {
    members: BTreeMap<u32, Instant>,
}

impl Roster {
    /// The actors that a run is launched with: 0 to `actors - 1`.
    pub(crate) fn launched(actors: usize) -> Self {
        Self {
            members: (0..actors as u32)
                .map(|actor| (actor, Instant::now()))
                .collect(),
        }
    }

    /// Members in the order of their numbers.
    pub(crate) fn members(&self) -> impl Iterator<Item = u32> + '_ {
        self.members.keys().copied()
    }

    /// How many rollouts make up a batch.
    pub(crate) fn len(&self) -> usize {
        self.members.len()
    }

    /// Hears an actor, and takes it in if it came by itself. False if it was a member already.
    pub(crate) fn join(&mut self, actor: u32) -> bool {
        self.members.insert(actor, Instant::now()).is_none()
    }

    /// Drops those that were not heard for as long as `patience`; returns them.
    pub(crate) fn dismiss_silent_for(&mut self, patience: Duration) -> Vec<u32> {
        let mut gone = Vec::new();
        self.members.retain(|actor, heard| {
            let silent = heard.elapsed() >= patience;
            if silent {
                gone.push(*actor);
            }
            !silent
        });
        gone
    }

    /// Keeps only those that answered; returns the ones that are gone.
    ///
    /// They become members again with their next rollout.
    pub(crate) fn dismiss_all_but(&mut self, answered: &[u32]) -> Vec<u32> {
        let gone = self
            .members()
            .filter(|actor| !answered.contains(actor))
            .collect();
        self.members.retain(|actor, _| answered.contains(actor));
        gone
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_ordered_by_number_not_by_arrival() {
        let mut roster = Roster::default();
        assert!(roster.join(7));
        assert!(roster.join(2));
        assert!(!roster.join(7));
        assert_eq!(roster.members().collect::<Vec<_>>(), [2, 7]);
    }

    #[test]
    fn the_silent_are_dismissed_and_may_return() {
        let mut roster = Roster::launched(3);
        assert_eq!(roster.dismiss_all_but(&[0, 2]), [1]);
        assert_eq!(roster.len(), 2);
        assert!(roster.join(1));
        assert_eq!(roster.members().collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn who_was_heard_lately_stays() {
        let mut roster = Roster::launched(2);
        assert!(
            roster
                .dismiss_silent_for(Duration::from_secs(3600))
                .is_empty()
        );
        assert_eq!(roster.dismiss_silent_for(Duration::ZERO), [0, 1]);
        assert_eq!(roster.len(), 0);
    }
}
