//! The sliding window 𝓑 of the last W mean rewards, with its percentile, moments and slope.
//!
//! All memory is taken at construction. Appending costs O(log W), reading percentile and slope O(1).

use crate::ranks::Ranks;

/// The last `capacity` values in the order they came.
#[derive(Clone, Debug)]
pub struct Window {
    capacity: usize,
    ranks: Ranks,
    /// Slot of the oldest value once the window is full.
    oldest: usize,
    /// First value ever seen. The sums are taken relative to it: a constant stream then has sums, and slope, exactly zero.
    origin: f64,
    /// Σ y over the window.
    sum: f64,
    /// Σ i·y over the window, i = 0 for the oldest value.
    moment: f64,
}

impl Window {
    /// An empty window of `capacity` ≥ 2 values whose percentile is the given fraction, 0 < `percentile` < 1.
    pub fn new(capacity: usize, percentile: f64) -> Self {
        Self {
            capacity,
            ranks: Ranks::new(capacity, percentile),
            oldest: 0,
            origin: 0.0,
            sum: 0.0,
            moment: 0.0,
        }
    }

    /// Values held.
    pub fn len(&self) -> usize {
        self.ranks.values().len()
    }

    /// Whether nothing was appended yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether W values are held.
    pub fn is_full(&self) -> bool {
        self.len() == self.capacity
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.ranks.clear();
        (self.oldest, self.sum, self.moment) = (0, 0.0, 0.0);
    }

    /// Appends a finite value; the oldest leaves a full window.
    pub fn push(&mut self, value: f64) {
        if self.is_empty() {
            self.origin = value;
        }
        let newest = value - self.origin;
        if self.is_full() {
            let leaving = self.ranks.values()[self.oldest] - self.origin;
            self.ranks.replace(self.oldest, value);
            self.oldest = (self.oldest + 1) % self.capacity;
            // Every remaining value moves one place towards the oldest.
            self.sum -= leaving;
            self.moment += (self.capacity - 1) as f64 * newest - self.sum;
            self.sum += newest;
        } else {
            self.moment += self.len() as f64 * newest;
            self.sum += newest;
            self.ranks.push(value);
        }
    }

    /// The p-th percentile by linear interpolation between neighbours, the default of numpy: with the n values sorted
    /// and counted from zero, h = p·(n − 1) and P = x₍⌊h⌋₎ + (h − ⌊h⌋)·(x₍⌊h⌋₊₁₎ − x₍⌊h⌋₎). None while empty.
    pub fn percentile(&self) -> Option<f64> {
        self.ranks.at_fraction()
    }

    /// Arithmetic mean; none while empty.
    pub fn mean(&self) -> Option<f64> {
        let n = self.len() as f64;
        (n > 0.0).then(|| self.ranks.values().iter().sum::<f64>() / n)
    }

    /// Population standard deviation (divided by n, not n − 1), O(W): needed once in a run. None while empty.
    pub fn deviation(&self) -> Option<f64> {
        let mean = self.mean()?;
        let squares: f64 = self
            .ranks
            .values()
            .iter()
            .map(|value| (value - mean).powi(2))
            .sum();
        Some((squares / self.len() as f64).sqrt())
    }

