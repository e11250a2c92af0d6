//! The engines that can move the robots, and what may touch in them.
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

/// An engine, and what may touch in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mechanics {
    /// What moves the robots.
    pub physics: Physics,
    /// Whether a robot's limbs and trunk meet each other; they pass through each other otherwise.
    pub self_collision: bool,
}

impl From<Physics> for Mechanics {
    /// Parts meet, as those of a robot do.
    fn from(physics: Physics) -> Self {
        Self {
            physics,
            self_collision: true,
        }
    }
}
