//! The product of two matrices, written once.
//!
//! Separate because it is the learner's hottest place and the crate's only unsafe code. burn calls the same library, but
//! for a result that it has zeroed and copied into aligned memory before: 7 to 11 % of an update of the
//! default discriminator.

/// Rows and columns in memory, with any steps between them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Matrix<'a> {
    values: &'a [f32],
    shape: [usize; 2],
    strides: [usize; 2],
}

impl<'a> Matrix<'a> {
    /// A matrix whose first number is the first of `values`; the number at (row, column) lies
    /// `row · strides[0] + column · strides[1]` after it.
    ///
    /// # Panics
    /// If it is empty or its last number lies outside of `values`.
    pub(crate) fn new(values: &'a [f32], shape: [usize; 2], strides: [usize; 2]) -> Self {
        assert!(shape[0] > 0 && shape[1] > 0, "an empty matrix: {shape:?}");
        let step = |axis: usize| {
            (shape[axis] - 1)
                .checked_mul(strides[axis])
                .expect("a place in memory")
        };
        let last = step(0).checked_add(step(1)).expect("a place in memory");
        assert!(
            last < values.len(),
            "{shape:?} by {strides:?} ends at {last}, outside of {} numbers",
            values.len()
        );
        Self {
            values,
            shape,
            strides,
        }
    }

    pub(crate) fn rows(&self) -> usize {
        self.shape[0]
    }

    pub(crate) fn columns(&self) -> usize {
        self.shape[1]
    }

    /// Distances in the library's type. A slice is at most `isize::MAX` bytes long, and strides of one row or column,
    /// which may be longer, are never walked.
    fn steps(&self) -> [isize; 2] {
        std::array::from_fn(|axis| {
            if self.shape[axis] == 1 {
                0
            } else {
                self.strides[axis] as isize
            }
        })
    }
}

/// `left · right`, row by row.
///
/// # Panics
/// If the left one's columns are not as many as the right one's rows.
#[expect(
    unsafe_code,
    reason = "the library takes pointers; it has no other door"
)]
pub(crate) fn product(left: Matrix<'_>, right: Matrix<'_>) -> Vec<f32> {
    let ([rows, inner], [also_inner, columns]) = (left.shape, right.shape);
    assert_eq!(inner, also_inner, "columns of the left, rows of the right");
    let count = rows.checked_mul(columns).expect("a place in memory");
    let mut out: Vec<f32> = Vec::with_capacity(count);
    let ([left_row, left_column], [right_row, right_column]) = (left.steps(), right.steps());
    // SAFETY: `Matrix::new` saw that every number of both lies in its slice. `out` has room for `count` numbers, which
    // are rows · columns; the library writes all of them and, as it is told not to read the destination, reads none.
    unsafe {
        gemm::gemm(
            rows,
            columns,
            inner,
            out.as_mut_ptr(),
            1,
            columns as isize,
            false,
            left.values.as_ptr(),
            left_column,
            left_row,
            right.values.as_ptr(),
            right_column,
            right_row,
            0.0,
            1.0,
            false,
            false,
            false,
            gemm::Parallelism::None,
        );
        out.set_len(count);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_by_hand() {
        // [1 2 3; 4 5 6] · [1 0; 0 1; 1 1] = [4 5; 10 11]
        let left = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let right = [1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let plain = product(
            Matrix::new(&left, [2, 3], [3, 1]),
            Matrix::new(&right, [3, 2], [2, 1]),
        );
        assert_eq!(plain, [4.0, 5.0, 10.0, 11.0]);
        // The left one's transpose, by its strides: [1 4; 2 5; 3 6] · [1 2; 3 4] = [13 18; 17 24; 21 30]
        let square = [1.0, 2.0, 3.0, 4.0];
        let transposed = product(
            Matrix::new(&left, [3, 2], [1, 3]),
            Matrix::new(&square, [2, 2], [2, 1]),
        );
        assert_eq!(transposed, [13.0, 18.0, 17.0, 24.0, 21.0, 30.0]);
    }

    #[test]
    fn a_single_row_may_have_any_stride() {
        let row = product(
            Matrix::new(&[2.0, 3.0], [1, 2], [usize::MAX, 1]),
            Matrix::new(&[5.0, 7.0], [2, 1], [1, 9]),
        );
        assert_eq!(row, [31.0]);
    }

    #[test]
    #[should_panic(expected = "outside of 5 numbers")]
    fn who_ends_outside_is_refused() {
        Matrix::new(&[0.0; 5], [2, 3], [3, 1]);
    }

    #[test]
    #[should_panic(expected = "rows of the right")]
    fn who_does_not_fit_is_refused() {
        let square = Matrix::new(&[0.0; 4], [2, 2], [2, 1]);
        product(square, Matrix::new(&[0.0; 3], [3, 1], [1, 1]));
    }
}
