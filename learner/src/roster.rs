//! Who is awaited: the actors whose rollouts make up the next batch.
//!
//! In lock-step a batch holds one rollout of every member, in the order of their numbers, so that
//! the same actors give the same batch whatever order their rollouts arrive in.

use std::collections::BTreeSet;

/// The actors that are expected to answer a broadcast.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Roster {
    members: BTreeSet<u32>,
}

impl Roster {
    /// The actors that a run is launched with: 0 to `actors - 1`.
    pub(crate) fn launched(actors: usize) -> Self {
        Self {
            members: (0..actors as u32).collect(),
        }
    }

    /// Members in the order of their numbers.
    pub(crate) fn members(&self) -> impl Iterator<Item = u32> + '_ {
        self.members.iter().copied()
    }

    /// How many rollouts make up a batch.
    pub(crate) fn len(&self) -> usize {
        self.members.len()
    }

    /// Takes in an actor that came by itself. False if it was a member already.
    pub(crate) fn join(&mut self, actor: u32) -> bool {
        self.members.insert(actor)
    }

    /// Keeps only those that answered; returns the ones that are gone.
    ///
    /// They become members again with their next rollout.
    pub(crate) fn dismiss_all_but(&mut self, answered: &[u32]) -> Vec<u32> {
        let gone = self
            .members()
            .filter(|actor| !answered.contains(actor))
            .collect();
        self.members = answered.iter().copied().collect();
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
        assert_eq!(roster, Roster::launched(3));
    }
}
