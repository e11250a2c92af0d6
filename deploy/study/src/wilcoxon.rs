//! Wilcoxon's signed-rank test with its exact p-value, as III-F uses it.
//!
//! Written by hand because no crate that is kept up offers the exact distribution with ties. It follows
//! `scipy.stats.wilcoxon`: differences of zero are left out (`zero_method="wilcox"`), equal absolute differences share
//! the mean of their ranks, and p is that of the permutation distribution of the ranks as they are. Without ties this
//! is `method="exact"`, with ties it is `method=PermutationMethod(n_resamples=inf)`, for SciPy's `"exact"` then holds
//! no longer, as its documentation says.

/// The outcome of a test of paired differences, two-sided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedRank {
    /// Pairs whose difference is not zero.
    pub pairs: usize,
    /// Sum of the ranks of positive differences, W⁺.
    pub positive: f64,
    /// The smaller of W⁺ and W⁻: what SciPy calls the statistic.
    pub statistic: f64,
    /// Probability, were both alike, of a W⁺ at least as far out as this one.
    pub p: f64,
}

impl SignedRank {
    /// The matched-pairs rank-biserial correlation:  r = (W⁺ − W⁻) / (W⁺ + W⁻)   (Kerby, 2014)
    ///
    /// 1 where every difference is positive, −1 where every one is negative, 0 where they balance.
    pub fn rank_biserial(&self) -> f64 {
        let total = (self.pairs * (self.pairs + 1)) as f64 / 2.0;
        2.0 * self.positive / total - 1.0
    }
}

/// Tests whether differences lie evenly about zero; `None` if none differs from zero or one is NaN.
pub fn signed_rank(differences: &[f64]) -> Option<SignedRank> {
    let mut sized: Vec<f64> = differences.iter().copied().filter(|d| *d != 0.0).collect();
    if sized.is_empty() || sized.iter().any(|d| d.is_nan()) {
        return None;
    }
    sized.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let ranks = doubled_ranks(&sized);
    let positive: usize = sized
        .iter()
        .zip(&ranks)
        .filter(|(difference, _)| **difference > 0.0)
        .map(|(_, rank)| rank)
        .sum();
    let total: usize = ranks.iter().sum();
    let chances = distribution(&ranks, total);
    // Summed from the small ends, where rounding would show.
    let at_most: f64 = chances[..=positive].iter().sum();
    let at_least: f64 = chances[positive..].iter().rev().sum();
    Some(SignedRank {
        pairs: sized.len(),
        positive: positive as f64 / 2.0,
        statistic: positive.min(total - positive) as f64 / 2.0,
        p: (2.0 * at_most.min(at_least)).min(1.0),
    })
}

/// The least p that so many pairs can give: all differences on one side, 2 of 2ⁿ.
pub fn smallest_p(pairs: usize) -> f64 {
    (2.0 * 0.5_f64.powi(i32::try_from(pairs).unwrap_or(i32::MAX))).min(1.0)
}

/// Twice the ranks of numbers sorted by absolute value; the mean of ranks is then whole too.
fn doubled_ranks(sorted: &[f64]) -> Vec<usize> {
    let mut ranks = Vec::with_capacity(sorted.len());
    for tied in sorted.chunk_by(|a, b| a.abs() == b.abs()) {
        let first = ranks.len() + 1;
        let last = ranks.len() + tied.len();
        ranks.extend(std::iter::repeat_n(first + last, tied.len()));
    }
    ranks
}

/// Chance of each sum of doubled ranks when every sign is a fair coin.
fn distribution(ranks: &[usize], total: usize) -> Vec<f64> {
    let mut chances = vec![0.0; total + 1];
    chances[0] = 1.0;
    let mut reach = 0;
    for rank in ranks {
        for sum in (0..=reach + rank).rev() {
            let without = if sum <= reach { chances[sum] } else { 0.0 };
            let with = if sum >= *rank {
                chances[sum - rank]
            } else {
                0.0
            };
            chances[sum] = 0.5 * (without + with);
        }
        reach += rank;
    }
    chances
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_pairs_on_one_side_are_two_of_eight() {
        let test = signed_rank(&[0.1, 0.3, 0.2]).unwrap();
        assert_eq!((test.positive, test.statistic), (6.0, 0.0)); // 1 + 2 + 3
        assert_eq!((test.p, test.rank_biserial()), (0.25, 1.0));
        let mixed = signed_rank(&[-0.1, 0.3, 0.2]).unwrap(); // (5 − 1) / 6
        assert!((mixed.rank_biserial() - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(smallest_p(3), 0.25);
        assert_eq!(smallest_p(10), 2.0 / 1024.0);
        assert_eq!(smallest_p(0), 1.0);
    }

    #[test]
    fn ties_share_ranks_and_zeros_are_left_out() {
        // |d| = 1 1 2: ranks 1.5 1.5 3; W⁺ = 1.5 + 3. Sums: 0 1.5 1.5 3 3 4.5 4.5 6, so P(≥ 4.5) = 3/8.
        let test = signed_rank(&[0.0, 1.0, -1.0, 2.0]).unwrap();
        assert_eq!((test.pairs, test.positive, test.statistic), (3, 4.5, 1.5));
        assert_eq!(test.p, 0.75);
        assert_eq!(signed_rank(&[0.0, 0.0]), None);
        assert_eq!(signed_rank(&[]), None);
        assert_eq!(signed_rank(&[1.0, f64::NAN]), None);
    }
}
