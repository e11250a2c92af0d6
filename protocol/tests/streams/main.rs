//! The streams between nodes and between processes. One binary: its own copies are the other
//! processes.

mod harness;
mod life;
mod messages;
mod refusals;
