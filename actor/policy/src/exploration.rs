//! How the robots of a fleet try: which of them calmly, and how long what is tried lasts.

use rand::Rng;

use crate::{OUTPUTS, normal};

/// Seconds of a control step.
const STEP: f64 = 0.02;

/// The noise of each robot's exploration, from one control step to the next.
///
/// zₜ = ρ·zₜ₋₁ + √(1 − ρ²)·ηₜ,  η standard normal, so that every zₜ is standard normal by itself; ρ = e^(−0.02 s / memory).
/// With a memory of 0 every step draws anew. What is tried for a single step of 20 ms hardly moves a leg, and of what comes of
/// it little is its own: noise that lasts tries movements.
#[derive(Clone, Debug, PartialEq)]
pub struct Exploration {
    calm: usize,
    /// ρ, and √(1 − ρ²).
    keep: f32,
    renew: f32,
    /// z of each robot.
    noise: Vec<[f32; OUTPUTS]>,
}

impl Exploration {
    /// For so many robots, the last `calm` of which explore calmly, with noise of so many seconds' `memory`.
    ///
    /// Draws from `rng` only if there is a memory.
    ///
    /// # Panics
    /// If more robots are calm than there are, or the memory is negative or no number.
    pub fn new<R: Rng + ?Sized>(robots: usize, calm: usize, memory: f32, rng: &mut R) -> Self {
        assert!(calm <= robots, "{calm} calm robots of {robots}");
        assert!(memory >= 0.0, "a memory of {memory} s");
        let keep = if memory > 0.0 {
            (-STEP / f64::from(memory)).exp()
        } else {
            0.0
        };
        let noise = (0..robots)
            .map(|_| {
                if memory > 0.0 {
                    normal::row(rng)
                } else {
                    [0.0; OUTPUTS]
                }
            })
            .collect();
        Self {
            calm,
            keep: keep as f32,
            renew: (1.0 - keep * keep).sqrt() as f32,
            noise,
        }
    }

    /// For so many robots that all explore alike, every step anew.
    pub fn plain(robots: usize) -> Self {
        Self {
            calm: 0,
            keep: 0.0,
            renew: 1.0,
            noise: vec![[0.0; OUTPUTS]; robots],
        }
    }

    /// z of all robots `[robots][joints]`, to be written down.
    pub fn noise(&self) -> &[f32] {
        self.noise.as_flattened()
    }

    /// Goes on from a z that was written down; whether it is of so many robots.
    pub fn restore(&mut self, noise: &[f32]) -> bool {
        let fits = noise.len() == self.noise.len() * OUTPUTS;
        if fits {
            self.noise.as_flattened_mut().copy_from_slice(noise);
        }
        fits
    }

    /// Robots that explore as widely as σ says, and those that are calm.
    pub(crate) fn parts(&mut self) -> [Trying<'_>; 2] {
        let (keep, renew) = (self.keep, self.renew);
        let wide = self.noise.len() - self.calm;
        let (wide, calm) = self.noise.split_at_mut(wide);
        [wide, calm].map(|noise| Trying { keep, renew, noise })
    }
}

/// Noise of some of the robots.
pub(crate) struct Trying<'a> {
    keep: f32,
    renew: f32,
    pub(crate) noise: &'a mut [[f32; OUTPUTS]],
}

impl Trying<'_> {
    /// The next z of a robot.
    #[inline(always)]
    pub(crate) fn next<R: Rng + ?Sized>(&mut self, robot: usize, rng: &mut R) -> [f32; OUTPUTS] {
        let fresh = normal::row(rng);
        let z = &mut self.noise[robot];
        for i in 0..OUTPUTS {
            z[i] = self.keep * z[i] + self.renew * fresh[i];
        }
        *z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    #[test]
    fn noise_that_remembers_is_as_wide_and_fades_by_the_memory() {
        let mut rng = Pcg64::seed_from_u64(1);
        // 0.1 s: ρ = e^(−0.2) = 0.8187, after five steps e^(−1) = 0.3679.
        let mut exploration = Exploration::new(1, 0, 0.1, &mut rng);
        let steps = 40_000;
        let rows: Vec<[f32; OUTPUTS]> = (0..steps)
            .map(|_| exploration.parts()[0].next(0, &mut rng))
            .collect();
        let product = |lag: usize| {
            let pairs = rows.iter().zip(&rows[lag..]);
            let sum: f64 = pairs
                .map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a * b)).sum::<f64>())
                .sum();
            sum / (OUTPUTS * (steps - lag)) as f64
        };
        // 920,000 numbers, of which one in ten is new: standard error 0.005.
        for (lag, expected) in [(0, 1.0), (1, 0.8187), (5, 0.3679)] {
            assert!((product(lag) - expected).abs() < 0.02, "{}", product(lag));
        }
    }

    #[test]
    fn without_a_memory_every_step_is_drawn_anew() {
        let (mut rng, mut same) = (Pcg64::seed_from_u64(2), Pcg64::seed_from_u64(2));
        let mut exploration = Exploration::new(3, 1, 0.0, &mut rng);
        assert_eq!(exploration, Exploration { calm: 1, ..Exploration::plain(3) });
        for _ in 0..4 {
            let [mut wide, _] = exploration.parts();
            assert_eq!(wide.next(1, &mut rng), normal::row(&mut same));
        }
    }

    #[test]
    fn it_goes_on_where_it_was() {
        let mut rng = Pcg64::seed_from_u64(3);
        let first = Exploration::new(2, 0, 0.1, &mut rng);
        let mut second = Exploration::new(2, 0, 0.1, &mut rng);
        assert_ne!(first, second);
        assert!(second.restore(first.noise()));
        assert_eq!(first, second);
        assert!(!second.restore(&first.noise()[1..]));
    }
}
