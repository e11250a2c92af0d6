//! The `[scheduler]` section of a run's configuration: the paper's values by default, its open places as knobs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::invalid::require;
use vocabulary::{Checked, Section};

use crate::weighting::guidance::CeilingKind;
use crate::{Granularity, Method};

/// Every knob of the schedule. Defaults are Table II and the paper's literal text.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ScheduleConfig {
    /// Method of weighting. Default: the paper's own.
    pub method: Method,
    /// W, iterations that both sliding windows hold. Table II: 1000.
    pub window: usize,
    /// p as a fraction. Table II gives 0.95 and the text divides p by 100: we read the 95th percentile, threshold 0.05.
    pub percentile: f64,
    /// α, share of the reward that the bounds of Eq. 13 are to hold. Table II: 0.95.
    pub alpha: f64,
    /// R* of Eq. 9, the "current expected maximum reward value". Default: the bound of Eq. 7.
    pub ceiling: CeilingKind,
    /// What Eq. 9 is fed with. Default: every transition its own reward, as it is "executed in parallel across
    /// environments". Eq. 12 always takes the batch's mean, as the text under it says.
    pub granularity: Granularity,
    /// When convergence is tested. Default: as Algorithm 1 is written.
    pub arm: ArmKind,
    /// What ramps of task, robots and motion go by. Default: the number of samples.
    pub pace: PaceKind,
    /// With `arm = "after_rise"` or `"episodes_last"`, or `pace = "progress"`: iterations over which the reward, or the share, is smoothed.
    pub smoothing: f64,
    /// Whose mean and deviation Eq. 13 takes. Default: the batch in which convergence was found, as Algorithm 1's inputs
    /// are rˢ and σˢ.
    pub bounds_from: BoundsSource,
}

impl Default for ScheduleConfig {
    fn default() -> Self {
        Self {
            method: Method::Ampco,
            window: 1000,
            percentile: 0.95,
            alpha: 0.95,
            ceiling: CeilingKind::Bound,
            granularity: Granularity::Sample,
            arm: ArmKind::WindowFull,
            pace: PaceKind::Samples,
            smoothing: 20.0,
            bounds_from: BoundsSource::Batch,
        }
    }
}

/// When convergence is tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ArmKind {
    /// As soon as the windows are full, as Algorithm 1 is written.
    WindowFull,
    /// Once the smoothed reward has risen from its minimum; the windows begin then.
    AfterRise,
    /// While episodes last, by their smoothed mean length, once no ramp moves but those of what disturbs robots; the windows begin then.
    /// Imitation is for robots that stay up: a style reward that stands still while they fall, or while commands still
    /// widen, has paused, not converged.
    EpisodesLast,
}

/// What ramps go by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PaceKind {
    /// The samples that were used.
    Samples,
    /// Those of them that were used while episodes lasted: ramps stand still while their smoothed mean length is below nine
    /// tenths of the longest possible. Those of `[ppo]` and `[exploration]` go by the samples all the same.
    Progress,
}

/// Where mean and deviation of Eq. 13 come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BoundsSource {
    /// The transitions of the batch in which convergence was found.
    Batch,
    /// The W mean rewards in the window.
    Window,
    /// The robots of that batch, each with its mean reward beside that of the robot with the nearest command: how far gaits
    /// differ, not how far the steps of one gait do or the commands.
    Robots,
}

/// Largest window accepted: its memory is taken at once, about 50 bytes an iteration.
const LARGEST_WINDOW: usize = 10_000_000;

impl Section for ScheduleConfig {
    const NAME: &'static str = "scheduler";

    fn validate(&self) -> Checked {
        let strictly_inside = |x: f64| x > 0.0 && x < 1.0;
        require(
            (2..=LARGEST_WINDOW).contains(&self.window),
            "window",
            self.window,
            "use 2 to 10000000 iterations; the paper uses 1000",
        )?;
        require(
            strictly_inside(self.percentile),
            "percentile",
            self.percentile,
            "write it as a fraction between 0 and 1; the paper's 95th percentile is 0.95",
        )?;
        require(
            strictly_inside(self.alpha),
            "alpha",
            self.alpha,
            "use a share between 0 and 1; the paper uses 0.95",
        )?;
        require(
            self.smoothing.is_finite() && self.smoothing >= 1.0,
            "smoothing",
            self.smoothing,
            "use 1 (none) or more iterations, such as 20",
        )?;
        match self.method {
            Method::Amp { style_weight } => require(
                (0.0..=1.0).contains(&style_weight),
                "method.amp.style_weight",
                style_weight,
                "use a share in [0, 1]; the paper compares 0.5, 0.7 and 0.8",
            ),
            Method::AmpRoger { lower, upper } => {
                require(
                    lower.is_finite(),
                    "method.amp_roger.lower",
                    lower,
                    "use a finite style reward",
                )?;
                require(
                    upper.is_finite() && upper > lower,
                    "method.amp_roger.upper",
                    upper,
                    "use a finite style reward above the lower bound",
                )
            }
            Method::AdaMimic
            | Method::Ampco
            | Method::AmpcoWithoutAig
            | Method::AmpcoWithoutRoger => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
