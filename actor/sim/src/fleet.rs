//! N environments in a fixed order: the unit that an actor steps, saves and restores.
//!
//! Separate because the layout of the slices is a contract with rollouts; what happens to one robot
//! is told in `env`.

mod make;
mod out;
mod saved;

pub use make::Varied;
pub use out::StepOut;

use crate::env::{Environment, Rows, Setting};
use crate::event::EventConfig;
use crate::physics::{Bodies, Exertion, Physics};
use crate::randomization::{RandomizationConfig, Table};
use crate::task::TaskConfig;
use crate::terms::Sums;
use g1::{ACTION, RobotState};
use nalgebra::Vector3;
use observation::{Scene, Tables};
use vocabulary::{Cause, RUNNING};

/// Environments stepped together. Same seed, same bits: an environment's future depends on the
/// seed, its index and its actions only.
pub struct Fleet {
    setting: Setting,
    physics: Physics,
    bodies: Bodies,
    environments: Vec<Environment>,
    /// Whether the action of this step could be used.
    acted: Vec<bool>,
    observations: Vec<f32>,
    /// What the critic sees of its own.
    critic: Vec<f32>,
    features: Vec<f32>,
    /// Room for one frame of what is seen.
    frame: Vec<f32>,
    /// What is remembered of each environment's last step; of no influence on the future, and in no snapshot.
    last: Vec<Last>,
    /// What the terms of the task came to since they were asked for; of no influence on the future either.
    sums: Sums,
    faults: u64,
}

/// What a new episode would make forgotten.
#[derive(Clone, Copy)]
struct Last {
    /// Where the step led that ended the last episode.
    end: RobotState,
    /// Whether that was the last step.
    ended: bool,
    /// Whether the last step could be used; before the first one, none could.
    whole: bool,
}

/// What one step of one environment led to, for those who judge a gait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LastStep {
    /// The robot after the step, before a new episode began; of a step that could not be used, the
    /// last sound state.
    pub state: RobotState,
    /// What the step took; zeros before the first step.
    pub exertion: Exertion,
}

impl Fleet {
    /// Number of environments N.
    pub fn len(&self) -> usize {
        self.environments.len()
    }

    /// Never: a fleet has at least one environment.
    pub fn is_empty(&self) -> bool {
        self.environments.is_empty()
    }

    /// What is seen of the robots.
    pub fn tables(&self) -> &Tables {
        &self.setting.tables
    }

    /// o_t as the policy sees it, a row per environment, until the next step.
    pub fn observations(&self) -> &[f32] {
        &self.observations
    }

    /// What the critic sees at t beside that, or instead; nothing where it sees what the policy does.
    pub fn critic_observations(&self) -> &[f32] {
        &self.critic
    }

    /// What the discriminator sees of the true state at t, a row per environment.
    pub fn features(&self) -> &[f32] {
        &self.features
    }

    /// The true state of an environment's robot.
    pub fn state(&self, environment: usize) -> &RobotState {
        self.environments[environment].state()
    }

    /// The command of an environment.
    pub fn command(&self, environment: usize) -> [f32; 3] {
        self.environments[environment].command()
    }

    /// The task as it counts now.
    pub fn task(&self) -> &TaskConfig {
        &self.setting.task
    }

    /// Table I as it counts now.
    pub fn randomization(&self) -> &RandomizationConfig {
        &self.setting.table.rows
    }

    /// Goes on with another task on the same ground: its rewards and ends count from the next step, its commands and
    /// starts whenever they are drawn next.
    pub fn set_task(&mut self, task: TaskConfig) {
        self.setting.task = TaskConfig {
            ground: self.setting.task.ground,
            ..task
        };
    }

    /// Goes on with other ranges of Table I: noise and pushes from the next step, robots and floors from
    /// their next episode.
    pub fn set_randomization(&mut self, randomization: RandomizationConfig) {
        self.setting.table = Table::of(randomization, &self.setting.tables);
    }

    /// Goes on with other ranges of `[event]`: forces from the next step, all else from the next episode of a robot.
    pub fn set_event(&mut self, event: &EventConfig) {
        self.setting.event = event.has_rows().then(|| event.clone());
    }

    /// Holds a command for the rest of an environment's episode. Its observation shows it at once.
    pub fn hold_command(&mut self, environment: usize, command: [f32; 3]) {
        self.environments[environment].hold_command(command);
        let first = self.environments[environment].steps() == 0;
        let tables = &self.setting.tables;
        let own = tables.critic.as_ref().map(|critic| &critic.own);
        let rows = [
            (Some(&tables.actor), &mut self.observations),
            (own, &mut self.critic),
        ];
        for (table, rows) in rows {
            if let Some(table) = table {
                let row = &mut rows[environment * table.width()..][..table.width()];
                table.replace("command", &command, first, row);
            }
        }
    }

    /// Pushes an environment's robot before its next step: a jump of its velocity, world frame, m/s.
    pub fn push(&mut self, environment: usize, change: [f32; 3]) {
        let change = Vector3::from(change);
        self.environments[environment].push(&mut self.bodies, environment, change);
    }

    /// What an environment's last step led to, also where an episode ended with it.
    pub fn last_step(&self, environment: usize) -> LastStep {
        let last = &self.last[environment];
        LastStep {
            state: if last.ended {
                last.end
            } else {
                *self.state(environment)
            },
            exertion: if last.whole {
                self.bodies.exertion(environment)
            } else {
                Exertion::default()
            },
        }
    }

