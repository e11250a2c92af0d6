//! Percentile-based breakout detection: Eq. 10, Eq. 11 and Algorithm 1.
//!
//! As long as the reward improves, new values keep exceeding the p-th percentile of their own recent history. When they
//! do so less often than chance would have it, the reward has stopped improving.

use crate::window::Window;

/// Breakout indicator:  b = 1\[r̄ˢ > P\]   (Eq. 10)
pub fn breaks_out(style_mean: f64, boundary: f64) -> bool {
    style_mean > boundary
}

/// Breakout rate below which the reward counts as converged:  1 − p   (Algorithm 1, line 6; p as a fraction)
///
/// Rounded to twelve decimals: 1 − 0.95 is 0.05000000000000004 in binary, and a rate of exactly 50 in 1000 would then
/// pass for being below one twentieth.
pub fn convergence_threshold(percentile: f64) -> f64 {
    ((1.0 - percentile) * 1e12).round() / 1e12
}

/// The last W breakout indicators.
#[derive(Clone, Debug)]
pub struct Indicators {
    ring: Vec<bool>,
    capacity: usize,
    oldest: usize,
    ones: usize,
}

impl Indicators {
    /// Room for the last `capacity` indicators.
    pub fn new(capacity: usize) -> Self {
        Self {
            ring: Vec::with_capacity(capacity),
            capacity,
            oldest: 0,
            ones: 0,
        }
    }

    /// Appends an indicator; the oldest leaves when W are held.
    pub fn push(&mut self, indicator: bool) {
        self.ones += usize::from(indicator);
        if self.ring.len() < self.capacity {
            self.ring.push(indicator);
        } else {
            self.ones -= usize::from(self.ring[self.oldest]);
            self.ring[self.oldest] = indicator;
            self.oldest = (self.oldest + 1) % self.capacity;
        }
    }

    /// Breakout rate over the last W indicators:  β = (1/W)·Σ b   (Eq. 11); none before there are W.
    pub fn rate(&self) -> Option<f64> {
        (self.ring.len() == self.capacity).then(|| self.ones as f64 / self.capacity as f64)
    }

    fn clear(&mut self) {
        self.ring.clear();
        (self.oldest, self.ones) = (0, 0);
    }
}

/// What appending one reward showed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// P, the percentile of the window before this reward; none while it held fewer than two values.
    pub boundary: Option<f64>,
    /// β; none before W indicators exist.
    pub breakout_rate: Option<f64>,
    /// Whether Algorithm 1 returns true.
    pub converged: bool,
}

/// Algorithm 1: the reward window, the indicator window and the test.
#[derive(Clone, Debug)]
pub struct Detector {
    rewards: Window,
    indicators: Indicators,
    threshold: f64,
}

impl Detector {
    /// A detector over the last `window` ≥ 2 iterations, with `percentile` p strictly between 0 and 1.
    pub fn new(window: usize, percentile: f64) -> Self {
        Self {
            rewards: Window::new(window, percentile),
            indicators: Indicators::new(window),
            threshold: convergence_threshold(percentile),
        }
    }

    /// One round of Algorithm 1 with this iteration's mean style reward (finite).
    ///
    /// Convergence:  β < 1 − p  and  |𝓑| = W. Both windows hold W values by then, so that β is what Eq. 11 says; the
    /// first test is made on the (W + 2)-th reward, as the first two give no indicator.
    pub fn append(&mut self, style_mean: f64) -> Observation {
        // Line 2: the percentile of the history, the newest value not yet in it. One value is no distribution.
        let boundary = if self.rewards.len() < 2 {
            None
        } else {
            self.rewards.percentile()
        };
        if let Some(boundary) = boundary {
            self.indicators.push(breaks_out(style_mean, boundary)); // line 3
        }
        let breakout_rate = self.indicators.rate(); // line 4
        self.rewards.push(style_mean); // line 5
        let converged =
            self.rewards.is_full() && breakout_rate.is_some_and(|rate| rate < self.threshold); // line 6
        Observation {
            boundary,
            breakout_rate,
            converged,
        }
    }

    /// The reward window 𝓑.
    pub fn rewards(&self) -> &Window {
        &self.rewards
    }

    /// β as of the newest reward; none before W indicators exist.
    pub fn breakout_rate(&self) -> Option<f64> {
        self.indicators.rate()
    }

    /// 1 − p
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// Forgets all history.
    pub fn clear(&mut self) {
        self.rewards.clear();
        self.indicators.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_exceeding_the_boundary_is_a_breakout() {
        assert!(breaks_out(0.51, 0.5));
        assert!(!breaks_out(0.5, 0.5));
    }

    #[test]
    fn the_rate_is_the_share_of_ones_among_the_last_w() {
        let mut indicators = Indicators::new(4);
        let rates = [true, true, false, true, false, false].map(|b| {
            indicators.push(b);
            indicators.rate()
        });
        // 1101 → 3/4, then 1010 → 2/4, then 0100 → 1/4
        assert_eq!(rates, [None, None, None, Some(0.75), Some(0.5), Some(0.25)]);
    }

    #[test]
    fn a_rate_equal_to_the_threshold_is_not_below_it() {
        let mut indicators = Indicators::new(1000);
        (0..1000).for_each(|i| indicators.push(i < 50));
        assert_eq!(indicators.rate(), Some(convergence_threshold(0.95))); // 50/1000 = 1 − 0.95
        assert_ne!(convergence_threshold(0.95), 1.0 - 0.95); // unrounded, 0.05 would have passed for below it
    }

    #[test]
    fn a_window_of_three_by_hand() {
        // W = 3, p = 0.5: the boundary is the median, convergence is β < 0.5.
        let mut detector = Detector::new(3, 0.5);
        let seen = [1.0, 2.0, 3.0, 4.0, 5.0, 4.0, 3.0].map(|reward| detector.append(reward));
        // Boundaries before each reward: –, –, med(1 2) = 1.5, med(1 2 3) = 2, 3, 4, med(4 5 4) = 4.
        assert_eq!(
            seen.map(|o| o.boundary),
            [
                None,
                None,
                Some(1.5),
                Some(2.0),
                Some(3.0),
                Some(4.0),
                Some(4.0)
            ]
        );
        // Indicators from the third reward on: 3 > 1.5, 4 > 2, 5 > 3, then 4 > 4 fails, 3 > 4 fails.
        let third = 1.0 / 3.0;
        assert_eq!(
            seen.map(|o| o.breakout_rate),
            [
                None,
                None,
                None,
                None,
                Some(1.0),
                Some(2.0 * third),
                Some(third)
            ]
        );
        assert_eq!(
            seen.map(|o| o.converged),
            [false, false, false, false, false, false, true]
        );
    }

    #[test]
    fn nothing_converges_before_both_windows_are_full() {
        let mut detector = Detector::new(10, 0.9);
        // A constant reward never breaks out, so β is 0 as soon as it exists: with the tenth indicator.
        let first = (1..).find(|_| detector.append(0.3).converged).unwrap();
        assert_eq!(first, 12); // W + 2
    }
}
