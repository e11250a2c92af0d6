//! Running mean and variance of rows, and the scaling that follows from them.

use crate::NetworkError;
use serde::{Deserialize, Serialize};

/// Statistics of all rows seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Normalizer {
    state: NormalizerState,
    /// Least standard deviation per column.
    floors: Vec<f32>,
    clip: f32,
}

/// What a normalizer remembers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NormalizerState {
    /// Rows seen.
    pub count: f64,
    /// Mean per column.
    pub mean: Vec<f64>,
    /// Sum of squared distances from the mean, per column.
    pub squares: Vec<f64>,
}

/// A fixed mapping  x ↦ clamp((x − mean)·inverse, ±clip), per column.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaling {
    /// Mean per column.
    pub mean: Vec<f32>,
    /// Inverse standard deviation per column.
    pub inverse: Vec<f32>,
    /// Largest magnitude of a result.
    pub clip: f32,
}

impl Normalizer {
    /// Before the first row: mean 0, deviation 1. `floors` are the least standard deviations, one per column: what
    /// hardly varies must not be blown up.
    pub fn new(floors: Vec<f32>, clip: f32) -> Self {
        let columns = floors.len();
        Self {
            state: NormalizerState {
                count: 0.0,
                mean: vec![0.0; columns],
                squares: vec![0.0; columns],
            },
            floors,
            clip,
        }
    }

    /// What it remembers.
    pub fn state(&self) -> &NormalizerState {
        &self.state
    }

    /// Continues from saved statistics.
    ///
    /// # Errors
    /// If they are of another number of columns.
    pub fn restore(&mut self, state: NormalizerState) -> Result<(), NetworkError> {
        let columns = self.floors.len();
        NetworkError::check_length("means of the normalizer", columns, state.mean.len())?;
        NetworkError::check_length("variances of the normalizer", columns, state.squares.len())?;
        self.state = state;
        Ok(())
    }

    /// Takes rows in. The result does not depend on who computed them, only on their order.
    ///
    /// The batch's own mean and squares are merged by the parallel-variance rule (Chan, Golub, LeVeque 1979).
    ///
    /// # Panics
    /// If the numbers do not make whole rows.
    pub fn update(&mut self, rows: &[f32]) {
        let columns = self.floors.len();
        assert_eq!(rows.len() % columns, 0, "whole rows of {columns}");
        if rows.is_empty() {
            return;
        }
        let added = (rows.len() / columns) as f64;
        let mut mean = vec![0.0_f64; columns];
        for row in rows.chunks_exact(columns) {
            for (mean, x) in mean.iter_mut().zip(row) {
                *mean += f64::from(*x);
            }
        }
        mean.iter_mut().for_each(|mean| *mean /= added);
        let mut squares = vec![0.0_f64; columns];
        for row in rows.chunks_exact(columns) {
            for ((square, mean), x) in squares.iter_mut().zip(&mean).zip(row) {
                let distance = f64::from(*x) - mean;
                *square += distance * distance;
            }
        }
        let state = &mut self.state;
        let total = state.count + added;
        for i in 0..columns {
            let shift = mean[i] - state.mean[i];
            state.squares[i] += squares[i] + shift * shift * state.count * added / total;
            state.mean[i] += shift * added / total;
        }
        state.count = total;
    }

    /// The mapping as of now.
    pub fn scaling(&self) -> Scaling {
        let NormalizerState {
            count,
            mean,
            squares,
        } = &self.state;
        let inverse = squares
            .iter()
            .zip(&self.floors)
            .map(|(square, floor)| {
                let deviation = if *count > 0.0 {
                    (square / count).sqrt()
                } else {
                    1.0
                };
                (1.0 / deviation.max(f64::from(*floor))) as f32
            })
            .collect();
        Scaling {
            mean: mean.iter().map(|mean| *mean as f32).collect(),
            inverse,
            clip: self.clip,
        }
    }
}

impl Scaling {
    /// Appends scaled rows to `out`.
    ///
    /// # Panics
    /// If the numbers do not make whole rows.
    pub fn apply(&self, rows: &[f32], out: &mut Vec<f32>) {
        let columns = self.mean.len();
        assert_eq!(rows.len() % columns, 0, "whole rows of {columns}");
        let start = out.len();
        out.resize(start + rows.len(), 0.0);
        let scaled = out[start..].chunks_exact_mut(columns);
        for (row, scaled) in rows.chunks_exact(columns).zip(scaled) {
            let scales = self.mean.iter().zip(&self.inverse);
            for ((x, scaled), (mean, inverse)) in row.iter().zip(scaled).zip(scales) {
                *scaled = ((x - mean) * inverse).clamp(-self.clip, self.clip);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_merge_to_the_statistics_of_all_rows() {
        // Columns 1 2 3 6 and 0 0 4 4: means 3 and 2, squares 4+1+0+9 = 14 and 4·4 = 16
        let mut normalizer = Normalizer::new(vec![0.0; 2], 5.0);
        normalizer.update(&[1.0, 0.0]);
        normalizer.update(&[2.0, 0.0, 3.0, 4.0, 6.0, 4.0]);
        let state = normalizer.state();
        assert_eq!(state.count, 4.0);
        assert!((state.mean[0] - 3.0).abs() < 1e-12 && (state.mean[1] - 2.0).abs() < 1e-12);
        assert!((state.squares[0] - 14.0).abs() < 1e-12 && (state.squares[1] - 16.0).abs() < 1e-12);
        // Deviations √(14/4) and 2: x = (3 + √3.5, 0) becomes (1, −1)
        let mut scaled = Vec::new();
        normalizer
            .scaling()
            .apply(&[3.0 + 3.5_f32.sqrt(), 0.0], &mut scaled);
        assert!((scaled[0] - 1.0).abs() < 1e-6 && (scaled[1] + 1.0).abs() < 1e-6);
    }

    #[test]
    fn deviations_have_floors_and_results_a_limit() {
        let mut normalizer = Normalizer::new(vec![0.5], 5.0);
        normalizer.update(&[1.0, 1.0]); // no deviation at all
        let mut scaled = Vec::new();
        normalizer
            .scaling()
            .apply(&[2.0, 100.0, -100.0], &mut scaled);
        assert_eq!(scaled, [2.0, 5.0, -5.0]);
    }

    #[test]
    fn before_the_first_row_nothing_is_scaled() {
        let mut scaled = Vec::new();
        Normalizer::new(vec![0.1; 2], 5.0)
            .scaling()
            .apply(&[0.5, -2.0], &mut scaled);
        assert_eq!(scaled, [0.5, -2.0]);
    }

    #[test]
    fn statistics_of_other_columns_are_refused() {
        let other = Normalizer::new(vec![0.0; 3], 5.0);
        let mut normalizer = Normalizer::new(vec![0.0; 2], 5.0);
        assert!(normalizer.restore(other.state().clone()).is_err());
    }
}
