//! One environment: what a robot is asked to do, and its own random numbers.
//!
//! Separate from the fleet because an episode's life (start, steps, pushes, new commands, end) is
//! told here once, for one robot, while the fleet only lines robots up. The robot itself is in its
//! engine, beside all others ([`Bodies`]).

mod setting;

pub(crate) use setting::Setting;

use crate::actuator;
use crate::command::Occasion;
use crate::event::lot::Lot;
use crate::moment::{self, Moment};
use crate::physics::Bodies;
use crate::randomization::{SensorNoise, Table};
use crate::start;
use crate::termination::stray::Astray;
use crate::terms::Sums;
use g1::{JOINTS, RobotState};
use nalgebra::Vector3;
use observation::{Scene, Truth};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::{Deserialize, Serialize};
use vocabulary::Cause;

/// What is seen of one environment: its rows, which hold what was seen before.
pub(crate) struct Rows<'a> {
    /// What the policy sees.
    pub(crate) observation: &'a mut [f32],
    /// What the critic sees of its own; empty where that is nothing.
    pub(crate) critic: &'a mut [f32],
}

/// What a step of one environment brought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) task_reward: f32,
    pub(crate) tracking_error: f32,
    /// Positive mechanical work of the motors, J.
    pub(crate) energy: f32,
    /// Vertical force on the left and the right sole, mean over the step, N.
    pub(crate) foot_forces: [f32; 2],
    /// Why the episode ended with the step; none if it goes on.
    pub(crate) end: Option<Cause>,
}

