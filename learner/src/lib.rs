//! The learner: gathers rollouts, pays them by style and task, improves policy and discriminator,
//! broadcasts the new weights.
//!
//! The mathematics lives in the pure crates below this folder; this shell carries rollouts in and
//! weights, reports and checkpoints out.

#![forbid(unsafe_code)]

mod config;
mod cores;
mod earned;
mod gait;
mod gathering;
mod guidance;
mod intake;
mod lines;
pub mod pages;
pub mod process;
mod record;
mod robot;
mod roster;
mod state;

pub use robot::robot;
