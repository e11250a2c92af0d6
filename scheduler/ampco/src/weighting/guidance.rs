//! Adaptive Imitation Guidance, AMPCO's phase I: Eq. 8 and Eq. 9.

use serde::{Deserialize, Serialize};

/// Largest style reward that Eq. 7 can pay, and largest task reward that Eq. 14 can pay:  max rᴳ = max rˢ = R*   (Eq. 8)
pub const EXPECTED_MAXIMUM: f32 = 1.0;

/// What Eq. 7 pays where the discriminator cannot tell policy and reference apart, D = 0:  1 − 0.25·(0 − 1)². The losses of
/// Eq. 3 and 4 leave a policy that moves as the reference does no more than this.
pub const EXPECTED_AT_EQUILIBRIUM: f32 = 0.75;

/// Smallest ceiling handed out: a running maximum of zero could not divide.
const SMALLEST_CEILING: f64 = 1e-6;

/// Task weight of Adaptive Imitation Guidance:  wᴳ = min((rˢ / R*)², 1)   (Eq. 9)
///
/// The task is allowed in only as far as the motion already convinces the discriminator.
#[inline]
pub fn task_weight(style_reward: f32, ceiling: f32) -> f32 {
    (style_reward / ceiling).powi(2).min(1.0)
}

/// What R* is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CeilingKind {
    /// 1, the largest value that the reward can take.
    Bound,
    /// The largest mean reward seen so far.
    RunningMax,
    /// 0.75 for style, what a perfect imitation earns: the discriminator cannot tell it from the reference. 1 for the task.
    Equilibrium,
}

/// R*, the "current expected maximum reward value" (Eq. 8), of one reward signal.
///
/// The paper leaves open whether it is the bound of the reward or what has been reached; [`CeilingKind`] offers both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ceiling {
    kind: CeilingKind,
    equilibrium: f32,
    largest_mean: Option<f64>,
}

impl Ceiling {
    /// R* of the style reward, with nothing seen.
    pub fn of_style(kind: CeilingKind) -> Self {
        Self {
            kind,
            equilibrium: EXPECTED_AT_EQUILIBRIUM,
            largest_mean: None,
        }
    }

    /// R* of the task reward, which has no opponent, with nothing seen.
    pub fn of_task(kind: CeilingKind) -> Self {
        Self {
            equilibrium: EXPECTED_MAXIMUM,
            ..Self::of_style(kind)
        }
    }

    /// Takes an iteration's mean reward into account.
    pub fn observe(&mut self, mean: f64) {
        self.largest_mean = Some(self.largest_mean.map_or(mean, |largest| largest.max(mean)));
    }

    /// R* > 0. A running maximum that has seen nothing stands at the bound.
    pub fn value(&self) -> f32 {
        match (self.kind, self.largest_mean) {
            (CeilingKind::RunningMax, Some(largest)) => largest.max(SMALLEST_CEILING) as f32,
            (CeilingKind::Equilibrium, _) => self.equilibrium,
            (CeilingKind::Bound | CeilingKind::RunningMax, _) => EXPECTED_MAXIMUM,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halfway_to_the_ceiling_grants_a_quarter_of_the_reward() {
        assert_eq!(task_weight(0.5, 1.0), 0.25); // (1/2)²
        assert_eq!(task_weight(0.25, 0.5), 0.25); // (0.25 / 0.5)²
    }

    #[test]
    fn at_and_above_the_ceiling_the_task_gets_everything() {
        assert_eq!(task_weight(1.0, 1.0), 1.0);
        assert_eq!(task_weight(0.9, 0.3), 1.0); // 3² = 9, cut to 1
        assert_eq!(task_weight(0.0, 1.0), 0.0);
    }

    #[test]
    fn the_running_maximum_only_rises() {
        let mut ceiling = Ceiling::of_style(CeilingKind::RunningMax);
        assert_eq!(ceiling.value(), 1.0); // nothing seen yet
        let values = [0.25, 0.5, 0.125].map(|mean| {
            ceiling.observe(mean);
            ceiling.value()
        });
        assert_eq!(values, [0.25, 0.5, 0.5]);
    }

    #[test]
    fn a_reward_of_zero_leaves_a_ceiling_that_can_divide() {
        let mut ceiling = Ceiling::of_style(CeilingKind::RunningMax);
        ceiling.observe(0.0);
        assert_eq!(task_weight(0.0, ceiling.value()), 0.0);
    }

    #[test]
    fn a_perfect_imitation_leaves_the_task_all_the_weight() {
        let mut style = Ceiling::of_style(CeilingKind::Equilibrium);
        style.observe(0.3);
        assert_eq!(task_weight(0.75, style.value()), 1.0);
        assert!((task_weight(0.375, style.value()) - 0.25).abs() < 1e-7); // (1/2)²
        assert_eq!(Ceiling::of_task(CeilingKind::Equilibrium).value(), 1.0);
    }

    #[test]
    fn the_bound_does_not_move() {
        let mut ceiling = Ceiling::of_style(CeilingKind::Bound);
        ceiling.observe(0.3);
        assert_eq!(ceiling.value(), 1.0);
    }
}
