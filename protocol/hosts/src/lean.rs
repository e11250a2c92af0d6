//! Lean rollouts: what can be restored bit for bit is not sent.
//!
//! Two things stand twice in a rollout. What the discriminator sees after a step is, unless the episode ended, what it
//! sees before the next one; and an observation holds the action before it. A bit per row says whether that is so of
//! the row: the rule is checked on the numbers themselves, so that a list of terms of which it is not true costs bytes
//! and never a bit. It is arithmetic on slices and knows no wire.

mod marks;
mod rows;

use std::ops::Range;

use protocol::{RolloutLayout, RolloutView, RolloutViewMut};

use marks::marked;
pub(crate) use rows::{put, take};
use rows::{rows, rows_mut};

/// Takes from rollouts of a layout what they hold twice, and puts it back.
#[derive(Clone, Debug)]
pub struct Lean {
    layout: RolloutLayout,
    /// Where an observation holds the action before it.
    previous: Range<usize>,
}

/// Why bytes are no lean rollout.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LeanError {
    /// Another length than the marks at the beginning ask for.
    #[error("a rollout of {got} bytes where {expected} were expected")]
    Length {
        /// Bytes expected.
        expected: usize,
        /// Bytes found.
        got: usize,
    },
    /// A row is marked as left out that nothing tells.
    #[error("row {0} is left out and cannot be restored")]
    Row(usize),
}

impl Lean {
    /// For rollouts of `layout` whose observations hold the previous action in the columns `previous`, if they do.
    ///
    /// # Panics
    /// If `previous` is not as wide as an action, or is not within an observation.
    pub fn new(layout: RolloutLayout, previous: Option<Range<usize>>) -> Self {
        let previous = previous.unwrap_or(0..0);
        assert!(
            previous.is_empty() || previous.len() == g1::ACTION,
            "{previous:?} is not as wide as an action"
        );
        assert!(
            previous.end <= layout.lists.widths.observation,
            "{previous:?} is not within an observation"
        );
        Self { layout, previous }
    }

    /// Sizes of the rollouts.
    pub fn layout(&self) -> &RolloutLayout {
        &self.layout
    }

    /// Most bytes that a lean rollout has.
    pub fn most(&self) -> usize {
        2 * self.marks() + 4 * self.layout.len()
    }

    /// The bytes that tell a rollout whose block is `numbers`.
    ///
    /// # Panics
    /// If `numbers` is not as long as the layout says.
    pub fn strip(&self, numbers: &[f32]) -> Vec<u8> {
        let view = self.layout.view(numbers);
        let (next, previous) = self.marks_of(&view);
        let mut bytes = Vec::with_capacity(self.most());
        bytes.extend_from_slice(&next);
        bytes.extend_from_slice(&previous);
        let RolloutView {
            layout: _,
            observations,
            actions,
            means,
            log_probs,
            task_rewards,
            energies,
            tracking_errors,
            ends,
            episode_steps,
            features,
            next_features,
            foot_forces,
            critic,
            measured,
            last_observations,
            timeout_observations,
            last_critic,
            timeout_critic,
        } = view;
        let environments = self.layout.environments;
        let first = self.layout.lists.widths.observation * environments;
        put(&mut bytes, &observations[..first]);
        self.put_seen(&mut bytes, &observations[first..], &previous, 0);
        for block in [
            actions,
            means,
            log_probs,
            task_rewards,
            energies,
            tracking_errors,
            ends,
            episode_steps,
            features,
        ] {
            put(&mut bytes, block);
        }
        let width = self.layout.lists.widths.features;
        for (row, numbers) in rows(next_features, width) {
            if !marked(&next, row) {
                put(&mut bytes, numbers);
            }
        }
        for block in [foot_forces, critic, measured] {
            put(&mut bytes, block);
        }
        let done = (self.layout.steps - 1) * environments;
        self.put_seen(&mut bytes, last_observations, &previous, done);
        for block in [timeout_observations, last_critic, timeout_critic] {
            put(&mut bytes, block);
        }
        bytes
    }

    /// Restores a rollout into `numbers`, every bit as it was.
    ///
    /// # Errors
    /// Bytes that no rollout of this layout gives; `numbers` is then not to be used.
    ///
    /// # Panics
    /// If `numbers` is not as long as the layout says.
    pub fn restore(&self, bytes: &[u8], numbers: &mut [f32]) -> Result<(), LeanError> {
        let expected = self.expected(bytes)?;
        if bytes.len() != expected {
            let got = bytes.len();
            return Err(LeanError::Length { expected, got });
        }
        let (next, rest) = bytes.split_at(self.marks());
        let (previous, mut rest) = rest.split_at(self.marks());
        let rest = &mut rest;
        let RolloutViewMut {
            layout: _,
            observations,
            actions,
            means,
            log_probs,
            task_rewards,
            energies,
            tracking_errors,
            ends,
            episode_steps,
            features,
            next_features,
            foot_forces,
            critic,
            measured,
            last_observations,
            timeout_observations,
            last_critic,
            timeout_critic,
        } = self.layout.view_mut(numbers);
        let environments = self.layout.environments;
        let (first, seen) =
            observations.split_at_mut(self.layout.lists.widths.observation * environments);
        take(rest, first);
        self.take_seen(rest, seen, previous, 0);
        for block in [
            &mut *actions,
            means,
            log_probs,
            task_rewards,
            energies,
            tracking_errors,
            ends,
            episode_steps,
            &mut *features,
        ] {
            take(rest, block);
        }
        let width = self.layout.lists.widths.features;
        for (row, numbers) in rows_mut(next_features, width) {
            if marked(next, row) {
                let same = (row + environments) * width;
                numbers.copy_from_slice(&features[same..same + width]);
            } else {
                take(rest, numbers);
            }
        }
        for block in [foot_forces, critic, measured] {
            take(rest, block);
        }
        let done = (self.layout.steps - 1) * environments;
        self.take_seen(rest, last_observations, previous, done);
        for block in [timeout_observations, last_critic, timeout_critic] {
            take(rest, block);
        }
        self.act_again(seen, actions, previous, 0);
        self.act_again(last_observations, actions, previous, done);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
