//! Arms that somebody else holds for a while: carrying, gesturing, shaken by the hand. Whatever the policy wants of them,
//! their motors hold another pose.

use super::spell::Spell;
use crate::command;
use crate::randomization::uniform;
use g1::joints::LEFT_ARM;
use g1::{DEFAULT_POSE, JOINT_TABLE, JOINTS};
use rand::Rng;
use serde::{Deserialize, Serialize};

/// Joints of both arms, the last of all.
const ARMS: usize = JOINTS - LEFT_ARM;

/// A robot whose arms are held now and then.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Held {
    /// Control steps until the next hold, of this one the rest if they are held.
    steps: u32,
    /// Where the arms are held, rad; none while they are the policy's.
    pose: Option<[f32; ARMS]>,
}

impl Held {
    /// At the start of an episode.
    pub(crate) fn new(row: Option<&Spell>, rng: &mut impl Rng) -> Self {
        let steps = row.map_or(0, |row| command::steps(row.seconds, rng));
        Self { steps, pose: None }
    }

    /// Puts the arms' targets of the coming control step where they are held, if they are.
    pub(crate) fn step(
        &mut self,
        row: Option<&Spell>,
        targets: &mut [f32; JOINTS],
        rng: &mut impl Rng,
    ) {
        let Some(row) = row else {
            *self = Self::default();
            return;
        };
        self.steps = self.steps.saturating_sub(1);
        if self.steps == 0 {
            (self.steps, self.pose) = match self.pose {
                Some(_) => (command::steps(row.seconds, rng), None),
                None => (command::steps(row.duration, rng), Some(pose(row, rng))),
            };
        }
        if let Some(pose) = &self.pose {
            targets[LEFT_ARM..].copy_from_slice(pose);
        }
    }
}

/// A pose of both arms that their joints can take: an angle is drawn, and each joint is held by up to as much to either side of
/// the default pose.
fn pose(row: &Spell, rng: &mut impl Rng) -> [f32; ARMS] {
    let angle = uniform(row.range, rng);
    std::array::from_fn(|i| {
        let joint = LEFT_ARM + i;
        let target = DEFAULT_POSE[joint] + uniform([-angle, angle], rng);
        let row = &JOINT_TABLE[joint];
        target.clamp(row.lower as f32, row.upper as f32)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn arms_are_held_and_let_go_in_time_and_legs_are_not_touched() {
        let row = Spell {
            range: [0.5, 0.5],
            duration: [0.1, 0.1],
            seconds: [0.2, 0.2],
        };
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let mut held = Held::new(Some(&row), &mut rng);
        let mut poses = Vec::new();
        // 0.2 s are ten steps, 0.1 s five: held from the 10th to the 14th, the 25th to the 29th, the 40th.
        for step in 1..=40 {
            let mut targets = [9.0; JOINTS];
            held.step(Some(&row), &mut targets, &mut rng);
            assert!(targets[..LEFT_ARM].iter().all(|target| *target == 9.0));
            let arms = &targets[LEFT_ARM..];
            let is_held = arms.iter().all(|target| *target != 9.0);
            assert_eq!(is_held, step % 15 >= 10, "{step}");
            if is_held {
                let off = arms.iter().zip(&DEFAULT_POSE[LEFT_ARM..]);
                assert!(off.clone().all(|(a, b)| (a - b).abs() <= 0.5 + 1e-6));
                poses.push(arms.to_vec());
            }
        }
        // One pose while they are held, another the next time.
        assert_eq!((poses[0].clone(), poses.len()), (poses[4].clone(), 11));
        assert_ne!(poses[0], poses[5]);
    }

    #[test]
    fn without_the_row_nothing_is_held() {
        let (mut rng, mut same) = (Pcg64Mcg::seed_from_u64(2), Pcg64Mcg::seed_from_u64(2));
        let mut held = Held::new(None, &mut rng);
        let mut targets = [9.0; JOINTS];
        held.step(None, &mut targets, &mut rng);
        assert_eq!(targets, [9.0; JOINTS]);
        assert_eq!(
            uniform([0.0, 1.0], &mut rng),
            uniform([0.0, 1.0], &mut same)
        );
    }
}
