//! The learner's life: networks, statistics, memory and generators, and one iteration after another.

use crate::batch::{Batch, FALL, TIME_OUT};
use crate::config::LearningConfig;
use crate::discrimination::{self, Discriminator};
use crate::error::Fault;
use crate::gae::{self, Returns};
use crate::ppo::{Ppo, PpoFigures, Rows};
use crate::replay::Replay;
use crate::report::{IterationReport, Seconds, moments};
use crate::robot::Robot;
use crate::style::style_reward;
use crate::{FEATURES, LearningError, OBSERVATION, TRANSITION, blend, exploration, inference};
use ampco::{Granularity, Rule};
use networks::{Normalizer, Scaling, snapshot};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Seconds since any fixed moment.
pub type Clock = fn() -> f64;

/// Everything that learns.
#[derive(Debug)]
pub struct Learning {
    pub(crate) config: LearningConfig,
    robot: Robot,
    clock: Clock,
    pub(crate) core: Core,
    pub(crate) replay: Replay,
    flat: Vec<f32>,
    scratch: Scratch,
}

/// What an iteration changes and a failed one has to give back.
#[derive(Clone, Debug)]
pub(crate) struct Core {
    pub(crate) ppo: Ppo,
    pub(crate) discriminator: Discriminator,
    pub(crate) observations: Normalizer,
    pub(crate) generator: Pcg64,
    pub(crate) iteration: u64,
    pub(crate) samples: u64,
}

/// Arrays over the rows of an iteration, kept between iterations.
#[derive(Debug, Default)]
struct Scratch {
    /// Transitions as the discriminator sees them, `[row][106]`.
    transitions: Vec<f32>,
    scores: Vec<f32>,
    style_rewards: Vec<f32>,
    rewards: Vec<f32>,
    /// Normalised, `[row][82]`.
    observations: Vec<f32>,
    /// Mirrored, as the robot would see it, `[row][82]`.
    mirrored: Vec<f32>,
    /// The same, normalised.
    mirrored_scaled: Vec<f32>,
    values: Vec<f32>,
    last_values: Vec<f32>,
    timeout_values: Vec<f32>,
    advantages: Vec<f32>,
    returns: Vec<f32>,
    experts: Vec<f32>,
    policy: Vec<f32>,
    /// What is normalised for a moment.
    scaled: Vec<f32>,
    scaled_policy: Vec<f32>,
}

impl Learning {
    /// Before the first iteration. Everything random follows from `seed`.
    ///
    /// # Errors
    /// If a value of the configuration or a table of the robot cannot be used.
    pub fn new(config: LearningConfig, robot: Robot, seed: u64) -> Result<Self, LearningError> {
        config.validate()?;
        robot.check()?;
        let mut generator = Pcg64::seed_from_u64(seed);
        let ppo = Ppo::new(
            &config,
            robot.action_mirror.clone(),
            &robot.joints,
            &mut generator,
        );
        let discriminator = Discriminator::new(
            &config.discriminator,
            &robot.features,
            config.ppo.threads,
            &mut generator,
        );
        let floors = vec![config.policy.observation_floor; OBSERVATION];
        Ok(Self {
            core: Core {
                ppo,
                discriminator,
                observations: Normalizer::new(floors, config.policy.observation_clip),
                generator,
                iteration: 0,
                samples: 0,
            },
            replay: Replay::new(config.discriminator.replay_capacity),
            clock: || 0.0,
            config,
            robot,
            flat: Vec::new(),
            scratch: Scratch::default(),
        })
    }

    /// Lets reports tell seconds; without a clock they tell 0.
    #[must_use]
    pub fn with_clock(mut self, clock: Clock) -> Self {
        self.clock = clock;
        self
    }

    /// Iterations done.
    pub fn iteration(&self) -> u64 {
        self.core.iteration
    }

    /// Rows learnt from.
    pub fn samples(&self) -> u64 {
        self.core.samples
    }

    /// Exploration width of each action of the policy as it is now.
    pub fn sigma(&self) -> Vec<f32> {
        exploration::sigma(
            &self.config.exploration,
            &self.robot.joints,
            self.core.ppo.log_sigma(),
            self.core.samples,
        )
    }

