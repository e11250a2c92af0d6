//! Mean, standard deviation and coefficient of variation over seeds.

/// A mean with its spread over runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// How many runs.
    pub runs: usize,
    /// Their mean.
    pub mean: f64,
    /// Standard deviation with n − 1 in the denominator: the runs are a sample of all seeds. NaN of one run.
    pub deviation: f64,
}

impl Spread {
    /// Of finite numbers; `None` if there is none, or if one is not finite.
    pub fn of(values: &[f64]) -> Option<Self> {
        if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let runs = values.len();
        let mean = values.iter().sum::<f64>() / runs as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Some(Self {
            runs,
            mean,
            deviation: (squares / (runs as f64 - 1.0)).sqrt(),
        })
    }

    /// Deviation over mean; NaN where there is none.
    pub fn variation(&self) -> f64 {
        self.deviation / self.mean.abs()
    }
}

/// The middle of numbers; NaN of none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_by_hand() {
        let spread = Spread::of(&[2.0, 4.0, 6.0]).unwrap();
        assert_eq!((spread.runs, spread.mean, spread.deviation), (3, 4.0, 2.0)); // (4 + 0 + 4) / 2
        assert_eq!(spread.variation(), 0.5);
        assert!(Spread::of(&[1.0]).unwrap().deviation.is_nan());
        assert_eq!(Spread::of(&[]), None);
        assert_eq!(Spread::of(&[1.0, f64::NAN]), None);
    }

    #[test]
    fn the_middle_of_an_even_number_lies_between_two() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 3.0, 2.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
