//! `ampco bench learner`: what a step of learning costs.
//!
//! A step of PPO is actor and critic forward, backward, clipped and taken by Adam; one of the discriminator is half
//! experts, half policy, with the gradient penalty on the experts. Figures are medians over repetitions on random rows:
//! the cost does not depend on what the numbers are.

use std::time::Instant;

use amp::discrimination::Discriminator;
use amp::ppo::{Ppo, Rows};
use amp::{Batch, Learning, LearningConfig, Robot};
use ampco::{Granularity, Rule};
use anyhow::{Result, ensure};
use clap::Args;
use g1::{ACTION, OBSERVATION};
use observation::Tables;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde_json::{Value, json};
use vocabulary::Cause;

use super::products;

/// Rows of a timed step, as in the figures that other trainers publish.
const ROWS: usize = 4096;

/// Times the learner's steps and whole iterations.
#[derive(Debug, Args)]
pub(crate) struct LearnerBench {
    /// Times that each step is repeated.
    #[arg(long, default_value_t = 30)]
    repetitions: usize,
    /// Iterations that are timed.
    #[arg(long, default_value_t = 5)]
    iterations: usize,
    /// Environments of the timed iteration.
    #[arg(long, default_value_t = 256)]
    environments: usize,
    /// Steps of each environment in it.
    #[arg(long, default_value_t = 32)]
    steps: usize,
    /// Threads that rows are divided among.
    #[arg(long, default_value_t = 2)]
    threads: usize,
}

impl LearnerBench {
    /// Milliseconds per step, samples per second.
    pub(crate) fn run(&self) -> Result<Value> {
        ensure!(
            self.repetitions > 0 && self.iterations > 0,
            "--repetitions 0 or --iterations 0: nothing to time; use 1 or more"
        );
        // As in the learner's own process.
        learner::pages::keep_small();
        let sized = |hidden: &[usize], judge: &[usize]| {
            let mut config = LearningConfig::default();
            config.policy.hidden = hidden.to_vec();
            config.policy.critic_hidden = hidden.to_vec();
            config.discriminator.hidden = judge.to_vec();
            config.ppo.threads = self.threads;
            config
        };
        let large = sized(&[512, 256, 128], &[1024, 512]);
        let defaults = LearningConfig::default();
        let default = sized(&defaults.policy.hidden, &defaults.discriminator.hidden);
        let (iteration, parts) = self.iteration(default.clone())?;
        let mut iterations = Vec::new();
        for (networks, config) in [("default", &default), ("512-256-128", &large)] {
            for epochs in [1, 5] {
                let mut config = config.clone();
                config.ppo.epochs = epochs;
                let seconds = self.iteration(config)?.0;
                iterations.push(json!({
                    "networks": networks,
                    "epochs": epochs,
                    "samples_per_second": (self.environments * self.steps) as f64 / seconds,
                }));
            }
        }
        let widths = [OBSERVATION, 512, 256, 128];
        let [actor, critic] = [ACTION, 1].map(|outputs| [&widths[..], &[outputs]].concat());
        let rows = (self.environments * self.steps) as f64;
        Ok(json!({
            "ppo_ms_4096": self.ppo_ms(large.clone())?,
            "ppo_products_ms_4096": self.median_ms(|| {
                products::multiply(&[&actor, &critic], ROWS, self.threads);
                Ok(())
            })?,
            "discriminator_ms_4096": self.discriminator_ms(large, ROWS / 2)?,
            "ppo_default_ms_4096": self.ppo_ms(default.clone())?,
            "discriminator_default_ms_4096": self.discriminator_ms(default, ROWS / 2)?,
            "samples_per_second": rows / iteration,
            "iteration_ms": 1e3 * iteration,
            "iteration_parts_ms": parts,
            "iterations": iterations,
            "rows": rows,
            "threads": self.threads,
            "repetitions": self.repetitions,
        }))
    }

    /// Actor and critic, one step of all rows.
    fn ppo_ms(&self, mut config: LearningConfig) -> Result<f64> {
        config.ppo.epochs = 1;
        config.ppo.minibatch = ROWS;
        config.validate()?;
        let mut rng = Pcg64::seed_from_u64(1);
        let robot = robot();
        let mut ppo = Ppo::new(&config, &robot, &mut rng);
        let column = |columns: usize, rng: &mut Pcg64| noise(ROWS * columns, rng);
        let observations = column(OBSERVATION, &mut rng);
        let actions = column(ACTION, &mut rng);
        let advantages = column(1, &mut rng);
        let means = vec![0.0; ROWS * ACTION];
        let sigma = [1.0; ACTION];
        let log_probs = standard_log_densities(&actions);
        let rows = Rows {
            observations: &observations,
            mirrored: &observations,
            critic: &[],
            mirrored_critic: &[],
            mirrored_share: config.ppo.mirrored_share.now(),
            kl_target: config.ppo.kl_target.now(),
            critic_alone: false,
            actions: &actions,
            means: &means,
            log_probs: &log_probs,
            widths: &[],
            advantages: &advantages,
            returns: &advantages,
        };
        self.median_ms(|| {
            ppo.update(&rows, &sigma, &mut rng)
                .map_err(|fault| anyhow::anyhow!("{} became {}", fault.what, fault.value))?;
            Ok(())
        })
    }