    /// The policy as it is now, in the layout of [`networks::snapshot`]: what actors are to collect the next batch with.
    pub fn policy_flat(&mut self) -> &[f32] {
        let sigma = self.sigma();
        let scaling = self.core.observations.scaling();
        snapshot::export(&scaling, &sigma, self.core.ppo.actor(), &mut self.flat);
        &self.flat
    }

    /// rˢ (Eq. 7) of transitions `[row][106]` as of now; appended to `rewards`.
    pub fn style_rewards(&mut self, transitions: &[f32], rewards: &mut Vec<f32>) {
        let Scratch { scaled, scores, .. } = &mut self.scratch;
        scaled.clear();
        scores.clear();
        self.core.discriminator.scaling().apply(transitions, scaled);
        self.core.discriminator.scores(scaled, scores);
        rewards.extend(scores.iter().map(|score| style_reward(*score)));
    }

    /// One iteration: score, blend, estimate advantages, improve the policy, train the discriminator.
    ///
    /// `experts` fills its slice with expert transitions, `[n][106]`; it is called once. Statistics of observations stay
    /// as the actors had them and take the batch in at the end, for the next policy.
    ///
    /// # Errors
    /// If the batch cannot be learnt from, or something became NaN or infinite. The learner is then as it was before.
    pub fn iterate(
        &mut self,
        batch: &Batch,
        experts: &mut dyn FnMut(&mut [f32]),
        rule: Rule,
        granularity: Granularity,
    ) -> Result<IterationReport, LearningError> {
        let started = (self.clock)();
        batch.check()?;
        rule.validate()?;
        let good = self.core.clone();
        let result = self.attempt(batch, experts, rule, granularity, started);
        result.map_err(|Fault { what, value }| {
            let iteration = good.iteration;
            self.core = good;
            LearningError::NotFinite {
                what,
                value,
                iteration,
            }
        })
    }

    fn attempt(
        &mut self,
        batch: &Batch,
        experts: &mut dyn FnMut(&mut [f32]),
        rule: Rule,
        granularity: Granularity,
        started: f64,
    ) -> Result<IterationReport, Fault> {
        let sigma = self.sigma();
        self.score(batch)?;
        let style = moments(&self.scratch.style_rewards);
        let task = moments(&batch.task_rewards);
        let style_weight = blend::blend(
            rule,
            granularity,
            &self.scratch.style_rewards,
            &batch.task_rewards,
            (style[0] as f32, task[0] as f32),
            &mut self.scratch.rewards,
        );
        let reward_mean = moments(&self.scratch.rewards)[0];
        let scored = (self.clock)();
        self.estimate(batch)?;
        let explained_variance = self.explained_variance();
        let estimated = (self.clock)();
        let ppo = self.improve(batch, &sigma)?;
        let improved = (self.clock)();
        let discriminator = self.discriminate(batch, experts)?;
        let discriminated = (self.clock)();
        self.take_in(batch);
        let ends = Ends::of(batch);
        Ok(IterationReport {
            iteration: self.core.iteration,
            samples: self.core.samples,
            rows: batch.rows() as u64,
            style_mean: style[0],
            style_std: style[1],
            style_min: style[2],
            style_max: style[3],
            task_mean: task[0],
            reward_mean,
            style_weight,
            episode_length: ends.mean_length,
            falls: ends.falls,
            time_outs: ends.time_outs,
            rmse: moments(&batch.tracking_errors)[0].max(0.0).sqrt(),
            energy_j: 1000.0 * moments(&batch.energies)[0],
            surrogate: ppo.surrogate,
            value_loss: ppo.value_loss,
            entropy: ppo.entropy,
            kl: ppo.kl,
            clip_fraction: ppo.clip_fraction,
            learning_rate: f64::from(self.core.ppo.rate()),
            gradient_norm: ppo.gradient_norm,
            sigma: moments(&sigma)[0],
            explained_variance,
            expert_score: discriminator.expert_score,
            policy_score: discriminator.policy_score,
            gradient_penalty: discriminator.gradient_penalty,
            discriminator_loss: discriminator.loss,
            seconds: Seconds {
                score: scored - started,
                advantage: estimated - scored,
                ppo: improved - estimated,
                discriminator: discriminated - improved,
                total: (self.clock)() - started,
            },
        })
    }

