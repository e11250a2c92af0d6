//! System tests: they spawn the real programs, talk to them as their peers do, and kill them.
//!
//! One binary, so that it links once. Nothing sleeps for luck: every wait is for something, and has
//! a deadline. Every test has a folder of its own, so runs never meet.

#![allow(missing_docs)]

mod bad_input;
mod begin;
mod circles;
mod config;
mod disk;
mod elastic;
mod faults;
mod features;
mod floors;
mod group;
mod harness;
mod hosts;
mod imports;
mod isolation;
mod licences;
mod outputs;
mod pair;
mod pictures;
mod pressure;
mod readme;
mod repeat;
mod resume;
mod schedule;
mod seen;
mod soak;
mod stages;
mod study;
mod transfer;
mod watch;
