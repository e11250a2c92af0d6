//! The learner's life: networks, statistics, memory and generators, and one iteration after another.

mod stages;

use crate::batch::Batch;
use crate::config::{LearningConfig, OBSERVATION_FLOOR, PpoConfig};
use crate::discrimination::{Discriminator, Figures};
use crate::error::Fault;
use crate::ppo::Ppo;
use crate::replay::Replay;
use crate::report::{IterationReport, Seconds, moments};
use crate::robot::Robot;
use crate::style::style_reward;
use crate::{LearningError, blend, exploration, spread};
use ampco::{Granularity, Rule};
use networks::{Normalizer, snapshot};
use rand::SeedableRng;
use rand_pcg::Pcg64;
use stages::Scratch;
use vocabulary::{Counts, RUNNING};

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
    /// Of what the critic sees; none where it sees what the policy does.
    pub(crate) critic: Option<Normalizer>,
    pub(crate) generator: Pcg64,
    pub(crate) iteration: u64,
    pub(crate) samples: u64,
}

impl Learning {
    /// Before the first iteration. Everything random follows from `seed`.
    ///
    /// # Errors
    /// If a value of the configuration or a table of the robot cannot be used.
    pub fn new(config: LearningConfig, robot: Robot, seed: u64) -> Result<Self, LearningError> {
        config.validate()?;
        robot.check(&config.discriminator)?;
        let mut generator = Pcg64::seed_from_u64(seed);
        let ppo = Ppo::new(&config, &robot, &mut generator);
        let discriminator = Discriminator::new(
            &config.discriminator,
            &robot,
            config.ppo.threads,
            &mut generator,
        );
        let normalizer = |width: usize| {
            let floors = vec![OBSERVATION_FLOOR; width];
            Normalizer::new(floors, config.policy.observation_clip)
        };
        let widths = robot.widths();
        Ok(Self {
            core: Core {
                ppo,
                discriminator,
                observations: normalizer(widths.observation),
                critic: robot
                    .critic_mirror
                    .as_ref()
                    .map(|_| normalizer(widths.critic)),
                generator,
                iteration: 0,
                samples: 0,
            },
            replay: Replay::new(
                config.discriminator.replay_capacity,
                config.discriminator.width(widths.features),
            ),
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

    /// Takes over what the configuration says otherwise than `before`, that of the saved state which was loaded: the state
    /// has a rate of its own, which follows the KL divergence, and would go on with that. A rate or schedule that was
    /// changed begins with the rate that is now given.
    pub fn retune(&mut self, before: &PpoConfig) {
        let now = &self.config.ppo;
        let (_, _, rate) = self.core.ppo.state_mut();
        if (now.learning_rate, now.schedule) != (before.learning_rate, before.schedule) {
            *rate = now.learning_rate;
        }
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

    /// rˢ (Eq. 7) of windows as of now, `[row][frames][features]` and the command if the discriminator sees that; appended to
    /// `rewards`.
    pub fn style_rewards(&mut self, windows: &[f32], rewards: &mut Vec<f32>) {
        let Scratch { scaled, scores, .. } = &mut self.scratch;
        scaled.clear();
        scores.clear();
        self.core.discriminator.view().apply(windows, scaled);
        self.core.discriminator.scores(scaled, scores);
        rewards.extend(scores.iter().map(|score| style_reward(*score)));
    }

    /// Trains the discriminator alone, on reference motion against other motion, as many windows of each as its steps take;
    /// both as [`Self::style_rewards`] takes them. What it has seen of both counts into its statistics.
    ///
    /// # Errors
    /// If something became NaN or infinite.
    pub fn teach_judge(
        &mut self,
        experts: &[f32],
        others: &[f32],
    ) -> Result<Figures, LearningError> {
        let iteration = self.core.iteration;
        let discriminator = &mut self.core.discriminator;
        discriminator.observe(experts);
        discriminator.observe(others);
        let view = discriminator.view();
        let (mut seen, mut seen_others) = (Vec::new(), Vec::new());
        view.apply(experts, &mut seen);
        view.apply(others, &mut seen_others);
        discriminator
            .update(&seen, &seen_others, &[])
            .map_err(|Fault { what, value }| LearningError::NotFinite {
                what,
                value,
                iteration,
            })
    }

    /// One iteration: score, blend, estimate advantages, improve the policy, train the discriminator.
    ///
    /// `experts` fills its slice with windows of reference motion, `[n][frames][features]`, each with its command if the
    /// discriminator sees that; it is called once. Statistics of observations stay as the actors had them and take the
    /// batch in at the end, for the next policy.
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
        batch.check(&self.robot.widths())?;
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
        let moments_known = (self.clock)();
        let style_weight = blend::blend(
            rule,
            granularity,
            &self.scratch.style_rewards,
            &batch.task_rewards,
            (style[0] as f32, task[0] as f32),
            &mut self.scratch.rewards,
        );
        let weighting = (self.clock)() - moments_known;
        let reward_mean = moments(&self.scratch.rewards)[0];
        let scored = (self.clock)();
        self.estimate(batch, &sigma)?;
        let explained_variance = self.explained_variance();
        let estimated = (self.clock)();
        let ppo = self.improve(batch, &sigma)?;
        let improved = (self.clock)();
        let discriminator = self.discriminate(batch, experts)?;
        let discriminated = (self.clock)();
        self.take_in(batch);
        Ok(IterationReport {
            iteration: self.core.iteration,
            samples: self.core.samples,
            rows: batch.rows() as u64,
            style_mean: style[0],
            style_std: style[1],
            style_std_robots: spread::deviation_at_a_command(
                &batch.means_of_robots(&self.scratch.style_rewards),
                &batch.commands_of_robots(&self.robot.command),
            ),
            style_min: style[2],
            style_max: style[3],
            task_mean: task[0],
            task_std: task[1],
            reward_mean,
            style_weight,
            episode_length: episode_length(batch),
            terminations: Counts::of(&batch.ends),
            rmse: moments(&batch.tracking_errors)[0].max(0.0).sqrt(),
            energy_j: 1000.0 * moments(&batch.energies)[0],
            surrogate: ppo.surrogate,
            value_loss: ppo.value_loss,
            entropy: ppo.entropy,
            kl: ppo.kl,
            clip_fraction: ppo.clip_fraction,
            asymmetry: ppo.asymmetry,
            learning_rate: f64::from(self.core.ppo.rate()),
            gradient_norm: ppo.gradient_norm,
            sigma: moments(&sigma)[0],
            explained_variance,
            expert_score: discriminator.expert_score,
            policy_score: discriminator.policy_score,
            mismatch_score: discriminator.mismatch_score,
            gradient_penalty: discriminator.gradient_penalty,
            discriminator_loss: discriminator.loss,
            seconds: Seconds {
                score: scored - started,
                weighting,
                advantage: estimated - scored,
                ppo: improved - estimated,
                discriminator: discriminated - improved,
                total: (self.clock)() - started,
            },
        })
    }
}

/// Mean length in steps of the episodes that ended in a batch.
fn episode_length(batch: &Batch) -> Option<f64> {
    let rows = batch.ends.iter().zip(&batch.episode_steps);
    let ended = rows.filter(|(end, _)| **end != RUNNING);
    let (steps, count) = ended.fold((0.0, 0.0), |(steps, count), (_, more)| {
        (steps + f64::from(*more), count + 1.0)
    });
    (count > 0.0).then(|| steps / count)
}

#[cfg(test)]
mod tests;
