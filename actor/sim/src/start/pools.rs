//! Frames to begin from, sorted by what they do: a robot that keeps to a kind of command begins in motion of it.

use super::Starts;
use crate::kind::{KINDS, Kind};
use rand::{Rng, RngExt};

/// Frames of reference motion by the kind of their command.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pools {
    /// Of each kind: the frame, and the running sum of the kind's weights.
    frames: [Vec<(usize, f32)>; KINDS.len()],
}

impl Pools {
    /// Sorted once, for draws without a search through all frames.
    pub(crate) fn of(starts: &Starts) -> Self {
        let mut pools = Self::default();
        let mut before = 0.0;
        for (frame, &sum) in starts.cumulative_weights.iter().enumerate() {
            let pool = &mut pools.frames[Kind::of(starts.commands[frame]) as usize];
            let within = pool.last().map_or(0.0, |&(_, sum)| sum);
            pool.push((frame, within + sum - before));
            before = sum;
        }
        pools
    }

    /// A frame of a kind by weight; none if no motion is of that kind.
    pub(crate) fn draw(&self, kind: Kind, rng: &mut impl Rng) -> Option<usize> {
        let pool = &self.frames[kind as usize];
        let &(_, total) = pool.last()?;
        let at = rng.random::<f32>() * total;
        let place = pool.partition_point(|&(_, sum)| sum <= at);
        Some(pool[place.min(pool.len() - 1)].0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use g1::RobotState;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn frames_are_drawn_by_weight_within_their_kind() {
        let frame = |command, weight| (RobotState::standing(), command, weight);
        let starts: Starts = [
            frame([0.8, 0.0, 0.0], 5.0),
            frame([0.0, 0.3, 0.0], 1.0),
            frame([0.0; 3], 2.0),
            frame([0.0, -0.3, 0.0], 3.0),
        ]
        .into_iter()
        .collect();
        let pools = Pools::of(&starts);
        let mut rng = Pcg64Mcg::seed_from_u64(2);
        let mut drawn = [0; 4];
        for _ in 0..1_000 {
            drawn[pools.draw(Kind::Lateral, &mut rng).unwrap()] += 1;
        }
        // Weight 3 of 4: Binomial(1000, ¾) is 750 ± 13.7.
        assert!(drawn[0] == 0 && drawn[2] == 0 && (682..818).contains(&drawn[3]));
        assert_eq!(pools.draw(Kind::Standing, &mut rng), Some(2));
        assert_eq!(pools.draw(Kind::Turning, &mut rng), None);
    }
}