    /// The discriminator, one step of `batch` experts and as many policy transitions.
    fn discriminator_ms(&self, mut config: LearningConfig, batch: usize) -> Result<f64> {
        config.discriminator.batch = batch;
        config.validate()?;
        let mut rng = Pcg64::seed_from_u64(2);
        let robot = robot();
        let threads = config.ppo.threads;
        let mut judge = Discriminator::new(&config.discriminator, &robot, threads, &mut rng);
        let experts = noise(batch * judge.width(), &mut rng);
        let policy = noise(batch * judge.width(), &mut rng);
        self.median_ms(|| {
            judge
                .update(&experts, &policy, &[])
                .map_err(|fault| anyhow::anyhow!("{} became {}", fault.what, fault.value))?;
            Ok(())
        })
    }

    /// Seconds of a whole iteration, and milliseconds of its parts.
    fn iteration(&self, config: LearningConfig) -> Result<(f64, Value)> {
        let mut rng = Pcg64::seed_from_u64(3);
        let mut batch = Batch::new(robot().widths());
        batch.resize(1, self.steps, self.environments);
        ensure!(
            batch.rows() > 0,
            "--environments 0 or --steps 0: nothing to learn from"
        );
        let mut learning = Learning::new(config, robot(), 4)?.with_clock(seconds);
        let mut totals = Vec::new();
        let mut newest = None;
        let mut experts = Pcg64::seed_from_u64(5);
        for _ in 0..=self.iterations {
            fill(&mut batch, &learning.sigma(), &mut rng);
            let report = learning.iterate(
                &batch,
                &mut |rows| {
                    rows.iter_mut()
                        .for_each(|x| *x = experts.random_range(-1.0..1.0))
                },
                Rule::Fixed { style_weight: 0.5 },
                Granularity::Sample,
            )?;
            totals.push(report.seconds.total);
            newest = Some(report.seconds);
        }
        totals.remove(0); // memory is taken from the system in the first
        let ms = |seconds: f64| (1e4 * seconds).round() / 10.0;
        let parts = newest.map(|seconds| {
            json!({
                "score": ms(seconds.score),
                "advantage": ms(seconds.advantage),
                "ppo": ms(seconds.ppo),
                "discriminator": ms(seconds.discriminator),
            })
        });
        Ok((median(totals), parts.into()))
    }

    fn median_ms(&self, mut work: impl FnMut() -> Result<()>) -> Result<f64> {
        work()?;
        let mut times = Vec::with_capacity(self.repetitions);
        for _ in 0..self.repetitions {
            let began = Instant::now();
            work()?;
            times.push(1e3 * began.elapsed().as_secs_f64());
        }
        Ok(median(times))
    }
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

/// Seconds since the first call.
fn seconds() -> f64 {
    static BEGIN: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Numbers of about unit deviation.
fn noise(count: usize, rng: &mut impl Rng) -> Vec<f32> {
    (0..count).map(|_| rng.random_range(-1.7..1.7)).collect()
}

/// Log-densities of actions under means 0 and deviations 1.
fn standard_log_densities(actions: &[f32]) -> Vec<f32> {
    let at_mean = -0.5 * ACTION as f32 * std::f32::consts::TAU.ln();
    let squares = |row: &[f32]| row.iter().map(|a| a * a).sum::<f32>();
    actions
        .chunks_exact(ACTION)
        .map(|row| at_mean - 0.5 * squares(row))
        .collect()
}

/// A batch of numbers such as a rollout brings: near the first policy's means, a few ends.
fn fill(batch: &mut Batch, sigma: &[f32], rng: &mut impl Rng) {
    let mut segment = batch.segment_mut(0);
    for part in [
        &mut segment.observations,
        &mut segment.features,
        &mut segment.next_features,
        &mut segment.last_observations,
        &mut segment.timeout_observations,
    ] {
        part.iter_mut()
            .for_each(|x| *x = rng.random_range(-1.7..1.7));
    }
    for (i, action) in segment.actions.iter_mut().enumerate() {
        *action = sigma[i % ACTION] * rng.random_range(-1.7..1.7);
    }
    let normalizer: f32 = sigma.iter().map(|s| s.ln()).sum();
    let scaled: Vec<f32> = segment
        .actions
        .iter()
        .enumerate()
        .map(|(i, action)| action / sigma[i % ACTION])
        .collect();
    for (log_prob, density) in segment
        .log_probs
        .iter_mut()
        .zip(standard_log_densities(&scaled))
    {
        *log_prob = density - normalizer;
    }
    for part in [
        &mut segment.task_rewards,
        &mut segment.energies,
        &mut segment.tracking_errors,
    ] {
        part.iter_mut()
            .for_each(|x| *x = rng.random_range(0.0..1.0));
    }
    segment.episode_steps.fill(100.0);
    for (i, end) in segment.ends.iter_mut().enumerate() {
        *end = if i % 500 == 499 {
            Cause::TimeOut.code()
        } else {
            0.0
        };
    }
}

/// The robot as the paper sees it.
fn robot() -> Robot {
    learner::robot(&Tables::default())
}
