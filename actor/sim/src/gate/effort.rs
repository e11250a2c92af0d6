//! Sparing work: nothing in Eq. 14 asks for less energy.

use crate::moment::Moment;
use crate::terms::Term;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp};

/// g = exp(−w·E), E the positive mechanical work of the step, J, and w the weight, 1/J
///
/// Walking at 1 m/s takes 2 to 3 J a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Effort {
    /// What a joule costs, 1/J. Default 0.01.
    pub weight: Ramp<f32>,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            weight: 0.01.into(),
        }
    }
}

impl Term for Effort {
    fn weight(&self) -> &Ramp<f32> {
        &self.weight
    }

    fn value(&self, moment: &Moment<'_>) -> f32 {
        (-moment.work).exp()
    }

    // (e^−E)^w in one step: of a violent one the first alone would be 0.
    fn raised(&self, moment: &Moment<'_>, weight: f32) -> f32 {
        (-weight * moment.work).exp()
    }

    fn set(&mut self, samples: f64) {
        self.weight.set(samples);
    }

    fn validate(&self) -> Checked {
        Ok(())
    }
}
