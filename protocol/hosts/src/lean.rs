//! Lean rollouts: what can be restored bit for bit is not sent.
//!
//! Two things stand twice in a rollout. What the discriminator sees after a step is, unless the episode ended, what it
//! sees before the next one; and an observation holds the action before it. A bit per row says whether that is so of
//! the row: the rule is checked on the numbers themselves, so that a list of terms of which it is not true costs bytes
//! and never a bit. It is arithmetic on slices and knows no wire.

use std::ops::Range;

use protocol::{RolloutLayout, RolloutView, RolloutViewMut};

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

    /// Bytes of the marks of one kind: a bit per environment and step.
    fn marks(&self) -> usize {
        (self.layout.environments * self.layout.steps).div_ceil(8)
    }

    /// How long a lean rollout with these marks is.
    fn expected(&self, bytes: &[u8]) -> Result<usize, LeanError> {
        let marks = self.marks();
        let Some((next, rest)) = bytes.split_at_checked(marks) else {
            let (expected, got) = (2 * marks, bytes.len());
            return Err(LeanError::Length { expected, got });
        };
        let Some((previous, _)) = rest.split_at_checked(marks) else {
            let (expected, got) = (2 * marks, bytes.len());
            return Err(LeanError::Length { expected, got });
        };
        let environments = self.layout.environments;
        let (told, rows) = (
            (self.layout.steps - 1) * environments,
            self.layout.steps * environments,
        );
        // Nothing follows the last step, and there are no rows behind the last.
        if let Some(row) = (told..8 * marks).find(|row| marked(next, *row)) {
            return Err(LeanError::Row(row));
        }
        let behind = if self.previous.is_empty() { 0 } else { rows };
        if let Some(row) = (behind..8 * marks).find(|row| marked(previous, *row)) {
            return Err(LeanError::Row(row));
        }
        let count = |marks: &[u8]| -> usize { marks.iter().map(|b| b.count_ones() as usize).sum() };
        let left_out =
            count(next) * self.layout.lists.widths.features + count(previous) * self.previous.len();
        Ok(2 * marks + 4 * (self.layout.len() - left_out))
    }

    /// The rows that need not be sent: of next features, and of previous actions.
    fn marks_of(&self, view: &RolloutView<'_>) -> (Vec<u8>, Vec<u8>) {
        let mut next = vec![0; self.marks()];
        let mut previous = next.clone();
        let environments = self.layout.environments;
        let width = self.layout.lists.widths.features;
        let after = &view.features[environments * width..];
        for ((row, told), (_, after)) in rows(view.next_features, width).zip(rows(after, width)) {
            if same(told, after) {
                next[row / 8] |= 1 << (row % 8);
            }
        }
        if self.previous.is_empty() {
            return (next, previous);
        }
        let width = self.layout.lists.widths.observation;
        let seen = view.observations[environments * width..]
            .chunks_exact(width)
            .chain(view.last_observations.chunks_exact(width));
        let acted = view.actions.chunks_exact(self.previous.len());
        for (row, (seen, acted)) in seen.zip(acted).enumerate() {
            if same(&seen[self.previous.clone()], acted) {
                previous[row / 8] |= 1 << (row % 8);
            }
        }
        (next, previous)
    }

    /// Observations, without the action before them where that is marked; the first is of row `from` of the marks.
    fn put_seen(&self, bytes: &mut Vec<u8>, block: &[f32], marks: &[u8], from: usize) {
        for (row, numbers) in rows(block, self.layout.lists.widths.observation) {
            if marked(marks, from + row) {
                put(bytes, &numbers[..self.previous.start]);
                put(bytes, &numbers[self.previous.end..]);
            } else {
                put(bytes, numbers);
            }
        }
    }

    fn take_seen(&self, rest: &mut &[u8], block: &mut [f32], marks: &[u8], from: usize) {
        for (row, numbers) in rows_mut(block, self.layout.lists.widths.observation) {
            if marked(marks, from + row) {
                take(rest, &mut numbers[..self.previous.start]);
                take(rest, &mut numbers[self.previous.end..]);
            } else {
                take(rest, numbers);
            }
        }
    }

    /// Puts the action before them into marked observations.
    fn act_again(&self, block: &mut [f32], actions: &[f32], marks: &[u8], from: usize) {
        for (row, numbers) in rows_mut(block, self.layout.lists.widths.observation) {
            if marked(marks, from + row) {
                let acted = &actions[(from + row) * self.previous.len()..][..self.previous.len()];
                numbers[self.previous.clone()].copy_from_slice(acted);
            }
        }
    }
}

fn rows(block: &[f32], width: usize) -> impl Iterator<Item = (usize, &[f32])> {
    block.chunks_exact(width.max(1)).enumerate()
}

fn rows_mut(block: &mut [f32], width: usize) -> impl Iterator<Item = (usize, &mut [f32])> {
    block.chunks_exact_mut(width.max(1)).enumerate()
}

fn marked(marks: &[u8], row: usize) -> bool {
    marks[row / 8] >> (row % 8) & 1 == 1
}

fn same(one: &[f32], other: &[f32]) -> bool {
    let mut pairs = one.iter().zip(other);
    pairs.all(|(one, other)| one.to_bits() == other.to_bits())
}

/// Appends numbers, the least significant byte first.
pub(crate) fn put(bytes: &mut Vec<u8>, numbers: &[f32]) {
    let from = bytes.len();
    bytes.resize(from + 4 * numbers.len(), 0);
    for (place, number) in bytes[from..].chunks_exact_mut(4).zip(numbers) {
        place.copy_from_slice(&number.to_le_bytes());
    }
}

/// Takes numbers from the front; the length was checked.
pub(crate) fn take(rest: &mut &[u8], numbers: &mut [f32]) {
    let (front, back) = rest.split_at(4 * numbers.len());
    for (number, bytes) in numbers.iter_mut().zip(front.chunks_exact(4)) {
        *number = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
    }
    *rest = back;
}

#[cfg(test)]
mod tests;
