//! What simulation, learning and judging say alike, said once.
//!
//! Separate, and below all of them, because none may import another: a number that one writes into a rollout
//! has to mean the same to whoever reads it.
//!
//! | subject | file |
//! | --- | --- |
//! | why an episode ended | [`cause`] |
#![forbid(unsafe_code)]

pub mod cause;

pub use cause::{Cause, Counts, RUNNING};
