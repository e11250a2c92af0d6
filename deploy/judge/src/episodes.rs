//! Episodes of one scenario: robots go until they fall or the time is over, and are measured.

use anyhow::{Context, Result};
use g1::gait::{CONTACT_FORCE, Conduct, Off, Strides};
use g1::joints::{LEFT_LEG, RIGHT_LEG};
use g1::{ACTION, FEATURES, JOINTS, RobotState, observation};
use policy::Policy;
use sim::{Fleet, LastStep, RandomizationConfig, Starts, StepRows, TimeOutConfig};
use vocabulary::{Cause, Ramp};

use super::judge::Judge;
use super::scenario::Scenario;
use super::stress::{Acting, Row};
use super::subject::{Kept, Subject};
use super::tally::{SETTLING, Sample, Tally, Trace};

/// Robots that are stepped together. Fixed, so that results do not depend on the number of threads.
pub(super) const TOGETHER: usize = 16;

/// How long, how often, and from which seed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conditions {
    pub(super) steps: u32,
    pub(super) episodes: usize,
    pub(super) seed: u64,
    /// Keep every step for plots.
    pub(super) traced: bool,
}

/// Some episodes of a scenario: what one thread does at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unit<'a> {
    pub(super) scenario: &'a Scenario,
    /// The first episode.
    pub(super) first: usize,
    pub(super) episodes: usize,
}

/// A scenario's episodes in units.
pub(super) fn units<'a>(
    scenario: &'a Scenario,
    conditions: &Conditions,
) -> impl Iterator<Item = Unit<'a>> {
    let all = conditions.episodes;
    (0..all).step_by(TOGETHER).map(move |first| Unit {
        scenario,
        first,
        episodes: TOGETHER.min(all - first),
    })
}

/// A policy that acts and a judge that looks: each thread has its own.
pub(super) struct Walker<'a> {
    subject: &'a Subject,
    policy: Policy,
    judge: Judge,
}

impl<'a> Walker<'a> {
    /// With the discriminator of `judge`.
    pub(super) fn new(subject: &'a Subject, judge: &Kept) -> Result<Self> {
        Ok(Self {
            subject,
            policy: subject.policy()?,
            judge: Judge::of(judge)?,
        })
    }

    /// Goes through a unit; `tell` hears how many robots made each step.
    pub(super) fn walk(
        &mut self,
        unit: &Unit<'_>,
        conditions: &Conditions,
        tell: impl Fn(usize),
    ) -> Result<Tally> {
        let n = unit.episodes;
        let scenario = unit.scenario;
        let mut fleet = Self::fleet(self.subject, unit, conditions)?;
        let mut block = Block::new(&fleet);
        let mut robots = vec![Robot::default(); n];
        let mut tally = Tally {
            episodes: n,
            traces: vec![Trace::default(); n],
            ..Tally::default()
        };
        let acting = scenario
            .stress
            .as_ref()
            .map_or_else(Acting::default, Row::acting);
        let taught = self.subject.task.command.widest()[2];
        let mut orders: Vec<_> = (0..n)
            .map(|robot| {
                acting.orders(
                    conditions.seed.wrapping_add((unit.first + robot) as u64),
                    taught,
                )
            })
            .collect();
        // The command of each robot, and since when.
        let mut held = vec![(scenario.command(0, conditions.steps), 0); n];
        let mut seen = vec![0.0; fleet.observations().len()];
        for step in 0..conditions.steps {
            for robot in 0..n {
                let asked = scenario.command(step, conditions.steps);
                let command = orders[robot]
                    .as_mut()
                    .map_or(asked, |orders| orders.at(step, asked));
                if command != held[robot].0 {
                    robots[robot].close(held[robot].0);
                    held[robot] = (command, step);
                }
                if fleet.command(robot) != command {
                    fleet.hold_command(robot, command);
                }
                let episode = unit.first + robot;
                let push = scenario.push(step, conditions.steps, episode, conditions.episodes);
                if let Some([x, y]) = push {
                    fleet.push(robot, [x, y, 0.0]);
                }
            }
            for (robot, before) in block.before.iter_mut().enumerate() {
                *before = *fleet.state(robot);
            }
            seen.copy_from_slice(fleet.observations());
            acting.withhold(&fleet.tables().actor, &mut seen);
            self.policy.means(&seen, n, &mut block.actions);
            fleet.step(&block.actions, &mut block.rows.out());
            for (robot, life) in robots
                .iter_mut()
                .enumerate()
                .filter(|(_, l)| l.ended.is_none())
            {
                let last = &fleet.last_step(robot);
                let states = [&block.before[robot], &last.state];
                let (command, since) = held[robot];
                self.judge.take(robot, step == 0, states, &command);
                let settled = step >= since + SETTLING;
                tally.add(&block, robot, command, last, life, settled);
                if conditions.traced {
                    tally.traces[robot].samples.push(sample(last));
                }
                life.forces = Some(last.exertion.foot_forces);
                life.ended = Cause::of(block.rows.ends[robot]).unwrap_or(Some(Cause::Fault));
            }
            tell(n);
            if robots.iter().all(|robot| robot.ended.is_some()) {
                break;
            }
        }
        for (robot, (command, _)) in robots.iter_mut().zip(held) {
            robot.close(command);
            tally.off.merge(&robot.off);
            tally.conduct.merge(&robot.conduct);
            tally.settled_conduct.merge(&robot.settled_conduct);
            // Whose episode nothing ended has had all its time.
            tally.ends.add(robot.ended.unwrap_or(Cause::TimeOut));
        }
        tally.style = self.judge.sum();
        if !conditions.traced {
            tally.traces.clear();
        }
        Ok(tally)
    }

