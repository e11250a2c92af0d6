//! The formulas of PPO (Schulman et al. 2017), each a function of tensors or numbers.
//!
//! As in [`crate::losses`], sums are divided by the count of the whole minibatch, of which the rows may be a part.

use burn::tensor::Tensor;

/// ½·ln 2π
const HALF_LOG_TAU: f32 = 0.918_938_5;

/// Largest |ln ratio| that is told apart; beyond, the exponential would overflow.
const LARGEST_LOG_RATIO: f32 = 20.0;

/// ln π(a) = Σᵢ (−½·((aᵢ − μᵢ)/σᵢ)² − ln σᵢ − ½·ln 2π)
///
/// `actions`, `means` `[n, k]`, `log_sigma` `[1, k]`; result `[n, 1]`.
pub fn log_density(actions: Tensor<2>, means: Tensor<2>, log_sigma: Tensor<2>) -> Tensor<2> {
    let [_, columns] = actions.dims();
    let distance = (actions - means) * (-log_sigma.clone()).exp();
    let at_mean = log_sigma.sum_dim(1) + columns as f32 * HALF_LOG_TAU;
    distance.square().sum_dim(1) * -0.5 - at_mean
}

/// [`log_density`] of rows that were tried with `widths` `[n, 1]` times σ.
pub fn log_density_within(
    actions: Tensor<2>,
    means: Tensor<2>,
    log_sigma: Tensor<2>,
    widths: Tensor<2>,
) -> Tensor<2> {
    let [_, columns] = actions.dims();
    let distance = (actions - means) * (-log_sigma.clone()).exp() / widths.clone();
    let at_mean = log_sigma.sum_dim(1) + columns as f32 * HALF_LOG_TAU;
    distance.square().sum_dim(1) * -0.5 - at_mean - widths.log() * columns as f32
}

/// L = −E min(ρ·A, clip(ρ, 1 − ε, 1 + ε)·A),  ρ = π(a)/π_old(a)
///
/// `log_density`, `old_log_density`, `advantages` `[n, 1]`, a part of `count` rows.
pub fn clipped_surrogate(
    log_density: Tensor<2>,
    old_log_density: Tensor<2>,
    advantages: Tensor<2>,
    clip: f32,
    count: usize,
) -> Tensor<1> {
    let ratio = (log_density - old_log_density)
        .clamp(-LARGEST_LOG_RATIO, LARGEST_LOG_RATIO)
        .exp();
    let free = ratio.clone() * advantages.clone();
    let clipped = ratio.clamp(1.0 - clip, 1.0 + clip) * advantages;
    -(free.min_pair(clipped).sum() / count as f32)
}

/// L = E w·½·Σᵢ ((μᵢ(M s) − (M μ_old(s))ᵢ)/σᵢ)²,  M the mirror image, w 1 for rows that count and 0 for others
///
/// `means`, `targets` `[n, k]`, `log_sigma` `[1, k]`, `weights` `[n, 1]`, a part of `count` rows. In units of the
/// divergence that it would take to become symmetric; σ is no way to lower it.
pub fn symmetry_loss(
    means: Tensor<2>,
    targets: Tensor<2>,
    log_sigma: Tensor<2>,
    weights: Tensor<2>,
    count: usize,
) -> Tensor<1> {
    let distance = (means - targets) * (-log_sigma.detach()).exp();
    (distance.square().sum_dim(1) * weights).sum() * (0.5 / count as f32)
}

/// L = E (V − R)²
///
/// All `[n, 1]`, a part of `count` rows.
pub fn value_loss(values: Tensor<2>, returns: Tensor<2>, count: usize) -> Tensor<1> {
    (values - returns).square().sum() / count as f32
}

/// Entropy of the Gaussian: Σᵢ (ln σᵢ + ½ + ½·ln 2π); `log_sigma` `[1, k]`.
pub fn entropy(log_sigma: Tensor<2>) -> Tensor<1> {
    let [_, columns] = log_sigma.dims();
    log_sigma.sum() + columns as f32 * (0.5 + HALF_LOG_TAU)
}

