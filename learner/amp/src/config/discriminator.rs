//! `[discriminator]`: the judge of style.

use super::Check;
use crate::{COMMAND, FEATURES};
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
    /// Widths of hidden layers (ReLU). The recipe's; published trainers use 1024-512.
    pub hidden: Vec<usize>,
    /// Steps per iteration. The recipe's.
    pub steps: usize,
    /// Expert windows per step, and as many of the policy. The recipe's.
    pub batch: usize,
    /// AdamW's rate. The recipe's.
    pub learning_rate: f32,
    /// Weight decay of hidden layers. The recipe's.
    pub decay: f32,
    /// Weight decay of the last layer. The recipe's.
    pub head_decay: f32,
    /// λ_GP of Eq. 6, on normalised observations. The recipe's; published least-squares trainers use 10.
    pub gradient_penalty: f32,
    /// Past policy windows that are remembered.
    pub replay_capacity: usize,
    /// New windows remembered per iteration: capacity and this make a memory of about 50 iterations.
    pub replay_insert: usize,
    /// Share of a step's policy windows that is taken from memory. The recipe's half.
    pub replay_share: f32,
    /// Normalised features are clipped to ± this.
    pub feature_clip: f32,
    /// Least standard deviations of features: differences below them are not style.
    pub floors: Floors,
}

/// `[discriminator.floors]`, each in its own unit. The recipe's: without that of joint velocities, exploration noise
/// gives the policy away.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Floors {
    /// Of the pelvis' height, m.
    pub height: f32,
    /// Of the pelvis' velocity, m/s.
    pub linear_velocity: f32,
    /// Of the pelvis' angular velocity, rad/s.
    pub angular_velocity: f32,
    /// Of the joints' positions, rad.
    pub joint_position: f32,
    /// Of the joints' velocities, rad/s.
    pub joint_velocity: f32,
}

impl Default for DiscriminatorConfig {
    fn default() -> Self {
        Self {
            frames: 2,
            spacing: 1,
            command_blur: None,
            hidden: vec![256, 128],
            steps: 3,
            batch: 1024,
            learning_rate: 1e-4,
            decay: 1e-3,
            head_decay: 1e-2,
            gradient_penalty: 20.0,
            replay_capacity: 50_000,
            replay_insert: 1024,
            replay_share: 0.5,
            feature_clip: 5.0,
            floors: Floors::default(),
        }
    }
}

impl Default for Floors {
    fn default() -> Self {
        Self {
            height: 0.03,
            linear_velocity: 0.3,
            angular_velocity: 0.5,
            joint_position: 0.1,
            joint_velocity: 2.0,
        }
    }
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
            .count("steps", self.steps, 1000)
            .count("batch", self.batch, 1 << 20)
            .positive("learning_rate", self.learning_rate)
            .not_negative("decay", self.decay)
            .not_negative("head_decay", self.head_decay)
            .not_negative("gradient_penalty", self.gradient_penalty)
            .count("replay_capacity", self.replay_capacity, 10_000_000)
            .count("replay_insert", self.replay_insert, self.replay_capacity)
            .share("replay_share", self.replay_share)
            .positive("feature_clip", self.feature_clip)
            .positive("floors.height", self.floors.height)
            .positive("floors.linear_velocity", self.floors.linear_velocity)
            .positive("floors.angular_velocity", self.floors.angular_velocity)
            .positive("floors.joint_position", self.floors.joint_position)
            .positive("floors.joint_velocity", self.floors.joint_velocity)
            .0
    }
}

impl DiscriminatorConfig {
    /// Numbers that it sees of a window: `[frames][53]`, then the command if it sees that.
    pub fn width(&self) -> usize {
        self.frames * FEATURES + self.command_blur.map_or(0, |blur| blur.len())
    }
}
