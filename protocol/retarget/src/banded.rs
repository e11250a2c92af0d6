//! Symmetric systems in which every frame knows two frames before and two after it.
//!
//! Separate because it is algebra that knows nothing of robots: a whole clip is solved in time that
//! grows with its length alone, by the Cholesky factors of blocks A = UᵀU.

use nalgebra::{SMatrix, SVector};

/// Row of blocks of a frame: itself, and the diagonals of the blocks that couple it to the frame
/// before it and to the one before that.
#[derive(Clone, Copy)]
pub(crate) struct Row<const N: usize> {
    /// Block on the diagonal; its lower triangle is read.
    pub(crate) own: SMatrix<f64, N, N>,
    /// Coupling to the frame before.
    pub(crate) before: SVector<f64, N>,
    /// Coupling to the frame two before.
    pub(crate) earlier: SVector<f64, N>,
    /// The right side.
    pub(crate) right: SVector<f64, N>,
}

impl<const N: usize> Row<N> {
    pub(crate) fn new() -> Self {
        Self {
            own: SMatrix::zeros(),
            before: SVector::zeros(),
            earlier: SVector::zeros(),
            right: SVector::zeros(),
        }
    }
}

/// Solution of the system; `None` if it is not positive definite.
pub(crate) fn solve<const N: usize>(rows: &[Row<N>]) -> Option<Vec<SVector<f64, N>>> {
    // Of a frame: the inverse of its own factor, and its factors with the frame before and two before.
    let mut factors: Vec<[SMatrix<f64, N, N>; 3]> = Vec::with_capacity(rows.len());
    let mut x: Vec<SVector<f64, N>> = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let (mut own, mut right) = (row.own, row.right);
        let (mut one, mut two) = (SMatrix::zeros(), SMatrix::zeros());
        if i >= 2 {
            two = factors[i - 2][0] * SMatrix::from_diagonal(&row.earlier);
            own -= two.tr_mul(&two);
            right -= two.tr_mul(&x[i - 2]);
        }
        if i >= 1 {
            let both = SMatrix::from_diagonal(&row.before) - factors[i - 1][1].tr_mul(&two);
            one = factors[i - 1][0] * both;
            own -= one.tr_mul(&one);
            right -= one.tr_mul(&x[i - 1]);
        }
        let inverse = inverse(&own.cholesky()?.unpack_dirty());
        x.push(inverse * right);
        factors.push([inverse, one, two]);
    }
    for i in (0..rows.len()).rev() {
        let mut right = x[i];
        if i + 1 < rows.len() {
            right -= factors[i + 1][1] * x[i + 1];
        }
        if i + 2 < rows.len() {
            right -= factors[i + 2][2] * x[i + 2];
        }
        x[i] = factors[i][0].tr_mul(&right);
    }
    Some(x)
}

/// Inverse of a lower triangle; what is above the diagonal is not read.
fn inverse<const N: usize>(lower: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let mut inverse = SMatrix::<f64, N, N>::zeros();
    for column in 0..N {
        inverse[(column, column)] = 1.0 / lower[(column, column)];
        for row in column + 1..N {
            let sum: f64 = (column..row)
                .map(|k| lower[(row, k)] * inverse[(k, column)])
                .sum();
            inverse[(row, column)] = -sum / lower[(row, row)];
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn it_solves_what_the_dense_matrix_solves() {
        const COUNT: usize = 7;
        let number = |i: usize| (1.7 * i as f64 + 0.3).sin();
        let rows: Vec<Row<2>> = (0..COUNT)
            .map(|i| Row {
                own: SMatrix::<f64, 2, 2>::new(9.0, number(i), number(i), 8.0),
                before: SVector::<f64, 2>::new(number(i + 20), -1.0),
                earlier: SVector::<f64, 2>::new(0.5, number(i + 40)),
                right: SVector::<f64, 2>::new(number(i + 60), number(i + 80)),
            })
            .collect();
        let mut dense = DMatrix::zeros(2 * COUNT, 2 * COUNT);
        let mut right = DVector::zeros(2 * COUNT);
        for (i, row) in rows.iter().enumerate() {
            for a in 0..2 {
                right[2 * i + a] = row.right[a];
                for b in 0..2 {
                    dense[(2 * i + a, 2 * i + b)] = row.own[(a, b)];
                }
                for (back, coupling) in [(1, row.before[a]), (2, row.earlier[a])] {
                    if i >= back {
                        dense[(2 * i + a, 2 * (i - back) + a)] = coupling;
                        dense[(2 * (i - back) + a, 2 * i + a)] = coupling;
                    }
                }
            }
        }
        let expected = dense.lu().solve(&right).unwrap();
        for (i, x) in solve(&rows).unwrap().iter().enumerate() {
            for a in 0..2 {
                assert!((x[a] - expected[2 * i + a]).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let mut row = Row::<1>::new();
        row.own[(0, 0)] = -1.0;
        assert!(solve(&[row]).is_none());
    }
}
