//! `[policy]` and `[exploration]`: what acts, and how widely it tries.

use super::Check;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, Section};

/// `[policy]`: sizes of actor and critic, and what they see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PolicyConfig {
    /// Widths of the actor's hidden layers (ELU). The recipe's 256-128-64; published G1 trainers use 512-256-128.
    pub hidden: Vec<usize>,
    /// Widths of the critic's hidden layers (ELU). As the actor's.
    pub critic_hidden: Vec<usize>,
    /// Normalised observations are clipped to ± this. The recipe's.
    pub observation_clip: f32,
}

/// `[exploration]`: the standard deviation σ of actions around the policy's mean, in units of actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExplorationConfig {
    /// `scheduled` follows the samples, `learned` is adapted by PPO from where `sigma` begins.
    pub kind: ExplorationKind,
    /// Legs' σ, on a straight line of its logarithm where it moves. 0.6 is 0.15 rad. The recipe's, as are the samples: σ
    /// 0.15 from the start got stuck falling.
    pub sigma: Ramp<f32>,
    /// Waist's σ in parts of the legs'. Noise there is the discriminator's shortcut. The recipe's.
    pub waist_factor: f32,
    /// Arms' σ in parts of the legs'. The recipe's.
    pub arm_factor: f32,
}

/// Choices of [`ExplorationConfig::kind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ExplorationKind {
    /// σ by the number of samples.
    Scheduled,
    /// σ as a parameter of the policy, the same in every state.
    Learned,
}

/// Gain of the actor's first last layer: small, so that the first actions are near the default pose. The recipe's.
pub(crate) const LAST_GAIN: f32 = 0.01;
/// Least standard deviation of an observation, in its own unit: what never varied must not be blown up later.
pub(crate) const OBSERVATION_FLOOR: f32 = 0.02;
/// Least and greatest σ of learned exploration.
pub(crate) const LEARNED_SIGMA: [f32; 2] = [0.05, 1.0];

impl Default for PolicyConfig {
    fn default() -> Self {
        Self {
            hidden: vec![256, 128, 64],
            critic_hidden: vec![256, 128, 64],
            observation_clip: 5.0,
        }
    }
}

impl Default for ExplorationConfig {
    fn default() -> Self {
        Self {
            kind: ExplorationKind::Scheduled,
            sigma: Ramp::moving(0.6, 0.2, [1.0e6, 3.0e6]),
            waist_factor: 0.3,
            arm_factor: 0.3,
        }
    }
}

impl Section for PolicyConfig {
    const NAME: &'static str = "policy";

    fn validate(&self) -> Checked {
        Check(Ok(()))
            .layers("hidden", &self.hidden)
            .layers("critic_hidden", &self.critic_hidden)
            .positive("observation_clip", self.observation_clip)
            .0
    }
}

impl Section for ExplorationConfig {
    const NAME: &'static str = "exploration";

    fn validate(&self) -> Checked {
        Check(Ok(()))
            .ramp("sigma", &self.sigma, Check::at_least_a_millionth)
            .at_least_a_millionth("waist_factor", self.waist_factor)
            .at_least_a_millionth("arm_factor", self.arm_factor)
            .0
    }
}
