//! `[ppo]`: how the policy is improved.

use super::Check;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, Section};

/// `[ppo]`: how the policy is improved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PpoConfig {
    /// γ, discount per 20 ms step. 0.99 in all published G1 trainers.
    pub gamma: f32,
    /// λ of the advantage estimate. 0.95 in all published G1 trainers.
    pub lambda: f32,
    /// Blended rewards are multiplied by it, so that values stay near 1. The recipe's.
    pub reward_scale: f32,
    /// Clip range of the probability ratio. 0.2 in most trainers.
    pub clip: f32,
    /// Passes over the batch. The recipe's.
    pub epochs: usize,
    /// Rows per step. The recipe's.
    pub minibatch: usize,
    /// Adam's rate at first. The recipe's.
    pub learning_rate: f32,
    /// When the rate follows the KL divergence. Per minibatch it saw-toothed in the recipe's trials.
    pub schedule: RateSchedule,
    /// Mean KL divergence of the last epoch that the rate is steered to, on a straight line of its logarithm where it
    /// moves. The recipe's. One that shrinks makes the last policies of a long run hardly differ.
    pub kl_target: Ramp<f32>,
    /// Share of each minibatch that is replaced by its left–right mirror image. The recipe's half.
    pub mirrored_share: Ramp<f32>,
    /// How long the critic alone learns at first, samples: for a policy that comes without critic and optimizer, and would
    /// be led astray by a new one. Default 0; `ampco train --from` a shipped policy makes it a million.
    pub critic_first: f64,
    /// Weight of the symmetry loss: how far the actor, shown the mirror image of a row, is off the mirror image of what
    /// it did there. Unlike mirrored rows it takes no ratio to a density that
    /// no policy had, so it works when exploration is narrow. Default 0: off.
    pub symmetry_weight: f32,
    /// Share of each minibatch that it is taken over; the critic learns from those rows mirrored.
    pub symmetry_share: f32,
    /// Threads that rows are divided among. Sums are made in their order, so that results depend on this number and not
    /// on the machine.
    pub threads: usize,
}

/// Choices of [`PpoConfig::schedule`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RateSchedule {
    /// The rate stays.
    Fixed,
    /// Once per iteration.
    PerIteration,
    /// Before every minibatch's step.
    PerMinibatch,
}

/// The rate follows the KL divergence when that leaves [target / band, target · band].
pub(crate) const KL_BAND: f64 = 1.5;
/// Factor of one change of the rate.
pub(crate) const RATE_FACTOR: f32 = 1.3;
/// Lowest rate of one that follows. As in published trainers.
pub(crate) const LEAST_RATE: f32 = 1e-5;
/// Highest rate of one that follows. As in published trainers.
pub(crate) const GREATEST_RATE: f32 = 1e-2;
/// Global norm that gradients are shortened to. 1 in all published trainers.
pub(crate) const GRADIENT_NORM: f32 = 1.0;

impl Default for PpoConfig {
    fn default() -> Self {
        Self {
            gamma: 0.99,
            lambda: 0.95,
            reward_scale: 0.1,
            clip: 0.2,
            epochs: 4,
            minibatch: 2048,
            learning_rate: 3e-4,
            schedule: RateSchedule::PerIteration,
            kl_target: 0.025.into(),
            mirrored_share: 0.5.into(),
            critic_first: 0.0,
            symmetry_weight: 0.0,
            symmetry_share: 0.25,
            threads: 2,
        }
    }
}

impl Section for PpoConfig {
    const NAME: &'static str = "ppo";

    fn validate(&self) -> Checked {
        Check(Ok(()))
            .share("gamma", self.gamma)
            .share("lambda", self.lambda)
            .positive("reward_scale", self.reward_scale)
            .positive("clip", self.clip)
            .count("epochs", self.epochs, 1000)
            .count("minibatch", self.minibatch, 1 << 24)
            .positive("learning_rate", self.learning_rate)
            .ramp("kl_target", &self.kl_target, Check::positive)
            .ramp("mirrored_share", &self.mirrored_share, Check::share)
            .that(
                self.critic_first >= 0.0 && self.critic_first.is_finite(),
                "critic_first",
                self.critic_first,
                "use a number of samples, or 0",
            )
            .not_negative("symmetry_weight", self.symmetry_weight)
            .share("symmetry_share", self.symmetry_share)
            .count("threads", self.threads, 256)
            .0
    }
}

impl PpoConfig {
    /// Whether any rows are seen mirrored, at any time of the run.
    pub fn mirrors(&self) -> bool {
        let some = self.mirrored_share.moves() || self.mirrored_share.now() > 0.0;
        some || self.symmetry_weight > 0.0
    }

    /// Share of each minibatch that is mirrored after `samples`.
    pub fn mirrored_share_at(&self, samples: u64) -> f32 {
        self.mirrored_share.at(samples as f64)
    }

    /// Whether the critic alone learns after `samples`.
    pub fn critic_alone_at(&self, samples: u64) -> bool {
        (samples as f64) < self.critic_first
    }

    /// Mean KL divergence that the rate is steered to after `samples`.
    pub fn kl_target_at(&self, samples: u64) -> f32 {
        self.kl_target.at_logarithmic(samples as f64)
    }
}

#[cfg(test)]
mod tests;
