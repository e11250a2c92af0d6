//! What is in force, as a few plain numbers: between processes and in checkpoints.
//!
//! Separate because the numbers come from outside: what names no rule, or one that cannot be evaluated, is refused here.

use serde::{Deserialize, Serialize};

use super::{Granularity, Rule, RuleError};

/// A rule, and whose rewards it is evaluated on. Written as [`Numbers`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "Numbers", try_from = "Numbers")]
pub struct Weighting {
    /// How rewards become weights.
    pub rule: Rule,
    /// Whose rewards.
    pub granularity: Granularity,
}

/// The same as plain numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Numbers {
    /// 0 fixed weights, 1 guided, 2 AdaMimic, 3 bounded.
    pub rule: u32,
    /// First parameter of the rule: style weight, ceiling, or lower bound.
    pub first: f32,
    /// Second parameter of the rule: upper bound.
    pub second: f32,
    /// 0 each transition's rewards, 1 the batch's means.
    pub granularity: u32,
}

impl From<Weighting> for Numbers {
    fn from(weighting: Weighting) -> Self {
        let (rule, first, second) = match weighting.rule {
            Rule::Fixed { style_weight } => (0, style_weight, 0.0),
            Rule::Guided { ceiling } => (1, ceiling, 0.0),
            Rule::AdaMimic { ceiling } => (2, ceiling, 0.0),
            Rule::Bounded { lower, upper } => (3, lower, upper),
        };
        let granularity = match weighting.granularity {
            Granularity::Sample => 0,
            Granularity::Mean => 1,
        };
        Self {
            rule,
            first,
            second,
            granularity,
        }
    }
}

impl TryFrom<Numbers> for Weighting {
    type Error = RuleError;

    fn try_from(numbers: Numbers) -> Result<Self, RuleError> {
        let Numbers { first, second, .. } = numbers;
        let rule = match numbers.rule {
            0 => Rule::Fixed {
                style_weight: first,
            },
            1 => Rule::Guided { ceiling: first },
            2 => Rule::AdaMimic { ceiling: first },
            3 => Rule::Bounded {
                lower: first,
                upper: second,
            },
            unknown => return Err(RuleError::UnknownRule(unknown)),
        };
        rule.validate()?;
        let granularity = match numbers.granularity {
            0 => Granularity::Sample,
            1 => Granularity::Mean,
            unknown => return Err(RuleError::UnknownGranularity(unknown)),
        };
        Ok(Self { rule, granularity })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_comes_back_as_it_was() {
        let rules = [
            (Rule::Fixed { style_weight: 0.7 }, 0),
            (Rule::Guided { ceiling: 0.9 }, 1),
            (Rule::AdaMimic { ceiling: 1.5 }, 2),
            (
                Rule::Bounded {
                    lower: -0.25,
                    upper: 0.75,
                },
                3,
            ),
        ];
        for (rule, number) in rules {
            for granularity in [Granularity::Sample, Granularity::Mean] {
                let weighting = Weighting { rule, granularity };
                let numbers = Numbers::from(weighting);
                assert_eq!(numbers.rule, number);
                assert_eq!(Weighting::try_from(numbers), Ok(weighting));
            }
        }
    }

    #[test]
    fn what_names_no_rule_is_refused() {
        let of = |rule, first, granularity| {
            Weighting::try_from(Numbers {
                rule,
                first,
                second: 0.0,
                granularity,
            })
        };
        assert_eq!(of(9, 0.5, 0), Err(RuleError::UnknownRule(9)));
        assert_eq!(of(0, 0.5, 2), Err(RuleError::UnknownGranularity(2)));
        assert!(matches!(of(1, f32::NAN, 0), Err(RuleError::Ceiling(_))));
        assert_eq!(of(0, 1.5, 0), Err(RuleError::StyleWeight(1.5)));
    }
}
