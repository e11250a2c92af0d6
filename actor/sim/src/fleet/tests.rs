//! Contracts of the fleet: robots, actions and tasks that all of its tests share.

mod episodes;
mod event;
mod faults;
mod repeat;
mod reward;
mod rows;
mod seen;
mod table;

use super::*;
use crate::actuator::Gains;
use crate::command::CommandConfig;
use crate::error::SimError;
use crate::model::Variation;
use crate::randomization::Push;
use crate::reward::RewardConfig;
use crate::reward::track::Track;
use crate::rows::StepRows;
use crate::start::{StartConfig, Starts};
use crate::termination::TerminationConfig;
use crate::termination::fall::FallConfig;
use crate::termination::stray::StrayConfig;
use crate::termination::time_out::TimeOutConfig;
use g1::{FEATURES, JOINTS, OBSERVATION, observation};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use vocabulary::Section;

const ENGINES: [Physics; 2] = [Physics::Rapier, Physics::Batched];

/// What no step writes.
const UNTOUCHED: f32 = -77.0;

fn step(fleet: &mut Fleet, actions: &[f32]) -> StepRows {
    let mut rows = StepRows::of(fleet, UNTOUCHED);
    fleet.step(actions, &mut rows.out());
    rows
}

fn walking_frames() -> Starts {
    let mut state = RobotState::standing();
    state.linear_velocity.x = 0.8;
    Starts {
        states: vec![state; 3],
        commands: vec![[0.8, 0.0, 0.0]; 3],
        cumulative_weights: vec![1.0, 2.0, 3.0],
    }
}

fn fleet(task: &TaskConfig, randomization: &RandomizationConfig, n: usize, seed: u64) -> Fleet {
    fleet_in(Physics::Rapier, task, randomization, n, seed)
}

fn fleet_in(
    physics: Physics,
    task: &TaskConfig,
    randomization: &RandomizationConfig,
    n: usize,
    seed: u64,
) -> Fleet {
    Fleet::new(physics, task, randomization, walking_frames(), n, seed).unwrap()
}

/// Actions from a generator of their own.
struct Actions(Pcg64Mcg);

impl Actions {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }
    fn draw(&mut self, n: usize, size: f32) -> Vec<f32> {
        (0..n * ACTION)
            .map(|_| size * (2.0 * self.0.random::<f32>() - 1.0))
            .collect()
    }
}

/// Episodes of so many steps, and otherwise the usual ends.
fn of_steps(steps: u32, staggered: bool) -> TerminationConfig {
    TerminationConfig {
        time_out: TimeOutConfig { steps, staggered },
        ..TerminationConfig::default()
    }
}

/// Short episodes and everything random, so that resets, pushes and commands all come.
fn eventful() -> (TaskConfig, RandomizationConfig) {
    let task = TaskConfig {
        termination: of_steps(20, true),
        command: CommandConfig {
            resample_seconds: [0.06, 0.2],
            ..CommandConfig::default()
        },
        start: StartConfig {
            reference_share: 0.7.into(),
            ..StartConfig::default()
        },
        ..TaskConfig::default()
    };
    let randomization = RandomizationConfig {
        impulse: Some(Push {
            range: [0.0, 0.5],
            seconds: [0.1, 0.3],
        }),
        ..RandomizationConfig::table_one()
    };
    (task, randomization)
}
