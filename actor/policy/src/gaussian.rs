//! Exploration: a Gaussian of given width around the mean action, and the density of what was drawn.

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::OUTPUTS;

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

    /// Draws  aᵢ = μᵢ + σᵢ·zᵢ,  zᵢ standard normal, for one row of means.
    pub fn sample<R: Rng + ?Sized>(&self, mean: &[f32], rng: &mut R, action: &mut [f32]) {
        for ((action, &mean), &sigma) in action.iter_mut().zip(mean).zip(&self.sigma) {
            let z: f32 = StandardNormal.sample(rng);
            *action = sigma.mul_add(z, mean);
        }
    }

    /// Log-density of an action:  ln π(a) = Σᵢ (−½·((aᵢ − μᵢ)/σᵢ)² − ln σᵢ − ½·ln 2π).
    ///
    /// Taken from the rounded action that is stored, not from the draw: who recomputes it later finds the same.
    pub fn log_density(&self, action: &[f32], mean: &[f32]) -> f32 {
        let squares: f32 = action
            .iter()
            .zip(mean)
            .zip(&self.inverse_sigma)
            .map(|((action, mean), inverse_sigma)| ((action - mean) * inverse_sigma).powi(2))
            .sum();
        self.log_density_at_mean - 0.5 * squares
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
        for _ in 0..draws {
            let mut action = [0.0; OUTPUTS];
            gaussian.sample(&mean, &mut rng, &mut action);
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
}
