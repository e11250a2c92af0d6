//! Which rows of a rollout need not be sent: a bit per environment and step, and what the bits say of a rollout's length.

use protocol::RolloutView;

use super::rows::rows;
use super::{Lean, LeanError};

impl Lean {
    /// Bytes of the marks of one kind: a bit per environment and step.
    pub(super) fn marks(&self) -> usize {
        (self.layout.environments * self.layout.steps).div_ceil(8)
    }

    /// How long a lean rollout with these marks is.
    pub(super) fn expected(&self, bytes: &[u8]) -> Result<usize, LeanError> {
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
    pub(super) fn marks_of(&self, view: &RolloutView<'_>) -> (Vec<u8>, Vec<u8>) {
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
}

pub(super) fn marked(marks: &[u8], row: usize) -> bool {
    marks[row / 8] >> (row % 8) & 1 == 1
}

fn same(one: &[f32], other: &[f32]) -> bool {
    let mut pairs = one.iter().zip(other);
    pairs.all(|(one, other)| one.to_bits() == other.to_bits())
}