    /// The robots of a unit, before their first step.
    pub(super) fn fleet(
        subject: &Subject,
        unit: &Unit<'_>,
        conditions: &Conditions,
    ) -> Result<Fleet> {
        let scenario = unit.scenario;
        let mut task = subject.task.clone();
        // Nobody's time is up before ours.
        task.termination.time_out = TimeOutConfig {
            steps: conditions.steps + 1,
            staggered: false,
        };
        // A judge counts falls; disobedience shows in the velocity errors.
        task.termination.stray = None;
        let (starts, share) = if scenario.from_reference {
            (subject.starts(scenario.commands[0]), 1.0)
        } else {
            (Starts::default(), 0.0)
        };
        task.start.reference_share = Ramp::Constant(share);
        let acting = scenario
            .stress
            .as_ref()
            .map_or_else(Acting::default, Row::acting);
        task.ground = acting.ground(task.ground);
        let rows = scenario.rows.iter().map(String::as_str);
        let randomization = RandomizationConfig::only(rows).context("Table I has no such row")?;
        // Robots of one unit differ by their index; units differ by their seed.
        let seed = conditions.seed.wrapping_add((unit.first as u64) << 32);
        // Exact sensors where nothing is randomised.
        let tables = match scenario.rows.is_empty() {
            true => subject.kept.tables.exact(),
            false => subject.kept.tables.clone(),
        };
        Ok(Fleet::seen_by(
            &tables,
            subject.mechanics,
            &task,
            (&randomization, &acting.event),
            starts,
            unit.episodes,
            seed,
        )?)
    }
}

/// What is remembered of a robot from step to step.
#[derive(Clone, Copy, Debug, Default)]
struct Robot {
    ended: Option<Cause>,
    forces: Option<[f32; 2]>,
    conduct: Conduct,
    settled_conduct: Conduct,
    strides: Strides,
    off: Off,
}

impl Robot {
    /// Another command than this one, or the end.
    fn close(&mut self, command: [f32; 3]) {
        if let Some(off) = std::mem::take(&mut self.strides).off(command) {
            self.off.merge(&off);
        }
        self.conduct.close();
        self.settled_conduct.close();
    }
}

impl Tally {
    fn add(
        &mut self,
        block: &Block,
        robot: usize,
        command: [f32; 3],
        last: &LastStep,
        life: &mut Robot,
        settled: bool,
    ) {
        let LastStep { state, exertion } = last;
        let planar = state.velocity_in_heading();
        let velocity = [planar.x, planar.y, state.angular_velocity.z];
        let features = &mut [0.0; FEATURES];
        observation::features(state, features);
        let (forces, forces_before) = (exertion.foot_forces, life.forces);
        let error = f64::from(block.rows.tracking_errors[robot]);
        let errors: [f64; 3] =
            std::array::from_fn(|axis| f64::from(command[axis] - velocity[axis]).powi(2));
        self.steps += 1.0;
        self.squared_error += error;
        for (sum, error) in self.squared_errors.iter_mut().zip(errors) {
            *sum += error;
        }
        life.conduct
            .add(command, velocity, features, forces, forces_before);
        if settled {
            self.settled_steps += 1.0;
            self.settled_error += error;
            self.settled_yaw_error += errors[2];
            life.strides.add(velocity, forces, forces_before);
            life.settled_conduct
                .add(command, velocity, features, forces, forces_before);
        }
        self.energy += f64::from(exertion.energy);
        self.task += f64::from(block.rows.task_rewards[robot]);
        self.feet.add(state, forces, forces_before);
        self.motors.add(&exertion.torque_use, &exertion.speed_use);
    }
}

fn sample(LastStep { state, exertion }: &LastStep) -> Sample {
    let velocity = state.velocity_in_heading();
    let joints: &[f32; JOINTS] = &state.joint_positions;
    Sample {
        velocity: [velocity.x, velocity.y, state.angular_velocity.z],
        hips: [joints[LEFT_LEG], joints[RIGHT_LEG]],
        down: exertion.foot_forces.map(|force| force > CONTACT_FORCE),
    }
}

/// Memory of one step of all robots.
pub(super) struct Block {
    /// The states before it.
    pub(super) before: Vec<RobotState>,
    pub(super) actions: Vec<f32>,
    pub(super) rows: StepRows,
}

impl Block {
    pub(super) fn new(fleet: &Fleet) -> Self {
        let n = fleet.len();
        Self {
            before: vec![RobotState::standing(); n],
            actions: vec![0.0; n * ACTION],
            rows: StepRows::of(fleet, 0.0),
        }
    }
}
