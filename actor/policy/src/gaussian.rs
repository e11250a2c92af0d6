//! Exploration: a Gaussian of given width around the mean action, and the density of what was drawn.

use pulp::Arch;
use rand::Rng;

use crate::{OUTPUTS, normal};

/// Squares of a row's deviations with room to add them by halves.
const SQUARES: usize = OUTPUTS.next_power_of_two();

/// Independent normal distributions, one per action.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaussian {
    sigma: [f32; OUTPUTS],
    inverse_sigma: [f32; OUTPUTS],
    /// Σᵢ (−ln σᵢ − ½·ln 2π): the log-density at the mean.
    log_density_at_mean: f32,
}

impl Gaussian {
    /// From standard deviations above zero.
    pub fn new(sigma: [f32; OUTPUTS]) -> Self {
        let half_log_two_pi = 0.5 * std::f64::consts::TAU.ln();
        let log_density: f64 = sigma
            .iter()
            .map(|&sigma| -f64::from(sigma).ln() - half_log_two_pi)
            .sum();
        Self {
            sigma,
            inverse_sigma: sigma.map(f32::recip),
            log_density_at_mean: log_density as f32,
        }
    }

    /// Standard deviation per action.
    pub fn sigma(&self) -> &[f32; OUTPUTS] {
        &self.sigma
    }

    /// Draws  aᵢ = μᵢ + σᵢ·zᵢ,  zᵢ standard normal, for rows of means `[n][joints]`, with the log-density of each row in
    /// `log_probs` `[n]`.
    pub(crate) fn sample<R: Rng + ?Sized>(
        &self,
        arch: Arch,
        means: &[f32],
        rng: &mut R,
        actions: &mut [f32],
        log_probs: &mut [f32],
    ) {
        let means = means.as_chunks().0;
        let actions = actions.as_chunks_mut().0;
        arch.dispatch(
            #[inline(always)]
            || {
                for ((mean, action), log_prob) in means.iter().zip(actions).zip(log_probs) {
                    let z = normal::row(rng);
                    for i in 0..OUTPUTS {
                        action[i] = mean[i] + self.sigma[i] * z[i];
                    }
                    *log_prob = self.of_row(action, mean);
                }
            },
        );
    }

    /// Log-density of an action:  ln π(a) = Σᵢ (−½·((aᵢ − μᵢ)/σᵢ)² − ln σᵢ − ½·ln 2π).
    ///
    /// Taken from the rounded action that is stored, not from the draw: who recomputes it later finds the same.
    ///
    /// # Panics
    /// If action or mean are not one row.
    pub fn log_density(&self, action: &[f32], mean: &[f32]) -> f32 {
        let row = |numbers: &[f32]| numbers.try_into().expect("one row");
        self.of_row(&row(action), &row(mean))
    }

    #[inline(always)]
    fn of_row(&self, action: &[f32; OUTPUTS], mean: &[f32; OUTPUTS]) -> f32 {
        let mut squares = [0.0; SQUARES];
        for i in 0..OUTPUTS {
            let deviation = (action[i] - mean[i]) * self.inverse_sigma[i];
            squares[i] = deviation * deviation;
        }
        // By halves, for a sum from first to last cannot be done in vectors.
        let mut count = SQUARES;
        while count > 1 {
            count /= 2;
            for i in 0..count {
                squares[i] += squares[i + count];
            }
        }
        self.log_density_at_mean - 0.5 * squares[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn the_density_by_hand() {
        // σ = ½ everywhere: at the mean 23·(ln 2 − ½·ln 2π) = 23·(0.693147 − 0.918939) = −5.193199
        let gaussian = Gaussian::new([0.5; OUTPUTS]);
        let mean = [1.0; OUTPUTS];
        assert!((gaussian.log_density(&mean, &mean) + 5.193_199).abs() < 1e-4);
        // One action two standard deviations off costs ½·2² = 2, another one off ½.
        let mut action = mean;
        action[3] += 1.0;
        action[7] -= 0.5;
        assert!((gaussian.log_density(&action, &mean) + 7.693_199).abs() < 1e-4);
    }

    #[test]
    fn each_action_has_its_own_width() {
        // ln σ enters with a minus: doubling one σ lowers the density at the mean by ln 2.
        let mut sigma = [1.0; OUTPUTS];
        let mean = [0.0; OUTPUTS];
        let narrow = Gaussian::new(sigma).log_density(&mean, &mean);
        sigma[0] = 2.0;
        let wide = Gaussian::new(sigma).log_density(&mean, &mean);
        assert!((narrow - wide - std::f32::consts::LN_2).abs() < 1e-5);
    }

    #[test]
    fn draws_have_the_mean_and_width_asked_for() {
        let mut sigma = [0.25; OUTPUTS];
        sigma[0] = 2.0;
        let gaussian = Gaussian::new(sigma);
        let mean = [3.0; OUTPUTS];
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let (mut sums, mut squares) = ([0.0_f64; OUTPUTS], [0.0_f64; OUTPUTS]);
        let draws = 20_000;
        let mut log_prob = [0.0];
        for _ in 0..draws {
            let mut action = [0.0; OUTPUTS];
            gaussian.sample(Arch::new(), &mean, &mut rng, &mut action, &mut log_prob);
            assert_eq!(log_prob[0], gaussian.log_density(&action, &mean));
            for i in 0..OUTPUTS {
                let off = f64::from(action[i] - mean[i]);
                sums[i] += off;
                squares[i] += off * off;
            }
        }
        for i in 0..OUTPUTS {
            let (sigma, n) = (f64::from(sigma[i]), f64::from(draws));
            // Standard errors: σ/√n = 0.007 σ of the mean, σ/√(2n) = 0.005 σ of the deviation; five of each.
            assert!((sums[i] / n).abs() < 0.036 * sigma);
            assert!(((squares[i] / n).sqrt() - sigma).abs() < 0.026 * sigma);
        }
    }

    #[test]
    fn every_width_of_vectors_draws_the_same_bits() {
        let gaussian = Gaussian::new(std::array::from_fn(|i| 0.1 + 0.01 * i as f32));
        let means: Vec<f32> = (0..7 * OUTPUTS).map(|i| (i as f32).sin()).collect();
        let draw = |arch: Arch| {
            let (mut actions, mut log_probs) = (vec![0.0; means.len()], vec![0.0; 7]);
            let mut rng = rand_pcg::Pcg64::seed_from_u64(2);
            gaussian.sample(arch, &means, &mut rng, &mut actions, &mut log_probs);
            actions.extend(log_probs);
            actions.into_iter().map(f32::to_bits).collect::<Vec<_>>()
        };
        let plain = draw(Arch::Scalar);
        assert_eq!(draw(Arch::new()), plain);
        #[cfg(target_arch = "x86_64")]
        if let Some(avx2) = pulp::x86::V3::try_new() {
            assert_eq!(draw(Arch::V3(avx2)), plain);
        }
    }
}
