//! What simulation, learning and judging say alike, said once.
//!
//! Separate, and below all of them, because none may import another: a number that one writes into a rollout
//! has to mean the same where it is read.
//!
//! | subject | file |
//! | --- | --- |
//! | why an episode ended | [`cause`] |
//! | which robots explore calmly | [`mod@calm`] |
//! | a value that may move over the samples | [`ramp`] |
//! | why a value of the configuration is refused | [`invalid`] |
//! | a number that may be `null` in a file | [`number`] |
//! | what a section of the configuration is | [`section`] |
//! | which engine moves the robots | [`physics`] |
#![forbid(unsafe_code)]

pub mod calm;
pub mod cause;
pub mod invalid;
pub mod number;
pub mod physics;
pub mod ramp;
pub mod section;

pub use calm::{CALM, calm};
pub use cause::{Cause, Counts, RUNNING};
pub use invalid::{Checked, Invalid};
pub use physics::{Mechanics, Physics};
pub use ramp::Ramp;
pub use section::Section;
