//! The actor: simulates a fleet of robots, lets the newest policy act, publishes what happened.
//!
//! An actor knows no phase and no weight: it ships task rewards and features, the learner blends.
//! Everything that decides lives in the pure crates below this folder; this shell carries.

#![forbid(unsafe_code)]

pub mod collect;
pub mod config;
pub mod process;
mod worker;
