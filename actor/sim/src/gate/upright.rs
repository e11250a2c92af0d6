//! Standing upright: the second factor of Eq. 14.

use crate::moment::{self, Moment};
use crate::terms::Term;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp};

/// g = max(0, −g_z), g_z of the unit gravity in the base frame: 1 upright, 0 lying   (Eq. 14)
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Upright {
    /// The power that it is raised to. Default 1, Eq. 14; 0 takes it away.
    pub weight: Ramp<f32>,
}

impl Default for Upright {
    fn default() -> Self {
        Self { weight: 1.0.into() }
    }
}

impl Term for Upright {
    fn weight(&self) -> &Ramp<f32> {
        &self.weight
    }

    fn value(&self, moment: &Moment<'_>) -> f32 {
        moment::uprightness(moment.state)
    }

    fn set(&mut self, samples: f64) {
        self.weight.set(samples);
    }

    fn validate(&self) -> Checked {
        Ok(())
    }
}
