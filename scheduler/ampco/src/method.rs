//! The methods that the paper compares, each a short composition: a rule for phase I and what follows convergence.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Rule, Weights};

/// A method of the comparison (III-D) or of the ablation (III-E), as a preset names it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Method {
    /// AMP: constant weights. The paper compares wˢ of 0.5, 0.7 and 0.8.
    Amp {
        /// wˢ in \[0, 1\].
        style_weight: f32,
    },
    /// AdaMimic: the task weight follows the task reward.
    #[serde(rename = "adamimic")]
    AdaMimic,
    /// AMP + ROGER: Eq. 12 from the first iteration, with bounds given by hand.
    AmpRoger {
        /// μ lower.
        lower: f32,
        /// μ upper > μ lower.
        upper: f32,
    },
    /// The paper's method: guidance, then bounds found at convergence.
    Ampco,
    /// Ablation without Adaptive Imitation Guidance: equal constant weights in phase I.
    AmpcoWithoutAig,
    /// Ablation without the constrained weighting: convergence is found, and the guidance goes on.
    AmpcoWithoutRoger,
}

/// What a method does once the style reward has converged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AfterConvergence {
    /// It has one phase; the breakout rate is only measured.
    Nothing,
    /// Phase II begins and keeps the rule of phase I.
    SameRule,
    /// Phase II begins with Eq. 12 inside the bounds of Eq. 13.
    Bounded,
}

impl Method {
    /// Rule of phase I, given R* of the style and of the task reward.
    pub fn first_rule(&self, style_ceiling: f32, task_ceiling: f32) -> Rule {
        match *self {
            Self::Amp { style_weight } => Rule::Fixed { style_weight },
            Self::AdaMimic => Rule::AdaMimic {
                ceiling: task_ceiling,
            },
            Self::AmpRoger { lower, upper } => Rule::Bounded { lower, upper },
            Self::Ampco | Self::AmpcoWithoutRoger => Rule::Guided {
                ceiling: style_ceiling,
            },
            Self::AmpcoWithoutAig => Rule::Fixed {
                style_weight: Weights::EQUAL.style(),
            },
        }
    }

    /// What follows convergence.
    pub fn after_convergence(&self) -> AfterConvergence {
        match self {
            Self::Amp { .. } | Self::AdaMimic | Self::AmpRoger { .. } => AfterConvergence::Nothing,
            Self::AmpcoWithoutRoger => AfterConvergence::SameRule,
            Self::Ampco | Self::AmpcoWithoutAig => AfterConvergence::Bounded,
        }
    }
}
