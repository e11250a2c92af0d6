//! From human motion capture to the G1: joint centres in, postures of the robot out.
//!
//! Separate from reading files because it is geometry that knows no format, and from the learner
//! because it happens once, before training. World frames have z up; lengths are in m, angles in
//! rad; everything after [`Capture::at_rate`] is at [`RATE`].
//!
//! The way of a capture: [`targets`] turns joint centres into what the robot shall do (directions of
//! its bones, orientation and place of its pelvis), [`solver`] finds joints for that, [`contact`] says
//! when the human's feet stand, [`feet`] makes the robot's feet stand there without slipping, and
//! the solver runs once more, now with the feet where they must be. [`retarget`] is that recipe.
#![forbid(unsafe_code)]

pub mod capture;
pub mod contact;
pub mod feet;
pub mod recipe;
pub mod report;
pub mod signal;
pub mod solver;
pub mod targets;

#[cfg(test)]
mod puppet;

pub use capture::{Capture, LANDMARKS, Landmark, Landmarks, Side};
pub use recipe::{Posture, retarget};
pub use report::Report;

/// Frames per second of what comes out: the policy's rate.
pub const RATE: f64 = 50.0;
