//! The judge of style: a discriminator, what it sees, and how it is trained (Eq. 3–6).
//!
//! It sees normalised transitions; the gradient penalty is taken where it looks, that is with respect to normalised
//! expert windows.

use crate::config::{DECAY, DiscriminatorConfig, FEATURE_CLIP, HEAD_DECAY, LossKind, floor};
use crate::error::Fault;
use crate::inference::{self, CHUNK};
use crate::robot::Robot;
use crate::{COMMAND, losses};
use networks::{
    Activation, Adam, AdamConfig, Decay, Mlp, Normalizer, Shape, orthogonal, shards, tensor,
    tracked_device, values,
};
use rand::Rng;
use std::ops::{AddAssign, Range};

mod mismatch;
mod view;

pub(crate) use mismatch::mismatch;
pub use view::View;

/// Figures of one update, means over its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Mean D of experts.
    pub expert_score: f64,
    /// Mean D of the policy.
    pub policy_score: f64,
    /// Mean D of reference motion beside commands that it does not follow; none if it is not shown.
    pub mismatch_score: Option<f64>,
    /// L_GP (Eq. 5).
    pub gradient_penalty: f64,
    /// L_AMP (Eq. 6).
    pub loss: f64,
}

/// The discriminator, its normalizer and its optimizer.
#[derive(Clone, Debug)]
pub struct Discriminator {
    config: DiscriminatorConfig,
    threads: usize,
    shape: Shape,
    weights: Vec<f32>,
    adam: Adam,
    normalizer: Normalizer,
    /// Numbers of a state.
    features: usize,
    /// Which features a command is about; 0 where none are and none are asked for.
    velocities: [usize; COMMAND],
}

/// Sums over the rows of one step, or of a shard of it.
#[derive(Default)]
struct Sums {
    gradient: Vec<f32>,
    expert_score: f64,
    policy_score: f64,
    mismatch_score: f64,
    penalty: f64,
    loss: f64,
}

impl AddAssign for Sums {
    fn add_assign(&mut self, part: Self) {
        shards::add(&mut self.gradient, &part.gradient);
        self.expert_score += part.expert_score;
        self.policy_score += part.policy_score;
        self.mismatch_score += part.mismatch_score;
        self.penalty += part.penalty;
        self.loss += part.loss;
    }
}

impl Discriminator {
    /// First weights: orthogonal with gain √2 in hidden layers, 1 in the last.
    pub fn new(
        config: &DiscriminatorConfig,
        robot: &Robot,
        threads: usize,
        rng: &mut (impl Rng + ?Sized),
    ) -> Self {
        let shape = Shape::new(
            config.width(robot.features.len()),
            &config.hidden,
            1,
            Activation::Relu,
        );
        let weights = orthogonal(&shape, std::f32::consts::SQRT_2, 1.0, rng);
        let decay = vec![
            Decay {
                part: 0..shape.head(),
                factor: DECAY,
            },
            Decay {
                part: shape.head()..shape.len(),
                factor: HEAD_DECAY,
            },
        ];
        let floors = robot.features.iter().map(floor).collect();
        Self {
            adam: Adam::new(shape.len(), AdamConfig::default(), decay),
            normalizer: Normalizer::new(floors, FEATURE_CLIP),
            config: config.clone(),
            threads,
            shape,
            weights,
            features: robot.features.len(),
            velocities: robot.velocities.unwrap_or_default(),
        }
    }

    /// Numbers of a window: `[frames][features]`, then the command if it sees that.
    pub fn width(&self) -> usize {
        self.shape.inputs
    }

    /// D of windows that are normalised already, `[row][width]`; appended to `scores`.
    pub fn scores(&self, transitions: &[f32], scores: &mut Vec<f32>) {
        let before = scores.len();
        inference::outputs(
            &self.shape,
            &self.weights,
            transitions,
            self.threads,
            scores,
        );
        if self.config.loss == LossKind::Logistic {
            for score in &mut scores[before..] {
                *score = losses::score_of_logit(*score);
            }
        }
    }

    /// The mapping of windows as of now: that of features, for every state.
    pub fn view(&self) -> View {
        View::new(&self.config, self.velocities, self.normalizer.scaling())
    }

    /// Takes windows `[row][width]`, not normalised, into the statistics: every state of each.
    pub fn observe(&mut self, transitions: &[f32]) {
        let states = self.config.frames * self.features;
        if states == self.width() {
            self.normalizer.update(transitions);
            return;
        }
        let windows = transitions.chunks_exact(self.width());
        let alone: Vec<f32> = windows
            .flat_map(|window| &window[..states])
            .copied()
            .collect();
        self.normalizer.update(&alone);
    }

    /// Trains on as many steps as `experts` and `policy` have batches; both normalised, `[row][width]`. So is what is wrong
    /// besides, `mismatched`: as many rows, or none.
    ///
    /// # Errors
    /// If a loss, a gradient or a weight is not finite. The weights are then spoilt: the caller holds the good ones.
    pub fn update(
        &mut self,
        experts: &[f32],
        policy: &[f32],
        mismatched: &[f32],
    ) -> Result<Figures, Fault> {
        let batch = self.config.batch * self.width();
        let mut figures = Figures::default();
        let steps = experts.len() / batch;
        let rows = experts.chunks_exact(batch).zip(policy.chunks_exact(batch));
        for (index, (experts, policy)) in rows.enumerate() {
            let mismatched = mismatched.chunks_exact(batch).nth(index);
            let step = self.step(experts, policy, mismatched.unwrap_or(&[]))?;
            figures.expert_score += step.expert_score / steps as f64;
            figures.policy_score += step.policy_score / steps as f64;
            if let Some(score) = step.mismatch_score {
                *figures.mismatch_score.get_or_insert(0.0) += score / steps as f64;
            }
            figures.gradient_penalty += step.gradient_penalty / steps as f64;
            figures.loss += step.loss / steps as f64;
        }
        self.check_weights()?;
        Ok(figures)
    }

