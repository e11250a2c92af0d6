//! The style reward of what is seen, by a discriminator that is kept as it is.

use amp::Learning;
use anyhow::{Context, Result};
use g1::FEATURES;

use super::subject::Kept;

/// Transitions that are scored together: a call of the network costs more than a few rows.
const TOGETHER: usize = 1_024;

/// A discriminator with memory for transitions that wait to be scored.
pub(super) struct Judge {
    learning: Learning,
    waiting: Vec<f32>,
    rewards: Vec<f32>,
    sum: f64,
}

impl Judge {
    /// The discriminator of a checkpoint.
    pub(super) fn of(kept: &Kept) -> Result<Self> {
        let mut config = kept.learning.clone();
        // Episodes are spread over threads already.
        config.ppo.threads = 1;
        // The seed is of weights that are replaced at once.
        let mut learning =
            Learning::new(config, learner::robot(), 0).context("setting up the networks")?;
        learning
            .load(kept.part("learning.bin")?)
            .with_context(|| format!("loading learning.bin of {}", kept.path.display()))?;
        Ok(Self {
            learning,
            waiting: Vec::new(),
            rewards: Vec::new(),
            sum: 0.0,
        })
    }

    /// Takes one step of one robot: the features (53) before and after it.
    pub(super) fn take(&mut self, before: &[f32], after: &[f32]) {
        self.waiting.extend_from_slice(before);
        self.waiting.extend_from_slice(after);
        if self.waiting.len() >= TOGETHER * 2 * FEATURES {
            self.score();
        }
    }

    /// Sum of rˢ (Eq. 7) over all steps taken since the last call.
    pub(super) fn sum(&mut self) -> f64 {
        self.score();
        std::mem::take(&mut self.sum)
    }

    fn score(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        self.rewards.clear();
        self.learning
            .style_rewards(&self.waiting, &mut self.rewards);
        self.waiting.clear();
        self.sum += self.rewards.iter().copied().map(f64::from).sum::<f64>();
    }
}
