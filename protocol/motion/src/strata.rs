//! Every speed alike: shares of transitions by the speed at which they happen.
//!
//! Separate because it cuts across clips: most captures walk at one comfortable speed, and a
//! discriminator that sees little else asks for it whatever the command is.

use crate::clip::Clip;
use crate::quality::speeds;
use rand::{Rng, RngExt};

/// Width of a stratum, m/s.
pub const STRATUM: f64 = 0.25;

/// Transitions with their shares.
#[derive(Clone, Debug)]
pub(crate) struct Strata {
    /// Running sum of shares over all transitions of all clips.
    cumulative: Vec<f64>,
    /// Where each clip's transitions begin.
    starts: Vec<usize>,
}

impl Strata {
    /// The shares of clips: within a stratum by weight, as without strata; all strata alike.
    pub(crate) fn of(clips: &[Clip]) -> Self {
        let (mut weights, mut places, mut starts) = (Vec::new(), Vec::new(), Vec::new());
        for clip in clips {
            starts.push(weights.len());
            let weight = f64::from(clip.weight) / clip.transitions() as f64;
            for speed in speeds(clip).iter().take(clip.transitions()) {
                weights.push(weight);
                places.push(stratum(*speed));
            }
        }
        let count = places.iter().max().map_or(0, |most| most + 1);
        let mut totals = vec![0.0; count];
        for (place, weight) in places.iter().zip(&weights) {
            totals[*place] += weight;
        }
        let mut sum = 0.0;
        let cumulative = places
            .iter()
            .zip(&weights)
            .map(|(place, weight)| {
                sum += weight / totals[*place];
                sum
            })
            .collect();
        Self { cumulative, starts }
    }

    /// Draws a transition: its clip and its first frame.
    pub(crate) fn draw(&self, rng: &mut impl Rng) -> (usize, usize) {
        let drawn = rng.random::<f64>() * self.cumulative[self.cumulative.len() - 1];
        let at = self.cumulative.partition_point(|sum| *sum <= drawn);
        let at = at.min(self.cumulative.len() - 1); // rounding may draw the total itself
        let clip = self.starts.partition_point(|start| *start <= at) - 1;
        (clip, at - self.starts[clip])
    }

    /// The share of a transition; 0 for a last frame from which none begins.
    pub(crate) fn share(&self, clip: usize, frame: usize) -> f32 {
        let at = self.starts[clip] + frame;
        let end = self
            .starts
            .get(clip + 1)
            .copied()
            .unwrap_or(self.cumulative.len());
        if at >= end {
            return 0.0;
        }
        let before = at.checked_sub(1).map_or(0.0, |i| self.cumulative[i]);
        (self.cumulative[at] - before) as f32
    }
}

/// The stratum of a speed, m/s.
pub fn stratum(speed: f64) -> usize {
    (speed / STRATUM) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn every_speed_has_the_same_share_however_rare_it_is() {
        let mut walk = gait::walk(0.9).unwrap();
        walk.weight = 9.0;
        let clips = [walk, gait::walk(0.6).unwrap(), gait::walk(1.6).unwrap()];
        let strata = Strata::of(&clips);
        let mut rng = Pcg64Mcg::seed_from_u64(5);
        let mut drawn = [0; 3];
        for _ in 0..6000 {
            let (clip, frame) = strata.draw(&mut rng);
            assert!(frame < clips[clip].transitions());
            drawn[clip] += 1;
        }
        // Three speeds in three strata: 2000 each, σ = 37.
        assert!(drawn.iter().all(|n| (1850..2150).contains(n)), "{drawn:?}");
        let share = |clip: usize| -> f32 {
            (0..clips[clip].frames.len())
                .map(|i| strata.share(clip, i))
                .sum()
        };
        for clip in 0..3 {
            assert!((share(clip) - 1.0).abs() < 1e-4, "{}", share(clip));
        }
    }

    #[test]
    fn within_a_speed_weights_decide() {
        let (a, mut b) = (gait::walk(0.8).unwrap(), gait::walk(0.9).unwrap());
        b.weight = 3.0;
        let strata = Strata::of(&[a, b.clone()]);
        let share: f32 = (0..b.frames.len()).map(|i| strata.share(1, i)).sum();
        assert!((share - 0.75).abs() < 1e-4, "{share}");
    }
}
