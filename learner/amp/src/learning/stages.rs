//! The stages of an iteration, in the order in which they run.
//!
//! Each reads the batch and what earlier stages left in [`Scratch`].

use super::Learning;
use crate::batch::Batch;
use crate::config::{OffPolicy, REPLAY_SHARE};
use crate::discrimination;
use crate::error::Fault;
use crate::gae::{self, Returns};
use crate::inference;
use crate::ppo::{PpoFigures, Rows};
use crate::report::moments;
use crate::robot::Mirror;
use crate::style::style_reward;
use crate::vtrace;
use crate::window::{Cut, Past, repeat_oldest};
use networks::Scaling;
use rand::RngExt;

/// Arrays over the rows of an iteration, kept between iterations.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    /// Windows as the discriminator sees them, `[row][frames][features]`.
    pub(super) windows: Vec<f32>,
    pub(super) past: Past,
    pub(super) scores: Vec<f32>,
    pub(super) style_rewards: Vec<f32>,
    pub(super) rewards: Vec<f32>,
    /// What the policy sees.
    pub(super) seen: Seen,
    /// What the critic sees; empty where that is the same.
    pub(super) critic: Seen,
    pub(super) values: Vec<f32>,
    pub(super) last_values: Vec<f32>,
    pub(super) timeout_values: Vec<f32>,
    /// How widely each row was tried.
    pub(super) exploration: Vec<f32>,
    pub(super) advantages: Vec<f32>,
    /// How far values are off what the critic is to say; empty where those are the advantages.
    pub(super) errors: Vec<f32>,
    /// ln π/μ of each row, where advantages are corrected by it.
    pub(super) log_ratios: Vec<f32>,
    pub(super) returns: Vec<f32>,
    pub(super) experts: Vec<f32>,
    pub(super) policy: Vec<f32>,
    /// What is normalised for a moment.
    pub(super) scaled: Vec<f32>,
    pub(super) scaled_policy: Vec<f32>,
    /// Reference motion beside commands that it does not follow, and the same normalised.
    pub(super) mismatched: Vec<f32>,
    pub(super) scaled_mismatched: Vec<f32>,
}

/// Observations of one kind over the rows of an iteration.
#[derive(Debug, Default)]
pub(super) struct Seen {
    /// Normalised, `[row][width]`.
    pub(super) scaled: Vec<f32>,
    /// Mirrored, as the robot would see it, `[row][width]`.
    pub(super) mirrored: Vec<f32>,
    /// The same, normalised.
    pub(super) mirrored_scaled: Vec<f32>,
}

impl Seen {
    /// Mirrors `rows`, or forgets what was mirrored.
    fn mirror(&mut self, rows: &[f32], mirror: Option<&Mirror>, scaling: &Scaling) {
        self.mirrored.clear();
        self.mirrored_scaled.clear();
        if let Some(mirror) = mirror {
            let width = mirror.index.len();
            self.mirrored.resize(rows.len(), 0.0);
            for (row, out) in rows
                .chunks_exact(width)
                .zip(self.mirrored.chunks_exact_mut(width))
            {
                mirror.apply(row, out);
            }
            scaling.apply(&self.mirrored, &mut self.mirrored_scaled);
        }
    }
}

impl Learning {
    /// Style rewards of the batch, by the discriminator as it was when the batch was collected.
    pub(super) fn score(&mut self, batch: &Batch) -> Result<(), Fault> {
        let Scratch {
            windows,
            past,
            scores,
            style_rewards,
            ..
        } = &mut self.scratch;
        let view = self.core.discriminator.view();
        past.of(batch);
        windows.clear();
        let cut = Cut::new(&self.config.discriminator, &self.robot);
        let mut window = Vec::with_capacity(self.core.discriminator.width());
        for row in 0..batch.rows() {
            window.clear();
            past.write(batch, row, &cut, &mut window);
            view.apply(&window, windows);
        }
        scores.clear();
        self.core.discriminator.scores(windows, scores);
        Fault::unless_finite(scores, |row| format!("discriminator score of row {row}"))?;
        style_rewards.clear();
        style_rewards.extend(scores.iter().map(|score| style_reward(*score)));
        Ok(())
    }

