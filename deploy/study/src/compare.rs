//! One method against another, over the seeds that both have.

use crate::bootstrap::{self, Interval};
use crate::metric::Metric;
use crate::results::{Column, Results};
use crate::statistics::median;
use crate::wilcoxon::{SignedRank, signed_rank, smallest_p};

/// The level of III-F.
pub const LEVEL: f64 = 0.05;

/// Two methods on one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Seeds that both have.
    pub pairs: usize,
    /// Mean of the first over these seeds.
    pub first: f64,
    /// Mean of the second.
    pub second: f64,
    /// The test of the differences, first less second; none if they are all zero.
    pub test: Option<SignedRank>,
    /// The median of these differences, with its interval.
    pub difference: Option<Interval>,
}

impl Comparison {
    /// Of two entries on a column; `None` without a common seed.
    pub fn of(results: &Results, a: &str, b: &str, metric: Metric, column: Column) -> Option<Self> {
        Self::of_pairs(&results.paired(a, b, metric, column))
    }

    /// Of how far runs lie from the middle of their method: which method is the steadier.
    pub fn of_steadiness(results: &Results, a: &str, b: &str, metric: Metric) -> Option<Self> {
        let paired = results.paired(a, b, metric, Column::Last);
        let (first, second): (Vec<f64>, Vec<f64>) = paired.iter().copied().unzip();
        let (first, second) = (median(&first), median(&second));
        let away: Vec<(f64, f64)> = paired
            .iter()
            .map(|(a, b)| ((a - first).abs(), (b - second).abs()))
            .collect();
        Self::of_pairs(&away)
    }

    /// Of numbers that belong to the same seeds; `None` of none.
    pub fn of_pairs(paired: &[(f64, f64)]) -> Option<Self> {
        if paired.is_empty() {
            return None;
        }
        let n = paired.len() as f64;
        let differences: Vec<f64> = paired.iter().map(|(a, b)| a - b).collect();
        Some(Self {
            pairs: paired.len(),
            first: paired.iter().map(|pair| pair.0).sum::<f64>() / n,
            second: paired.iter().map(|pair| pair.1).sum::<f64>() / n,
            test: signed_rank(&differences),
            difference: bootstrap::of_median(&differences),
        })
    }

    /// The exact p; 1 where every difference is zero.
    pub fn p(&self) -> f64 {
        self.test.map_or(1.0, |test| test.p)
    }

    /// How large the effect is, by the ranks of the differences; 0 where all are zero.
    pub fn rank_biserial(&self) -> f64 {
        self.test.map_or(0.0, |test| test.rank_biserial())
    }

    /// "r = −1, median difference −0.031 (95 %: −0.045 to −0.012)", the values as `written` writes them.
    pub fn size(&self, written: impl Fn(f64) -> String) -> String {
        let effect = format!("r = {:.2}", self.rank_biserial());
        let words = match self.difference {
            None => effect,
            Some(found) => format!(
                "{effect}, median difference {} (95 %: {} to {})",
                written(found.median),
                written(found.low),
                written(found.high)
            ),
        };
        words.replace('-', "−")
    }

    /// The least p that these pairs could have given.
    pub fn smallest_p(&self) -> f64 {
        smallest_p(self.pairs)
    }

    /// Whether the pairs are enough for any outcome to count.
    pub fn can_decide(&self) -> bool {
        self.smallest_p() < LEVEL
    }

    /// "p = 0.0312, n = 6", and what n allows where it allows too little.
    pub fn words(&self) -> String {
        let mut words = format!("p = {}, n = {}", written(self.p()), self.pairs);
        if !self.can_decide() {
            let least = written(self.smallest_p());
            words.push_str(&format!(", smallest reachable p = {least}"));
        }
        words
    }
}

/// A probability with four significant digits, none lost to a fixed number of decimals.
pub fn written(p: f64) -> String {
    let digits = (3.0 - p.max(1e-12).log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{p:.digits$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn three_seeds_can_decide_nothing_and_six_can() {
        let few = sample::results(&[("ampco", &[1.0, 1.1, 1.2]), ("amp-0.5", &[2.0, 2.2, 2.4])]);
        let comparison =
            Comparison::of(&few, "ampco", "amp-0.5", Metric::Rmse, Column::Last).unwrap();
        assert_eq!((comparison.p(), comparison.can_decide()), (0.25, false));
        assert_eq!(
            comparison.words(),
            "p = 0.25, n = 3, smallest reachable p = 0.25"
        );

        let many = sample::results(&[
            ("ampco", &[1.0, 1.1, 1.2, 1.3, 1.4, 1.5]),
            ("amp-0.5", &[2.0, 2.2, 2.4, 2.6, 2.8, 3.1]),
        ]);
        let comparison =
            Comparison::of(&many, "ampco", "amp-0.5", Metric::Rmse, Column::Last).unwrap();
        assert_eq!(comparison.words(), "p = 0.03125, n = 6"); // 2 of 64
        // 1.0 less 2.0, up to 1.5 less 3.1: in the middle 1.2 less 2.4 and 1.3 less 2.6.
        let size = comparison.size(|value| format!("{value:.2}"));
        assert!(
            size.starts_with("r = −1.00, median difference −1.25 (95 %: −1."),
            "{size}"
        );
        assert!(Comparison::of(&many, "ampco", "no", Metric::Rmse, Column::Last).is_none());
    }

    #[test]
    fn the_steadier_method_is_nearer_to_its_middle() {
        let results =
            sample::results(&[("ampco", &[1.0, 1.1, 1.2]), ("amp-0.5", &[2.0, 4.0, 7.0])]);
        let comparison =
            Comparison::of_steadiness(&results, "ampco", "amp-0.5", Metric::Rmse).unwrap();
        // 0.1 0 0.1 against 2 0 3
        assert!((comparison.first - 0.2 / 3.0).abs() < 1e-9);
        assert!((comparison.second - 5.0 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn probabilities_keep_their_digits() {
        assert_eq!(written(1.0), "1");
        assert_eq!(written(0.001953125), "0.001953");
        assert_eq!(written(2.0_f64.powi(-19)), "0.000001907");
    }
}
