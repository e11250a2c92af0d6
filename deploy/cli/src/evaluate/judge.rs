//! The style reward of what is seen, by the discriminator of the checkpoint.

use amp::Learning;
use g1::FEATURES;

/// A discriminator with memory for one step of all robots.
pub(super) struct Judge {
    learning: Learning,
    transitions: Vec<f32>,
}

impl Judge {
    pub(super) fn new(learning: Learning) -> Self {
        Self {
            learning,
            transitions: Vec::new(),
        }
    }

    /// rˢ (Eq. 7) of each robot's step, from the features before and after it (`[robot][53]`).
    pub(super) fn style_rewards(&mut self, before: &[f32], after: &[f32], rewards: &mut Vec<f32>) {
        self.transitions.clear();
        for (before, after) in before
            .chunks_exact(FEATURES)
            .zip(after.chunks_exact(FEATURES))
        {
            self.transitions.extend_from_slice(before);
            self.transitions.extend_from_slice(after);
        }
        rewards.clear();
        self.learning.style_rewards(&self.transitions, rewards);
    }
}
