//! What a run is to be: presets by name or file, the whole configuration that a preset and a few options make, and what
//! each of its keys is for.

#![forbid(unsafe_code)]

pub mod keys;
pub mod presets;
pub mod resolve;
