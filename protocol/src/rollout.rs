//! Rollouts: what an actor collected in T control steps of N environments.
//!
//! Separate because its memory layout is shared by the actor, which writes it in place step by
//! step, and the learner, which reads it in place.

mod layout;
mod ledger;
mod lists;
mod terms;

use std::fmt;
use std::time::{Duration, Instant};

use iceoryx2::prelude::ZeroCopySend;

pub use layout::{Flaw, RolloutLayout, RolloutStep, RolloutStepMut, RolloutView, RolloutViewMut};
pub use ledger::{Entry, Ledger, Totals};
pub use lists::{Lists, SentPrint};
pub use terms::{MAX_NAME, MAX_TERMS, TermMean};

use crate::error::PortError;
use crate::port::{Loan, Publisher, Received, SendOutcome, Subscriber, Wake};
use crate::presence::Node;
use crate::stream::{self, Spec, Stream};

/// Who collected a rollout, under which policy, and how long it took.
///
/// `actor`, `environments`, `steps`, `incarnation`, `sequence` and `lists` are filled by
/// [`RolloutPublisher::send`]; the caller gives the rest.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, ZeroCopySend)]
#[type_name("ampco.RolloutHeader")]
pub struct RolloutHeader {
    /// Index of the actor, from 0.
    pub actor: u32,
    /// N, environments.
    pub environments: u32,
    /// T, control steps.
    pub steps: u32,
    /// Wall-clock seconds spent in rewards, resets and observations.
    pub observation_seconds: f32,
    /// Life of the actor, see [`Node::incarnation`].
    pub incarnation: u64,
    /// Rollouts that this life tried to send before this one, the lost ones included.
    pub sequence: u64,
    /// Incarnation of the learner whose weights were used.
    pub learner: u64,
    /// Version of those weights: iterations done.
    pub policy_version: u64,
    /// Wall-clock seconds spent in physics.
    pub physics_seconds: f32,
    /// Wall-clock seconds spent in policy inference.
    pub inference_seconds: f32,
    /// Wall-clock seconds spent waiting, for weights and for room, since the rollout before.
    pub waiting_seconds: f32,
    /// Wall-clock seconds from the first to the last step.
    pub collect_seconds: f32,
    /// Means of the task's terms over all steps; read them with [`Self::terms`].
    pub terms: [TermMean; MAX_TERMS],
    /// What the rows hold.
    pub lists: SentPrint,
}

impl RolloutHeader {
    /// Name and mean of every term of the task that the actor looked at.
    ///
    /// # Errors
    /// The first that no sound actor sends.
    pub fn terms(&self) -> Result<Vec<(&str, f32)>, Flaw> {
        terms::read(&self.terms)
    }

    /// Sizes, if a message of `numbers` numbers has them and its rows hold what `lists` say.
    pub fn layout(&self, lists: Lists, numbers: usize) -> Result<RolloutLayout, PortError> {
        if let Some(difference) = self.lists.difference(&lists) {
            return Err(PortError::Lists {
                actor: self.actor,
                difference,
            });
        }
        let layout = RolloutLayout {
            environments: self.environments as usize,
            steps: self.steps as usize,
            lists,
        };
        match layout.checked_len() {
            Some(expected) if expected == numbers && numbers > 0 => Ok(layout),
            expected => Err(PortError::Length {
                stream: Rollouts::SPEC.name,
                expected: expected.unwrap_or(usize::MAX),
                got: numbers,
            }),
        }
    }
}

/// The stream of rollouts.
#[derive(Debug)]
pub(crate) enum Rollouts {}

impl Stream for Rollouts {
    type Item = f32;
    type Header = RolloutHeader;
    const SPEC: Spec = stream::ROLLOUTS;
}

/// An actor's end.
pub struct RolloutPublisher {
    port: Publisher<Rollouts>,
    layout: RolloutLayout,
    actor: u32,
    incarnation: u64,
    sequence: u64,
    totals: SendTotals,
    waited: Duration,
}

/// What became of the rollouts of one [`RolloutPublisher`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SendTotals {
    /// Taken by a learner's buffer.
    pub delivered: u64,
    /// Sent while nobody listened.
    pub lost: u64,
    /// Given up because the learner's buffer stayed full, or this process was asked to stop.
    pub dropped: u64,
}

impl fmt::Debug for RolloutPublisher {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("RolloutPublisher")
            .field("actor", &self.actor)
            .field("layout", &self.layout)
            .field("totals", &self.totals)
            .finish_non_exhaustive()
    }
}

impl RolloutPublisher {
    /// Opens the stream for actor `actor` and reserves memory for its messages.
    ///
    /// A send that finds the learner's buffer full waits for at most `patience`.
    pub fn new(
        node: &Node,
        actor: u32,
        layout: RolloutLayout,
        patience: Duration,
    ) -> Result<Self, PortError> {
        Ok(Self {
            port: Publisher::open(node, layout.len(), patience)?,
            layout,
            actor,
            incarnation: node.incarnation(),
            sequence: 0,
            totals: SendTotals::default(),
            waited: Duration::ZERO,
        })
    }

    /// Shared memory for one rollout, to be filled over many steps and then sent. Two loans may
    /// exist at a time. Its numbers are those of an earlier rollout until they are written.
    pub fn loan(&self) -> Result<RolloutLoan, PortError> {
        let sample = self.port.loan(self.layout.len())?;
        let layout = self.layout;
        Ok(RolloutLoan { sample, layout })
    }

