//! Rollouts in, a batch out: the only copy that a rollout ever sees.

use std::time::{Duration, Instant};

use amp::Batch;
use anyhow::{Result, bail};
use protocol::{Entry, Ledger, Rollout, RolloutLayout, RolloutSubscriber, Shutdown, TICK};
use run::Folder;
use run::journal::{self, Journal};
use tracing::{info, warn};

use crate::gathering::{self, Gathered, Gathering, Seat, TermMeans, copy};
use crate::roster::Roster;

/// How rollouts are asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    /// Every rollout from the newest weights, one of each member, in the members' order.
    pub(crate) lockstep: bool,
    /// Oldest weights accepted, in versions behind the newest.
    pub(crate) max_lag: u64,
    /// How long actors may stay silent before the batch goes on without them.
    pub(crate) patience: Duration,
    /// Sizes of every rollout.
    pub(crate) layout: RolloutLayout,
}

/// Waits for rollouts, checks them, copies them to their places.
pub(crate) struct Intake {
    rollouts: RolloutSubscriber,
    roster: Roster,
    ledger: Ledger,
    learner: u64,
    terms: Terms,
    /// Where actors show that they are alive.
    folder: Folder,
    journal: Journal,
    unused: Unused,
}

/// Rollouts that arrived in time and were not used all the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Unused {
    /// Their actor had answered already, as a restarted one does.
    pub(crate) surplus: u64,
    /// A number in them was none.
    pub(crate) unusable: u64,
}

impl Intake {
    pub(crate) fn new(
        rollouts: RolloutSubscriber,
        learner: u64,
        actors: usize,
        terms: Terms,
        folder: Folder,
        journal: Journal,
    ) -> Self {
        Self {
            rollouts,
            roster: Roster::launched(actors),
            ledger: Ledger::default(),
            learner,
            terms,
            folder,
            journal,
            unused: Unused::default(),
        }
    }

    /// Counts of rollouts that were dropped on their way, or came too late.
    pub(crate) fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Counts of rollouts that came in time and were not used.
    pub(crate) fn unused(&self) -> Unused {
        self.unused
    }