    /// Values, advantages and returns.
    pub(super) fn estimate(&mut self, batch: &Batch, sigma: &[f32]) -> Result<(), Fault> {
        let threads = self.config.ppo.threads;
        let Scratch {
            rewards,
            seen,
            critic,
            values,
            last_values,
            timeout_values,
            advantages,
            errors,
            log_ratios,
            exploration,
            returns,
            scaled,
            ..
        } = &mut self.scratch;
        let ppo = &self.core.ppo;
        let evaluate = |rows: &[f32], out: &mut Vec<f32>| {
            inference::outputs(ppo.critic_shape(), ppo.critic(), rows, threads, out);
        };
        seen.scaled.clear();
        let scaling = self.core.observations.scaling();
        scaling.apply(&batch.observations, &mut seen.scaled);
        // What the critic sees: rows, those after the last step, those at which episodes were cut.
        critic.scaled.clear();
        let widths = batch.widths();
        let (scaling, rows, last, cut_off, width) = match &self.core.critic {
            None => {
                let cut_off = &batch.timeout_observations;
                (
                    scaling,
                    &seen.scaled,
                    &batch.last_observations,
                    cut_off,
                    widths.observation,
                )
            }
            Some(normalizer) => {
                let scaling = normalizer.scaling();
                scaling.apply(&batch.critic, &mut critic.scaled);
                let cut_off = &batch.timeout_critic;
                (
                    scaling,
                    &critic.scaled,
                    &batch.last_critic,
                    cut_off,
                    widths.critic,
                )
            }
        };
        values.clear();
        evaluate(rows, values);

        scaled.clear();
        scaling.apply(last, scaled);
        last_values.clear();
        evaluate(scaled, last_values);

        let time_outs: Vec<usize> = batch.time_outs().map(|(_, robot)| robot).collect();
        scaled.clear();
        for robot in &time_outs {
            scaling.apply(&cut_off[robot * width..][..width], scaled);
        }
        let mut cut = Vec::new();
        evaluate(scaled, &mut cut);
        timeout_values.clear();
        timeout_values.resize(batch.robots(), 0.0);
        for (robot, value) in time_outs.iter().zip(cut) {
            timeout_values[*robot] = value;
        }

        let corrected = self.config.ppo.off_policy == OffPolicy::VTrace;
        log_ratios.clear();
        errors.clear();
        if corrected {
            scaled.clear();
            let (shape, actor) = (ppo.actor_shape(), ppo.actor());
            inference::outputs(shape, actor, &seen.scaled, threads, scaled);
            exploration.clear();
            batch.exploration(exploration);
            let tried = (batch.actions.as_slice(), scaled.as_slice());
            vtrace::log_ratios(tried, sigma, exploration, &batch.log_probs, log_ratios);
            errors.resize(batch.rows(), 0.0);
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
            let from = Returns {
                rewards: &rewards[rows.clone()],
                values: &values[rows.clone()],
                ends: &batch.ends[rows.clone()],
                last_values: &last_values[robots.clone()],
                timeout_values: &timeout_values[robots],
            };
            let (gamma, lambda) = (self.config.ppo.gamma, self.config.ppo.lambda);
            let out = &mut advantages[rows.clone()];
            if corrected {
                let ratios = &log_ratios[rows.clone()];
                let errors = &mut errors[rows];
                vtrace::advantages(*segment, from, ratios, (gamma, lambda), out, errors);
            } else {
                gae::advantages(*segment, from, gamma, lambda, out);
            }
        }
        let errors = if corrected { &*errors } else { &*advantages };
        returns.clear();
        returns.extend(errors.iter().zip(&*values).map(|(a, v)| a + v));
        Fault::unless_finite(returns, |row| format!("return of row {row}"))
    }

    /// 1 − Var(R − V)/Var(R); 0 if the returns do not vary.
    pub(super) fn explained_variance(&self) -> f64 {
        let variance = |numbers: &[f32]| moments(numbers)[1].powi(2);
        let returns = variance(&self.scratch.returns);
        if returns == 0.0 {
            return 0.0;
        }
        let errors = match self.scratch.errors.as_slice() {
            [] => self.scratch.advantages.as_slice(),
            errors => errors,
        };
        1.0 - variance(errors) / returns
    }

