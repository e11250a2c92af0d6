//! What the learner says about one iteration, and why a report may be refused.

use serde::Deserialize;
use vocabulary::number;

/// Rewards of one iteration's batch, before blending; as JSON the fields of a line of the metrics, where `null` is a
/// number that was not finite.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Report {
    /// Number of the iteration; reports come in rising order.
    pub iteration: u64,
    /// r̄ˢ, mean style reward over the batch's transitions.
    #[serde(default = "number::unknown", deserialize_with = "number::or_nan")]
    pub style_mean: f64,
    /// σˢ, standard deviation of the style reward over the same transitions.
    #[serde(default = "number::unknown", deserialize_with = "number::or_nan")]
    pub style_std: f64,
    /// Standard deviation of the robots' mean style rewards about what their commands make of them; none if that is not known.
    pub style_std_robots: Option<f64>,
    /// Mean task reward over the same transitions.
    #[serde(default = "number::unknown", deserialize_with = "number::or_nan")]
    pub task_mean: f64,
    /// Mean length of the episodes that ended in the iteration, as a share of the longest possible; none if none ended.
    pub episode_share: Option<f64>,
}

/// Why a report was refused. The schedule is then as it was before.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReportError {
    /// NaN or infinite.
    #[error("{field} of iteration {iteration} is {value}, not a finite number")]
    NotFinite {
        /// Iteration of the report.
        iteration: u64,
        /// Field of [`Report`].
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A standard deviation below zero.
    #[error("{field} of iteration {iteration} is {value}, below zero")]
    NegativeDeviation {
        /// Iteration of the report.
        iteration: u64,
        /// Field of [`Report`].
        field: &'static str,
        /// Its value.
        value: f64,
    },
    /// A report seen before, or from before the newest one.
    #[error("iteration {iteration} does not follow iteration {newest}")]
    OutOfOrder {
        /// Iteration of the report.
        iteration: u64,
        /// Newest iteration observed.
        newest: u64,
    },
}

impl Report {
    pub(crate) fn check(&self, newest: Option<u64>) -> Result<(), ReportError> {
        let iteration = self.iteration;
        for (field, value) in [
            ("style_mean", self.style_mean),
            ("style_std", self.style_std),
            ("style_std_robots", self.style_std_robots.unwrap_or(0.0)),
            ("task_mean", self.task_mean),
            ("episode_share", self.episode_share.unwrap_or(0.0)),
        ] {
            if !value.is_finite() {
                return Err(ReportError::NotFinite {
                    iteration,
                    field,
                    value,
                });
            }
        }
        for (field, value) in [
            ("style_std", self.style_std),
            ("style_std_robots", self.style_std_robots.unwrap_or(0.0)),
        ] {
            if value < 0.0 {
                return Err(ReportError::NegativeDeviation {
                    iteration,
                    field,
                    value,
                });
            }
        }
        match newest {
            Some(newest) if iteration <= newest => {
                Err(ReportError::OutOfOrder { iteration, newest })
            }
            _ => Ok(()),
        }
    }
}
