//! Periodic curves as short Fourier series over the phase of a stride.
//!
//! Separate because every published gait curve, of humans and of the G1, is kept in this one form.

use std::f64::consts::TAU;

/// Harmonics kept.
pub(super) const ORDER: usize = 8;

/// mean + Σₖ cosₖ·cos(2πkφ) + sinₖ·sin(2πkφ), φ the phase of a stride in [0, 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Harmonics {
    pub(super) mean: f64,
    pub(super) cos: [f64; ORDER],
    pub(super) sin: [f64; ORDER],
}

impl Harmonics {
    /// A curve that does not move.
    pub(super) const fn still(mean: f64) -> Self {
        Self {
            mean,
            cos: [0.0; ORDER],
            sin: [0.0; ORDER],
        }
    }

    /// The first harmonics of a periodic function.
    pub(super) fn of(function: impl Fn(f64) -> f64) -> Self {
        const SAMPLES: usize = 64;
        let mut curve = Self::still(0.0);
        for i in 0..SAMPLES {
            let phase = i as f64 / SAMPLES as f64;
            let value = function(phase) / SAMPLES as f64;
            curve.mean += value;
            for k in 0..ORDER {
                let (sin, cos) = (TAU * (k + 1) as f64 * phase).sin_cos();
                curve.cos[k] += 2.0 * value * cos;
                curve.sin[k] += 2.0 * value * sin;
            }
        }
        curve
    }

    /// The curve's value at a phase.
    pub(super) fn at(&self, phase: f64) -> f64 {
        let mut value = self.mean;
        for k in 0..ORDER {
            let (sin, cos) = (TAU * (k + 1) as f64 * phase).sin_cos();
            value += self.cos[k] * cos + self.sin[k] * sin;
        }
        value
    }

    /// The curve moved to be `lead` earlier: `shifted(lead).at(φ) = at(φ + lead)`.
    pub(super) fn shifted(&self, lead: f64) -> Self {
        let mut curve = *self;
        for k in 0..ORDER {
            let (sin, cos) = (TAU * (k + 1) as f64 * lead).sin_cos();
            curve.cos[k] = self.cos[k] * cos + self.sin[k] * sin;
            curve.sin[k] = self.sin[k] * cos - self.cos[k] * sin;
        }
        curve
    }

    /// The curve with every swing about its mean scaled.
    pub(super) fn swings_scaled(&self, factor: f64) -> Self {
        Self {
            mean: self.mean,
            cos: self.cos.map(|c| c * factor),
            sin: self.sin.map(|s| s * factor),
        }
    }

    /// The curve scaled, mean included.
    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self {
            mean: self.mean * factor,
            ..self.swings_scaled(factor)
        }
    }

    /// The sum of two curves.
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self {
            mean: self.mean + other.mean,
            cos: std::array::from_fn(|k| self.cos[k] + other.cos[k]),
            sin: std::array::from_fn(|k| self.sin[k] + other.sin[k]),
        }
    }

    /// The curve about another mean.
    pub(super) fn about(&self, mean: f64) -> Self {
        Self { mean, ..*self }
    }

    /// What changes sign half a stride later: odd harmonics only. In a symmetric gait the base's
    /// roll, yaw and sideways motion are such.
    pub(super) fn antisymmetric(&self) -> Self {
        let mut curve = self.about(0.0);
        for k in (1..ORDER).step_by(2) {
            (curve.cos[k], curve.sin[k]) = (0.0, 0.0); // index k is harmonic k + 1
        }
        curve
    }

    /// What repeats every half stride: even harmonics only, as the base's pitch and height do.
    pub(super) fn symmetric(&self) -> Self {
        let mut curve = *self;
        for k in (0..ORDER).step_by(2) {
            (curve.cos[k], curve.sin[k]) = (0.0, 0.0);
        }
        curve
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> Harmonics {
        Harmonics {
            mean: 1.0,
            cos: [2.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            sin: [3.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        }
    }

    #[test]
    fn quarter_phases_are_sums_of_coefficients() {
        assert!((curve().at(0.0) - 3.5).abs() < 1e-12); // 1 + 2 + 0.5
        // φ = 1/4: cos = 0, −1; sin = 1, 0, −1, so 1 + 3 − 0.5 + 1.
        assert!((curve().at(0.25) - 4.5).abs() < 1e-12);
        assert!((curve().at(1.3) - curve().at(0.3)).abs() < 1e-12);
    }

    #[test]
    fn harmonics_of_a_curve_are_its_own() {
        let again = Harmonics::of(|phase| curve().at(phase));
        for phase in [0.0, 0.3, 0.61] {
            assert!((again.at(phase) - curve().at(phase)).abs() < 1e-12);
        }
    }

    #[test]
    fn shifting_moves_the_phase() {
        for phase in [0.0, 0.13, 0.77] {
            assert!((curve().shifted(0.2).at(phase) - curve().at(phase + 0.2)).abs() < 1e-12);
        }
    }

    #[test]
    fn odd_and_even_parts_make_the_whole() {
        let (odd, even) = (curve().antisymmetric(), curve().symmetric());
        for phase in [0.05, 0.4, 0.9] {
            assert!((odd.at(phase) + odd.at(phase + 0.5)).abs() < 1e-12);
            assert!((even.at(phase) - even.at(phase + 0.5)).abs() < 1e-12);
            assert!((odd.plus(&even).at(phase) - curve().at(phase)).abs() < 1e-12);
        }
    }
}
