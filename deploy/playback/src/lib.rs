//! Recorded motion: what a robot did, frame by frame, and a page that plays it.
//!
//! Separate, and pure, because a policy in simulation and a clip of reference motion are watched in the same way, and
//! because watching must not cost training anything: no window, no graphics library, only text.
//!
//! | subject | file |
//! | --- | --- |
//! | frames and what is said about them | [`recording`] |
//! | one self-contained HTML page | [`page`], its parts in `page/` |
#![forbid(unsafe_code)]

pub mod page;
pub mod recording;

pub use recording::{Frame, Recording};