/// Exact divergence KL(old ‖ new) of two Gaussians of independent actions, for one row:
/// Σᵢ (ln(σᵢ/σᵢ_old) + (σᵢ_old² + (μᵢ_old − μᵢ)²)/(2σᵢ²) − ½), every σ `width` times as wide
pub fn divergence(
    old_means: &[f32],
    old_sigma: &[f32],
    means: &[f32],
    sigma: &[f32],
    width: f32,
) -> f64 {
    let old = old_means.iter().zip(old_sigma);
    let new = means.iter().zip(sigma);
    old.zip(new)
        .map(|((old_mean, old_sigma), (mean, sigma))| {
            let [old_sigma, sigma] = [old_sigma, sigma].map(|sigma| f64::from(width * *sigma));
            let distance = f64::from(old_mean - mean);
            (sigma / old_sigma).ln()
                + (old_sigma * old_sigma + distance * distance) / (2.0 * sigma * sigma)
                - 0.5
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use networks::{plain_device, tensor, tracked_device, values};

    #[test]
    fn a_density_within_half_the_width_is_that_of_half_the_sigma() {
        let rows = |numbers: &[f32]| tensor(numbers.to_vec(), 2, &plain_device());
        let (actions, means) = (rows(&[0.3, -0.2, 0.3, -0.2]), rows(&[0.1, 0.1, 0.1, 0.1]));
        let sigma = |factor: f32| rows(&[(0.4 * factor).ln(), (0.2 * factor).ln()]);
        let of = |factor| values(log_density(actions.clone(), means.clone(), sigma(factor)));
        let within = values(log_density_within(
            actions.clone(),
            means.clone(),
            sigma(1.0),
            column(&[1.0, 0.5]),
        ));
        assert!((within[0] - of(1.0)[0]).abs() < 1e-5);
        assert!((within[1] - of(0.5)[1]).abs() < 1e-5);
        // −½·(0.5² + 1.5²) − ln 0.4 − ln 0.2 − ln 2π, and with half of each σ −½·4·(…) + 2·ln 2 for the two of them.
        let wide = -1.25 - 0.08_f32.ln() - std::f32::consts::TAU.ln();
        assert!((within[0] - wide).abs() < 1e-5);
        assert!((within[1] - (wide - 3.75 + 2.0 * 2_f32.ln())).abs() < 1e-5);
    }

    fn column(numbers: &[f32]) -> Tensor<2> {
        tensor(numbers.to_vec(), 1, &plain_device())
    }

    #[test]
    fn the_density_by_hand() {
        // Two actions, σ = ½ and 1: one σ off in the first, on the mean in the second:
        // −½ − ln ½ − ln 2π = −0.5 + 0.693147 − 1.837877 = −1.644730
        let device = plain_device();
        let rows = |x: [f32; 2]| tensor(x.to_vec(), 2, &device);
        let density = log_density(
            rows([1.5, 3.0]),
            rows([1.0, 3.0]),
            rows([0.5_f32.ln(), 0.0]),
        );
        assert!((values(density)[0] + 1.644_73).abs() < 1e-5);
        // entropy: ln ½ + 0 + 2·(½ + 0.918939) = −0.693147 + 2.837877
        assert!((values(entropy(rows([0.5_f32.ln(), 0.0])))[0] - 2.144_73).abs() < 1e-5);
    }

    #[test]
    fn the_surrogate_by_hand() {
        // Ratios 1.5, 1.5, 0.5, 0.5 with advantages 1, −1, 1, −1 and ε = 0.2:
        // min(1.5, 1.2) = 1.2;  min(−1.5, −1.2) = −1.5;  min(0.5, 0.8) = 0.5;  min(−0.5, −0.8) = −0.8.  Sum −0.6
        let logs: Vec<f32> = [1.5_f32, 1.5, 0.5, 0.5].iter().map(|r| r.ln()).collect();
        let loss = clipped_surrogate(
            column(&logs),
            column(&[0.0; 4]),
            column(&[1.0, -1.0, 1.0, -1.0]),
            0.2,
            4,
        );
        assert!((values(loss)[0] - 0.15).abs() < 1e-6);
    }

    #[test]
    fn its_gradient_raises_what_was_better_and_stops_at_the_clip() {
        // d/d(ln π) of −ρA/4 is −ρA/4 where unclipped, 0 where clipped.
        // ρ = 1, A = 2: −0.5 (a step down raises the density);  ρ = 1.5, A = 1: clipped, 0;
        // ρ = 1.5, A = −1: the clip does not protect, +0.375;  ρ = 0.5, A = −1: clipped, 0
        let logs = [1.0_f32, 1.5, 1.5, 0.5].map(f32::ln).to_vec();
        let density = tensor(logs, 1, &tracked_device()).require_grad();
        let advantages = tensor(vec![2.0, 1.0, -1.0, -1.0], 1, &tracked_device());
        let old = tensor(vec![0.0; 4], 1, &tracked_device());
        let loss = clipped_surrogate(density.clone(), old, advantages, 0.2, 4);
        let gradient = values(density.grad(&loss.backward()).expect("tracked"));
        for (found, expected) in gradient.iter().zip([-0.5, 0.0, 0.375, 0.0]) {
            assert!((found - expected).abs() < 1e-6, "{gradient:?}");
        }
    }

    #[test]
    fn the_symmetry_loss_by_hand() {
        // σ = ½ and 2. First row 1 and 1 off: ½·(2² + ½²) = 2.125; the second does not count. Over 4 rows: 0.53125.
        // Its gradient by the first mean: (1 − 0)/¼/4 = 1.
        let device = tracked_device();
        let rows = |x: &[f32], columns| tensor(x.to_vec(), columns, &device);
        let means = rows(&[1.0, -1.0, 5.0, 5.0], 2).require_grad();
        let loss = symmetry_loss(
            means.clone(),
            rows(&[0.0; 4], 2),
            rows(&[0.5_f32.ln(), 2.0_f32.ln()], 2),
            rows(&[1.0, 0.0], 1),
            4,
        );
        assert!((values(loss.clone())[0] - 0.531_25).abs() < 1e-6);
        let gradient = values(means.grad(&loss.backward()).expect("tracked"));
        for (found, expected) in gradient.iter().zip([1.0, -0.062_5, 0.0, 0.0]) {
            assert!((found - expected).abs() < 1e-6, "{gradient:?}");
        }
    }

    #[test]
    fn the_value_loss_by_hand() {
        let loss = value_loss(column(&[3.0, 0.5]), column(&[4.0, 0.0]), 2);
        // (3−4)² + 0.5² = 1.25 over 2
        assert!((values(loss)[0] - 0.625).abs() < 1e-6);
    }

    #[test]
    fn the_divergence_by_hand() {
        assert_eq!(divergence(&[1.0], &[0.5], &[1.0], &[0.5], 1.0), 0.0);
        // Half as wide, the same distance counts four times: 0.5²/(2·0.25²).
        assert!((divergence(&[1.0], &[0.5], &[1.5], &[0.5], 0.5) - 2.0).abs() < 1e-9);
        // one σ apart: ½
        assert!((divergence(&[1.0], &[0.5], &[1.5], &[0.5], 1.0) - 0.5).abs() < 1e-9);
        // σ doubled: ln 2 + 1/8 − ½ = 0.318147
        assert!((divergence(&[0.0], &[1.0], &[0.0], &[2.0], 1.0) - 0.318_147).abs() < 1e-6);
    }
}