    /// One step of the optimizer on as many experts as policy transitions.
    fn step(
        &mut self,
        experts: &[f32],
        policy: &[f32],
        mismatched: &[f32],
    ) -> Result<Figures, Fault> {
        let count = experts.len() / self.width();
        let threads = self.threads.min(count);
        let total = shards::total(count, threads, |part| {
            self.differentiate(experts, policy, mismatched, part)
        });
        self.check(&total)?;
        self.adam.step(
            &mut self.weights,
            &total.gradient,
            self.config.learning_rate,
        );
        Ok(Figures {
            expert_score: total.expert_score / count as f64,
            policy_score: total.policy_score / count as f64,
            mismatch_score: (!mismatched.is_empty()).then(|| total.mismatch_score / count as f64),
            gradient_penalty: total.penalty,
            loss: total.loss,
        })
    }

    /// Refuses what would spoil the weights.
    fn check(&self, total: &Sums) -> Result<(), Fault> {
        if !total.loss.is_finite() {
            // A broken weight breaks every loss after it: it is the cause to name.
            self.check_weights()?;
            return Err(Fault::new("discriminator loss", total.loss));
        }
        Fault::unless_finite(&total.gradient, |i| format!("gradient of {}", self.name(i)))
    }

    fn check_weights(&self) -> Result<(), Fault> {
        Fault::unless_finite(&self.weights, |i| self.name(i))
    }

    /// Gradient and figures of a part of a step's rows.
    fn differentiate(
        &self,
        experts: &[f32],
        policy: &[f32],
        mismatched: &[f32],
        part: Range<usize>,
    ) -> Sums {
        let device = tracked_device();
        let network = Mlp::new(&self.shape, &self.weights, &device).expect("weights of this shape");
        let count = experts.len() / self.width();
        let mut sums = Sums {
            gradient: vec![0.0; self.weights.len()],
            ..Sums::default()
        };
        let width = self.width();
        let logistic = self.config.loss == LossKind::Logistic;
        let total = |outputs: Vec<f32>| -> f64 {
            let score = |output: &f32| match logistic {
                true => losses::score_of_logit(*output),
                false => *output,
            };
            outputs.iter().map(|output| f64::from(score(output))).sum()
        };
        for piece in shards::pieces(part, CHUNK) {
            let numbers = piece.start * width..piece.end * width;
            let rows = |from: &[f32]| tensor(from[numbers.clone()].to_vec(), width, &device);
            let expert = network.forward_all(rows(experts));
            let policy_scores = network.forward(rows(policy));
            // Of Eq. 5's o, the states: how far off the command motion may be, the blur says.
            let gradient = network.input_gradient(&expert.hidden);
            let along_states = gradient.narrow(1, 0, self.config.frames * self.features);
            let penalty = losses::gradient_penalty(along_states, count);
            let wrong = |scores, count| match self.config.loss {
                LossKind::LeastSquares => losses::policy_loss(scores, count),
                LossKind::Logistic => losses::policy_logistic(scores, count),
            };
            let of_experts = match self.config.loss {
                LossKind::LeastSquares => losses::expert_loss(expert.output.clone(), count),
                LossKind::Logistic => losses::expert_logistic(expert.output.clone(), count),
            };
            let mut of_policy = wrong(policy_scores.clone(), count);
            if !mismatched.is_empty() {
                let scores = network.forward(rows(mismatched));
                of_policy = of_policy + wrong(scores.clone(), count) * self.config.mismatched;
                sums.mismatch_score += total(values(scores));
            }
            // The slope of a score where nothing is known is half that of its logit.
            let penalty = if logistic { penalty * 0.25 } else { penalty };
            let loss = losses::amp_loss(
                of_experts,
                of_policy,
                penalty.clone(),
                self.config.gradient_penalty,
            );
            sums.loss += f64::from(values(loss.clone())[0]);
            sums.penalty += f64::from(values(penalty)[0]);
            sums.expert_score += total(values(expert.output));
            sums.policy_score += total(values(policy_scores));
            drop(expert.hidden);
            network.add_gradients(&mut loss.backward(), &mut sums.gradient);
        }
        sums
    }

    /// Weights, optimizer and normalizer, to be written from a saved state.
    pub(crate) fn state_mut(&mut self) -> (&mut [f32], &mut Adam, &mut Normalizer) {
        (&mut self.weights, &mut self.adam, &mut self.normalizer)
    }

    /// Weights, optimizer and normalizer.
    pub(crate) fn state(&self) -> (&[f32], &Adam, &Normalizer) {
        (&self.weights, &self.adam, &self.normalizer)
    }

    /// Tensors by name, sizes and place in the flat vector.
    pub(crate) fn tensors(&self) -> Vec<(String, Vec<usize>, Range<usize>)> {
        self.shape
            .tensors()
            .map(|(name, sizes, place)| (format!("discriminator.{name}"), sizes, place))
            .collect()
    }

    fn name(&self, index: usize) -> String {
        let tensors = self.tensors();
        let found = tensors
            .into_iter()
            .find(|(_, _, place)| place.contains(&index));
        found.map_or_else(String::new, |(name, ..)| name)
    }
}

#[cfg(test)]
mod tests;
