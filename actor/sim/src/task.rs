//! The `[task]` section: what is paid, what ends an episode, what is commanded, where episodes begin.
//!
//! Separate because this file is only the table of contents: each term and each rule is a file of its own. The defaults
//! are the paper's: Eq. 14, and an end by a fall or after 20 s.

use crate::command::CommandConfig;
use crate::gate::{self, GateConfig};
use crate::ground::GroundConfig;
use crate::moment::Moment;
use crate::reward::{self, RewardConfig};
use crate::start::StartConfig;
use crate::termination::TerminationConfig;
use crate::terms::{self, Sums};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::invalid::within;
use vocabulary::{Checked, Section};

/// Names of the terms in metrics: rewards, then gates, as [`Sums`] has them.
pub(crate) const NAMES: [&str; reward::NAMES.len() + gate::NAMES.len()] = {
    let mut names = [""; reward::NAMES.len() + gate::NAMES.len()];
    let mut place = 0;
    while place < names.len() {
        names[place] = if place < reward::NAMES.len() {
            reward::NAMES[place]
        } else {
            gate::NAMES[place - reward::NAMES.len()]
        };
        place += 1;
    }
    names
};

const _: () = assert!(NAMES.len() <= terms::MOST, "a message holds no more terms");

/// The `[task]` section. Where a [`vocabulary::Ramp`] stands, a value may move with the samples that the learner has
/// used.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TaskConfig {
    /// What is paid.
    pub reward: RewardConfig,
    /// What is left of it.
    pub gate: GateConfig,
    /// What ends an episode.
    pub termination: TerminationConfig,
    /// Commands.
    pub command: CommandConfig,
    /// Where episodes begin.
    pub start: StartConfig,
    /// Hills and bumps. Default: the floor is level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<GroundConfig>,
}

impl Section for TaskConfig {
    const NAME: &'static str = "task";

    fn validate(&self) -> Checked {
        within("reward", self.reward.validate())?;
        self.reward.pays()?;
        within("gate", self.gate.validate())?;
        within("termination", self.termination.validate())?;
        within("command", self.command.validate())?;
        within("start", self.start.validate())?;
        let ground = self.ground.as_ref().map_or(Ok(()), GroundConfig::validate);
        within("ground", ground)
    }
}

impl TaskConfig {
    /// The task after a number of samples: nothing in it moves any more.
    #[must_use]
    pub fn at(&self, samples: f64) -> Self {
        let mut task = self.clone();
        task.reward.set(samples);
        task.gate.set(samples);
        task.termination.set(samples);
        task.command.set(samples);
        task.start.set(samples);
        task
    }

    /// Task reward: rᴳ = ∏ gᵢ^vᵢ · Σ wᵢ·rᵢ / Σ wᵢ   (Eq. 14 with one term and one gate)
    pub fn pay(&self, moment: &Moment<'_>) -> f32 {
        self.pay_and_tell(moment, &mut Sums::default())
    }

    /// The same; each term is added to `sums`.
    pub(crate) fn pay_and_tell(&self, moment: &Moment<'_>, sums: &mut Sums) -> f32 {
        let mean = self.reward.mean(moment, sums);
        self.gate.of(mean, moment, sums)
    }
}

#[cfg(test)]
mod tests;
