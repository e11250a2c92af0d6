//! What configuration checks have in common: a bad field is told by name, value and remedy.
//!
//! Separate so that each config struct stands beside the code that reads it and still fails alike.

use crate::world::CONTROL_STEP;
use rand::{Rng, RngExt};

/// A configuration value that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{field} = {value} is not usable: {remedy}")]
pub struct Invalid {
    /// Path of the field inside its section.
    pub field: &'static str,
    /// The value, printed.
    pub value: String,
    /// What would be accepted.
    pub remedy: String,
}

/// Fails unless `value` holds.
pub(crate) fn require(
    holds: bool,
    field: &'static str,
    value: impl std::fmt::Debug,
    remedy: impl Into<String>,
) -> Result<(), Invalid> {
    if holds {
        return Ok(());
    }
    Err(Invalid {
        field,
        value: format!("{value:?}"),
        remedy: remedy.into(),
    })
}

/// A share lies in 0..=1.
pub(crate) fn share(field: &'static str, value: f32) -> Result<(), Invalid> {
    require(
        (0.0..=1.0).contains(&value),
        field,
        value,
        "give a share from 0 to 1",
    )
}

/// A number that is finite and no less than `least`.
pub(crate) fn at_least(field: &'static str, value: f32, least: f32) -> Result<(), Invalid> {
    let holds = value.is_finite() && value >= least;
    require(
        holds,
        field,
        value,
        format!("give a finite number from {least} on"),
    )
}

/// A range is finite and in order.
pub(crate) fn range(field: &'static str, value: [f32; 2]) -> Result<(), Invalid> {
    let holds = value.iter().all(|x| x.is_finite()) && value[0] <= value[1];
    require(
        holds,
        field,
        value,
        "give two finite numbers, the lesser first",
    )
}

/// Two numbers of samples between which something changes, in order.
pub(crate) fn way(field: &'static str, [from, to]: [f64; 2]) -> Result<(), Invalid> {
    require(
        from >= 0.0 && from <= to && to.is_finite(),
        field,
        (from, to),
        "give numbers of samples from 0 on, to_samples no less than from_samples",
    )
}

/// How far the way between two numbers of samples is gone, 0 to 1.
pub(crate) fn progress([from, to]: [f64; 2], samples: f64) -> f32 {
    if samples <= from {
        0.0
    } else if samples >= to {
        1.0
    } else {
        ((samples - from) / (to - from)) as f32
    }
}

/// A number of control steps for a duration drawn from a range of seconds; at least one.
pub(crate) fn steps(seconds: [f32; 2], rng: &mut impl Rng) -> u32 {
    let seconds = rng.random_range(seconds[0]..=seconds[1]);
    ((seconds / CONTROL_STEP).round() as u32).max(1)
}
