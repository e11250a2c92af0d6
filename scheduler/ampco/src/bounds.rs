//! Behavioural bounds from the reward at convergence: Eq. 13.
//!
//! Separate from the rule that uses them because bounds are born once, when convergence is found, and never move again.

/// Half width given to bounds whose reward did not vary: Eq. 12 divides by their distance.
const SMALLEST_HALF_WIDTH: f64 = 1e-4;

/// Limits of the style reward in phase II. They exist only once convergence has been found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    lower: f64,
    upper: f64,
}

/// Half width of the bounds in standard deviations:  k = √(1 / (1 − α))   (Chebyshev's inequality, under Eq. 13)
pub fn chebyshev_factor(alpha: f64) -> f64 {
    (1.0 / (1.0 - alpha)).sqrt()
}

impl Bounds {
    /// Bounds that hold at least a share α of the reward:  μ_upper = μ + k·σ,  μ_lower = μ − k·σ   (Eq. 13)
    ///
    /// `mean` and `deviation` are finite, `deviation` ≥ 0, `alpha` in \[0, 1). The lower bound may lie below zero, the
    /// upper above one: Eq. 13 does not cut them, and Eq. 12 works with them as they are.
    pub fn around(mean: f64, deviation: f64, alpha: f64) -> Self {
        let half_width = (chebyshev_factor(alpha) * deviation).max(SMALLEST_HALF_WIDTH);
        Self {
            lower: mean - half_width,
            upper: mean + half_width,
        }
    }

    /// Whether the lower and the upper bound lie outside what Eq. 7 can pay, 0 to 1: Eq. 12 then never gives one of the
    /// rewards all the weight.
    pub fn idle(&self) -> [bool; 2] {
        [self.lower < 0.0, self.upper > 1.0]
    }

    /// μ lower.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// μ upper, always above the lower bound.
    pub fn upper(&self) -> f64 {
        self.upper
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_paper_s_factor_for_ninety_five_percent() {
        assert!((chebyshev_factor(0.95) - 20.0_f64.sqrt()).abs() < 1e-9); // √(1 / 0.05) = √20 ≈ 4.47
        assert!((chebyshev_factor(0.75) - 2.0).abs() < 1e-12); // √4
    }

    #[test]
    fn bounds_stand_k_deviations_from_the_mean() {
        let bounds = Bounds::around(0.5, 0.125, 0.75); // 0.5 ± 2·0.125
        assert_eq!((bounds.lower(), bounds.upper()), (0.25, 0.75));
    }

    #[test]
    fn bounds_outside_the_reward_s_range_are_idle() {
        let idle = |mean, deviation| Bounds::around(mean, deviation, 0.75).idle(); // mean ± 2·deviation
        assert_eq!(idle(0.5, 0.25), [false, false]); // 0 and 1 can be reached
        assert_eq!(idle(0.5, 0.375), [true, true]); // −0.25, 1.25
        assert_eq!(idle(0.25, 0.25), [true, false]); // −0.25, 0.75
        assert_eq!(idle(0.75, 0.25), [false, true]); // 0.25, 1.25
    }

    #[test]
    fn a_reward_that_never_varied_still_gets_bounds_that_can_divide() {
        let bounds = Bounds::around(0.3, 0.0, 0.95);
        assert!(bounds.lower() < bounds.upper());
        assert!(((bounds.lower() + bounds.upper()) / 2.0 - 0.3).abs() < 1e-12);
    }
}