    /// Style rewards of the batch, by the discriminator as it was when the batch was collected.
    fn score(&mut self, batch: &Batch) -> Result<(), Fault> {
        let Scratch {
            transitions,
            scores,
            style_rewards,
            ..
        } = &mut self.scratch;
        let scaling = self.core.discriminator.scaling();
        interleave(&batch.features, &batch.next_features, &scaling, transitions);
        scores.clear();
        self.core.discriminator.scores(transitions, scores);
        if let Some(i) = networks::first_not_finite(scores) {
            return Err(Fault::new(
                format!("discriminator score of row {i}"),
                scores[i],
            ));
        }
        style_rewards.clear();
        style_rewards.extend(scores.iter().map(|score| style_reward(*score)));
        Ok(())
    }

    /// Values, advantages and returns.
    fn estimate(&mut self, batch: &Batch) -> Result<(), Fault> {
        let threads = self.config.ppo.threads;
        let Scratch {
            rewards,
            observations,
            values,
            last_values,
            timeout_values,
            advantages,
            returns,
            scaled,
            ..
        } = &mut self.scratch;
        let scaling = self.core.observations.scaling();
        let ppo = &self.core.ppo;
        let evaluate = |rows: &[f32], out: &mut Vec<f32>| {
            inference::outputs(ppo.critic_shape(), ppo.critic(), rows, threads, out);
        };
        observations.clear();
        scaling.apply(&batch.observations, observations);
        values.clear();
        evaluate(observations, values);

        scaled.clear();
        scaling.apply(&batch.last_observations, scaled);
        last_values.clear();
        evaluate(scaled, last_values);

        let time_outs: Vec<usize> = batch.time_outs().map(|(_, robot)| robot).collect();
        scaled.clear();
        for robot in &time_outs {
            scaling.apply(
                &batch.timeout_observations[robot * OBSERVATION..][..OBSERVATION],
                scaled,
            );
        }
        let mut cut = Vec::new();
        evaluate(scaled, &mut cut);
        timeout_values.clear();
        timeout_values.resize(batch.robots(), 0.0);
        for (robot, value) in time_outs.iter().zip(cut) {
            timeout_values[*robot] = value;
        }

        let scale = self.config.ppo.reward_scale;
        rewards.iter_mut().for_each(|reward| *reward *= scale);
        advantages.clear();
        advantages.resize(batch.rows(), 0.0);
        let (mut row, mut robot) = (0, 0);
        for segment in batch.segments() {
            let rows = row..row + segment.rows();
            let robots = robot..robot + segment.environments;
            (row, robot) = (rows.end, robots.end);
            gae::advantages(
                *segment,
                Returns {
                    rewards: &rewards[rows.clone()],
                    values: &values[rows.clone()],
                    ends: &batch.ends[rows.clone()],
                    last_values: &last_values[robots.clone()],
                    timeout_values: &timeout_values[robots],
                },
                self.config.ppo.gamma,
                self.config.ppo.lambda,
                &mut advantages[rows],
            );
        }
        returns.clear();
        returns.extend(advantages.iter().zip(&*values).map(|(a, v)| a + v));
        match networks::first_not_finite(returns) {
            None => Ok(()),
            Some(i) => Err(Fault::new(format!("return of row {i}"), returns[i])),
        }
    }

    /// 1 − Var(R − V)/Var(R); 0 if the returns do not vary.
    fn explained_variance(&self) -> f64 {
        let variance = |numbers: &[f32]| moments(numbers)[1].powi(2);
        let returns = variance(&self.scratch.returns);
        if returns == 0.0 {
            return 0.0;
        }
        1.0 - variance(&self.scratch.advantages) / returns
    }

    fn improve(&mut self, batch: &Batch, sigma: &[f32]) -> Result<PpoFigures, Fault> {
        let scratch = &mut self.scratch;
        scratch.mirrored.clear();
        scratch.mirrored_scaled.clear();
        if self.config.ppo.mirrored_share > 0.0 {
            let mirror = &self.robot.observation_mirror;
            scratch.mirrored.resize(batch.observations.len(), 0.0);
            let rows = batch.observations.chunks_exact(OBSERVATION);
            for (row, out) in rows.zip(scratch.mirrored.chunks_exact_mut(OBSERVATION)) {
                mirror.apply(row, out);
            }
            let scaling = self.core.observations.scaling();
            scaling.apply(&scratch.mirrored, &mut scratch.mirrored_scaled);
        }
        let rows = Rows {
            observations: &scratch.observations,
            mirrored: &scratch.mirrored_scaled,
            actions: &batch.actions,
            means: &batch.means,
            log_probs: &batch.log_probs,
            advantages: &scratch.advantages,
            returns: &scratch.returns,
            values: &scratch.values,
        };
        self.core.ppo.update(&rows, sigma, &mut self.core.generator)
    }

