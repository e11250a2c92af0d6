//! Rollouts in, a batch out: the only copy that a rollout ever sees.

use std::time::{Duration, Instant};

use amp::Batch;
use anyhow::{Result, bail};
use protocol::{
    Entry, Ledger, Rollout, RolloutHeader, RolloutLayout, RolloutSubscriber, Shutdown, TICK,
};
use tracing::{info, warn};

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

/// What came together for one iteration. Seconds are means over the rollouts, but for `collect`,
/// which is the slowest's.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Gathered {
    pub(crate) rollouts: usize,
    pub(crate) actors: usize,
    /// Mean age of the weights that acted, in versions.
    pub(crate) policy_lag: f64,
    pub(crate) collect_seconds: f64,
    pub(crate) physics_seconds: f64,
    pub(crate) observation_seconds: f64,
    pub(crate) inference_seconds: f64,
    pub(crate) waiting_seconds: f64,
    /// Copying rollouts to their places, all together.
    pub(crate) copy_seconds: f64,
}

/// Waits for rollouts, checks them, copies them to their places.
pub(crate) struct Intake {
    rollouts: RolloutSubscriber,
    roster: Roster,
    ledger: Ledger,
    learner: u64,
    terms: Terms,
    /// Rollouts of an actor that had answered already, as a restarted one does.
    surplus: u64,
}

impl Intake {
    pub(crate) fn new(
        rollouts: RolloutSubscriber,
        learner: u64,
        actors: usize,
        terms: Terms,
    ) -> Self {
        Self {
            rollouts,
            roster: Roster::launched(actors),
            ledger: Ledger::default(),
            learner,
            terms,
            surplus: 0,
        }
    }

    /// Counts of rollouts that were dropped on their way, or came and were not used.
    pub(crate) fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// Rollouts not used because their actor had answered already.
    pub(crate) fn surplus(&self) -> u64 {
        self.surplus
    }

    /// Fills `batch` with rollouts that weights of `version` answer for.
    ///
    /// `None` if a stop was asked for while no actor answers. Otherwise an iteration that has begun
    /// is brought to its end, because a checkpoint stands between two rollouts.
    pub(crate) fn gather(
        &mut self,
        version: u64,
        batch: &mut Batch,
        shutdown: &Shutdown,
    ) -> Result<Option<Gathered>> {
        let mut seats = self.seats();
        batch.resize(
            seats.len(),
            self.terms.layout.steps,
            self.terms.layout.environments,
        );
        let mut gathered = Gathered::default();
        let mut since = Instant::now();
        let mut warned = false;
        while seats.iter().any(|seat| !seat.taken) {
            match self.rollouts.receive()? {
                Some(rollout) => {
                    self.seat(&rollout, version, batch, &mut seats, &mut gathered)?;
                    continue;
                }
                None => {
                    self.rollouts.wait(TICK)?;
                }
            }
            if since.elapsed() < self.terms.patience {
                continue;
            }
            if seats.iter().any(|seat| seat.taken) {
                self.leave_empty_seats(batch, &mut seats);
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
        gathered.actors = self.roster.len();
        gathered.average();
        Ok(Some(gathered))
    }

    /// One seat per rollout wanted: in lock-step an actor's own, else anybody's.
    fn seats(&self) -> Vec<Seat> {
        let free = |actor| Seat {
            actor,
            taken: false,
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
    fn seat(
        &mut self,
        rollout: &Rollout,
        version: u64,
        batch: &mut Batch,
        seats: &mut Vec<Seat>,
        gathered: &mut Gathered,
    ) -> Result<()> {
        let header = *rollout.header();
        let lag = if self.terms.lockstep {
            0
        } else {
            self.terms.max_lag
        };
        let oldest = version.saturating_sub(lag);
        if rollout.layout() != self.terms.layout {
            bail!(
                "actor {} sends {:?}, this run's configuration says {:?}; restart the group",
                header.actor,
                rollout.layout(),
                self.terms.layout
            );
        }
        match self.ledger.enter(&header, self.learner, oldest) {
            Entry::Fresh => {}
            refused => {
                info!(
                    actor = header.actor,
                    version = header.policy_version,
                    ?refused,
                    "rollout not used"
                );
                return Ok(());
            }
        }
        let newcomer = self.roster.join(header.actor);
        if newcomer {
            info!(actor = header.actor, "actor joined");
        }
        let fits = |seat: &Seat| !seat.taken && seat.actor.is_none_or(|own| own == header.actor);
        let place = match seats.iter().position(fits) {
            Some(place) => place,
            None if newcomer => {
                seats.push(Seat {
                    actor: Some(header.actor),
                    taken: false,
                });
                batch.add_segment(self.terms.layout.steps, self.terms.layout.environments);
                seats.len() - 1
            }
            None => {
                self.surplus += 1;
                info!(
                    actor = header.actor,
                    "rollout not used: its actor has answered already"
                );
                return Ok(());
            }
        };
        seats[place].taken = true;
        let began = Instant::now();
        copy(rollout, batch, place);
        gathered.copy_seconds += began.elapsed().as_secs_f64();
        gathered.count(&header, version);
        Ok(())
    }

    fn leave_empty_seats(&mut self, batch: &mut Batch, seats: &mut Vec<Seat>) {
        let answered: Vec<u32> = seats
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
        for place in (0..seats.len()).rev() {
            if !seats[place].taken {
                batch.remove_segment(place);
                seats.remove(place);
            }
        }
    }
}

/// A place in the batch.
#[derive(Clone, Copy, Debug)]
struct Seat {
    /// Whose it is; `None` is anybody's.
    actor: Option<u32>,
    taken: bool,
}

impl Gathered {
    fn count(&mut self, header: &RolloutHeader, version: u64) {
        self.rollouts += 1;
        self.policy_lag += version.saturating_sub(header.policy_version) as f64;
        self.collect_seconds = self.collect_seconds.max(f64::from(header.collect_seconds));
        self.physics_seconds += f64::from(header.physics_seconds);
        self.observation_seconds += f64::from(header.observation_seconds);
        self.inference_seconds += f64::from(header.inference_seconds);
        self.waiting_seconds += f64::from(header.waiting_seconds);
    }

    fn average(&mut self) {
        let rollouts = self.rollouts.max(1) as f64;
        self.policy_lag /= rollouts;
        self.physics_seconds /= rollouts;
        self.observation_seconds /= rollouts;
        self.inference_seconds /= rollouts;
        self.waiting_seconds /= rollouts;
    }
}

/// The one copy: every block of the rollout to its segment's rows.
fn copy(rollout: &Rollout, batch: &mut Batch, segment: usize) {
    let from = rollout.view();
    let to = batch.segment_mut(segment);
    to.observations.copy_from_slice(from.observations);
    to.actions.copy_from_slice(from.actions);
    to.means.copy_from_slice(from.means);
    to.log_probs.copy_from_slice(from.log_probs);
    to.task_rewards.copy_from_slice(from.task_rewards);
    to.energies.copy_from_slice(from.energies);
    to.tracking_errors.copy_from_slice(from.tracking_errors);
    to.ends.copy_from_slice(from.ends);
    to.episode_steps.copy_from_slice(from.episode_steps);
    to.features.copy_from_slice(from.features);
    to.next_features.copy_from_slice(from.next_features);
    to.foot_forces.copy_from_slice(from.foot_forces);
    to.last_observations.copy_from_slice(from.last_observations);
    to.timeout_observations
        .copy_from_slice(from.timeout_observations);
}
