//! Whether the discriminator still has an opinion: one that tells every transition apart pays them all alike.
//!
//! Separate because it is told to people and changes nothing.

use std::fmt;

/// Mean scores from which on both sides count as told apart: Eq. 3 and 4 pull D to 1 and −1, and at −0.9 a transition is
/// paid 1 − ¼·1.9² = 0.10 (Eq. 7).
const CERTAIN: f64 = 0.9;
/// Least standard deviation of a style reward that still ranks transitions.
const SPREAD: f64 = 0.1;
/// Iterations in a row after which a change is believed.
const LASTING: u32 = 20;

/// What the discriminator made of an iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scores {
    /// Mean D of expert windows.
    pub expert: f64,
    /// Mean D of policy transitions.
    pub policy: f64,
    /// Standard deviation of the style reward over the batch.
    pub style_std: f64,
}

impl Scores {
    /// Whether every transition is told apart, and paid alike.
    pub fn are_saturated(&self) -> bool {
        self.expert >= CERTAIN && self.policy <= -CERTAIN && self.style_std <= SPREAD
    }
}

impl fmt::Display for Scores {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            expert,
            policy,
            style_std,
        } = self;
        if self.are_saturated() {
            write!(
                out,
                "the discriminator tells every transition apart (scores {expert:.2} and {policy:.2}, style reward \
                 ±{style_std:.2}): its reward teaches little; lower discriminator.learning_rate or discriminator.steps"
            )
        } else {
            write!(
                out,
                "the discriminator does not tell every transition apart (scores {expert:.2} and {policy:.2}, style \
                 reward ±{style_std:.2})"
            )
        }
    }
}

/// Follows the scores over iterations.
#[derive(Clone, Copy, Debug, Default)]
pub struct Saturation {
    saturated: bool,
    /// Iterations in a row that say otherwise.
    otherwise: u32,
}

impl Saturation {
    /// Takes one more iteration; whether it is saturated, if that has just become certain to be otherwise than before.
    pub fn take(&mut self, scores: &Scores) -> Option<bool> {
        if scores.are_saturated() == self.saturated {
            self.otherwise = 0;
            return None;
        }
        self.otherwise += 1;
        if self.otherwise < LASTING {
            return None;
        }
        self.otherwise = 0;
        self.saturated = !self.saturated;
        Some(self.saturated)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const APART: Scores = Scores {
        expert: 0.98,
        policy: -0.97,
        style_std: 0.02,
    };
    const UNSURE: Scores = Scores {
        expert: 0.5,
        policy: -0.4,
        style_std: 0.2,
    };

    #[test]
    fn both_scores_and_the_spread_must_say_so() {
        assert!(APART.are_saturated());
        for not in [
            Scores {
                expert: 0.8,
                ..APART
            },
            Scores {
                policy: -0.8,
                ..APART
            },
            Scores {
                style_std: 0.11,
                ..APART
            },
            Scores {
                policy: f64::NAN,
                ..APART
            },
            UNSURE,
        ] {
            assert!(!not.are_saturated(), "{not:?}");
        }
        let words = APART.to_string();
        assert!(words.contains("scores 0.98 and -0.97") && words.contains("discriminator.steps"));
    }

    #[test]
    fn its_beginning_and_its_end_are_told_once_each() {
        let mut saturation = Saturation::default();
        let mut take = |scores, times| -> Vec<bool> {
            (0..times)
                .filter_map(|_| saturation.take(&scores))
                .collect()
        };
        // 19 in a row are not believed, and one that is otherwise begins the count anew.
        assert_eq!(take(APART, 19), [false; 0]);
        assert_eq!(take(UNSURE, 1), [false; 0]);
        assert_eq!(take(APART, 19), [false; 0]);
        assert_eq!(take(APART, 1), [true]);
        assert_eq!(take(APART, 100), [false; 0]);
        assert_eq!(take(UNSURE, 19), [false; 0]);
        assert_eq!(take(UNSURE, 100), [false]);
        assert_eq!(take(APART, 20), [true]);
    }
}
