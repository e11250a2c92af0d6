//! Measures of a flat gradient.

/// Euclidean length of the whole vector.
pub fn norm(gradient: &[f32]) -> f32 {
    gradient
        .iter()
        .map(|g| f64::from(*g) * f64::from(*g))
        .sum::<f64>()
        .sqrt() as f32
}

/// Shortens the whole vector to `limit` if it is longer; returns the length that it had.
pub fn clip_norm(gradient: &mut [f32], limit: f32) -> f32 {
    let length = norm(gradient);
    if length > limit {
        let scale = limit / length;
        gradient.iter_mut().for_each(|g| *g *= scale);
    }
    length
}

/// Index of the first NaN or infinity.
pub fn first_not_finite(numbers: &[f32]) -> Option<usize> {
    // A sum of magnitudes is finite only if all are (or it overflows, then the search decides): quick in the usual case.
    let sum: f32 = numbers.iter().map(|x| x.abs() * 1e-10).sum();
    if sum.is_finite() {
        return None;
    }
    numbers.iter().position(|x| !x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_norm_is_clipped_as_a_whole() {
        let mut gradient = [3.0, 4.0];
        assert_eq!(clip_norm(&mut gradient, 10.0), 5.0);
        assert_eq!(gradient, [3.0, 4.0]);
        assert_eq!(clip_norm(&mut gradient, 1.0), 5.0);
        assert!((gradient[0] - 0.6).abs() < 1e-6 && (gradient[1] - 0.8).abs() < 1e-6);
    }

    #[test]
    fn not_finite_numbers_are_found() {
        assert_eq!(first_not_finite(&[1.0, f32::MAX, -f32::MAX]), None);
        assert_eq!(first_not_finite(&[1.0, f32::NAN]), Some(1));
        assert_eq!(
            first_not_finite(&[1.0, 2.0, f32::NEG_INFINITY, f32::INFINITY]),
            Some(2)
        );
        assert_eq!(first_not_finite(&[]), None);
    }
}
