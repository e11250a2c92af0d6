//! What ends an episode: a table of rules, a file each. Each end is told by its [`vocabulary::Cause`].

pub mod fall;
pub mod stray;
pub mod time_out;

use crate::termination::fall::FallConfig;
use crate::termination::stray::StrayConfig;
use crate::termination::time_out::TimeOutConfig;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::Checked;
use vocabulary::invalid::within;

/// `[task.termination]`: the rules. A fault, a step whose numbers broke, ends an episode in any case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TerminationConfig {
    /// Falling.
    pub fall: FallConfig,
    /// The time is up.
    pub time_out: TimeOutConfig,
    /// Not doing what was asked for. Default: nothing ends an episode for that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stray: Option<StrayConfig>,
}

impl TerminationConfig {
    /// Checks every rule; names the first bad parameter.
    pub(crate) fn validate(&self) -> Checked {
        within("fall", self.fall.validate())?;
        within("time_out", self.time_out.validate())?;
        let stray = self.stray.as_ref().map_or(Ok(()), StrayConfig::validate);
        within("stray", stray)
    }

    /// Holds all that moves where it is after a number of samples.
    pub(crate) fn set(&mut self, samples: f64) {
        if let Some(stray) = &mut self.stray {
            stray.set(samples);
        }
    }
}
