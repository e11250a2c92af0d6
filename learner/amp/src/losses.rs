//! What the discriminator is trained on: Eq. 3 to 6, and the logistic loss instead of Eq. 3 and 4.
//!
//! Each expectation is a sum divided by the count of rows of the whole step, not of the tensor given: rows are divided
//! among threads, and the losses of the parts have to add up to the loss of the whole.

use burn::tensor::Tensor;
use burn::tensor::activation::log_sigmoid;

/// L_expert = E over experts of (D(o_t, o_{t+1}) − 1)²   (Eq. 3)
///
/// `scores` `[n, 1]`, a part of `count` expert windows.
pub fn expert_loss(scores: Tensor<2>, count: usize) -> Tensor<1> {
    (scores - 1.0).square().sum() / count as f32
}

/// L_policy = E over the policy of (D(o_t, o_{t+1}) + 1)²   (Eq. 4)
///
/// `scores` `[n, 1]`, a part of `count` policy transitions.
pub fn policy_loss(scores: Tensor<2>, count: usize) -> Tensor<1> {
    (scores + 1.0).square().sum() / count as f32
}

/// What takes the place of Eq. 3 with the logistic loss: 2·E over experts of −ln σ(ℓ).
///
/// `logits` ℓ `[n, 1]`, a part of `count` expert windows; D = tanh(ℓ/2), see [`score_of_logit`]. Twice, so that where
/// nothing is known, at ℓ = 0, it pulls as Eq. 3 does: with ½ of Eq. 6, by ½ per unit of ℓ.
pub fn expert_logistic(logits: Tensor<2>, count: usize) -> Tensor<1> {
    log_sigmoid(logits).sum() * (-2.0 / count as f32)
}

/// What takes the place of Eq. 4 with the logistic loss: 2·E over the policy of −ln σ(−ℓ), as [`expert_logistic`].
pub fn policy_logistic(logits: Tensor<2>, count: usize) -> Tensor<1> {
    log_sigmoid(logits.neg()).sum() * (-2.0 / count as f32)
}

/// D = tanh(ℓ/2): what both losses make of the densities p of experts and q of the policy where they are least is
/// (p − q)/(p + q), so that Eq. 7 pays the same for it.
pub fn score_of_logit(logit: f32) -> f32 {
    (0.5 * logit).tanh()
}

/// L_GP = E over experts of ‖∇D(o_t, o_{t+1})‖²   (Eq. 5)
///
/// `input_gradients` `[n, width]`, with respect to the normalised states that the discriminator sees; a part of `count`
/// expert windows.
pub fn gradient_penalty(input_gradients: Tensor<2>, count: usize) -> Tensor<1> {
    input_gradients.square().sum() / count as f32
}

/// L_AMP = ½ L_expert + ½ L_policy + λ_GP L_GP   (Eq. 6)
pub fn amp_loss(
    expert_loss: Tensor<1>,
    policy_loss: Tensor<1>,
    gradient_penalty: Tensor<1>,
    penalty_weight: f32,
) -> Tensor<1> {
    expert_loss * 0.5 + policy_loss * 0.5 + gradient_penalty * penalty_weight
}

#[cfg(test)]
mod tests {
    use super::*;
    use networks::{plain_device, tensor, values};

    fn rows(numbers: &[f32], columns: usize) -> Tensor<2> {
        tensor(numbers.to_vec(), columns, &plain_device())
    }

    #[test]
    fn experts_belong_at_plus_one() {
        // (1−1)² + (0−1)² + (−1−1)² = 5 over 3
        let loss = values(expert_loss(rows(&[1.0, 0.0, -1.0], 1), 3))[0];
        assert!((loss - 5.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn the_policy_belongs_at_minus_one() {
        // (1+1)² + (0+1)² + (−1+1)² = 5; over 10, of which these three are a part
        let loss = values(policy_loss(rows(&[1.0, 0.0, -1.0], 1), 10))[0];
        assert!((loss - 0.5).abs() < 1e-6);
    }

    #[test]
    fn logits_that_know_nothing_cost_ln_4_and_sure_ones_nothing() {
        // −2·ln σ(0) = 2·ln 2; −2·ln σ(±ln 3) = −2·ln ¾ and −2·ln ¼; over 3 and over 10.
        let (unknown, ln_3) = (4_f32.ln(), 3_f32.ln());
        let (near, far) = (-2.0 * 0.75_f32.ln(), -2.0 * 0.25_f32.ln());
        let logits = [0.0, ln_3, -ln_3];
        let expert = values(expert_logistic(rows(&logits, 1), 3))[0];
        assert!((expert - (unknown + near + far) / 3.0).abs() < 1e-5);
        let policy = values(policy_logistic(rows(&logits[..2], 1), 10))[0];
        assert!((policy - (unknown + far) / 10.0).abs() < 1e-5);
        // Far off it grows like the logit and stays finite: 2·200.
        let sure = values(policy_logistic(rows(&[200.0], 1), 1))[0];
        assert!((sure - 400.0).abs() < 1e-3, "{sure}");
        // Three experts for one of the policy: (3 − 1)/(3 + 1).
        assert!((score_of_logit(ln_3) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn the_penalty_is_the_mean_squared_length() {
        // ‖(3, 4)‖² = 25, ‖(1, 0)‖² = 1: 26 over 2
        let penalty = values(gradient_penalty(rows(&[3.0, 4.0, 1.0, 0.0], 2), 2))[0];
        assert!((penalty - 13.0).abs() < 1e-5);
    }

    #[test]
    fn the_combination_weighs_them() {
        // ½·2 + ½·4 + 10·0.1 = 4
        let one = |x: f32| Tensor::<1>::from_floats([x], &plain_device());
        let loss = values(amp_loss(one(2.0), one(4.0), one(0.1), 10.0))[0];
        assert!((loss - 4.0).abs() < 1e-6);
    }
}
