//! The supervisor with a group of stand-ins: shell scripts that die, disobey and refuse on request,
//! which the real programs do not. The real group is tried by the system tests.

mod beginning;
mod deaths;
mod ending;
mod stage;