    /// Mean of every reward term and gate over all robots' steps since this was last asked, by their names in metrics;
    /// those that do not exist are not among them. Steps that broke do not count.
    pub fn take_terms(&mut self) -> Vec<(&'static str, f32)> {
        self.sums.take(&crate::task::NAMES)
    }

    /// Steps thrown away so far because an action or a state was not finite.
    pub fn faults(&self) -> u64 {
        self.faults
    }

    /// Advances every environment by one control step (20 ms) with its action, N·23, and begins new
    /// episodes where one ended. Afterwards [`Fleet::observations`] and [`Fleet::features`] are those
    /// of t + 1, of the new episode where there is one.
    ///
    /// # Panics
    /// If a slice has another length than its field says.
    pub fn step(&mut self, actions: &[f32], out: &mut StepOut<'_>) {
        self.advance(actions);
        self.observe(out);
    }

    /// The first half of a step: the robots move with their actions, N·23.
    ///
    /// # Panics
    /// If there are not N·23 numbers.
    pub fn advance(&mut self, actions: &[f32]) {
        assert_eq!(actions.len(), self.len() * ACTION, "actions are N·23");
        let actions = actions.as_chunks::<ACTION>().0;
        for (i, action) in actions.iter().enumerate() {
            let environment = &mut self.environments[i];
            self.acted[i] = environment.act(&self.setting, &mut self.bodies, i, action);
        }
        self.bodies.advance();
    }

    /// The second half of a step: what came of it is judged and written, and new episodes begin.
    ///
    /// # Panics
    /// If a slice has another length than its field says.
    pub fn observe(&mut self, out: &mut StepOut<'_>) {
        let n = self.len();
        let widths = self.setting.tables.widths();
        out.check(n, &widths);
        for i in 0..n {
            let environment = &mut self.environments[i];
            let outcome = if self.acted[i] {
                environment.judge(&self.setting, &self.bodies, i, &mut self.sums)
            } else {
                environment.broken()
            };
            let faulty = outcome.end == Some(Cause::Fault);
            self.faults += u64::from(faulty);
            let last = &mut self.last[i];
            last.whole = !faulty;
            last.ended = outcome.end.is_some();
            if last.ended {
                last.end = *environment.state();
            }
            out.task_rewards[i] = outcome.task_reward;
            out.energies[i] = outcome.energy;
            out.tracking_errors[i] = outcome.tracking_error;
            out.ends[i] = outcome.end.map_or(RUNNING, Cause::code);
            out.episode_steps[i] = environment.steps() as f32;
            out.foot_forces.as_chunks_mut().0[i] = outcome.foot_forces;
            let next_features = &mut out.next_features[i * widths.features..][..widths.features];
            judged(&self.setting.tables, environment.state(), next_features);
            if widths.measured > 0 {
                let measured = &mut out.measured[i * widths.measured..][..widths.measured];
                environment.measure(&self.setting, measured);
            }
            let seen = &mut self.observations[i * widths.observation..][..widths.observation];
            let critic = &mut self.critic[i * widths.critic..][..widths.critic];
            let table = self.setting.table(i);
            if outcome.end == Some(Cause::TimeOut) {
                // Seen before the reset: the value of a timed-out episode is that of its own end.
                let rows = Rows {
                    observation: &mut out.timeout_observations[i * widths.observation..]
                        [..widths.observation],
                    critic: &mut out.timeout_critic[i * widths.critic..][..widths.critic],
                };
                rows.observation.copy_from_slice(seen);
                rows.critic.copy_from_slice(critic);
                environment.observe(&self.setting, table, &mut self.frame, rows);
            }
            environment.proceed(&self.setting, &mut self.bodies, i, outcome.end);
            let rows = Rows {
                observation: seen,
                critic,
            };
            environment.observe(&self.setting, table, &mut self.frame, rows);
            let features = &mut self.features[i * widths.features..][..widths.features];
            if outcome.end.is_none() {
                features.copy_from_slice(next_features);
            } else {
                judged(&self.setting.tables, environment.state(), features);
            }
        }
    }

    fn forget_last_steps(&mut self) {
        let of = |environment: &Environment| Last {
            end: *environment.state(),
            ended: false,
            whole: false,
        };
        self.last = self.environments.iter().map(of).collect();
    }

    /// Writes what is seen of an environment now.
    fn look(&mut self, i: usize) {
        let environment = &mut self.environments[i];
        let widths = self.setting.tables.widths();
        let rows = Rows {
            observation: &mut self.observations[i * widths.observation..][..widths.observation],
            critic: &mut self.critic[i * widths.critic..][..widths.critic],
        };
        let table = self.setting.table(i);
        environment.observe(&self.setting, table, &mut self.frame, rows);
        let features = &mut self.features[i * widths.features..][..widths.features];
        judged(&self.setting.tables, environment.state(), features);
    }
}

/// Writes what the discriminator sees of a state.
fn judged(tables: &Tables, state: &RobotState, row: &mut [f32]) {
    tables.discriminator.measure(&Scene::of(state), row);
    tables.discriminator.adjust(row);
}

#[cfg(test)]
mod tests;
