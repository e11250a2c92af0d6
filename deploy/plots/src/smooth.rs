//! A noisy curve as a mean with its spread.
//!
//! Separate because every training curve needs it: thousands of iterations are more points than a
//! figure has pixels.

/// A mean curve and what lies around it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spread {
    /// Means of successive groups, at their mean x.
    pub mean: Vec<(f64, f64)>,
    /// x, least and greatest of each group.
    pub band: Vec<(f64, f64, f64)>,
}

/// Groups points into at most `most` groups of equal size and tells each one's mean, least and
/// greatest. Numbers that are not finite count for nothing; a group of none is a gap.
///
/// # Panics
/// If `most` is 0.
pub fn smooth(points: &[(f64, f64)], most: usize) -> Spread {
    assert!(most > 0, "a curve has at least one group");
    let size = points.len().div_ceil(most).max(1);
    let mut spread = Spread::default();
    for group in points.chunks(size) {
        let x = group.iter().map(|p| p.0).sum::<f64>() / group.len() as f64;
        let finite = || group.iter().map(|p| p.1).filter(|y| y.is_finite());
        let count = finite().count();
        if count == 0 {
            spread.mean.push((x, f64::NAN));
            spread.band.push((x, f64::NAN, f64::NAN));
            continue;
        }
        spread.mean.push((x, finite().sum::<f64>() / count as f64));
        let (least, greatest) = (
            finite().fold(f64::INFINITY, f64::min),
            finite().fold(f64::NEG_INFINITY, f64::max),
        );
        spread.band.push((x, least, greatest));
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_means_with_their_extremes() {
        let points = [
            (1.0, 2.0),
            (2.0, f64::NAN),
            (3.0, 6.0),
            (4.0, f64::NAN),
            (5.0, f64::NAN),
            (6.0, f64::NAN),
            (7.0, 1.0),
        ];
        let spread = smooth(&points, 3); // groups of 3, 3, 1
        assert_eq!(spread.mean[0], (2.0, 4.0)); // (2 + 6) / 2 at (1 + 2 + 3) / 3
        assert_eq!(spread.band[0], (2.0, 2.0, 6.0));
        assert!(spread.mean[1].1.is_nan() && spread.band[1].1.is_nan());
        assert_eq!(spread.mean[2], (7.0, 1.0));
        assert_eq!(smooth(&points, 100).mean.len(), 7);
        assert_eq!(smooth(&[], 5), Spread::default());
    }
}
