//! A confidence interval of the median difference, by the bootstrap without chance.
//!
//! The bootstrap draws n of n differences with replacement and takes the median of each draw. Crates that do so (there is
//! none that is widely used and takes a generator) draw a few thousand; but of a median the whole distribution over all
//! nⁿ draws is known in closed form (Hutson and Ernst, 2000, "The exact bootstrap mean and variance of an L-estimator"),
//! so that nothing hangs on a seed. With few pairs the interval of percentiles is somewhat too narrow, as every bootstrap
//! is; whether there is a difference is for the exact test to say.

use crate::statistics::median;

/// A median with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The median of the differences.
    pub median: f64,
    /// Where 2.5 % of the draws' medians lie below.
    pub low: f64,
    /// Where 2.5 % lie above.
    pub high: f64,
}

/// The share of draws outside, on each side.
const TAIL: f64 = 0.025;

/// The median and its 95 % interval; `None` of no difference, or if one is not finite.
pub fn of_median(differences: &[f64]) -> Option<Interval> {
    if differences.is_empty() || differences.iter().any(|d| !d.is_finite()) {
        return None;
    }
    let mut sorted = differences.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut chances = medians(&sorted);
    chances.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(Interval {
        median: median(&sorted),
        low: percentile(chances.iter()),
        high: percentile(chances.iter().rev()),
    })
}

/// The first value by which more than [`TAIL`] of the draws are counted.
fn percentile<'a>(chances: impl Iterator<Item = &'a (f64, f64)>) -> f64 {
    let (mut sum, mut last) = (0.0, f64::NAN);
    for (value, chance) in chances {
        sum += chance;
        last = *value;
        // Of two draws that together are exactly the tail, rounding would decide.
        if sum > TAIL + 1e-12 {
            break;
        }
    }
    last
}

/// Every median that a draw of `sorted` can have, with its chance.
fn medians(sorted: &[f64]) -> Vec<(f64, f64)> {
    let n = sorted.len();
    let below = |index: usize| index as f64 / n as f64;
    // At least `rank` of n draws are among the first `index`.
    let reached = |rank: usize, index: usize| -> f64 {
        let p = below(index);
        (rank..=n)
            .map(|k| choose(n, k) * power(p, k) * power(1.0 - p, n - k))
            .sum()
    };
    let rank = n.div_ceil(2);
    // Of the draw, the value at the rank is this one.
    let at = |index: usize| reached(rank, index + 1) - reached(rank, index);
    if n % 2 == 1 {
        return (0..n).map(|index| (sorted[index], at(index))).collect();
    }
    // The mean of two neighbours: of n draws half are up to `i`, with one there, and half from `j` on, with one there.
    let half = n / 2;
    let pair = |i: usize, j: usize| {
        let first = power(below(i + 1), half) - power(below(i), half);
        let second = power(below(n - j), half) - power(below(n - j - 1), half);
        choose(n, half) * first * second
    };
    let mut found = Vec::new();
    for i in 0..n {
        let mut apart = 0.0;
        for j in i + 1..n {
            let chance = pair(i, j);
            apart += chance;
            found.push((0.5 * (sorted[i] + sorted[j]), chance));
        }
        found.push((sorted[i], at(i) - apart));
    }
    found
}

fn choose(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product()
}

fn power(base: f64, exponent: usize) -> f64 {
    base.powi(i32::try_from(exponent).unwrap_or(i32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All nⁿ draws, one by one.
    fn drawn(values: &[f64]) -> Vec<f64> {
        let n = values.len();
        let mut medians: Vec<f64> = (0..n.pow(n as u32))
            .map(|mut number| {
                let draw: Vec<f64> = (0..n)
                    .map(|_| {
                        let value = values[number % n];
                        number /= n;
                        value
                    })
                    .collect();
                median(&draw)
            })
            .collect();
        medians.sort_by(f64::total_cmp);
        medians
    }

    #[test]
    fn the_chances_are_those_of_all_draws_one_by_one() {
        for values in [
            &[3.0][..],
            &[1.0, 4.0],
            &[1.0, 2.0, 5.0],
            &[-1.0, 0.5, 2.0, 7.0],
            &[-1.0, 0.5, 2.0, 7.0, 8.5],
            &[-1.0, 0.5, 2.0, 7.0, 8.5, 20.0],
        ] {
            let all = drawn(values);
            let share =
                |of: f64| all.iter().filter(|m| **m == of).count() as f64 / all.len() as f64;
            let found = medians(values);
            for (value, _) in &found {
                let sum: f64 = found
                    .iter()
                    .filter(|(v, _)| v == value)
                    .map(|(_, chance)| chance)
                    .sum();
                assert!((sum - share(*value)).abs() < 1e-12, "{values:?}: {value}");
            }
            let interval = of_median(values).unwrap();
            let cut = (TAIL * all.len() as f64).floor() as usize;
            assert_eq!(interval.low, all[cut], "{values:?}");
            assert_eq!(interval.high, all[all.len() - 1 - cut], "{values:?}");
        }
    }

    #[test]
    fn ten_differences_have_an_interval_within_them() {
        let differences = [5.0, 1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0];
        let interval = of_median(&differences).unwrap();
        assert_eq!(interval.median, 5.5);
        // Symmetric data, symmetric interval.
        assert_eq!(interval.low + interval.high, 11.0);
        assert!(interval.low > 1.0 && interval.low < 4.0, "{interval:?}");
        let ties = of_median(&[2.0; 4]).unwrap();
        assert_eq!((ties.low, ties.median, ties.high), (2.0, 2.0, 2.0));
        assert_eq!(of_median(&[]), None);
        assert_eq!(of_median(&[f64::NAN]), None);
    }
}
