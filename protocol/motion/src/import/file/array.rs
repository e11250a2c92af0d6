//! An array of numbers with a shape, as NumPy has them.
//!
//! Separate because archives and pickles both hold them, and because checking every frame for
//! numbers that are not finite belongs in one place.

use super::File;
use crate::error::MotionError;
use wording::count;

/// Numbers in C order.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::import) struct Array {
    pub(in crate::import) shape: Vec<usize>,
    pub(in crate::import) values: Vec<f64>,
}

impl Array {
    /// An array from the order that the file has; `None` if the shape needs another count of numbers.
    pub(in crate::import) fn of(
        shape: Vec<usize>,
        values: Vec<f64>,
        fortran: bool,
    ) -> Option<Self> {
        let count = shape.iter().try_fold(1usize, |n, &d| n.checked_mul(d))?;
        if count != values.len() {
            return None;
        }
        let values = if fortran && shape.len() > 1 {
            transposed(&shape, &values)
        } else {
            values
        };
        Some(Self { shape, values })
    }

    /// How many frames: the first dimension.
    pub(in crate::import) fn frames(&self) -> usize {
        self.shape.first().copied().unwrap_or(0)
    }

    /// Numbers per frame.
    pub(in crate::import) fn width(&self) -> usize {
        self.shape.iter().skip(1).product()
    }

    /// The numbers of a frame.
    pub(in crate::import) fn frame(&self, i: usize) -> &[f64] {
        let width = self.width();
        &self.values[i * width..(i + 1) * width]
    }

    /// `width` numbers of every frame, from `from` on.
    pub(in crate::import) fn part(&self, from: usize, width: usize) -> Self {
        let values = (0..self.frames()).flat_map(|i| &self.frame(i)[from..from + width]);
        Self {
            shape: vec![self.frames(), width],
            values: values.copied().collect(),
        }
    }

    /// Checks that every frame has the numbers it must have and that they are finite and below a
    /// bound; `meaning` says what the bound stands for.
    ///
    /// # Errors
    /// The shape, or the first number that is not.
    pub(in crate::import) fn check(
        &self,
        file: &File<'_>,
        name: &str,
        widths: &[usize],
        (bound, meaning): (f64, &str),
    ) -> Result<(), MotionError> {
        let expected = || {
            let widths: Vec<String> = widths.iter().map(usize::to_string).collect();
            format!("expected frames of {} numbers", widths.join(" or "))
        };
        if self.shape.len() < 2 || !widths.contains(&self.width()) {
            let problem = format!("array {name} has the shape {:?}", self.shape);
            return Err(file.unusable(&problem, &expected()));
        }
        if self.frames() == 0 {
            return Err(file.unusable(
                &format!("array {name} holds no frames"),
                "export the motion again",
            ));
        }
        let width = self.width();
        for (i, value) in self.values.iter().enumerate() {
            let field = || format!("{name}[{}]", i % width);
            if !value.is_finite() {
                let problem = format!("{value} is not a finite number");
                return Err(file.frame(i / width, &field(), problem, "repair or cut the frame"));
            }
            if value.abs() > bound {
                return Err(file.frame(
                    i / width,
                    &field(),
                    format!("{value} is too large"),
                    meaning,
                ));
            }
        }
        Ok(())
    }

    /// Checks that two arrays have as many frames.
    pub(in crate::import) fn check_length(
        &self,
        file: &File<'_>,
        name: &str,
        (other, other_name): (&Self, &str),
    ) -> Result<(), MotionError> {
        if self.frames() == other.frames() {
            return Ok(());
        }
        let problem = format!(
            "array {name} has {}, {other_name} has {}",
            count(self.frames(), "frame"),
            other.frames()
        );
        Err(file.unusable(
            &problem,
            "export the motion again: all arrays must be as long",
        ))
    }
}

/// What is a length: nothing human is farther than this, m.
pub(in crate::import) const PLACES: (f64, &str) = (1e4, "places are in metres");
/// What is an angle, rad.
pub(in crate::import) const ANGLES: (f64, &str) = (10.0, "angles are in radians");

/// Fortran order to C order.
fn transposed(shape: &[usize], values: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    let mut index = vec![0; shape.len()];
    for value in values {
        let at = shape.iter().zip(&index).fold(0, |at, (&d, &i)| at * d + i);
        out[at] = *value;
        // In Fortran order the first index runs fastest.
        for (i, &dimension) in index.iter_mut().zip(shape) {
            *i += 1;
            if *i < dimension {
                break;
            }
            *i = 0;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn complaint(array: &Array, widths: &[usize]) -> String {
        let file = File {
            path: Path::new("walk.npz"),
            bytes: b"",
        };
        array
            .check(&file, "poses", widths, ANGLES)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn columns_first_becomes_rows_first() {
        // [[1, 2, 3], [4, 5, 6]] written column by column.
        let array = Array::of(vec![2, 3], vec![1.0, 4.0, 2.0, 5.0, 3.0, 6.0], true).unwrap();
        assert_eq!(array.frame(1), [4.0, 5.0, 6.0]);
        assert_eq!(Array::of(vec![2, 2], vec![1.0], false), None);
        assert_eq!(Array::of(vec![usize::MAX, 2], vec![1.0], false), None);
    }

    #[test]
    fn what_is_wrong_is_said_with_frame_and_field() {
        let mut array = Array::of(vec![2, 3], vec![0.5; 6], false).unwrap();
        let file = File {
            path: Path::new("x"),
            bytes: b"",
        };
        array.check(&file, "poses", &[3, 4], ANGLES).unwrap();
        let message = complaint(&array, &[4]);
        assert!(message.contains("poses") && message.contains("[2, 3]") && message.contains('4'));
        array.values[4] = f64::NAN;
        let message = complaint(&array, &[3]);
        assert!(
            message.contains("walk.npz frame 2, poses[1]: NaN"),
            "{message}"
        );
        array.values[4] = 90.0;
        let message = complaint(&array, &[3]);
        assert!(
            message.contains("frame 2") && message.contains("radians"),
            "{message}"
        );
        let empty = Array::of(vec![0, 3], Vec::new(), false).unwrap();
        assert!(complaint(&empty, &[3]).contains("no frames"));
    }
}
