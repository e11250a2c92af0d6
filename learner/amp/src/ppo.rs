//! One PPO update: several epochs of clipped steps on the rows of one iteration (Schulman et al. 2017).
//!
//! Rows of a minibatch are divided among threads, each with its own copy of the networks; gradients are added in the
//! order of threads, clipped as a whole, and taken by one optimizer. Actor, critic and ln σ lie in one flat vector.

mod part;
mod step;

use crate::LearningError;
use crate::config::{
    ExplorationKind, LAST_GAIN, LEARNED_SIGMA, LEAST_RATE, LearningConfig, PpoConfig, RateSchedule,
};
use crate::error::Fault;
use crate::minibatch::{Order, split};
use crate::report::moments;
use crate::robot::{Mirror, Robot};
use crate::{exploration, surrogate};
use networks::{Activation, Adam, AdamConfig, NetworkError, Shape, orthogonal, values};
use part::Minibatch;
use rand::Rng;
use std::ops::Range;

/// Rows of one iteration, all of the same count. Observations are normalised.
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// `[row][observation]`
    pub observations: &'a [f32],
    /// The same rows mirrored, `[row][observation]`; read if a share of rows is mirrored.
    pub mirrored: &'a [f32],
    /// What the critic sees, `[row][critic]`; empty where that is what the policy sees.
    pub critic: &'a [f32],
    /// The same rows mirrored, `[row][critic]`; read if a share of rows is mirrored.
    pub mirrored_critic: &'a [f32],
    /// Share of each minibatch that is taken from them.
    pub mirrored_share: f32,
    /// Mean KL divergence that the rate is steered to.
    pub kl_target: f32,
    /// Whether actor and ln σ stay as they are.
    pub critic_alone: bool,
    /// `[row][joint]`
    pub actions: &'a [f32],
    /// Mean actions of the policy that acted, `[row][joint]`.
    pub means: &'a [f32],
    /// Log-densities under it, `[row]`.
    pub log_probs: &'a [f32],
    /// How widely each row was tried, in parts of σ, `[row]`; empty where all were alike.
    pub widths: &'a [f32],
    /// Not normalised, `[row]`.
    pub advantages: &'a [f32],
    /// Targets of the critic, `[row]`.
    pub returns: &'a [f32],
}

/// Figures of one update.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PpoFigures {
    /// Mean surrogate loss.
    pub surrogate: f64,
    /// Mean value loss.
    pub value_loss: f64,
    /// Mean KL(old ‖ new) of the last epoch.
    pub kl: f64,
    /// Share of ratios outside the clip range.
    pub clip_fraction: f64,
    /// Mean global norm of the gradient before clipping.
    pub gradient_norm: f64,
    /// Entropy after the update.
    pub entropy: f64,
    /// Mean symmetry loss; none if no row was a lesson in it.
    pub asymmetry: Option<f64>,
}

/// Actor, critic, exploration and their optimizer.
#[derive(Clone, Debug)]
pub struct Ppo {
    config: PpoConfig,
    actor: Shape,
    critic: Shape,
    mirror: Mirror,
    /// Whether the critic sees rows of its own.
    own_critic: bool,
    /// ln σ is within these; none if σ is not learned.
    log_sigma_limits: Option<Range<f32>>,
    /// Actor, critic, ln σ.
    weights: Vec<f32>,
    adam: Adam,
    rate: f32,
    order: Order,
}

impl Ppo {
    /// First weights: orthogonal with gain √2 in hidden layers, a small last gain for the actor, 1 for the critic.
    pub fn new(config: &LearningConfig, robot: &Robot, rng: &mut (impl Rng + ?Sized)) -> Self {
        let hidden_gain = std::f32::consts::SQRT_2;
        let widths = robot.widths();
        let layers = &config.policy;
        let actor = Shape::new(
            widths.observation,
            &layers.hidden,
            widths.action,
            Activation::Elu,
        );
        let critic = Shape::new(
            robot.critic_width(),
            &layers.critic_hidden,
            1,
            Activation::Elu,
        );
        let mut weights = orthogonal(&actor, hidden_gain, LAST_GAIN, rng);
        weights.extend(orthogonal(&critic, hidden_gain, 1.0, rng));
        weights.extend(exploration::initial_log_sigma(
            &config.exploration,
            &robot.joints,
        ));
        let limits = LEARNED_SIGMA[0].ln()..LEARNED_SIGMA[1].ln();
        Self {
            adam: Adam::new(weights.len(), AdamConfig::default(), vec![]),
            rate: config.ppo.learning_rate,
            config: config.ppo.clone(),
            log_sigma_limits: (config.exploration.kind == ExplorationKind::Learned)
                .then_some(limits),
            order: Order::default(),
            actor,
            critic,
            mirror: robot.action_mirror.clone(),
            own_critic: robot.critic_mirror.is_some(),
            weights,
        }
    }

    /// Sizes of the actor.
    pub fn actor_shape(&self) -> &Shape {
        &self.actor
    }

    /// Sizes of the critic.
    pub fn critic_shape(&self) -> &Shape {
        &self.critic
    }

    /// The actor's weights.
    pub fn actor(&self) -> &[f32] {
        &self.weights[..self.actor.len()]
    }

    /// Begins with a trained actor, and its critic if that is known.
    ///
    /// # Errors
    /// If one is of another size, or a weight of the critic is not finite.
    pub(crate) fn begin_with(
        &mut self,
        actor: &[f32],
        critic: Option<&[f32]>,
    ) -> Result<(), LearningError> {
        NetworkError::check_length("weights of the actor", self.actor.len(), actor.len())?;
        self.weights[..actor.len()].copy_from_slice(actor);
        let Some(critic) = critic else {
            return Ok(());
        };
        NetworkError::check_length("weights of the critic", self.critic.len(), critic.len())?;
        if let Some(index) = networks::first_not_finite(critic) {
            return Err(NetworkError::NotFinite {
                what: "weights of the critic".to_owned(),
                index,
                value: critic[index],
            }
            .into());
        }
        self.weights[actor.len()..][..critic.len()].copy_from_slice(critic);
        self.begin_gently();
        Ok(())
    }