/// An episode. Everything that its future depends on is in here, the robot in its engine aside.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Environment {
    random: Pcg64Mcg,
    state: RobotState,
    command: [f32; 3],
    previous_action: [f32; JOINTS],
    truth: Truth,
    /// What has befallen the robot for this episode. In a part of its own in snapshots, for most have none.
    #[serde(skip)]
    lot: Option<Box<Lot>>,
    /// The pushes of the coming step together, world frame, m/s.
    pushed: Vector3<f32>,
    astray: Astray,
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
    pub(crate) fn new(setting: &Setting, bodies: &mut Bodies, seed: u64, index: usize) -> Self {
        let mut environment = Self {
            random: Pcg64Mcg::seed_from_u64(mix(mix(seed).wrapping_add(index as u64))),
            state: RobotState::standing(),
            command: [0.0; 3],
            previous_action: [0.0; JOINTS],
            truth: Truth::NOMINAL,
            lot: None,
            pushed: Vector3::zeros(),
            astray: Astray::default(),
            command_in: None,
            push_in: None,
            age: 0,
            steps: 0,
        };
        environment.reset(setting, bodies, index);
        if setting.task.termination.time_out.staggered {
            environment.age = environment
                .random
                .random_range(0..setting.task.termination.time_out.steps);
        }
        environment
    }

    /// Begins a new episode.
    fn reset(&mut self, setting: &Setting, bodies: &mut Bodies, index: usize) {
        let table = &setting.table(index).rows;
        let mut variation = table.draw_variation(&mut self.random);
        let kinds = setting.task.command.kinds.as_ref();
        let kind = kinds.map(|kinds| kinds.of_robot(index, setting.robots));
        let start = start::draw(
            &setting.starts,
            kind.map(|kind| (kind, &setting.pools)),
            &setting.task.start,
            &setting.task.command,
            &mut self.random,
        );
        let state = match &setting.ground {
            None => start.state,
            Some(ground) => ground.place(&start.state, setting.task.start.lift, &mut self.random),
        };
        let mut lot = setting
            .event(index)
            .map(|event| Box::new(Lot::draw(event, &mut variation, &mut self.random)));
        self.state = setting.told(bodies.begin(index, &variation, &state));
        self.command = start.command;
        self.previous_action = [0.0; JOINTS];
        self.truth = Truth {
            friction: variation.friction,
            payload: variation.torso_mass,
            com_offset: variation.torso_com,
            ..Truth::NOMINAL
        };
        if let Some(lot) = &mut lot {
            lot.begin(&self.state);
            lot.tell(&mut self.truth);
        }
        self.lot = lot;
        self.condition(bodies, index);
        self.pushed = Vector3::zeros();
        self.astray = Astray::at_start(start.fits);
        self.command_in = Some(setting.task.command.draw_interval(&mut self.random));
        self.push_in = table.draw_push_interval(&mut self.random);
        self.age = 0;
        self.steps = 0;
    }

    /// Gives the robot in its engine the condition that is its lot.
    fn condition(&self, bodies: &mut Bodies, index: usize) {
        bodies.set_condition(index, self.lot.as_ref().map(|lot| lot.condition()));
    }

    /// What has befallen the robot.
    pub(crate) fn lot(&self) -> Option<&Lot> {
        self.lot.as_deref()
    }

    /// Takes up a lot where it was left, after everything else.
    pub(crate) fn resume(&mut self, lot: Option<Lot>, bodies: &mut Bodies, index: usize) {
        self.lot = lot.map(Box::new);
        if let Some(lot) = &self.lot {
            lot.tell(&mut self.truth);
        }
        self.condition(bodies, index);
    }

    /// Says what the coming control step acts with; false if the action cannot be used.
    pub(crate) fn act(
        &mut self,
        setting: &Setting,
        bodies: &mut Bodies,
        index: usize,
        action: &[f32; JOINTS],
    ) -> bool {
        self.steps += 1;
        self.age += 1;
        // All numbers, without a way out at the first: many at a time.
        if !action.iter().fold(true, |all, a| all & a.is_finite()) {
            return false;
        }
        if count_down(&mut self.push_in) {
            let table = &setting.table(index).rows;
            if let Some(push) = table.draw_push(&mut self.random) {
                self.push(bodies, index, push);
                if let Some(rule) = &setting.task.termination.stray {
                    self.astray.pushed(rule);
                }
            }
            self.push_in = table.draw_push_interval(&mut self.random);
        }
        let mut targets = actuator::targets(action);
        match &mut self.lot {
            None => bodies.set_targets(index, &targets),
            Some(lot) => {
                let (force, begins) = lot.press(setting.event(index), &mut self.random);
                if let Some(rule) = setting.task.termination.stray.as_ref().filter(|_| begins) {
                    self.astray.pushed(rule);
                }
                self.truth.lot.force = force;
                bodies.set_force(index, force);
                lot.hold(setting.event(index), &mut targets, &mut self.random);
                bodies.set_targets_by_step(index, &lot.targets(&targets));
            }
        }
        self.previous_action = *action;
        true
    }

    /// Looks at what a control step brought. After it an ended episode has to be left by
    /// [`Environment::proceed`].
    pub(crate) fn judge(
        &mut self,
        setting: &Setting,
        bodies: &Bodies,
        index: usize,
        sums: &mut Sums,
    ) -> Outcome {
        if !bodies.is_sound(index) {
            return self.broken();
        }
        self.state = setting.told(bodies.state(index));
        if let Some(lot) = &mut self.lot {
            lot.sense(&self.state);
        }
        let rules = &setting.task.termination;
        let stray = rules.stray.as_ref();
        let strayed = stray.is_some_and(|rule| self.astray.step(rule, &self.command, &self.state));
        let end = if rules.fall.has_fallen(&self.state) {
            Some(Cause::Fall)
        } else if strayed {
            Some(Cause::Stray)
        } else if self.age >= rules.time_out.steps {
            Some(Cause::TimeOut)
        } else {
            None
        };
        let (energy, foot_forces) = bodies.work_and_forces(index);
        self.truth.foot_forces = foot_forces;
        self.truth.push = std::mem::take(&mut self.pushed).into();
        let moment = Moment::new(&self.command, &self.state, energy);
        Outcome {
            task_reward: setting.task.pay_and_tell(&moment, sums),
            tracking_error: moment.velocity_error,
            energy,
            foot_forces,
            end,
        }
    }

    /// Goes on after a step: into the next episode, or with a new command when its time has come.
    pub(crate) fn proceed(
        &mut self,
        setting: &Setting,
        bodies: &mut Bodies,
        index: usize,
        end: Option<Cause>,
    ) {
        if end.is_some() {
            self.reset(setting, bodies, index);
        } else if count_down(&mut self.command_in) {
            self.command = setting
                .task
                .command
                .draw(Occasion::default(), &mut self.random);
            self.astray = Astray::default();
            self.command_in = Some(setting.task.command.draw_interval(&mut self.random));
        }
    }

    /// Pushes the robot before its next step: a jump of its velocity, world frame, m/s.
    pub(crate) fn push(&mut self, bodies: &mut Bodies, index: usize, change: Vector3<f32>) {
        bodies.push(index, change);
        self.pushed += change;
    }

    /// Writes what policy and critic see now, with sensor noise where it is on, before the past frames that their rows
    /// hold. `frame` is room for one frame.
    pub(crate) fn observe(
        &mut self,
        setting: &Setting,
        table: &Table,
        frame: &mut [f32],
        rows: Rows<'_>,
    ) {
        let scene = Scene {
            state: &self.state,
            command: &self.command,
            previous_action: &self.previous_action,
            truth: &self.truth,
        };
        let sensed = self.lot.as_ref().map(|lot| lot.seen());
        let sensed = Scene {
            state: sensed.as_ref().unwrap_or(&self.state),
            ..scene
        };
        let first = self.steps == 0;
        let mut see = |list: &observation::Table, scene, noise: &SensorNoise, row: &mut [f32]| {
            if list.is_of_the_present() {
                list.measure(scene, row);
                noise.blur(row, &mut self.random);
                list.adjust(row);
            } else {
                let frame = &mut frame[..list.frame_width()];
                list.measure(scene, frame);
                noise.blur(frame, &mut self.random);
                list.adjust(frame);
                list.remember(frame, first, row);
            }
        };
        see(
            &setting.tables.actor,
            &sensed,
            &table.noise,
            rows.observation,
        );
        if let Some(critic) = &setting.tables.critic {
            see(&critic.own, &scene, &table.critic_noise, rows.critic);
        }
    }

    /// Writes what is measured beside: of the state that a step led to, under the command that it had.
    pub(crate) fn measure(&self, setting: &Setting, row: &mut [f32]) {
        setting.tables.measured.measure(
            &Scene {
                state: &self.state,
                command: &self.command,
                previous_action: &self.previous_action,
                truth: &self.truth,
            },
            row,
        );
    }

    /// Steps done in this episode.
    pub(crate) fn steps(&self) -> u32 {
        self.steps
    }

    /// The true state; of a step that broke, the last sound one.
    pub(crate) fn state(&self) -> &RobotState {
        &self.state
    }

    pub(crate) fn command(&self) -> [f32; 3] {
        self.command
    }

    /// Holds a command until the episode ends.
    pub(crate) fn hold_command(&mut self, command: [f32; 3]) {
        self.command = command;
        self.astray = Astray::default();
        self.command_in = None;
    }

    /// A step that cannot be used ends the episode in the last sound state and pays nothing.
    pub(crate) fn broken(&self) -> Outcome {
        Outcome {
            task_reward: 0.0,
            tracking_error: moment::velocity_error(&self.command, &self.state),
            energy: 0.0,
            foot_forces: [0.0; 2],
            end: Some(Cause::Fault),
        }
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
