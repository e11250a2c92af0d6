//! The account of a run: every rollout that was sent, and what it came to.

mod way;

use std::collections::{BTreeMap, BTreeSet};

use super::{Entry, Key};
use way::Ways;

/// Most rollouts of one actor that a dying process can take along unread: two in the learner's
/// buffer, one that it has taken out, one that is being sent.
const IN_FLIGHT: usize = 4;

/// What all rollouts came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Account {
    /// Rollouts that actors sent.
    pub sent: u64,
    /// Learned from, once, by what the run goes on from.
    pub used: u64,
    /// Not used, by reason: those of [`super::OUTCOMES`] and [`super::FATES`]; `unread` when learner, actor or one who
    /// passes rollouts on ended before it was read; `rolled_back` when it was learned from and the learner
    /// killed before its next checkpoint.
    pub dropped: BTreeMap<String, u64>,
    /// Learned from twice, or gone without any of these reasons.
    pub uncounted: u64,
}

/// What is known of one rollout.
#[derive(Debug, Default)]
struct Known {
    outcome: Option<String>,
    /// The learner's life, whether it lasts, and the fate, in order.
    fates: Vec<(usize, bool, String)>,
}

/// Puts the journals of all processes side by side.
pub fn account(journals: &[Vec<Entry>]) -> Account {
    let lives = Lives::of(journals);
    let mut rollouts: BTreeMap<Key, Known> = BTreeMap::new();
    let mut sent = BTreeSet::new();
    let ways = Ways::of(journals);
    for entry in journals.iter().flatten() {
        match entry {
            Entry::Sending(key) => {
                sent.insert(*key);
            }
            Entry::Sent(key, outcome) => {
                // A carrier that gives a rollout up knows more than the actor, whose stream had it.
                let known = &mut rollouts.entry(*key).or_default().outcome;
                if known.as_deref().is_none_or(|before| before == "delivered") {
                    *known = Some(outcome.clone());
                }
            }
            Entry::Received(learner, iteration, key, fate) => {
                let life = lives.number(*learner);
                let lasts = lives.lasts(life, *iteration);
                let known = rollouts.entry(*key).or_default();
                known.fates.push((life, lasts, fate.clone()));
            }
            Entry::Begun(..)
            | Entry::Carrying(_)
            | Entry::Carried(_)
            | Entry::Passing(_)
            | Entry::Passed(_) => {}
        }
    }
    let mut account = Account {
        sent: sent.len() as u64,
        ..Account::default()
    };
    // What was received and never sent cannot be: the line is written before the send.
    account.uncounted += rollouts.keys().filter(|key| !sent.contains(key)).count() as u64;
    // Those that went missing in the same place share what the ends there excuse.
    let mut unread: BTreeMap<(Gap, way::Place), usize> = BTreeMap::new();
    for key in &sent {
        match rollouts.get(key).and_then(Known::reason) {
            Some(Reason::Used) => account.used += 1,
            Some(Reason::Twice) => account.uncounted += 1,
            Some(Reason::Dropped(reason)) => account.drop(reason, 1),
            None => {
                let received = |key: &Key| rollouts.get(key).is_some_and(|k| !k.fates.is_empty());
                let place = (Gap::around(*key, &rollouts), ways.place(*key, received));
                *unread.entry(place).or_default() += 1;
            }
        }
    }
    for ((gap, place), count) in unread {
        let excused = count.min(place.room(gap.room(lives.0.len())));
        account.drop("unread", excused as u64);
        account.uncounted += (count - excused) as u64;
    }
    account
}

impl Account {
    fn drop(&mut self, reason: &str, count: u64) {
        if count > 0 {
            *self.dropped.entry(reason.to_owned()).or_default() += count;
        }
    }
}

enum Reason<'a> {
    Used,
    Twice,
    Dropped(&'a str),
}

impl Known {
    /// What it came to; `None` when it was sent and nobody has read it.
    fn reason(&self) -> Option<Reason<'_>> {
        let mut uses = self.fates.iter().filter(|(.., fate)| fate == "used");
        match (uses.next(), uses.next()) {
            (Some(_), Some(_)) => return Some(Reason::Twice),
            (Some((_, true, _)), None) => return Some(Reason::Used),
            (Some(_), None) => return Some(Reason::Dropped("rolled_back")),
            (None, _) => {}
        }
        if let Some((.., fate)) = self.fates.first() {
            return Some(Reason::Dropped(fate));
        }
        match self.outcome.as_deref() {
            None | Some("delivered") => None,
            Some(outcome) => Some(Reason::Dropped(outcome)),
        }
    }
}

/// The learners of a run, one after the other: number, and iterations done when it began.
struct Lives(Vec<(u64, u64)>);

impl Lives {
    fn of(journals: &[Vec<Entry>]) -> Self {
        let begun = journals.iter().flatten().filter_map(|entry| match entry {
            Entry::Begun(learner, iteration) => Some((*learner, *iteration)),
            _ => None,
        });
        Self(begun.collect())
    }

    fn number(&self, learner: u64) -> usize {
        let found = self.0.iter().position(|(number, _)| *number == learner);
        found.unwrap_or(0)
    }

    /// Whether what a life did in an iteration was there when all later ones began.
    fn lasts(&self, life: usize, iteration: u64) -> bool {
        self.0
            .iter()
            .skip(life + 1)
            .all(|(_, begun)| *begun >= iteration)
    }
}

/// Where rollouts went missing: an actor's life, and between which learners' lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Gap {
    actor: u32,
    life: u64,
    before: Option<usize>,
    after: Option<usize>,
}

impl Gap {
    fn around(key: Key, rollouts: &BTreeMap<Key, Known>) -> Self {
        let (actor, life, _) = key;
        let learner = |known: &Known| known.fates.first().map(|(life, ..)| *life);
        Self {
            actor,
            life,
            before: rollouts
                .range((actor, life, 0)..key)
                .rev()
                .find_map(|(_, known)| learner(known)),
            after: rollouts
                .range(key..=(actor, life, u64::MAX))
                .find_map(|(_, known)| learner(known)),
        }
    }

    /// How many may have been lost in it: what was under way at each end of a learner in between, or
    /// at the actor's own. Within one learner's life a stream loses nothing.
    fn room(&self, lives: usize) -> usize {
        let from = self.before.unwrap_or(0);
        let ends = match self.after {
            Some(after) => after.saturating_sub(from),
            None => lives.saturating_sub(from).max(1),
        };
        ends * IN_FLIGHT
    }
}

#[cfg(test)]
mod tests;
