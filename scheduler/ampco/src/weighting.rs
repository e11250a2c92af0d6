//! The rules that turn rewards into weights, as rivals side by side.
//!
//! The scheduler chooses a [`Rule`]; whoever holds the rewards evaluates it. Both call the functions of this module, so
//! a rule can travel between processes as a few numbers and means the same at both ends.

pub mod adamimic;
pub mod guidance;
mod numbers;
pub mod roger;

pub use numbers::{Numbers, Weighting};

use serde::{Deserialize, Serialize};

use crate::Weights;

/// How the weights of Eq. 1 follow from the rewards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Constant weights: plain AMP.
    Fixed {
        /// wˢ in \[0, 1\].
        style_weight: f32,
    },
    /// Adaptive Imitation Guidance, the task weight grows with the style reward (Eq. 9): AMPCO's phase I.
    Guided {
        /// R* > 0 of the style reward.
        ceiling: f32,
    },
    /// The task weight grows with the task reward: the AdaMimic baseline.
    AdaMimic {
        /// R* > 0 of the task reward.
        ceiling: f32,
    },
    /// The style weight grows as the style reward sinks from the upper to the lower bound (Eq. 12): phase II, and ROGER.
    Bounded {
        /// μ lower.
        lower: f32,
        /// μ upper > μ lower.
        upper: f32,
    },
}

/// Whose reward a rule is evaluated on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Granularity {
    /// Each transition's own.
    Sample,
    /// The mean over the iteration's batch.
    Mean,
}

/// Why a rule that came from elsewhere cannot be evaluated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RuleError {
    /// No rule has this number.
    #[error("rule {0} is unknown, known are 0 to 3")]
    UnknownRule(u32),
    /// No granularity has this number.
    #[error("granularity {0} is unknown, known are 0 and 1")]
    UnknownGranularity(u32),
    /// A style weight that is no share.
    #[error("style weight {0} is outside [0, 1]")]
    StyleWeight(f32),
    /// A ceiling that cannot divide.
    #[error("ceiling {0} is not a positive finite number")]
    Ceiling(f32),
    /// Bounds that enclose nothing.
    #[error("lower bound {lower} is not below the upper bound {upper}, or one is not finite")]
    Bounds {
        /// μ lower as received.
        lower: f32,
        /// μ upper as received.
        upper: f32,
    },
}

impl Rule {
    /// Weights for one pair of rewards: of a transition, or the batch's means (see [`crate::Granularity`]).
    #[inline]
    pub fn weights(&self, style_reward: f32, task_reward: f32) -> Weights {
        match *self {
            Self::Fixed { style_weight } => Weights::from_style(style_weight),
            Self::Guided { ceiling } => {
                Weights::from_task(guidance::task_weight(style_reward, ceiling))
            }
            Self::AdaMimic { ceiling } => {
                Weights::from_task(adamimic::task_weight(task_reward, ceiling))
            }
            Self::Bounded { lower, upper } => {
                Weights::from_style(roger::style_weight(style_reward, lower, upper))
            }
        }
    }

    /// Blended reward of each transition, weighted by its own rewards: [`Self::weights`] and Eq. 1 over slices of equal
    /// length. The rule is looked at once, so that the loop over the transitions runs on vectors.
    pub fn blend_each(&self, style_rewards: &[f32], task_rewards: &[f32], blended: &mut [f32]) {
        /// Compiled anew for each rule, of which `weights` then sees only the one.
        #[inline(always)]
        fn each(
            rewards: (&[f32], &[f32]),
            blended: &mut [f32],
            weights: impl Fn(f32, f32) -> Weights,
        ) {
            assert_eq!(
                (rewards.0.len(), rewards.1.len()),
                (blended.len(), blended.len())
            );
            for ((blended, &style), &task) in blended.iter_mut().zip(rewards.0).zip(rewards.1) {
                *blended = weights(style, task).blend(task, style);
            }
        }
        let rewards = (style_rewards, task_rewards);
        match *self {
            Self::Fixed { style_weight } => each(rewards, blended, |s, t| {
                Self::Fixed { style_weight }.weights(s, t)
            }),
            Self::Guided { ceiling } => each(rewards, blended, |s, t| {
                Self::Guided { ceiling }.weights(s, t)
            }),
            Self::AdaMimic { ceiling } => each(rewards, blended, |s, t| {
                Self::AdaMimic { ceiling }.weights(s, t)
            }),
            Self::Bounded { lower, upper } => {
                each(rewards, blended, |s, t| {
                    Self::Bounded { lower, upper }.weights(s, t)
                });
            }
        }
    }

