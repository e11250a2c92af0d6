//! One environment: a robot, what it is asked to do, and its own random numbers.
//!
//! Separate from the fleet because an episode's life (start, steps, pushes, new commands, end) is
//! told here once, for one robot, while the fleet only lines robots up.

use crate::actuator::{self, Gains};
use crate::engine::Engine;
use crate::model::Variation;
use crate::randomization::RandomizationConfig;
use crate::start::{self, Starts};
use crate::task::{self, End, TaskConfig};
use crate::world::{Exertion, World};
use g1::{JOINTS, RobotState, observation};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};

/// What all environments of a fleet have in common.
pub(crate) struct Setting {
    pub(crate) task: TaskConfig,
    pub(crate) randomization: RandomizationConfig,
    pub(crate) starts: Starts,
    pub(crate) gains: Gains,
    /// A world that was never stepped.
    pub(crate) template: World,
}

/// What a step of one environment brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) task_reward: f32,
    pub(crate) tracking_error: f32,
    pub(crate) exertion: Exertion,
    pub(crate) end: End,
    /// The true state after the step; of a step that broke, the last sound one.
    pub(crate) state: RobotState,
    /// Whether the step broke: its action or its result was not finite.
    pub(crate) faulty: bool,
}

/// A robot in an episode. Everything that its future depends on is in here.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Environment {
    random: Pcg64Mcg,
    world: World,
    state: RobotState,
    command: [f32; 3],
    previous_action: [f32; JOINTS],
    /// Steps until a new command; none while the command is held from outside.
    command_in: Option<u32>,
    /// Steps until the next push; none without pushes.
    push_in: Option<u32>,
    /// Steps that count toward the time-out. Runs ahead of `steps` in a staggered first episode.
    age: u32,
    /// Steps done in this episode.
    steps: u32,
}

impl Environment {
    /// At the start of its first episode. Its generator depends on nothing but the two numbers.
    pub(crate) fn new(setting: &Setting, seed: u64, index: usize) -> Self {
        let mut environment = Self {
            random: Pcg64Mcg::seed_from_u64(mix(mix(seed).wrapping_add(index as u64))),
            world: setting.template.clone(),
            state: RobotState::standing(),
            command: [0.0; 3],
            previous_action: [0.0; JOINTS],
            command_in: None,
            push_in: None,
            age: 0,
            steps: 0,
        };
        environment.reset(setting);
        if setting.task.staggered {
            environment.age = environment
                .random
                .random_range(0..setting.task.episode_steps);
        }
        environment
    }

    /// Begins a new episode.
    fn reset(&mut self, setting: &Setting) {
        let variation = setting.randomization.draw_variation(&mut self.random);
        let (state, command) = start::draw(
            &setting.starts,
            &setting.task.start,
            &setting.task.command,
            &mut self.random,
        );
        self.world = if variation == Variation::NOMINAL {
            setting.template.clone()
        } else {
            World::from_template(&setting.template, &variation)
        };
        self.world.set_state(&state);
        self.state = self.world.state();
        self.command = command;
        self.previous_action = [0.0; JOINTS];
        self.command_in = Some(setting.task.command.draw_interval(&mut self.random));
        self.push_in = setting.randomization.draw_push_interval(&mut self.random);
        self.age = 0;
        self.steps = 0;
    }

    /// One control step. After it an ended episode has to be left by [`Environment::proceed`].
    pub(crate) fn step(
        &mut self,
        setting: &Setting,
        engine: &mut Engine,
        action: &[f32; JOINTS],
    ) -> Outcome {
        self.steps += 1;
        self.age += 1;
        if action.iter().any(|a| !a.is_finite()) {
            return self.broken();
        }
        if count_down(&mut self.push_in) {
            let push = setting.randomization.draw_push(&mut self.random);
            self.world.push(push);
            self.push_in = setting.randomization.draw_push_interval(&mut self.random);
        }
        let targets = actuator::targets(action);
        let exertion = self.world.control_step(engine, &setting.gains, &targets);
        if !self.world.is_sound() {
            return self.broken();
        }
        self.state = self.world.state();
        self.previous_action = *action;
        let end = if setting.task.has_fallen(&self.state) {
            End::Fall
        } else if self.age >= setting.task.episode_steps {
            End::Timeout
        } else {
            End::Running
        };
        Outcome {
            task_reward: setting.task.reward(&self.command, &self.state),
            tracking_error: task::tracking_error(&self.command, &self.state),
            exertion,
            end,
            state: self.state,
            faulty: false,
        }
    }

    /// Goes on after a step: into the next episode, or with a new command when its time has come.
    pub(crate) fn proceed(&mut self, setting: &Setting, end: End) {
        if end != End::Running {
            self.reset(setting);
        } else if count_down(&mut self.command_in) {
            self.command = setting.task.command.draw(&mut self.random);
            self.command_in = Some(setting.task.command.draw_interval(&mut self.random));
        }
    }

    /// Writes what the policy sees now, with sensor noise where it is on (82 numbers).
    pub(crate) fn observe(&mut self, randomization: &RandomizationConfig, out: &mut [f32]) {
        observation::policy_observation(&self.state, &self.command, &self.previous_action, out);
        randomization.blur(out, &mut self.random);
    }

    /// Steps done in this episode.
    pub(crate) fn steps(&self) -> u32 {
        self.steps
    }

    pub(crate) fn state(&self) -> &RobotState {
        &self.state
    }

    pub(crate) fn command(&self) -> [f32; 3] {
        self.command
    }

    /// Holds a command until the episode ends.
    pub(crate) fn hold_command(&mut self, command: [f32; 3]) {
        self.command = command;
        self.command_in = None;
    }

    /// A step that cannot be used counts as a fall in the last sound state and pays nothing.
    fn broken(&self) -> Outcome {
        Outcome {
            task_reward: 0.0,
            tracking_error: task::tracking_error(&self.command, &self.state),
            exertion: Exertion::default(),
            end: End::Fall,
            state: self.state,
            faulty: true,
        }
    }

    /// Pushes the robot before its next step: a jump of its velocity, world frame, m/s.
    pub(crate) fn push(&mut self, change: Vector3<f32>) {
        self.world.push(change);
    }

    #[cfg(test)]
    pub(crate) fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }
}

/// Counts a timer down; whether it has just run out.
fn count_down(timer: &mut Option<u32>) -> bool {
    match timer {
        Some(left) => {
            *left = left.saturating_sub(1);
            *left == 0
        }
        None => false,
    }
}

/// SplitMix64: neighbouring seeds and indices become unrelated.
fn mix(x: u64) -> u64 {
    let mut z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timers_run_out_once() {
        let mut timer = Some(2);
        assert!(!count_down(&mut timer));
        assert!(count_down(&mut timer));
        assert!(!count_down(&mut None));
    }

    #[test]
    fn seeds_are_mixed_as_published() {
        // First output of SplitMix64 from state 0 (Vigna's reference implementation).
        assert_eq!(mix(0), 0xe220_a839_7b1d_cdaf);
    }
}