    /// Before the actor's first step: the lowest rate unless that is fixed, and an optimizer that remembers nothing. Adam's memory of squares is
    /// longer than that of gradients, so with the steps that the critic took alone counted in, the actor's first ones
    /// would be several times the rate. A trained policy went 1.8 to 180 nats in one iteration.
    pub(crate) fn begin_gently(&mut self) {
        // One that does not move would stay there for good.
        if self.config.schedule != RateSchedule::Fixed {
            self.rate = LEAST_RATE;
        }
        self.adam = Adam::new(self.weights.len(), AdamConfig::default(), vec![]);
    }

    /// The critic's weights.
    pub fn critic(&self) -> &[f32] {
        &self.weights[self.actor.len()..][..self.critic.len()]
    }

    /// ln σ per action; means something if σ is learned.
    pub fn log_sigma(&self) -> &[f32] {
        &self.weights[self.actor.len() + self.critic.len()..]
    }

    /// Adam's rate.
    pub fn rate(&self) -> f32 {
        self.rate
    }

    /// All weights, the optimizer and its rate, to be written from a saved state.
    pub(crate) fn state_mut(&mut self) -> (&mut [f32], &mut Adam, &mut f32) {
        (&mut self.weights, &mut self.adam, &mut self.rate)
    }

    /// The optimizer.
    pub(crate) fn adam(&self) -> &Adam {
        &self.adam
    }

    /// Improves actor and critic; `sigma` is the exploration width that the rows were collected with.
    ///
    /// # Errors
    /// If a loss, a gradient or a weight is not finite. The weights are then spoilt: the caller holds the good ones.
    pub fn update(
        &mut self,
        rows: &Rows<'_>,
        sigma: &[f32],
        rng: &mut (impl Rng + ?Sized),
    ) -> Result<PpoFigures, Fault> {
        let count = rows.advantages.len();
        let mut order = std::mem::take(&mut self.order);
        let (shift, scale) = normalization(rows.advantages.iter().copied());
        let mut figures = PpoFigures::default();
        let mut steps = 0;
        let mut asymmetry = (0.0, 0);
        for epoch in 0..self.config.epochs {
            let last_epoch = epoch + 1 == self.config.epochs;
            let indices = order.shuffle(count, rng);
            let minibatches = split(indices, self.config.minibatch);
            let mut kl = (0.0, 0);
            for indices in minibatches {
                let minibatch = Minibatch {
                    rows,
                    indices,
                    old_sigma: sigma,
                    shift,
                    scale,
                };
                let (sums, norm) = self.step(&minibatch, sigma)?;
                figures.surrogate += sums.surrogate;
                figures.value_loss += sums.value_loss;
                figures.clip_fraction += sums.clipped as f64 / indices.len() as f64;
                figures.gradient_norm += f64::from(norm);
                asymmetry = (asymmetry.0 + sums.asymmetry, asymmetry.1 + sums.lessons);
                kl = (kl.0 + sums.kl, kl.1 + sums.kl_rows);
                steps += 1;
            }
            if last_epoch {
                figures.kl = kl.0 / kl.1.max(1) as f64;
            }
        }
        self.order = order;
        self.check_weights()?;
        if self.config.schedule == RateSchedule::PerIteration && !rows.critic_alone {
            self.follow(figures.kl, rows.kl_target);
        }
        for figure in [
            &mut figures.surrogate,
            &mut figures.value_loss,
            &mut figures.clip_fraction,
            &mut figures.gradient_norm,
        ] {
            *figure /= f64::from(steps.max(1));
        }
        figures.asymmetry = (asymmetry.1 > 0).then(|| asymmetry.0 / f64::from(steps));
        figures.entropy = f64::from(values(surrogate::entropy(self.log_sigma_tensor(sigma)))[0]);
        Ok(figures)
    }

    /// Tensors by name, sizes and place in the flat vector.
    pub(crate) fn tensors(&self) -> Vec<(String, Vec<usize>, Range<usize>)> {
        let parts = [
            ("actor", &self.actor, 0),
            ("critic", &self.critic, self.actor.len()),
        ];
        let mut tensors: Vec<_> = parts
            .into_iter()
            .flat_map(|(part, shape, start)| {
                shape.tensors().map(move |(name, sizes, place)| {
                    (
                        format!("{part}.{name}"),
                        sizes,
                        start + place.start..start + place.end,
                    )
                })
            })
            .collect();
        let (start, joints) = (self.actor.len() + self.critic.len(), self.actor.outputs);
        tensors.push(("log_sigma".to_owned(), vec![joints], start..start + joints));
        tensors
    }

    /// Name of the tensor that a number of the flat vector belongs to.
    fn name(&self, index: usize) -> String {
        let tensors = self.tensors();
        let found = tensors
            .into_iter()
            .find(|(_, _, place)| place.contains(&index));
        found.map_or_else(String::new, |(name, ..)| name)
    }
}

/// Shift and scale that give numbers mean 0 and deviation 1.
fn normalization(numbers: impl Iterator<Item = f32>) -> (f32, f32) {
    let [mean, deviation, ..] = moments(&numbers.collect::<Vec<_>>());
    (mean as f32, (1.0 / (deviation + 1e-8)) as f32)
}

#[cfg(test)]
mod tests;
