//! One step of the optimizer: gradients of all threads added, checked, clipped and taken.

use super::part::{Minibatch, Sums};
use super::{Ppo, RateSchedule};
use crate::config::{GRADIENT_NORM, GREATEST_RATE, KL_BAND, LEAST_RATE, RATE_FACTOR};
use crate::error::Fault;
use burn::tensor::Tensor;
use networks::{clip_norm, shards, tensor, tracked_device};

impl Ppo {
    /// One step of the optimizer; its sums, and the norm of the gradient before clipping.
    pub(super) fn step(
        &mut self,
        minibatch: &Minibatch<'_>,
        sigma: &[f32],
    ) -> Result<(Sums, f32), Fault> {
        let count = minibatch.indices.len();
        let threads = self.config.threads.min(count);
        let mut total = shards::total(count, threads, |part| {
            self.differentiate(minibatch, part, sigma)
        });
        let waits = minibatch.rows.critic_alone;
        if waits {
            // With a gradient of 0 and moments of 0 Adam changes nothing; a policy that comes without a critic has no moments.
            let (actor, rest) = total.gradient.split_at_mut(self.actor.len());
            actor.fill(0.0);
            rest[self.critic.len()..].fill(0.0);
        }
        let norm = self.check(&mut total)?;
        if self.config.schedule == RateSchedule::PerMinibatch && !waits {
            let kl = total.kl / total.kl_rows.max(1) as f64;
            self.follow(kl, minibatch.rows.kl_target);
        }
        self.adam
            .step(&mut self.weights, &total.gradient, self.rate);
        if let Some(limits) = &self.log_sigma_limits {
            let start = self.actor.len() + self.critic.len();
            for log in &mut self.weights[start..] {
                *log = log.clamp(limits.start, limits.end);
            }
        }
        Ok((total, norm))
    }

    /// Clips the gradient to its greatest norm, and refuses what would spoil the weights; the norm before.
    pub(super) fn check(&self, total: &mut Sums) -> Result<f32, Fault> {
        for (what, value) in [
            ("surrogate loss", total.surrogate),
            ("value loss", total.value_loss),
        ] {
            if !value.is_finite() {
                // A broken weight breaks every loss after it: it is the cause to name.
                self.check_weights()?;
                return Err(Fault::new(what, value));
            }
        }
        let norm = clip_norm(&mut total.gradient, GRADIENT_NORM);
        Fault::unless_finite(&total.gradient, |i| format!("gradient of {}", self.name(i)))?;
        Ok(norm)
    }

    pub(super) fn check_weights(&self) -> Result<(), Fault> {
        Fault::unless_finite(&self.weights, |i| self.name(i))
    }

    /// ln σ `[1, joints]`: a differentiable weight if it is learned, else that of the given σ.
    pub(super) fn log_sigma_tensor(&self, sigma: &[f32]) -> Tensor<2> {
        let device = tracked_device();
        let joints = self.actor.outputs;
        match self.log_sigma_limits {
            Some(_) => tensor(self.log_sigma().to_vec(), joints, &device).require_grad(),
            None => tensor(sigma.iter().map(|s| s.ln()).collect(), joints, &device),
        }
    }

    /// Moves the rate one factor toward the KL `target`, if KL is outside the band.
    pub(super) fn follow(&mut self, kl: f64, target: f32) {
        let target = f64::from(target);
        if kl > target * KL_BAND {
            self.rate /= RATE_FACTOR;
        } else if kl < target / KL_BAND {
            self.rate *= RATE_FACTOR;
        }
        self.rate = self.rate.clamp(LEAST_RATE, GREATEST_RATE);
    }
}
