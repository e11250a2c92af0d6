//! What a run is to be: presets by name or file, and the whole configuration that a preset and a few options make.

#![forbid(unsafe_code)]

pub mod presets;
pub mod resolve;
