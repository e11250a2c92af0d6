//! The way of rollouts from another machine, and where on it they went missing.
//!
//! Separate because between an actor there and the learner two more processes may end, each with rollouts in its hands:
//! the carrier, whose journal names each that was acknowledged, and the gate, whose journal names each that it has put
//! into the learner's stream. An end excuses what could be in those hands then, and only between the two rollouts
//! around it that got through.

use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};

use super::super::{Entry, Key};
use super::IN_FLIGHT;

/// Most rollouts of one actor that a carrier takes along when it ends: two in its buffer, one in its hands, one in its
/// queue, one on its way, one that is being sent to it.
const CARRIED: usize = 6;

/// What carriers and gates have written.
pub(super) struct Ways {
    carriers: Log,
    gates: Log,
    carried: BTreeSet<Key>,
    passed: BTreeSet<Key>,
}

/// Between which rollouts that got through one went missing, and how often a process ended there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    /// Between an actor and the learner of one machine.
    Here,
    /// In the learner's stream, which a gate had put it into.
    Stream(Window),
    /// Before that: with the carrier.
    Carrier(Window),
    /// The carrier was told that it had arrived, and no gate says so: nothing excuses that.
    Nowhere,
}

/// A stretch of a log.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Window {
    from: usize,
    to: usize,
    ends: usize,
}

impl Place {
    /// How many may have gone missing, of which `learners` at ends of the learner or of the actor.
    pub(super) fn room(self, learners: usize) -> usize {
        match self {
            Self::Here => learners,
            Self::Stream(window) => learners + window.ends * IN_FLIGHT,
            Self::Carrier(window) => window.ends * CARRIED,
            Self::Nowhere => 0,
        }
    }
}

impl Ways {
    pub(super) fn of(journals: &[Vec<Entry>]) -> Self {
        let (mut carriers, mut gates) = (Log::default(), Log::default());
        for (file, journal) in journals.iter().enumerate() {
            for entry in journal {
                match entry {
                    Entry::Carrying(actor) => carriers.begin(*actor, file),
                    Entry::Carried(key) => carriers.through(*key),
                    Entry::Passing(actor) => gates.begin(*actor, file),
                    Entry::Passed(key) => gates.through(*key),
                    Entry::Sending(_) | Entry::Sent(..) | Entry::Begun(..) => {}
                    Entry::Received(..) => {}
                }
            }
        }
        Self {
            carried: carriers.all(),
            passed: gates.all(),
            carriers,
            gates,
        }
    }

    /// Where a rollout that was sent and never received went missing; `received` knows those that were.
    pub(super) fn place(&self, key: Key, received: impl Fn(&Key) -> bool) -> Place {
        if self.passed.contains(&key) {
            Place::Stream(self.gates.around(key, received))
        } else if self.carried.contains(&key) {
            Place::Nowhere
        } else if self.carriers.0.contains_key(&key.0) {
            Place::Carrier(self.carriers.around(key, |_| true))
        } else {
            Place::Here
        }
    }
}

/// By actor, what was written in order.
#[derive(Default)]
struct Log(BTreeMap<u32, Vec<Mark>>);

enum Mark {
    /// A process begins; whether one of the same journal did before, whose end this tells.
    Begin { file: usize, again: bool },
    /// A rollout got through: the actor's life, the place in it.
    Through(u64, u64),
}

impl Log {
    fn begin(&mut self, actor: u32, file: usize) {
        let marks = self.0.entry(actor).or_default();
        let again = marks
            .iter()
            .any(|mark| matches!(mark, Mark::Begin { file: other, .. } if *other == file));
        marks.push(Mark::Begin { file, again });
    }

    fn through(&mut self, (actor, life, number): Key) {
        let marks = self.0.entry(actor).or_default();
        marks.push(Mark::Through(life, number));
    }

    fn all(&self) -> BTreeSet<Key> {
        let through = |(actor, marks): (&u32, &Vec<Mark>)| {
            let keys = marks.iter().filter_map(|mark| match mark {
                Mark::Through(life, number) => Some((*actor, *life, *number)),
                Mark::Begin { .. } => None,
            });
            keys.collect::<Vec<_>>()
        };
        self.0.iter().flat_map(through).collect()
    }

    /// Between the last before this one that got through, also farther on, and the first after it. Where nothing of
    /// this life follows, the actor or the last process has ended, too.
    fn around(&self, (actor, life, number): Key, farther: impl Fn(&Key) -> bool) -> Window {
        let marks = self.0.get(&actor).map_or(&[][..], Vec::as_slice);
        let through = |mark: &Mark| match mark {
            Mark::Through(life, number) if farther(&(actor, *life, *number)) => {
                Some((*life, *number))
            }
            Mark::Through(..) | Mark::Begin { .. } => None,
        };
        let is =
            |mark: &Mark, order| through(mark).is_some_and(|at| at.cmp(&(life, number)) == order);
        let last = marks.iter().rposition(|mark| is(mark, Ordering::Less));
        let next = marks.iter().position(|mark| is(mark, Ordering::Greater));
        let (from, to) = (last.unwrap_or(0), next.unwrap_or(marks.len()));
        let again = |mark: &&Mark| matches!(mark, Mark::Begin { again: true, .. });
        let begun = marks.get(from..to).unwrap_or_default().iter();
        let follows = next.and_then(|next| through(&marks[next]));
        let over = follows.is_none_or(|(other, _)| other != life);
        let ends = begun.filter(again).count() + usize::from(over);
        Window { from, to, ends }
    }
}