    /// Sends a filled loan.
    ///
    /// A full buffer is waited for (until the patience ends or the process should stop); whatever
    /// the outcome, the loan is gone and the sequence number used, so the learner sees the gap.
    pub fn send(
        &mut self,
        mut loan: RolloutLoan,
        header: RolloutHeader,
    ) -> Result<SendOutcome, PortError> {
        *loan.sample.user_header_mut() = RolloutHeader {
            actor: self.actor,
            environments: self.layout.environments as u32,
            steps: self.layout.steps as u32,
            incarnation: self.incarnation,
            sequence: self.sequence,
            lists: self.layout.lists.into(),
            ..header
        };
        self.sequence += 1;
        let start = Instant::now();
        let outcome = self.port.send(loan.sample)?;
        self.waited = start.elapsed();
        match outcome {
            SendOutcome::Delivered => self.totals.delivered += 1,
            SendOutcome::Lost => self.totals.lost += 1,
            SendOutcome::Dropped | SendOutcome::Interrupted => self.totals.dropped += 1,
        }
        if outcome != SendOutcome::Delivered {
            tracing::warn!(actor = self.actor, sequence = self.sequence - 1, ?outcome, totals = ?self.totals, "rollout not delivered");
        }
        Ok(outcome)
    }

    /// Sends a filled loan for another: who collected it, in which life and under which number stay as `header` says,
    /// so that the learner sees the actor and its gaps, and not who carried the rollout here.
    ///
    /// # Errors
    /// [`PortError::Length`] where the header is of another actor or of other sizes than this end was opened for,
    /// [`PortError::Lists`] where its rows hold something else.
    pub fn forward(
        &mut self,
        mut loan: RolloutLoan,
        header: RolloutHeader,
    ) -> Result<SendOutcome, PortError> {
        let layout = header.layout(self.layout.lists, self.layout.len())?;
        if layout != self.layout || header.actor != self.actor {
            return Err(PortError::Length {
                stream: Rollouts::SPEC.name,
                expected: self.layout.len(),
                got: layout.len(),
            });
        }
        *loan.sample.user_header_mut() = header;
        let start = Instant::now();
        let outcome = self.port.send(loan.sample)?;
        self.waited = start.elapsed();
        if outcome == SendOutcome::Delivered {
            self.totals.delivered += 1;
        }
        Ok(outcome)
    }

    /// Sizes of the rollouts.
    pub fn layout(&self) -> RolloutLayout {
        self.layout
    }

    /// Actor, life and number of the next rollout that is sent.
    pub fn key(&self) -> (u32, u64, u64) {
        (self.actor, self.incarnation, self.sequence)
    }

    /// What became of the rollouts so far.
    pub fn totals(&self) -> SendTotals {
        self.totals
    }

    /// Time that the last send took, mostly waiting for room.
    pub fn waited(&self) -> Duration {
        self.waited
    }
}

/// A rollout being written in shared memory. Dropping it gives the memory back unsent.
pub struct RolloutLoan {
    sample: Loan<Rollouts>,
    layout: RolloutLayout,
}

impl fmt::Debug for RolloutLoan {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("RolloutLoan")
            .field("layout", &self.layout)
            .finish_non_exhaustive()
    }
}

impl RolloutLoan {
    /// All fields, to be written; [`RolloutViewMut::step`] gives those of one step.
    pub fn view_mut(&mut self) -> RolloutViewMut<'_> {
        self.layout.view_mut(self.sample.payload_mut())
    }

    /// The whole block, [`RolloutLayout::len`] numbers, to be written.
    pub fn numbers_mut(&mut self) -> &mut [f32] {
        self.sample.payload_mut()
    }
}

/// The learner's end. There is one per run.
#[derive(Debug)]
pub struct RolloutSubscriber {
    port: Subscriber<Rollouts>,
    lists: Lists,
}

impl RolloutSubscriber {
    /// Opens the stream for rows that hold what `lists` say; fails with [`PortError::Taken`] while another learner
    /// lives.
    pub fn new(node: &Node, lists: Lists) -> Result<Self, PortError> {
        let port = Subscriber::open(node)?;
        Ok(Self { port, lists })
    }

    /// The next rollout, if there is one; one of other lists is an error ([`PortError::Lists`]). Of each actor two may be held at a time: copy and drop.
    pub fn receive(&self) -> Result<Option<Rollout>, PortError> {
        let Some(sample) = self.port.receive()? else {
            return Ok(None);
        };
        let header = sample.user_header();
        let layout = header.layout(self.lists, sample.payload().len())?;
        Ok(Some(Rollout { sample, layout }))
    }

    /// Sleeps until a rollout was sent, `timeout` is over, or this process should stop; ticks.
    pub fn wait(&self, timeout: Duration) -> Result<Wake, PortError> {
        self.port.wait(timeout)
    }
}

/// A rollout being read in shared memory. Dropping it makes room for the actor.
pub struct Rollout {
    sample: Received<Rollouts>,
    layout: RolloutLayout,
}

impl fmt::Debug for Rollout {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Rollout")
            .field("header", self.header())
            .finish_non_exhaustive()
    }
}

impl Rollout {
    /// Who collected it, and under which policy.
    pub fn header(&self) -> &RolloutHeader {
        self.sample.user_header()
    }

    /// Sizes.
    pub fn layout(&self) -> RolloutLayout {
        self.layout
    }

    /// All fields.
    pub fn view(&self) -> RolloutView<'_> {
        self.layout.view(self.sample.payload())
    }

    /// The first number that cannot be, if there is one.
    pub fn flaw(&self) -> Option<Flaw> {
        self.view().flaw()
    }

    /// The whole block, [`RolloutLayout::len`] numbers.
    pub fn numbers(&self) -> &[f32] {
        self.sample.payload()
    }
}
