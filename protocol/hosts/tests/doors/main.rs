//! Both ends over a real socket: what gets in, what is turned away, and what it costs.

mod harness;
mod line;
mod strangers;
