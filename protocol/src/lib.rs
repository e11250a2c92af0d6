//! What the processes of a run say to each other. The only crate that knows iceoryx2.
//!
//! Four streams in shared memory, each with an event that wakes its readers:
//!
//! ```text
//!   actor 0 ─┐                                            one f32 block per rollout,
//!   actor 1 ─┼── rollouts ──────▶ learner                 written and read in place;
//!   actor n ─┘   (overflow off)   │  ▲  │                 a full buffer holds the actor up
//!      ▲                          │  │  │
//!      └───────── weights ◀───────┘  │  └── rewards ──▶ scheduler     every report counts,
//!           (newest wins,            │      (depth 64)  │            gaps are seen
//!            kept for late actors)   │                  │
//!                                    └── directives ◀───┘            newest wins, kept
//! ```
//!
//! | stream | writer | readers | type |
//! | --- | --- | --- | --- |
//! | rollouts | actors | learner (exactly one) | [`RolloutPublisher`], [`RolloutSubscriber`] |
//! | weights | learner (exactly one) | actors, monitors | [`WeightsPublisher`], [`WeightsSubscriber`] |
//! | rewards | learner (exactly one) | scheduler, monitors | [`RewardPublisher`], [`RewardSubscriber`] |
//! | directives | scheduler (exactly one) | learner, monitors | [`DirectivePublisher`], [`DirectiveSubscriber`] |
//!
//! A process joins the [`Domain`] of its run as a [`Node`] and opens its ends; any start order
//! works, and any process may die and come back. Unsafe code lives in this crate alone.

mod directive;
mod domain;
mod error;
mod port;
mod presence;
mod reward;
mod rollout;
mod room;
mod service;
mod shutdown;
mod stream;
mod watch;
mod weights;

pub use directive::{Answer, Directive, DirectivePublisher, DirectiveSubscriber};
pub use domain::{Domain, DomainError, Member, PROTOCOL_VERSION};
pub use error::PortError;
pub use port::{SendOutcome, Wake};
pub use presence::{Node, TICK};
pub use reward::{RewardArrival, RewardPublisher, RewardReport, RewardSubscriber};
pub use rollout::{
    Entry, Flaw, Ledger, Lists, MAX_NAME, MAX_TERMS, Rollout, RolloutHeader, RolloutLayout,
    RolloutLoan, RolloutPublisher, RolloutStep, RolloutStepMut, RolloutSubscriber, RolloutView,
    RolloutViewMut, SendTotals, SentPrint, TermMean, Totals,
};
pub use shutdown::{PresenceError, SUPERVISOR_VARIABLE, Shutdown, end_with_supervisor};
pub use stream::MAX_ACTORS;
pub use weights::{
    MAX_HIDDEN_LAYERS, Weights, WeightsHeader, WeightsOrder, WeightsPublisher, WeightsSubscriber,
};

/// Bytes of shared memory that a run reserves: every actor's rollouts, the weights, and the small
/// segments of reports, directives and connections.
pub fn reserved_bytes(actors: usize, layout: RolloutLayout, weights: usize) -> u64 {
    let rollouts = port::reserved_bytes::<rollout::Rollouts>(layout.len());
    let small = port::reserved_bytes::<reward::Rewards>(1)
        + port::reserved_bytes::<directive::Directives>(1)
        + room::MARGIN;
    actors as u64 * rollouts + port::reserved_bytes::<weights::WeightsStream>(weights) + small
}
