//! One thread's share of a minibatch: rows copied together, losses, gradients.

use super::{Ppo, Rows};
use crate::inference::CHUNK;
use crate::minibatch::is_mirrored;
use crate::surrogate;
use networks::{Mlp, shards, tensor, tracked_device, values};
use std::ops::{AddAssign, Range};

/// Sums over the rows of one minibatch, or of a shard of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Sums {
    pub(super) gradient: Vec<f32>,
    pub(super) surrogate: f64,
    pub(super) value_loss: f64,
    pub(super) kl: f64,
    pub(super) kl_rows: usize,
    pub(super) clipped: usize,
    pub(super) asymmetry: f64,
    /// Rows that `asymmetry` is over.
    pub(super) lessons: usize,
}

impl AddAssign for Sums {
    fn add_assign(&mut self, part: Self) {
        shards::add(&mut self.gradient, &part.gradient);
        self.surrogate += part.surrogate;
        self.value_loss += part.value_loss;
        self.kl += part.kl;
        self.kl_rows += part.kl_rows;
        self.clipped += part.clipped;
        self.asymmetry += part.asymmetry;
        self.lessons += part.lessons;
    }
}

/// What all shards of a minibatch have in common.
pub(super) struct Minibatch<'a> {
    pub(super) rows: &'a Rows<'a>,
    pub(super) indices: &'a [usize],
    pub(super) old_sigma: &'a [f32],
    /// Advantages become (A − shift)·scale.
    pub(super) shift: f32,
    pub(super) scale: f32,
}

impl Ppo {
    /// Gradient and figures of a part of a minibatch.
    pub(super) fn differentiate(
        &self,
        minibatch: &Minibatch<'_>,
        part: Range<usize>,
        sigma: &[f32],
    ) -> Sums {
        let device = tracked_device();
        let network =
            |shape, weights| Mlp::new(shape, weights, &device).expect("weights of this shape");
        let actor = network(&self.actor, self.actor());
        let critic = network(&self.critic, self.critic());
        let log_sigma = self.log_sigma_tensor(sigma);
        let new_sigma: Vec<f32> = values(log_sigma.clone())
            .iter()
            .map(|log| log.exp())
            .collect();
        let count = minibatch.indices.len();
        let joints = self.actor.outputs;
        let mut sums = Sums {
            gradient: vec![0.0; self.weights.len()],
            ..Sums::default()
        };
        let (actor_gradient, rest) = sums.gradient.split_at_mut(self.actor.len());
        let (critic_gradient, sigma_gradient) = rest.split_at_mut(self.critic.len());
        for piece in shards::pieces(part, CHUNK) {
            let chunk = self.gather(minibatch, piece);
            let rows = |numbers: &[f32], columns| tensor(numbers.to_vec(), columns, &device);
            let observations = tensor(chunk.observations, self.actor.inputs, &device);

            let means = actor.forward(observations.clone());
            let actions = rows(&chunk.actions, joints);
            let density = if chunk.widths.is_empty() {
                surrogate::log_density(actions.clone(), means.clone(), log_sigma.clone())
            } else {
                surrogate::log_density_within(
                    actions.clone(),
                    means.clone(),
                    log_sigma.clone(),
                    rows(&chunk.widths, 1),
                )
            };
            let loss = surrogate::clipped_surrogate(
                density.clone(),
                rows(&chunk.log_probs, 1),
                tensor(chunk.advantages, 1, &device),
                self.config.clip,
                count,
            );
            sums.surrogate += f64::from(values(loss.clone())[0]);
            sums.lessons += chunk.lessons.iter().filter(|is| **is > 0.0).count();
            let loss = if self.config.symmetry_weight > 0.0 {
                let asymmetry = surrogate::symmetry_loss(
                    means.clone(),
                    actions,
                    log_sigma.clone(),
                    tensor(chunk.lessons, 1, &device),
                    count,
                );
                sums.asymmetry += f64::from(values(asymmetry.clone())[0]);
                loss + asymmetry * self.config.symmetry_weight
            } else {
                loss
            };
            let mut gradients = loss.backward();
            actor.add_gradients(&mut gradients, actor_gradient);
            if let Some(gradient) = log_sigma.grad_remove(&mut gradients) {
                sigma_gradient
                    .iter_mut()
                    .zip(values(gradient))
                    .for_each(|(a, b)| *a += b);
            }

            let seen = if self.own_critic {
                tensor(chunk.critic, self.critic.inputs, &device)
            } else {
                observations
            };
            let loss = surrogate::value_loss(
                critic.forward(seen),
                tensor(chunk.returns, 1, &device),
                count,
            );
            sums.value_loss += f64::from(values(loss.clone())[0]);
            let mut gradients = loss.backward();
            critic.add_gradients(&mut gradients, critic_gradient);

            let (means, densities) = (values(means), values(density));
            for (i, role) in chunk.roles.iter().enumerate() {
                if *role != Role::Lesson {
                    let ratio = (densities[i] - chunk.log_probs[i]).exp();
                    sums.clipped += usize::from((ratio - 1.0).abs() > self.config.clip);
                }
                if *role == Role::Own {
                    let action = i * joints..(i + 1) * joints;
                    sums.kl += surrogate::divergence(
                        &chunk.means[action.clone()],
                        minibatch.old_sigma,
                        &means[action],
                        &new_sigma,
                        chunk.widths.get(i).copied().unwrap_or(1.0),
                    );
                    sums.kl_rows += 1;
                }
            }
        }
        sums
    }

