//! The matrix products of a step alone: what no learner on this machine can be faster than.
//!
//! Separate because it is a yardstick and not a part of the learner: milliseconds of a step say little about the learner
//! as long as one does not know what the processor needs for the products in it.

use std::hint::black_box;

use networks::{plain_device, shards, tensor};

/// Rows that are multiplied at a time, large enough that the products run at full speed.
const CHUNK: usize = 512;

/// Forward and backward products of networks of these widths, of `rows` rows on `threads` threads, once.
///
/// A layer of n inputs and m outputs: X·W, and backward Xᵀ·dY and, but in the first layer, dY·Wᵀ.
pub(super) fn multiply(networks: &[&[usize]], rows: usize, threads: usize) {
    shards::run(&mut vec![(); threads], |index, ()| {
        let device = plain_device();
        let ones =
            |rows: usize, columns: usize| tensor(vec![1.0; rows * columns], columns, &device);
        for widths in networks {
            for (layer, pair) in widths.windows(2).enumerate() {
                let weight = ones(pair[0], pair[1]);
                for piece in shards::pieces(shards::part(rows, index, threads), CHUNK) {
                    let (input, change) = (ones(piece.len(), pair[0]), ones(piece.len(), pair[1]));
                    black_box(input.clone().matmul(weight.clone()));
                    black_box(input.transpose().matmul(change.clone()));
                    if layer > 0 {
                        black_box(change.matmul(weight.clone().transpose()));
                    }
                }
            }
        }
    });
}
