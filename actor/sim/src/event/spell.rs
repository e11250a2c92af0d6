//! A row of what comes and goes within an episode: how much of it, how long it lasts, how long it stays away.

use crate::time::CONTROL_STEP;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::Checked;
use vocabulary::invalid::{range_between, within};

/// The row.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spell {
    /// Least and greatest size; every one between them is as likely.
    pub range: [f32; 2],
    /// How long it lasts, s: least and greatest. Default 0.05 to 0.2, a push.
    #[serde(default = "duration")]
    pub duration: [f32; 2],
    /// Time from the end of one to the next, s: least and greatest. Default 5 to 10.
    #[serde(default = "seconds")]
    pub seconds: [f32; 2],
}

fn duration() -> [f32; 2] {
    [0.05, 0.2]
}

fn seconds() -> [f32; 2] {
    [5.0, 10.0]
}

impl Spell {
    /// Refuses times beyond `limits`, s, of which `why` tells; the range is checked with those of all rows.
    pub(crate) fn check(&self, name: &str, limits: [f32; 2], why: &str) -> Checked {
        let hour = "seconds, from one control step to an hour";
        within(name, range_between("duration", self.duration, limits, why))?;
        let pause = range_between("seconds", self.seconds, [CONTROL_STEP, 3_600.0], hour);
        within(name, pause)
    }
}
