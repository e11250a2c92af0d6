//! Rows of numbers as bytes, and observations without the action before them.

use super::Lean;
use super::marks::marked;

impl Lean {
    /// Observations, without the action before them where that is marked; the first is of row `from` of the marks.
    pub(super) fn put_seen(&self, bytes: &mut Vec<u8>, block: &[f32], marks: &[u8], from: usize) {
        for (row, numbers) in rows(block, self.layout.lists.widths.observation) {
            if marked(marks, from + row) {
                put(bytes, &numbers[..self.previous.start]);
                put(bytes, &numbers[self.previous.end..]);
            } else {
                put(bytes, numbers);
            }
        }
    }

    pub(super) fn take_seen(&self, rest: &mut &[u8], block: &mut [f32], marks: &[u8], from: usize) {
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
    pub(super) fn act_again(&self, block: &mut [f32], actions: &[f32], marks: &[u8], from: usize) {
        for (row, numbers) in rows_mut(block, self.layout.lists.widths.observation) {
            if marked(marks, from + row) {
                let acted = &actions[(from + row) * self.previous.len()..][..self.previous.len()];
                numbers[self.previous.clone()].copy_from_slice(acted);
            }
        }
    }
}

pub(super) fn rows(block: &[f32], width: usize) -> impl Iterator<Item = (usize, &[f32])> {
    block.chunks_exact(width.max(1)).enumerate()
}

pub(super) fn rows_mut(
    block: &mut [f32],
    width: usize,
) -> impl Iterator<Item = (usize, &mut [f32])> {
    block.chunks_exact_mut(width.max(1)).enumerate()
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
