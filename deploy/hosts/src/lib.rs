//! Actors on other machines: the gate beside the learner, the carrier beside the actors.
//!
//! ```text
//!   ampco join ─ starts ─▶ carrier, actors           ampco train --listen ─ starts ─▶ gate, learner, scheduler
//!                            actors ═ carrier ══ hosts' line ══ gate ═ learner
//! ```
//!
//! The carrier stands in for the learner on its machine and the gate for the actors on theirs, so that neither actors
//! nor learner know of hosts. What the two say to each other is in [`hosts`].

#![forbid(unsafe_code)]

pub mod carrier;
pub mod gate;
pub mod join;
pub mod known;

mod local;
mod stay;

pub use join::JoinRun;
