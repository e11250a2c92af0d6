//! What the hosts of a run say to each other: gRPC over mutual TLS. The only crate that knows tonic.
//!
//! ```text
//!   another machine                                       the learner's machine
//!   actors ─ shared memory ─ carrier ══ Line ═══ wire ═══ Desk ══ gate ─ shared memory ─ learner
//!                                     Deliver: a rollout ───▶ taken, or "again"
//!                                     Newest:  "other than these" ───▶ weights, when there are some
//! ```
//!
//! | call | what | who answers when |
//! | --- | --- | --- |
//! | `Join` | version, processor and actors of a host | at once, with configuration and numbers of actors |
//! | `Motion` | a piece of a motion file, by its hash | at once |
//! | `Newest` | the weights that the host has | when the learner has others, or after some seconds |
//! | `Deliver` | one rollout of one actor | when the learner's buffer has it: the answer is the acknowledgement |
//! | `Attach`, `Fetch` | an actor's robots of a checkpoint | at once |
//! | `Leave` | actors that are gone | at once |
//!
//! Every call is unary and may be made again: of each actor one rollout is on its way, the answer to it is waited for
//! before the next is sent, and the learner's ledger tells a repeated one from a new one. So order is kept also over
//! connections that break. What a stranger may cost is bounded by [`Limits`].

#![forbid(unsafe_code)]

mod desk;
mod doors;
mod lean;
mod line;
mod messages;
mod passes;
mod processor;
mod sent;

pub use desk::{Answer, Desk, Said};
pub use doors::{Doors, Limits};
pub use lean::{Lean, LeanError};
pub use line::{CallError, Line, LineFigures};
pub use messages::{
    Attached, Delivered, Delivery, Figures, Join, Joined, Leave, MotionFile, Newest, Piece,
    PieceWanted, Robots, RobotsWanted, Wanted,
};
pub use passes::{Pass, PassError, Passes};
pub use processor::features;
pub use sent::{SentError, flat_of, rollout_of, sent_flat, sent_rollout, sent_weights, weights_of};

/// Version of everything that crosses from host to host. Hosts of other versions are refused, and so are those whose
/// [`protocol::PROTOCOL_VERSION`] is another.
pub const VERSION: u32 = 1;

/// Most bytes of a piece of a file.
pub const PIECE: usize = 1 << 20;