    /// Copies rows together, mirrored where it is their turn.
    ///
    /// A mirrored row keeps its log-density and advantage: it stands for what the mirrored robot would have met. One
    /// that is a lesson in symmetry has no advantage, and the mirrored mean for its action.
    fn gather(&self, minibatch: &Minibatch<'_>, piece: Range<usize>) -> Chunk {
        let Minibatch { rows, indices, .. } = minibatch;
        let (inputs, joints) = (self.actor.inputs, self.actor.outputs);
        let own = if self.own_critic {
            self.critic.inputs
        } else {
            0
        };
        let mut chunk = Chunk::with_capacity(piece.len(), inputs, own, joints);
        for position in piece {
            let row = indices[position];
            let role = if is_mirrored(position, rows.mirrored_share) {
                Role::Mirrored
            } else if self.config.symmetry_weight > 0.0
                && is_mirrored(position, self.config.symmetry_share)
            {
                Role::Lesson
            } else {
                Role::Own
            };
            let observation = row * inputs..(row + 1) * inputs;
            let critic = row * own..(row + 1) * own;
            let action = row * joints..(row + 1) * joints;
            if role == Role::Own {
                chunk
                    .observations
                    .extend_from_slice(&rows.observations[observation]);
                chunk.critic.extend_from_slice(&rows.critic[critic]);
                chunk
                    .actions
                    .extend_from_slice(&rows.actions[action.clone()]);
                chunk.means.extend_from_slice(&rows.means[action]);
            } else {
                let done = if role == Role::Lesson {
                    rows.means
                } else {
                    rows.actions
                };
                chunk
                    .observations
                    .extend_from_slice(&rows.mirrored[observation]);
                let mirrored = &rows.mirrored_critic;
                chunk.critic.extend_from_slice(&mirrored[critic]);
                let start = chunk.actions.len();
                chunk.actions.resize(start + joints, 0.0);
                let out = &mut chunk.actions[start..];
                self.mirror.apply(&done[action], out);
                // Not read: KL is that of rows as they were.
                chunk.means.resize(start + joints, 0.0);
            }
            chunk.roles.push(role);
            chunk.log_probs.push(rows.log_probs[row]);
            chunk.widths.extend(rows.widths.get(row));
            let advantage = (rows.advantages[row] - minibatch.shift) * minibatch.scale;
            let (advantage, lesson) = match role {
                Role::Lesson => (0.0, 1.0),
                Role::Own | Role::Mirrored => (advantage, 0.0),
            };
            chunk.advantages.push(advantage);
            chunk.lessons.push(lesson);
            chunk.returns.push(rows.returns[row]);
        }
        chunk
    }
}

/// What a row of a minibatch is there for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// It is as it was collected.
    Own,
    /// Its mirror image stands for what the mirrored robot would have met.
    Mirrored,
    /// Its mirror image is for the symmetry loss.
    Lesson,
}

/// Rows copied together.
struct Chunk {
    observations: Vec<f32>,
    critic: Vec<f32>,
    actions: Vec<f32>,
    means: Vec<f32>,
    log_probs: Vec<f32>,
    /// How widely each was tried, in parts of σ; empty where all were alike.
    widths: Vec<f32>,
    advantages: Vec<f32>,
    returns: Vec<f32>,
    /// 1 where a row is a lesson in symmetry.
    lessons: Vec<f32>,
    roles: Vec<Role>,
}

impl Chunk {
    fn with_capacity(rows: usize, inputs: usize, own: usize, joints: usize) -> Self {
        let column = || Vec::with_capacity(rows);
        Self {
            observations: Vec::with_capacity(rows * inputs),
            critic: Vec::with_capacity(rows * own),
            actions: Vec::with_capacity(rows * joints),
            means: Vec::with_capacity(rows * joints),
            log_probs: column(),
            widths: column(),
            advantages: column(),
            returns: column(),
            lessons: column(),
            roles: Vec::with_capacity(rows),
        }
    }
}