    /// Refuses parameters that would make [`Self::weights`] meaningless; rules made by a [`crate::Schedule`] pass.
    pub fn validate(&self) -> Result<(), RuleError> {
        match *self {
            Self::Fixed { style_weight } if !(0.0..=1.0).contains(&style_weight) => {
                Err(RuleError::StyleWeight(style_weight))
            }
            Self::Guided { ceiling } | Self::AdaMimic { ceiling }
                if !(ceiling.is_finite() && ceiling > 0.0) =>
            {
                Err(RuleError::Ceiling(ceiling))
            }
            Self::Bounded { lower, upper } if !(lower < upper && (upper - lower).is_finite()) => {
                Err(RuleError::Bounds { lower, upper })
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_listens_to_its_own_reward() {
        // style 0.5, task 0.2, every ceiling 1
        assert_eq!(
            Rule::Fixed { style_weight: 0.7 }.weights(0.5, 0.2).style(),
            0.7
        );
        assert_eq!(Rule::Guided { ceiling: 1.0 }.weights(0.5, 0.2).task(), 0.25); // 0.5²
        assert!((Rule::AdaMimic { ceiling: 1.0 }.weights(0.5, 0.2).task() - 0.04).abs() < 1e-6); // 0.2²
        assert_eq!(
            Rule::Bounded {
                lower: 0.25,
                upper: 0.75
            }
            .weights(0.5, 0.2)
            .style(),
            0.5
        ); // halfway
    }

    #[test]
    fn a_batch_is_blended_as_its_transitions_are() {
        let (style, task): (Vec<f32>, Vec<f32>) = (0..37)
            .map(|i| (i as f32 / 36.0, 1.0 - i as f32 / 50.0))
            .unzip();
        for rule in [
            Rule::Fixed { style_weight: 0.7 },
            Rule::Guided { ceiling: 0.8 },
            Rule::AdaMimic { ceiling: 0.9 },
            Rule::Bounded {
                lower: 0.25,
                upper: 0.75,
            },
        ] {
            let mut blended = vec![0.0; 37];
            rule.blend_each(&style, &task, &mut blended);
            for ((blended, &style), &task) in blended.iter().zip(&style).zip(&task) {
                assert_eq!(*blended, rule.weights(style, task).blend(task, style));
            }
        }
    }

    #[test]
    fn meaningless_parameters_are_refused() {
        assert_eq!(
            Rule::Fixed { style_weight: 1.1 }.validate(),
            Err(RuleError::StyleWeight(1.1))
        );
        assert_eq!(
            Rule::Guided { ceiling: 0.0 }.validate(),
            Err(RuleError::Ceiling(0.0))
        );
        assert!(Rule::AdaMimic { ceiling: f32::NAN }.validate().is_err());
        assert!(
            Rule::Bounded {
                lower: 0.5,
                upper: 0.5
            }
            .validate()
            .is_err()
        );
        assert!(
            Rule::Bounded {
                lower: 0.1,
                upper: f32::INFINITY
            }
            .validate()
            .is_err()
        );
        assert_eq!(
            Rule::Bounded {
                lower: 0.1,
                upper: 0.5
            }
            .validate(),
            Ok(())
        );
    }
}
