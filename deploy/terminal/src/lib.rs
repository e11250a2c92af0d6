//! What the commands of `ampco` have in common with whoever types them: the options that name runs, files and engines,
//! the lines that are shown, the figures of a run in words, the exit status.
//!
//! Separate from the commands because each is a crate of its own, and all are to say the same things alike.

#![forbid(unsafe_code)]

pub mod console;
mod engine;
pub mod failure;
pub mod figures;
pub mod file;
mod place;

pub use engine::{Engine, SelfCollision};
pub use place::Place;