    /// Trains the discriminator on experts, transitions of this batch and remembered ones.
    fn discriminate(
        &mut self,
        batch: &Batch,
        experts: &mut dyn FnMut(&mut [f32]),
    ) -> Result<discrimination::Figures, Fault> {
        let config = &self.config.discriminator;
        let Scratch {
            experts: expert,
            policy,
            scaled,
            scaled_policy,
            ..
        } = &mut self.scratch;
        let core = &mut self.core;
        let count = config.steps * config.batch;
        expert.clear();
        expert.resize(count * TRANSITION, 0.0);
        experts(expert);
        if let Some(i) = networks::first_not_finite(expert) {
            return Err(Fault::new(
                format!("expert transition {}", i / TRANSITION),
                expert[i],
            ));
        }
        policy.clear();
        for i in 0..count {
            let remembered = crate::minibatch::is_mirrored(i, config.replay_share);
            if remembered && !self.replay.is_empty() {
                policy.extend_from_slice(self.replay.draw(&mut core.generator));
            } else {
                let row = core.generator.random_range(0..batch.rows());
                policy.extend_from_slice(&batch.features[row * FEATURES..][..FEATURES]);
                policy.extend_from_slice(&batch.next_features[row * FEATURES..][..FEATURES]);
            }
        }
        core.discriminator.observe(expert);
        core.discriminator.observe(policy);
        let scaling = core.discriminator.scaling();
        scaled.clear();
        scaling.apply(expert, scaled);
        scaled_policy.clear();
        scaling.apply(policy, scaled_policy);
        core.discriminator.update(scaled, scaled_policy)
    }

    /// What the next iteration is to know of this batch. Nothing fails from here on.
    fn take_in(&mut self, batch: &Batch) {
        let core = &mut self.core;
        core.observations.update(&batch.observations);
        // A mirrored robot's observations are as likely: statistics of both keep the two sides alike.
        core.observations.update(&self.scratch.mirrored);
        let rows = batch.rows();
        for _ in 0..self.config.discriminator.replay_insert.min(rows) {
            let row = core.generator.random_range(0..rows);
            let mut transition = [0.0; TRANSITION];
            transition[..FEATURES].copy_from_slice(&batch.features[row * FEATURES..][..FEATURES]);
            transition[FEATURES..]
                .copy_from_slice(&batch.next_features[row * FEATURES..][..FEATURES]);
            self.replay.insert(&transition);
        }
        core.iteration += 1;
        core.samples += rows as u64;
    }
}

/// (o_t, o_{t+1}) side by side and normalised, `[row][106]`.
fn interleave(features: &[f32], next_features: &[f32], scaling: &Scaling, out: &mut Vec<f32>) {
    out.clear();
    let pairs = features
        .chunks_exact(FEATURES)
        .zip(next_features.chunks_exact(FEATURES));
    let mut pair = [0.0; TRANSITION];
    for (now, next) in pairs {
        pair[..FEATURES].copy_from_slice(now);
        pair[FEATURES..].copy_from_slice(next);
        scaling.apply(&pair, out);
    }
}

/// How episodes of a batch ended.
struct Ends {
    mean_length: Option<f64>,
    falls: u64,
    time_outs: u64,
}

impl Ends {
    fn of(batch: &Batch) -> Self {
        let count = |end| batch.ends.iter().filter(|e| **e == end).count() as u64;
        let (falls, time_outs) = (count(FALL), count(TIME_OUT));
        let steps: f64 = batch
            .ends
            .iter()
            .zip(&batch.episode_steps)
            .filter(|(end, _)| **end == FALL || **end == TIME_OUT)
            .map(|(_, steps)| f64::from(*steps))
            .sum();
        let ended = falls + time_outs;
        Self {
            mean_length: (ended > 0).then(|| steps / ended as f64),
            falls,
            time_outs,
        }
    }
}

#[cfg(test)]
mod tests;
