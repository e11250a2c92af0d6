//! What the schedule answers to a report.

use crate::{Bounds, Granularity, Rule, Weighting};

/// The phase of training. Bounds exist in phase II only, and there is no way back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Phase {
    /// Imitation leads, convergence is being looked for.
    One,
    /// Convergence was found.
    Two(Switch),
}

impl Phase {
    /// 1 or 2, as it is written in logs.
    pub fn number(&self) -> u32 {
        match self {
            Self::One => 1,
            Self::Two(_) => 2,
        }
    }
}

/// The moment in which convergence was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Switch {
    /// Iteration whose report showed it.
    pub iteration: u64,
    /// Bounds of Eq. 13, fixed from then on.
    pub bounds: Bounds,
    /// Slope of the reward window at that moment, in reward per iteration.
    pub trend: f64,
}

impl Switch {
    /// What speaks against this switch.
    pub fn warning(&self) -> Option<Warning> {
        (self.trend < 0.0).then_some(Warning::RewardWasFalling { trend: self.trend })
    }

    /// What its bounds leave undone, see [`Bounds::idle`].
    fn idle(&self) -> Option<Warning> {
        let (lower, upper) = (self.bounds.lower(), self.bounds.upper());
        match self.bounds.idle() {
            [false, false] => None,
            [true, false] => Some(Warning::LowerBoundIsIdle { lower }),
            [false, true] => Some(Warning::UpperBoundIsIdle { upper }),
            [true, true] => Some(Warning::BoundsAreIdle { lower, upper }),
        }
    }
}

/// A doubt about the phase switch. It is told, not acted upon: the rule is Algorithm 1's.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Warning {
    /// A falling reward breaks out as rarely as a converged one.
    #[error(
        "the style reward was falling when convergence was found (trend {trend:.2e} per iteration): this may be a decline, not a plateau; arm = \"after_rise\" waits for a rise"
    )]
    RewardWasFalling {
        /// Slope of the reward window, below zero.
        trend: f64,
    },
    /// The style reward, 0 to 1, reaches neither bound of Eq. 13.
    #[error(
        "the bounds of Eq. 13, {lower:.3} and {upper:.3}, are wider than the style reward's range, 0 to 1: they bind nothing; \
         bounds_from = \"robots\" or \"window\", or a lower scheduler.alpha, makes them narrower"
    )]
    BoundsAreIdle {
        /// μ lower.
        lower: f64,
        /// μ upper.
        upper: f64,
    },
    /// The style reward, 0 to 1, never sinks to the lower bound.
    #[error(
        "the lower bound of Eq. 13, {lower:.3}, is below the style reward's range, 0 to 1: it binds nothing, and style never \
         gets all the weight"
    )]
    LowerBoundIsIdle {
        /// μ lower.
        lower: f64,
    },
    /// The style reward, 0 to 1, never rises to the upper bound.
    #[error(
        "the upper bound of Eq. 13, {upper:.3}, is above the style reward's range, 0 to 1: it binds nothing, and the task never \
         gets all the weight"
    )]
    UpperBoundIsIdle {
        /// μ upper.
        upper: f64,
    },
}

/// The answer to one report: valid from the next iteration on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decision {
    /// Iteration of the report that it answers.
    pub iteration: u64,
    /// Phase of training.
    pub phase: Phase,
    /// How rewards become weights.
    pub rule: Rule,
    /// Whose rewards the rule is evaluated on.
    pub granularity: Granularity,
    /// β, once W indicators exist.
    pub breakout_rate: Option<f64>,
    /// 1 − p, below which β means convergence.
    pub threshold: f64,
    /// Slope of the reward window, in reward per iteration, once it holds two values.
    pub trend: Option<f64>,
    /// Iterations in which the run's ramps stood still so far, see [`crate::PaceKind`].
    pub held: u64,
}

impl Decision {
    /// Rule and granularity together.
    pub fn weighting(&self) -> Weighting {
        Weighting {
            rule: self.rule,
            granularity: self.granularity,
        }
    }

    /// Iteration in which convergence was found.
    pub fn switched_at(&self) -> Option<u64> {
        self.switch().map(|switch| switch.iteration)
    }

    /// Whether this very report brought phase II.
    pub fn just_switched(&self) -> bool {
        self.switched_at() == Some(self.iteration)
    }

    /// Bounds of phase II.
    pub fn bounds(&self) -> Option<Bounds> {
        self.switch().map(|switch| switch.bounds)
    }

    /// What speaks against the switch that was made; stands as long as phase II does.
    pub fn warning(&self) -> Option<Warning> {
        self.switch().and_then(|switch| switch.warning())
    }

    /// What the bounds leave undone where the rule in force is made of them.
    pub fn idle_bounds(&self) -> Option<Warning> {
        let bounded = matches!(self.rule, Rule::Bounded { .. });
        self.switch()
            .filter(|_| bounded)
            .and_then(|switch| switch.idle())
    }

    fn switch(&self) -> Option<Switch> {
        match self.phase {
            Phase::One => None,
            Phase::Two(switch) => Some(switch),
        }
    }
}
