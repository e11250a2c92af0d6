//! Memory for one step of a fleet, for callers that have no shared memory to write into.

use crate::fleet::Fleet;
use crate::fleet::StepOut;

/// Owned rows behind a [`StepOut`]; the fields are explained there.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are those of StepOut")]
pub struct StepRows {
    pub task_rewards: Vec<f32>,
    pub energies: Vec<f32>,
    pub tracking_errors: Vec<f32>,
    pub ends: Vec<f32>,
    pub episode_steps: Vec<f32>,
    pub next_features: Vec<f32>,
    pub foot_forces: Vec<f32>,
    pub measured: Vec<f32>,
    pub timeout_observations: Vec<f32>,
    pub timeout_critic: Vec<f32>,
}

impl StepRows {
    /// Rows for the environments of a fleet, every number `value` until it is written.
    pub fn of(fleet: &Fleet, value: f32) -> Self {
        let (n, widths) = (fleet.len(), fleet.tables().widths());
        let rows = |width: usize| vec![value; n * width];
        Self {
            task_rewards: rows(1),
            energies: rows(1),
            tracking_errors: rows(1),
            ends: rows(1),
            episode_steps: rows(1),
            next_features: rows(widths.features),
            foot_forces: rows(2),
            measured: rows(widths.measured),
            timeout_observations: rows(widths.observation),
            timeout_critic: rows(widths.critic),
        }
    }

    /// Where [`crate::Fleet::step`] writes.
    pub fn out(&mut self) -> StepOut<'_> {
        StepOut {
            task_rewards: &mut self.task_rewards,
            energies: &mut self.energies,
            tracking_errors: &mut self.tracking_errors,
            ends: &mut self.ends,
            episode_steps: &mut self.episode_steps,
            next_features: &mut self.next_features,
            foot_forces: &mut self.foot_forces,
            measured: &mut self.measured,
            timeout_observations: &mut self.timeout_observations,
            timeout_critic: &mut self.timeout_critic,
        }
    }
}
