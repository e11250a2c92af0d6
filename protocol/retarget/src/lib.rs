//! From human motion capture to the G1: joint centres in, postures of the robot out.
//!
//! Separate because it is geometry that knows no format, and from the learner
//! because it happens once, before training. World frames have z up; lengths are in m, angles in
//! rad; everything after [`Capture::at_rate`] is at [`RATE`].
//!
//! The way of a capture: [`targets`] turns joint centres into what the robot shall do (directions of
//! its bones, orientation and place of its pelvis), `solver` finds joints for that frame by frame and
//! `path` smooths them over the clip, [`contact`] says when the human's feet stand, [`feet`] makes the
//! robot's feet stand there without slipping, `pelvis` carries the pelvis where standing legs are as
//! long as the human's knees have them, and `path` runs once more for the legs, now with the feet where
//! they must be. [`retarget`] is that recipe.
#![forbid(unsafe_code)]

mod account;
mod banded;
pub mod capture;
pub mod contact;
pub mod feet;
pub mod floor;
mod limb;
mod path;
mod pelvis;
pub mod posture;
pub mod recipe;
pub mod report;
pub mod signal;
mod sole;
pub mod solver;
pub mod targets;

#[cfg(test)]
mod puppet;

pub use capture::{Capture, LANDMARKS, Landmark, Landmarks, Side};
pub use floor::Floor;
pub use posture::Posture;
pub use recipe::retarget;
pub use report::Report;

/// Frames per second of what comes out: the policy's rate.
pub const RATE: f64 = 50.0;
