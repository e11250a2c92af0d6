//! Adam and AdamW on a flat vector.
//!
//! Not burn's: gradients arrive as one flat sum over shards, clipping is of the global norm (burn clips each tensor by
//! itself), a state that does not fit is refused (burn starts it anew without a word), and one pass over memory replaces
//! ten.

use crate::NetworkError;
use pulp::Arch;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Constants of the update.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdamConfig {
    /// β₁, memory of the mean gradient.
    pub beta_1: f32,
    /// β₂, memory of the mean squared gradient.
    pub beta_2: f32,
    /// ε, added to the root.
    pub epsilon: f32,
}

impl Default for AdamConfig {
    /// The values of the original publication.
    fn default() -> Self {
        Self {
            beta_1: 0.9,
            beta_2: 0.999,
            epsilon: 1e-8,
        }
    }
}

/// Weight decay of a part of the vector, decoupled from the gradient (AdamW).
#[derive(Clone, Debug, PartialEq)]
pub struct Decay {
    /// Which weights.
    pub part: Range<usize>,
    /// λ: each step multiplies them by 1 − rate·λ.
    pub factor: f32,
}

/// What an optimizer remembers: everything that an exact continuation needs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AdamState {
    /// Steps done.
    pub steps: u64,
    /// Mean gradient.
    pub first: Vec<f32>,
    /// Mean squared gradient.
    pub second: Vec<f32>,
}

/// The optimizer.
#[derive(Clone, Debug)]
pub struct Adam {
    config: AdamConfig,
    decay: Vec<Decay>,
    state: AdamState,
}

impl Adam {
    /// For `length` weights, before the first step.
    ///
    /// # Panics
    /// If a decay's part reaches beyond them.
    pub fn new(length: usize, config: AdamConfig, decay: Vec<Decay>) -> Self {
        assert!(
            decay.iter().all(|decay| decay.part.end <= length),
            "decay within the weights"
        );
        Self {
            config,
            decay,
            state: AdamState {
                steps: 0,
                first: vec![0.0; length],
                second: vec![0.0; length],
            },
        }
    }

    /// What it remembers.
    pub fn state(&self) -> &AdamState {
        &self.state
    }

    /// Continues from a saved state.
    ///
    /// # Errors
    /// If the state is of another number of weights.
    pub fn restore(&mut self, state: AdamState) -> Result<(), NetworkError> {
        let expected = self.state.first.len();
        NetworkError::check_length(
            "first moments of the optimizer",
            expected,
            state.first.len(),
        )?;
        NetworkError::check_length(
            "second moments of the optimizer",
            expected,
            state.second.len(),
        )?;
        self.state = state;
        Ok(())
    }

    /// One step:  m ← β₁m + (1−β₁)g,  v ← β₂v + (1−β₂)g²,  w ← w(1 − rate·λ) − rate·m̂ / (√v̂ + ε),
    /// with m̂ = m/(1−β₁ᵗ), v̂ = v/(1−β₂ᵗ).
    ///
    /// # Panics
    /// If weights or gradients are not as many as the optimizer is for.
    pub fn step(&mut self, weights: &mut [f32], gradients: &[f32], rate: f32) {
        let AdamConfig {
            beta_1,
            beta_2,
            epsilon,
        } = self.config;
        let length = self.state.first.len();
        assert_eq!((weights.len(), gradients.len()), (length, length));
        for decay in &self.decay {
            let keep = 1.0 - rate * decay.factor;
            weights[decay.part.clone()]
                .iter_mut()
                .for_each(|weight| *weight *= keep);
        }
        self.state.steps += 1;
        let t = i32::try_from(self.state.steps).unwrap_or(i32::MAX);
        let correct_1 = (1.0 / (1.0 - f64::from(beta_1).powi(t))) as f32;
        let correct_2 = (1.0 / (1.0 - f64::from(beta_2).powi(t))) as f32;
        let AdamState { first, second, .. } = &mut self.state;
        Arch::new().dispatch(
            #[inline(always)]
            || {
                let moments = first.iter_mut().zip(second.iter_mut());
                for ((weight, gradient), (first, second)) in
                    weights.iter_mut().zip(gradients).zip(moments)
                {
                    *first += (1.0 - beta_1) * (gradient - *first);
                    *second += (1.0 - beta_2) * (gradient * gradient - *second);
                    let root = (*second * correct_2).sqrt() + epsilon;
                    *weight -= rate * (*first * correct_1) / root;
                }
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_steps_by_hand() {
        // Step 1: m̂ = g, v̂ = g²: the weight moves by rate·sign(g) = 0.1, whatever the gradient's size.
        let mut adam = Adam::new(2, AdamConfig::default(), vec![]);
        let mut weights = [1.0, 1.0];
        adam.step(&mut weights, &[3.0, -0.01], 0.1);
        assert!((weights[0] - 0.9).abs() < 1e-6 && (weights[1] - 1.1).abs() < 1e-6);
        // Step 2 with g = 0 on the first: m = 0.9·0.3 = 0.27, m̂ = 0.27/0.19 = 1.4210526;
        // v = 0.999·0.009 = 0.008991, v̂ = 0.008991/0.001999 = 4.4977489, root 2.1207897: moves 0.067006
        adam.step(&mut weights, &[0.0, 0.0], 0.1);
        assert!((weights[0] - (0.9 - 0.067_006)).abs() < 1e-5);
    }

    #[test]
    fn decay_touches_its_part_only() {
        let decay = Decay {
            part: 1..2,
            factor: 0.5,
        };
        let mut adam = Adam::new(2, AdamConfig::default(), vec![decay]);
        let mut weights = [2.0, 2.0];
        adam.step(&mut weights, &[0.0, 0.0], 0.1);
        assert_eq!(weights, [2.0, 1.9]); // 2·(1 − 0.1·0.5)
    }

    #[test]
    fn a_restored_state_continues_bit_by_bit() {
        let run = |adam: &mut Adam, weights: &mut [f32; 2], steps: Range<usize>| {
            for step in steps {
                adam.step(weights, &[(step as f32).sin(), 0.3], 0.01);
            }
        };
        let fresh = || Adam::new(2, AdamConfig::default(), vec![]);
        let (mut straight, mut a) = (fresh(), [0.5, -0.5]);
        run(&mut straight, &mut a, 0..10);
        let (mut before, mut b) = (fresh(), [0.5, -0.5]);
        run(&mut before, &mut b, 0..5);
        let mut after = fresh();
        after.restore(before.state().clone()).expect("same length");
        run(&mut after, &mut b, 5..10);
        assert_eq!(a, b);
        assert_eq!(straight.state(), after.state());
    }

    #[test]
    fn a_state_of_other_weights_is_refused() {
        let other = Adam::new(3, AdamConfig::default(), vec![]);
        let error = Adam::new(2, AdamConfig::default(), vec![]).restore(other.state().clone());
        assert_eq!(
            error.expect_err("3 is not 2").to_string(),
            "first moments of the optimizer: 3 numbers, expected 2"
        );
    }
}
