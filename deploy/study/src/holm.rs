//! Holm's correction of several p-values for being several.

/// The corrected values, in the order of the given ones: of m, the k-th least times m − k + 1, none less than one before it
/// (Holm, 1979).
pub fn corrected(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut corrected = vec![0.0; p.len()];
    let mut least: f64 = 0.0;
    for (rank, index) in order.iter().enumerate() {
        least = least.max((p.len() - rank) as f64 * p[*index]).min(1.0);
        corrected[*index] = least;
    }
    corrected
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_counts_for_all_and_the_greatest_for_itself() {
        // 3 × 0.01; 2 × 0.03; 0.04 would be less than that.
        assert_eq!(corrected(&[0.04, 0.01, 0.03]), [0.06, 0.03, 0.06]);
        assert_eq!(corrected(&[0.5]), [0.5]);
        assert_eq!(corrected(&[0.6, 0.7]), [1.0, 1.0]);
        assert_eq!(corrected(&[]), [0.0; 0]);
    }
}
