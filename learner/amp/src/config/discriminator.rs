//! `[discriminator]`: the judge of style.

use super::Check;
use crate::COMMAND;
use crate::columns::{Feature, FeatureKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Section};

/// `[discriminator]`: the judge of style.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DiscriminatorConfig {
    /// States that it looks at. The paper's pair; longer windows show rhythm (see [`crate::window`]).
    pub frames: usize,
    /// Control steps from one of these states to the next. The paper's are successive (1); six states three steps apart
    /// span 0.3 s, half a step of walking.
    pub spacing: usize,
    /// How much it sees of how far the velocity is off the command, and of reference motion off its clip's own: blurred by
    /// so much either way (m/s, m/s, rad/s), so that an error below it is nothing odd. Default: it does
    /// not, as in the paper. Then any motion of the data is good style whatever was asked for, and of those standing
    /// is the easiest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command_blur: Option<[f32; COMMAND]>,
    /// Weight, beside the policy's windows, of reference motion with a command that it does not follow, which is to be told
    /// apart as the policy's is. Default 0: none is shown, as in the paper. It then learns what disobeying looks like from the
    /// policy alone. Needs `command_blur`.
    #[serde(skip_serializing_if = "is_zero")]
    pub mismatched: f32,
    /// What it is trained on: `least_squares`, the paper's Eq. 3 and 4, or `logistic`.
    pub loss: LossKind,
    /// Widths of hidden layers (ReLU). The recipe's; published trainers use 1024-512.
    pub hidden: Vec<usize>,
    /// Steps per iteration. The recipe's.
    pub steps: usize,
    /// Expert windows per step, and as many of the policy. The recipe's.
    pub batch: usize,
    /// AdamW's rate. The recipe's.
    pub learning_rate: f32,
    /// λ_GP of Eq. 6, on normalised observations. The recipe's; published least-squares trainers use 10.
    pub gradient_penalty: f32,
    /// Past policy windows that are remembered.
    pub replay_capacity: usize,
    /// New windows remembered per iteration: capacity and this make a memory of about 50 iterations.
    pub replay_insert: usize,
}

/// Choices of [`DiscriminatorConfig::loss`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LossKind {
    /// Scores are drawn to +1 and −1 (Eq. 3 and 4).
    #[default]
    LeastSquares,
    /// Cross-entropy of a logit ℓ; the score is tanh(ℓ/2), which has the same optimum.
    Logistic,
}

/// Weight decay of hidden layers. The recipe's.
pub(crate) const DECAY: f32 = 1e-3;
/// Weight decay of the last layer. The recipe's.
pub(crate) const HEAD_DECAY: f32 = 1e-2;
/// Share of a step's policy windows that is taken from memory. The recipe's half.
pub(crate) const REPLAY_SHARE: f32 = 0.5;
/// Normalised features are clipped to ± this.
pub(crate) const FEATURE_CLIP: f32 = 5.0;

/// Least standard deviation of a number that the discriminator sees, in what it is scaled to: differences below it are
/// not style. The recipe's: without that of joint velocities, exploration noise gives the policy away.
pub(crate) fn floor(feature: &Feature) -> f32 {
    let in_units = match feature.kind {
        FeatureKind::Height => 0.03,         // m
        FeatureKind::LinearVelocity => 0.3,  // m/s
        FeatureKind::AngularVelocity => 0.5, // rad/s
        FeatureKind::JointPosition => 0.1,   // rad
        FeatureKind::JointVelocity => 2.0,   // rad/s
    };
    in_units * feature.scale
}

impl Default for DiscriminatorConfig {
    fn default() -> Self {
        Self {
            frames: 2,
            spacing: 1,
            command_blur: None,
            mismatched: 0.0,
            loss: LossKind::LeastSquares,
            hidden: vec![256, 128],
            steps: 3,
            batch: 1024,
            learning_rate: 1e-4,
            gradient_penalty: 20.0,
            replay_capacity: 50_000,
            replay_insert: 1024,
        }
    }
}

/// Whether an option is off.
fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

impl Section for DiscriminatorConfig {
    const NAME: &'static str = "discriminator";

    fn validate(&self) -> Checked {
        Check(Ok(()))
            .layers("hidden", &self.hidden)
            .that(
                (2..=32).contains(&self.frames),
                "frames",
                self.frames,
                "use 2, the paper's pair, to 32",
            )
            .that(
                (1..=50).contains(&self.spacing),
                "spacing",
                self.spacing,
                "use 1, successive states, to 50 steps of 20 ms",
            )
            .that(
                self.command_blur
                    .is_none_or(|blur| blur.iter().all(|x| x.is_finite() && *x > 0.0)),
                "command_blur",
                self.command_blur.unwrap_or_default(),
                "use three numbers above 0: m/s forward, m/s aside, rad/s",
            )
            .not_negative("mismatched", self.mismatched)
            .that(
                self.mismatched == 0.0 || self.command_blur.is_some(),
                "mismatched",
                self.mismatched,
                "set discriminator.command_blur: without it no command is seen",
            )
            .count("steps", self.steps, 1000)
            .count("batch", self.batch, 1 << 20)
            .positive("learning_rate", self.learning_rate)
            .not_negative("gradient_penalty", self.gradient_penalty)
            .count("replay_capacity", self.replay_capacity, 10_000_000)
            .count("replay_insert", self.replay_insert, self.replay_capacity)
            .0
    }
}

impl DiscriminatorConfig {
    /// Numbers that it sees of a window of states of so many `features`: `[frames][features]`, then the command if it sees
    /// that.
    pub fn width(&self, features: usize) -> usize {
        self.frames * features + self.command_blur.map_or(0, |blur| blur.len())
    }
}
