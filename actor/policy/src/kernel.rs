//! One linear layer on a block of rows: the product and the bias in one pass.
//!
//! A tile of up to 6 rows and 32 columns (16 with AVX2) is kept in registers while the loop runs along the inputs. The
//! source is generic over the width of vectors; `pulp` compiles it for AVX-512, AVX2, NEON and plain numbers and enters
//! the best that the machine has. All are fused multiply-adds in the order of the inputs, one chain per output, so that
//! they agree bit by bit, whatever the tile.

use pulp::{Arch, Simd, WithSimd};

/// Columns of a panel of weights.
pub(crate) const COLUMNS: usize = 32;

/// Rows that the tallest tile takes: with two vectors each they fill 12 registers. AVX-512 has 32, but with 12 rows the
/// compiler unrolled the loop along the inputs until it ran out of them: 1.8 times slower. AVX2 has 16: with four
/// vectors each and 3 rows one sum lived in memory: 1.9 times slower.
pub(crate) const TILE_ROWS: usize = 6;

/// Values of several rows, one row every `stride` numbers.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub(crate) values: &'a [f32],
    pub(crate) stride: usize,
}

/// 32 columns of a layer's result: for each of `count` rows and each column c
/// `output[row·output_stride + c] = bias[c] + Σₖ input[row][k]·panel[k][c]`.
pub(crate) struct Product<'a> {
    pub(crate) input: Rows<'a>,
    pub(crate) count: usize,
    /// Weights of the 32 outputs for each input in turn.
    pub(crate) panel: &'a [[f32; COLUMNS]],
    pub(crate) bias: &'a [f32; COLUMNS],
    pub(crate) output: &'a mut [f32],
    pub(crate) output_stride: usize,
}

impl Product<'_> {
    /// Evaluates with the vectors of this machine.
    pub(crate) fn evaluate(self, arch: Arch) {
        arch.dispatch(self);
    }

    /// Tiles of `ROWS` rows as far as they go, then smaller ones for the rest. `VECTORS` vectors are the columns of a
    /// tile, and `PARTS` of those the 32 of the panel, one after the other: a part's weights stay in the first-level cache.
    #[inline(always)]
    fn tiles<S: Simd, const ROWS: usize, const VECTORS: usize, const PARTS: usize>(
        mut self,
        simd: S,
    ) {
        for part in 0..PARTS {
            let mut row = 0;
            while row + ROWS <= self.count {
                self.tile::<S, ROWS, VECTORS, PARTS>(simd, row, part);
                row += ROWS;
            }
            while ROWS > 4 && row + 4 <= self.count {
                self.tile::<S, 4, VECTORS, PARTS>(simd, row, part);
                row += 4;
            }
            while row < self.count {
                self.tile::<S, 1, VECTORS, PARTS>(simd, row, part);
                row += 1;
            }
        }
    }

    #[expect(
        clippy::needless_range_loop,
        clippy::manual_memcpy,
        reason = "loops of known length over arrays are unrolled and stay in registers; iterators and copies made of calls do not: measured ten times slower"
    )]
    #[inline(always)]
    fn tile<S: Simd, const ROWS: usize, const VECTORS: usize, const PARTS: usize>(
        &mut self,
        simd: S,
        first: usize,
        part: usize,
    ) {
        assert!(part < PARTS, "seen here, it is not asked again in the loop");
        let inputs = self.panel.len();
        let Rows { values, stride } = self.input;
        // Slices of exactly this length let the compiler see that no index below leaves them.
        let mut rows = [&values[..0]; ROWS];
        for row in 0..ROWS {
            rows[row] = &values[(first + row) * stride..][..inputs];
        }
        let (bias, _) = S::as_simd_f32s(self.bias);
        let bias = bias.as_chunks::<VECTORS>().0[part];
        let (panel, _) = S::as_simd_f32s(self.panel.as_flattened());
        let panel = &panel.as_chunks::<VECTORS>().0.as_chunks::<PARTS>().0[..inputs];
        let mut sums = [[simd.splat_f32s(0.0); VECTORS]; ROWS];
        for row in 0..ROWS {
            for vector in 0..VECTORS {
                sums[row][vector] = bias[vector];
            }
        }
        for k in 0..inputs {
            for row in 0..ROWS {
                let x = simd.splat_f32s(rows[row][k]);
                for vector in 0..VECTORS {
                    sums[row][vector] =
                        simd.mul_add_f32s(x, panel[k][part][vector], sums[row][vector]);
                }
            }
        }
        // A copy: stored by an index that varies, the sums themselves would live in memory instead of registers.
        let mut done = [[simd.splat_f32s(0.0); VECTORS]; ROWS];
        for row in 0..ROWS {
            done[row] = sums[row];
        }
        for row in 0..ROWS {
            let start = (first + row) * self.output_stride + part * COLUMNS / PARTS;
            let output = &mut self.output[start..][..COLUMNS / PARTS];
            let (vectors, _) = S::as_mut_simd_f32s(output);
            for vector in 0..VECTORS {
                vectors[vector] = done[row][vector];
            }
        }
    }
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // As many rows as leave a few registers for the weights; lanes times vectors times parts are COLUMNS.
        match S::F32_LANES {
            16 => self.tiles::<S, TILE_ROWS, 2, 1>(simd),
            8 => self.tiles::<S, TILE_ROWS, 2, 2>(simd),
            4 => self.tiles::<S, 3, 8, 1>(simd),
            _ => self.tiles::<S, 1, COLUMNS, 1>(simd),
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};

    use super::*;

    #[test]
    fn every_machine_s_vectors_give_the_same_bits() {
        let (count, inputs) = (29, 57);
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let mut random = || rng.random_range(-1.0_f32..1.0);
        let input: Vec<f32> = (0..count * inputs).map(|_| random()).collect();
        let panel: Vec<[f32; COLUMNS]> = (0..inputs)
            .map(|_| std::array::from_fn(|_| random()))
            .collect();
        let bias: [f32; COLUMNS] = std::array::from_fn(|_| random());
        let evaluate = |arch: Arch| {
            let mut output = vec![0.0; count * COLUMNS];
            Product {
                input: Rows {
                    values: &input,
                    stride: inputs,
                },
                count,
                panel: &panel,
                bias: &bias,
                output: &mut output,
                output_stride: COLUMNS,
            }
            .evaluate(arch);
            output
        };
        let plain = evaluate(Arch::Scalar);
        assert_eq!(evaluate(Arch::new()), plain);
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            assert_eq!(evaluate(Arch::V3(avx2)), plain);
        }
    }
}
