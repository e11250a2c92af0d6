//! How a figure moves over a run: one line for all that shrink by a factor rather than by an amount.

/// `first` until `from` samples, `last` after `to`, and between them a straight line of the logarithm. Both positive.
pub(crate) fn logarithmic(first: f32, last: f32, from: f64, to: f64, samples: u64) -> f32 {
    let samples = samples as f64;
    if samples <= from {
        return first;
    }
    if samples >= to {
        return last;
    }
    let progress = ((samples - from) / (to - from)) as f32;
    first * (last / first).powf(progress)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_holds_shrinks_and_stays() {
        let at = |samples| logarithmic(0.6, 0.2, 1e6, 3e6, samples);
        assert_eq!([at(0), at(1_000_000)], [0.6; 2]);
        assert_eq!([at(3_000_000), at(u64::MAX)], [0.2; 2]);
        // Halfway on the logarithmic line: √(0.6·0.2) = 0.3464
        assert!((at(2_000_000) - 0.346_41).abs() < 1e-5);
        // A step.
        assert_eq!(logarithmic(0.6, 0.2, 1e6, 1e6, 1_000_001), 0.2);
    }
}