    /// Slope of the least-squares line through the window, in reward per iteration; none with fewer than two values.
    ///
    /// With i = 0…n−1:  slope = 12·(Σ i·y − (n−1)/2·Σ y) / (n·(n² − 1)).
    pub fn slope(&self) -> Option<f64> {
        let n = self.len() as f64;
        (n >= 2.0).then(|| 12.0 * (self.moment - (n - 1.0) / 2.0 * self.sum) / (n * (n * n - 1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, RngExt, SeedableRng};

    fn window_of(capacity: usize, percentile: f64, values: &[f64]) -> Window {
        let mut window = Window::new(capacity, percentile);
        values.iter().for_each(|&value| window.push(value));
        window
    }

    #[test]
    fn percentiles_by_hand() {
        // n = 5, p = 0.9: h = 3.6, between 40 and 50 → 40 + 0.6·10
        assert!(
            (window_of(5, 0.9, &[50.0, 10.0, 40.0, 20.0, 30.0])
                .percentile()
                .unwrap()
                - 46.0)
                .abs()
                < 1e-12
        );
        // n = 4, p = 0.5: h = 1.5, the middle of 2 and 3
        assert_eq!(
            window_of(8, 0.5, &[4.0, 1.0, 3.0, 2.0]).percentile(),
            Some(2.5)
        );
        // n = 2, p = 0.95: 1 + 0.95·(2 − 1)
        assert_eq!(window_of(8, 0.95, &[2.0, 1.0]).percentile(), Some(1.95));
        assert_eq!(window_of(8, 0.95, &[7.0]).percentile(), Some(7.0));
        assert_eq!(window_of(8, 0.95, &[]).percentile(), None);
    }

    #[test]
    fn the_oldest_value_leaves_a_full_window() {
        // Of 9 1 2 3 the last three remain: median 2, mean 2.
        let window = window_of(3, 0.5, &[9.0, 1.0, 2.0, 3.0]);
        assert!(window.is_full());
        assert_eq!((window.percentile(), window.mean()), (Some(2.0), Some(2.0)));
    }

    #[test]
    fn moments_by_hand() {
        // 2 4 4 4 5 5 7 9: mean 5, squares 9+1+1+1+0+0+4+16 = 32, √(32/8) = 2
        let window = window_of(8, 0.95, &[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert_eq!((window.mean(), window.deviation()), (Some(5.0), Some(2.0)));
    }

    #[test]
    fn the_slope_of_a_line_is_its_slope_also_after_sliding() {
        let line: Vec<f64> = (0..10).map(|i| 3.0 - 0.5 * f64::from(i)).collect();
        assert!((window_of(4, 0.5, &line).slope().unwrap() + 0.5).abs() < 1e-12);
        // 1 2 4: Σ y = 7, Σ i·y = 10; 12·(10 − 7)/(3·8) = 1.5
        assert!((window_of(4, 0.5, &[1.0, 2.0, 4.0]).slope().unwrap() - 1.5).abs() < 1e-12);
    }

    #[test]
    fn a_constant_stream_has_no_slope_at_all() {
        assert_eq!(window_of(7, 0.95, &[0.3; 50]).slope(), Some(0.0));
    }

    #[test]
    fn clearing_forgets() {
        let mut window = window_of(3, 0.5, &[1.0, 5.0, 9.0, 2.0]);
        window.clear();
        [1.0, 2.0, 4.0]
            .into_iter()
            .for_each(|value| window.push(value));
        assert_eq!(window.percentile(), Some(2.0));
        assert!((window.slope().unwrap() - 1.5).abs() < 1e-12);
    }

    #[test]
    fn percentile_and_slope_agree_with_sorting_and_summing_on_random_streams() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(7);
        for (capacity, percentile) in [(2, 0.5), (3, 0.95), (17, 0.9), (100, 0.95), (257, 0.01)] {
            let mut window = Window::new(capacity, percentile);
            let mut all: Vec<f64> = Vec::new();
            for _ in 0..1000 {
                // Few distinct values, so that ties are common.
                let value =
                    f64::from(rng.next_u32() % 50) + if rng.random::<bool>() { 0.25 } else { 0.0 };
                all.push(value);
                window.push(value);
                let recent = &all[all.len().saturating_sub(capacity)..];
                let mut sorted = recent.to_vec();
                sorted.sort_by(f64::total_cmp);
                let h = percentile * (sorted.len() - 1) as f64;
                let (low, high) = (
                    sorted[h as usize],
                    sorted[(h as usize + 1).min(sorted.len() - 1)],
                );
                assert_eq!(
                    window.percentile(),
                    Some(low + (h - h.floor()) * (high - low))
                );
                if recent.len() >= 2 {
                    let middle = (recent.len() - 1) as f64 / 2.0;
                    let arm = |i: usize| i as f64 - middle;
                    let above: f64 = recent.iter().enumerate().map(|(i, y)| arm(i) * y).sum();
                    let below: f64 = (0..recent.len()).map(|i| arm(i) * arm(i)).sum();
                    assert!((window.slope().unwrap() - above / below).abs() < 1e-9);
                }
            }
        }
    }
}
