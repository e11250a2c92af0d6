//! The scheduler: listens to the learner's reward reports and publishes phase and weighting.
//!
//! It never sees a rollout. Everything that decides is in the pure crate `ampco`; this shell carries reports in and
//! directives out, and puts the schedule together again from the run's metrics whenever it has missed something.

#![forbid(unsafe_code)]

mod config;
mod desk;
mod history;
mod message;
pub mod process;
