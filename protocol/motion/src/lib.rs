//! Reference motion of the G1: what the discriminator takes for human.
//!
//! Separate from learning because it is data and geometry only. Clips come from the built-in
//! generator ([`gait`]: no file, no download) or from files ([`import`]: motion capture and other
//! robots' tables); both become states at 50 Hz ([`Clip`]) in a [`Dataset`] that is drawn from.
//! [`quality`] measures them, [`export`] writes them.
#![forbid(unsafe_code)]

pub mod clip;
pub mod config;
pub mod dataset;
pub mod error;
pub mod export;
pub mod gait;
pub mod import;
pub mod quality;
pub mod strata;
mod velocity;

pub use clip::{Clip, FRAME_SECONDS};
pub use config::{ClipConfig, Draw, Gait, MotionConfig, QuaternionOrder};
pub use dataset::Dataset;
pub use error::MotionError;
pub use quality::Quality;
