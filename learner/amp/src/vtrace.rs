//! V-trace: advantages of rollouts that an older policy made (Espeholt et al. 2018).
//!
//! For longer lags than PPO's clipped ratio alone bears, as between machines: [`crate::gae`] takes it for granted that
//! the present policy would have gone on as the older one did, and is the further off the further the two are apart.

use crate::Segment;
use crate::gae::{Returns, backward};

/// ½·ln 2π
const HALF_LOG_TAU: f32 = 0.918_938_5;

/// Writes, for each row,
///
/// D_t = ρ_t·δ_t + γ·c_t·D_{t+1},  δ_t = r_t + γ·V(o_{t+1}) − V(o_t),  ρ_t = min(1, π/μ),  c_t = λ·min(1, π/μ)
///
/// to `errors`, so that V(o_t) + D_t is what the critic is to say, and A_t = δ_t + γλ·D_{t+1} to `advantages`. π is the
/// present policy, μ the one that acted, `log_ratios` ln π/μ of each row. Where both are the same D and A are
/// [`crate::gae::advantages`]. Ends are as there.
///
/// # Panics
/// If a slice does not fit the rollout.
pub fn advantages(
    segment: Segment,
    from: Returns<'_>,
    log_ratios: &[f32],
    (gamma, lambda): (f32, f32),
    advantages: &mut [f32],
    errors: &mut [f32],
) {
    assert_eq!(advantages.len(), segment.rows(), "one advantage per row");
    assert_eq!(errors.len(), segment.rows(), "one error per row");
    backward(segment, from, gamma, |row, delta, next_error| {
        advantages[row] = delta + gamma * lambda * next_error;
        errors[row] = log_ratios[row].min(0.0).exp() * advantages[row];
        errors[row]
    });
}

/// Appends  ln π(a)/μ(a)  of each row, π a Gaussian about `means` with σ times the row's width.
///
/// `actions`, `means` `[row][action]`, `log_probs` ln μ(a) `[row]`, `widths` `[row]` or empty where all are 1.
pub fn log_ratios(
    (actions, means): (&[f32], &[f32]),
    sigma: &[f32],
    widths: &[f32],
    log_probs: &[f32],
    out: &mut Vec<f32>,
) {
    let columns = sigma.len();
    let rows = actions
        .chunks_exact(columns)
        .zip(means.chunks_exact(columns));
    for (row, ((action, mean), log_prob)) in rows.zip(log_probs).enumerate() {
        let width = widths.get(row).copied().unwrap_or(1.0);
        let each = action.iter().zip(mean).zip(sigma);
        let density: f32 = each
            .map(|((action, mean), sigma)| {
                let sigma = width * sigma;
                let distance = (action - mean) / sigma;
                -0.5 * distance * distance - sigma.ln() - HALF_LOG_TAU
            })
            .sum();
        out.push(density - log_prob);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gae;
    use vocabulary::{Cause, RUNNING};

    /// One robot, three steps, γ = λ = ½, rewards 1, values 2 4 6, last value 8: δ = 1, 0, −1.
    fn estimate(log_ratios: &[f32; 3], ends: &[f32; 3]) -> ([f32; 3], [f32; 3]) {
        let segment = Segment {
            steps: 3,
            environments: 1,
        };
        let from = Returns {
            rewards: &[1.0; 3],
            values: &[2.0, 4.0, 6.0],
            ends,
            last_values: &[8.0],
            timeout_values: &[10.0],
        };
        let (mut advantages, mut errors) = ([0.0; 3], [0.0; 3]);
        super::advantages(
            segment,
            from,
            log_ratios,
            (0.5, 0.5),
            &mut advantages,
            &mut errors,
        );
        let mut plain = [0.0; 3];
        gae::advantages(segment, from, 0.5, 0.5, &mut plain);
        if *log_ratios == [0.0; 3] {
            assert_eq!((advantages, errors), (plain, plain));
        }
        (advantages, errors)
    }

    #[test]
    fn of_the_same_policy_it_is_generalised_advantage_estimation() {
        let running = [RUNNING; 3];
        assert_eq!(estimate(&[0.0; 3], &running).0, [0.9375, -0.25, -1.0]);
        estimate(&[0.0; 3], &[RUNNING, Cause::Fall.code(), RUNNING]);
        estimate(&[0.0; 3], &[RUNNING, Cause::TimeOut.code(), RUNNING]);
    }

    #[test]
    fn half_as_likely_counts_half_and_more_likely_counts_once_by_hand() {
        // Ratios 2, ½, ½: weights 1, ½, ½.
        // D₂ = ½·(−1) = −½,  A₂ = −1
        // D₁ = ½·(0 + ¼·(−½)) = −1/16,  A₁ = −⅛
        // D₀ = 1 + ¼·(−1/16) = 63/64 = A₀
        let half = -std::f32::consts::LN_2;
        let (advantages, errors) = estimate(&[-half, half, half], &[RUNNING; 3]);
        let near = |found: [f32; 3], expected: [f32; 3]| {
            let pairs = found.iter().zip(expected);
            assert!(
                pairs.clone().all(|(a, b)| (a - b).abs() < 1e-6),
                "{found:?}"
            );
        };
        near(errors, [63.0 / 64.0, -1.0 / 16.0, -0.5]);
        near(advantages, [63.0 / 64.0, -0.125, -1.0]);
        // A fall at the second step: δ₁ = 1 − 4 = −3, and nothing follows: D₁ = −3/2, A₁ = −3; D₀ = 1 − 3/8.
        let ends = [RUNNING, Cause::Fall.code(), RUNNING];
        let (advantages, errors) = estimate(&[-half, half, half], &ends);
        near(errors, [0.625, -1.5, -0.5]);
        near(advantages, [0.625, -3.0, -1.0]);
    }

    #[test]
    fn a_ratio_by_hand() {
        // Two actions, σ ½ and 1, a σ off in the first: −½ − ln ½ − ln 2π = −1.644730; of half the width −2 − ln ¼ − ln ½ − ln 2π.
        let mut out = Vec::new();
        let (actions, means) = ([1.5, 3.0, 1.5, 3.0], [1.0, 3.0, 1.0, 3.0]);
        log_ratios(
            (&actions, &means),
            &[0.5, 1.0],
            &[1.0, 0.5],
            &[-1.0, -1.0],
            &mut out,
        );
        assert!((out[0] + 0.644_730).abs() < 1e-5, "{out:?}");
        let half = -2.0 + 8_f32.ln() - std::f32::consts::TAU.ln() + 1.0;
        assert!((out[1] - half).abs() < 1e-5, "{out:?}");
    }
}
