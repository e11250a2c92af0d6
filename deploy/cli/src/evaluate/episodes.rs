//! Episodes of one command: robots walk until they fall or the time is over, and are measured.

use anyhow::Result;
use g1::gait::Gait;
use g1::{ACTION, FEATURES};
use sim::{Fleet, RandomizationConfig, StepRows};

use super::subject::Subject;

/// Under which conditions a command is walked.
pub(super) struct Conditions {
    pub(super) steps: u32,
    pub(super) episodes: usize,
    pub(super) randomize: bool,
    pub(super) from_reference: bool,
    pub(super) seed: u64,
}

/// What was measured, over all steps that robots were on their feet.
#[derive(Debug)]
pub(super) struct Outcome {
    pub(super) episodes: usize,
    /// Share of episodes without a fall.
    pub(super) survival: f64,
    /// √(mean ‖v* − v‖²), planar, heading frame, m/s.
    pub(super) rmse: f64,
    /// Positive mechanical work per 1,000 control steps of one robot, J.
    pub(super) energy_j: f64,
    pub(super) style_reward: f64,
    pub(super) task_reward: f64,
    /// Mean planar velocity in the heading frame, m/s.
    pub(super) velocity: [f64; 2],
    /// Mean yaw rate, rad/s.
    pub(super) yaw_rate: f64,
    /// Mean time to the fall or to the end.
    pub(super) seconds_survived: f64,
    pub(super) gait: Gait,
}

/// Sums over the steps of robots on their feet.
#[derive(Default)]
struct Sums {
    steps: f64,
    squared_error: f64,
    energy: f64,
    style: f64,
    task: f64,
    velocity: [f64; 2],
    yaw_rate: f64,
    gait: Gait,
}

/// Walks `conditions.episodes` episodes with one command.
pub(super) fn walk(
    subject: &Subject,
    command: [f32; 3],
    conditions: &Conditions,
) -> Result<Outcome> {
    let n = conditions.episodes;
    let mut task = subject.task.clone();
    task.episode_steps = conditions.steps + 1;
    task.staggered = false;
    task.start.reference_share = if conditions.from_reference { 1.0 } else { 0.0 };
    let randomization = if conditions.randomize {
        RandomizationConfig::default()
    } else {
        RandomizationConfig::none()
    };
    let mut fleet = Fleet::new(
        &task,
        &randomization,
        subject.starts.clone(),
        n,
        conditions.seed,
    )?;
    for robot in 0..n {
        fleet.hold_command(robot, command);
    }
    let mut policy = subject.policy()?;
    let mut judge = subject.judge()?;
    let mut block = Block::new(n);
    let mut sums = Sums::default();
    let mut survived = vec![None; n];
    let mut forces_before: Vec<Option<[f32; 2]>> = vec![None; n];
    for step in 0..conditions.steps {
        block.features.copy_from_slice(fleet.features());
        policy.means(fleet.observations(), n, &mut block.actions);
        fleet.step(&block.actions, &mut block.rows.out());
        judge.style_rewards(&block.features, &block.rows.next_features, &mut block.style);
        for robot in 0..n {
            if survived[robot].is_some() {
                continue;
            }
            sums.add(&block, robot, forces_before[robot]);
            forces_before[robot] = Some(block.forces(robot));
            if block.rows.ends[robot] == 1.0 {
                survived[robot] = Some(step + 1);
            }
        }
        if survived.iter().all(Option::is_some) {
            break;
        }
    }
    let fallen = survived.iter().flatten().count();
    let lived: u32 = survived
        .iter()
        .map(|fell| fell.unwrap_or(conditions.steps))
        .sum();
    Ok(sums.outcome(n, fallen, f64::from(lived) / n as f64 / 50.0))
}

impl Sums {
    fn add(&mut self, block: &Block, robot: usize, forces_before: Option<[f32; 2]>) {
        let rows = &block.rows;
        let next = &rows.next_features[robot * FEATURES..][..FEATURES];
        self.steps += 1.0;
        self.squared_error += f64::from(rows.tracking_errors[robot]);
        self.energy += f64::from(rows.energies[robot]);
        self.style += f64::from(block.style[robot]);
        self.task += f64::from(rows.task_rewards[robot]);
        // Upright robots: base and heading frame differ by the small tilt.
        self.velocity[0] += f64::from(next[1]);
        self.velocity[1] += f64::from(next[2]);
        self.yaw_rate += f64::from(next[6]);
        self.gait.add(next, block.forces(robot), forces_before);
    }

    fn outcome(self, episodes: usize, fallen: usize, seconds_survived: f64) -> Outcome {
        let mean = |sum: f64| sum / self.steps;
        Outcome {
            episodes,
            survival: (episodes - fallen) as f64 / episodes as f64,
            rmse: mean(self.squared_error).sqrt(),
            energy_j: mean(self.energy) * 1_000.0,
            style_reward: mean(self.style),
            task_reward: mean(self.task),
            velocity: self.velocity.map(mean),
            yaw_rate: mean(self.yaw_rate),
            seconds_survived,
            gait: self.gait,
        }
    }
}

/// Memory of one step of all robots.
struct Block {
    features: Vec<f32>,
    actions: Vec<f32>,
    style: Vec<f32>,
    rows: StepRows,
}

impl Block {
    fn new(n: usize) -> Self {
        Self {
            features: vec![0.0; n * FEATURES],
            actions: vec![0.0; n * ACTION],
            style: Vec::with_capacity(n),
            rows: StepRows::filled(n, 0.0),
        }
    }

    /// Left and right foot force of a robot, N.
    fn forces(&self, robot: usize) -> [f32; 2] {
        let forces = &self.rows.foot_forces;
        [forces[2 * robot], forces[2 * robot + 1]]
    }
}