    pub(super) fn improve(&mut self, batch: &Batch, sigma: &[f32]) -> Result<PpoFigures, Fault> {
        let scratch = &mut self.scratch;
        let mirrors = self.config.ppo.mirrors();
        let mirror = Some(&self.robot.observation_mirror).filter(|_| mirrors);
        let scaling = self.core.observations.scaling();
        scratch.seen.mirror(&batch.observations, mirror, &scaling);
        if let Some(normalizer) = &self.core.critic {
            let mirror = self.robot.critic_mirror.as_ref().filter(|_| mirrors);
            let scaling = normalizer.scaling();
            scratch.critic.mirror(&batch.critic, mirror, &scaling);
        }
        scratch.exploration.clear();
        batch.exploration(&mut scratch.exploration);
        let rows = Rows {
            observations: &scratch.seen.scaled,
            mirrored: &scratch.seen.mirrored_scaled,
            critic: &scratch.critic.scaled,
            mirrored_critic: &scratch.critic.mirrored_scaled,
            mirrored_share: self.config.ppo.mirrored_share_at(self.core.samples),
            kl_target: self.config.ppo.kl_target_at(self.core.samples),
            critic_alone: self.config.ppo.critic_alone_at(self.core.samples),
            actions: &batch.actions,
            means: &batch.means,
            log_probs: &batch.log_probs,
            widths: &scratch.exploration,
            advantages: &scratch.advantages,
            returns: &scratch.returns,
        };
        self.core.ppo.update(&rows, sigma, &mut self.core.generator)
    }

    /// Trains the discriminator on experts, windows of this batch and remembered ones.
    pub(super) fn discriminate(
        &mut self,
        batch: &Batch,
        experts: &mut dyn FnMut(&mut [f32]),
    ) -> Result<discrimination::Figures, Fault> {
        let config = &self.config.discriminator;
        let Scratch {
            experts: expert,
            past,
            policy,
            scaled,
            scaled_policy,
            mismatched,
            scaled_mismatched,
            ..
        } = &mut self.scratch;
        let core = &mut self.core;
        let cut = Cut::new(config, &self.robot);
        let count = config.steps * config.batch;
        expert.clear();
        let width = core.discriminator.width();
        expert.resize(count * width, 0.0);
        experts(expert);
        Fault::unless_finite(expert, |i| format!("expert window {}", i / width))?;
        if (config.frames, config.spacing) != (2, 1) {
            for window in expert.chunks_exact_mut(width) {
                let row = core.generator.random_range(0..batch.rows());
                let states = &mut window[..cut.states()];
                repeat_oldest(states, past.real(row, &cut), cut.features);
            }
        }
        policy.clear();
        for i in 0..count {
            let remembered = crate::minibatch::is_mirrored(i, REPLAY_SHARE);
            if remembered && !self.replay.is_empty() {
                policy.extend_from_slice(self.replay.draw(&mut core.generator));
            } else {
                let row = core.generator.random_range(0..batch.rows());
                past.write(batch, row, &cut, policy);
            }
        }
        core.discriminator.observe(expert);
        core.discriminator.observe(policy);
        let view = core.discriminator.view();
        scaled.clear();
        view.apply(expert, scaled);
        scaled_policy.clear();
        view.apply(policy, scaled_policy);
        scaled_mismatched.clear();
        if let (true, Some(blur)) = (config.mismatched > 0.0, config.command_blur) {
            mismatched.clear();
            discrimination::mismatch(expert, policy, width, blur, mismatched);
            view.apply(mismatched, scaled_mismatched);
        }
        core.discriminator
            .update(scaled, scaled_policy, scaled_mismatched)
    }

    /// What the next iteration is to know of this batch. Nothing fails from here on.
    pub(super) fn take_in(&mut self, batch: &Batch) {
        let core = &mut self.core;
        core.observations.update(&batch.observations);
        // A mirrored robot's observations are as likely: statistics of both keep the two sides alike.
        core.observations.update(&self.scratch.seen.mirrored);
        if let Some(normalizer) = &mut core.critic {
            normalizer.update(&batch.critic);
            normalizer.update(&self.scratch.critic.mirrored);
        }
        let rows = batch.rows();
        let cut = Cut::new(&self.config.discriminator, &self.robot);
        let mut window = Vec::with_capacity(core.discriminator.width());
        for _ in 0..self.config.discriminator.replay_insert.min(rows) {
            let row = core.generator.random_range(0..rows);
            window.clear();
            self.scratch.past.write(batch, row, &cut, &mut window);
            self.replay.insert(&window);
        }
        let waited = self.config.ppo.critic_alone_at(core.samples);
        core.iteration += 1;
        core.samples += rows as u64;
        if waited && !self.config.ppo.critic_alone_at(core.samples) {
            core.ppo.begin_gently();
        }
    }
}
