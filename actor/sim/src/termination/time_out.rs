//! Time-outs: an episode is cut for its length.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, invalid};

/// When the time is up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TimeOutConfig {
    /// Control steps in an episode. Default 1000, the 20 s of III-F.
    pub steps: u32,
    /// Let the first episodes begin at different ages, so that time-outs do not come all at once.
    /// Default true.
    pub staggered: bool,
}

impl Default for TimeOutConfig {
    fn default() -> Self {
        Self {
            steps: 1_000,
            staggered: true,
        }
    }
}

impl TimeOutConfig {
    /// Checks every parameter; names the first bad one.
    pub(crate) fn validate(&self) -> Checked {
        invalid::require(self.steps > 0, "steps", self.steps, "give at least 1")
    }
}
