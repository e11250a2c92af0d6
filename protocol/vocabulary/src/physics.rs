//! The engines that can move the robots.
//!
//! Here because a run's configuration names one, simulation has them, and reports say which it was.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which engine moves the robots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Physics {
    /// rapier: a world per robot. The judge of every result.
    #[default]
    Rapier,
    /// The solver for this one robot that steps sixteen per instruction.
    Batched,
}