    /// The actors whose rollouts are awaited, in the order of their numbers.
    pub(crate) fn members(&self) -> impl Iterator<Item = u32> + '_ {
        self.roster.members()
    }

    /// Fills `batch` with rollouts that weights of `version` answer for.
    ///
    /// `None` if a stop was asked for and nobody lives who could still answer. Otherwise an iteration
    /// that has begun is brought to its end, because a checkpoint stands between two rollouts.
    pub(crate) fn gather(
        &mut self,
        version: u64,
        batch: &mut Batch,
        shutdown: &Shutdown,
    ) -> Result<Option<Gathered>> {
        let seats = self.seats();
        batch.resize(
            seats.len(),
            self.terms.layout.steps,
            self.terms.layout.environments,
        );
        let mut now = Gathering {
            version,
            batch,
            seats,
            gathered: Gathered::default(),
        };
        let mut since = Instant::now();
        let mut warned = false;
        while now.seats.iter().any(|seat| !seat.taken) {
            match self.rollouts.receive()? {
                Some(rollout) => {
                    self.take(&rollout, &mut now)?;
                    continue;
                }
                None => {
                    self.rollouts.wait(TICK)?;
                }
            }
            if shutdown.requested() && !self.can_still_be_filled(&now.seats) {
                return Ok(None);
            }
            if !self.terms.lockstep {
                self.dismiss_silent(&mut now);
            }
            if since.elapsed() < self.terms.patience {
                continue;
            }
            if now.seats.iter().any(|seat| seat.taken) {
                self.leave_empty_seats(&mut now);
            } else {
                if !warned {
                    warn!(
                        seconds = self.terms.patience.as_secs(),
                        "no actor answers; add one with `ampco actor`"
                    );
                    warned = true;
                }
                if shutdown.requested() {
                    return Ok(None);
                }
                since = Instant::now();
            }
        }
        now.gathered.actors = self.roster.len();
        now.gathered.terms = gathering::means(now.seats.iter().map(|seat| &seat.terms));
        now.gathered.average();
        Ok(Some(now.gathered))
    }

    /// Whether actors live that can fill the empty seats: all that are awaited in lock-step, else any.
    fn can_still_be_filled(&self, seats: &[Seat]) -> bool {
        let lives = |actor: u32| {
            let holder = self.folder.holder(&format!("actor-{actor}"));
            // Where that cannot be read, waiting has its deadline all the same.
            !matches!(holder, Ok(None))
        };
        if self.terms.lockstep && self.roster.len() > 0 {
            let mut awaited = seats.iter().filter(|seat| !seat.taken);
            awaited.all(|seat| seat.actor.is_some_and(lives))
        } else {
            self.roster.members().any(lives)
        }
    }

    /// One seat per rollout wanted: in lock-step an actor's own, else anybody's.
    fn seats(&self) -> Vec<Seat> {
        let free = |actor| Seat {
            actor,
            taken: false,
            terms: TermMeans::new(),
        };
        if self.roster.len() == 0 {
            return vec![free(None)];
        }
        self.roster
            .members()
            .map(|actor| free(self.terms.lockstep.then_some(actor)))
            .collect()
    }

    /// Copies a rollout that is wanted to its seat, and counts one that is not.
    fn take(&mut self, rollout: &Rollout, now: &mut Gathering<'_>) -> Result<()> {
        let header = *rollout.header();
        let lag = if self.terms.lockstep {
            0
        } else {
            self.terms.max_lag
        };
        let oldest = now.version.saturating_sub(lag);
        if rollout.layout() != self.terms.layout {
            let said = |layout: RolloutLayout| {
                format!(
                    "{} environments by {} steps",
                    layout.environments, layout.steps
                )
            };
            bail!(
                "actor {} sends {}, this run's configuration says {}; restart the group",
                header.actor,
                said(rollout.layout()),
                said(self.terms.layout)
            );
        }
        let entry = self.ledger.enter(&header, self.learner, oldest);
        // Overlapped, of many actors some always come too late: they live all the same, and the next
        // batch has a place for them.
        let counts =
            entry == Entry::Fresh || !self.terms.lockstep && header.learner == self.learner;
        let newcomer = counts && self.roster.join(header.actor);
        if newcomer {
            info!(actor = header.actor, "actor joined");
        }
        let fate = match entry {
            Entry::Fresh => self.seat(rollout, newcomer, now),
            Entry::Stale => "stale",
            Entry::Duplicate => "duplicate",
        };
        if fate != "used" {
            info!(
                actor = header.actor,
                version = header.policy_version,
                fate,
                "rollout not used"
            );
        }
        let key = (header.actor, header.incarnation, header.sequence);
        let (learner, iteration) = (self.learner, now.version + 1);
        self.journal
            .write(|| journal::Entry::Received(learner, iteration, key, fate.to_owned()));
        Ok(())
    }

    /// Copies a fresh rollout to its seat. Returns its fate.
    fn seat(&mut self, rollout: &Rollout, newcomer: bool, now: &mut Gathering<'_>) -> &'static str {
        let header = *rollout.header();
        let layout = self.terms.layout;
        let fits = |seat: &Seat| !seat.taken && seat.actor.is_none_or(|own| own == header.actor);
        let mut place = now.seats.iter().position(fits);
        let terms = header.terms();
        if let Some(flaw) = rollout.flaw().or(terms.as_ref().err().copied()) {
            warn!(
                actor = header.actor,
                field = flaw.field,
                row = flaw.row,
                value = flaw.value,
                "rollout refused: a number in it cannot be"
            );
            self.unused.unusable += 1;
            // It was the answer: there will be no other in this iteration.
            if let Some(place) = place {
                now.batch.remove_segment(place);
                now.seats.remove(place);
            }
            return "unusable";
        }
        if place.is_none() && newcomer {
            now.seats.push(Seat {
                actor: Some(header.actor),
                taken: false,
                terms: TermMeans::new(),
            });
            now.batch.add_segment(layout.steps, layout.environments);
            place = Some(now.seats.len() - 1);
        }
        let Some(place) = place else {
            self.unused.surplus += 1;
            return "surplus";
        };
        now.seats[place].taken = true;
        now.seats[place].terms = terms
            .into_iter()
            .flatten()
            .map(|(name, mean)| (name.to_owned(), f64::from(mean)))
            .collect();
        let began = Instant::now();
        copy(rollout, now.batch, place);
        now.gathered.copy_seconds += began.elapsed().as_secs_f64();
        now.gathered.count(&header, now.version);
        "used"
    }

    fn leave_empty_seats(&mut self, now: &mut Gathering<'_>) {
        let answered: Vec<u32> = now
            .seats
            .iter()
            .filter(|seat| seat.taken)
            .filter_map(|seat| seat.actor)
            .collect();
        if self.terms.lockstep {
            let gone = self.roster.dismiss_all_but(&answered);
            warn!(?gone, "actors are silent; the batch goes on without them");
        } else {
            warn!("actors are slow; the batch goes on with what came");
        }
        for place in (0..now.seats.len()).rev() {
            if !now.seats[place].taken {
                now.batch.remove_segment(place);
                now.seats.remove(place);
            }
        }
    }

    /// Overlapped, others fill the seats of actors that are gone, so their absence has to be looked for.
    /// Asked when no rollout waits: whoever lives has been heard then, also after this process stood
    /// still.
    fn dismiss_silent(&mut self, now: &mut Gathering<'_>) {
        let gone = self.roster.dismiss_silent_for(self.terms.patience);
        if gone.is_empty() {
            return;
        }
        warn!(?gone, "actors are silent; batches go on without them");
        for _ in gone {
            // One seat of the batch stays, for whoever comes.
            if now.seats.len() > 1
                && let Some(place) = now.seats.iter().rposition(|seat| !seat.taken)
            {
                now.batch.remove_segment(place);
                now.seats.remove(place);
            }
        }
    }
}
