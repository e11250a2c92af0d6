//! Numbers of a JSON file that may not be finite.
//!
//! JSON has no NaN and no infinity; serde writes `null` for them, and refuses it where a number is read.

use serde::{Deserialize, Deserializer};

/// What is not there: NaN. For `#[serde(default = …)]`.
pub fn unknown() -> f64 {
    f64::NAN
}

/// A number, or NaN where the file says `null`. For `#[serde(deserialize_with = …)]`.
pub fn or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or_else(unknown))
}
