//! The policy: normalise, evaluate the layers, and explore.

use pulp::Arch;
use rand::Rng;
use vocabulary::CALM;

use crate::gaussian::Gaussian;
use crate::kernel::{Rows, TILE_ROWS};
use crate::layer::{Activation, Layer};
use crate::{OUTPUTS, PolicyError, Shape};

/// Rows that go through all layers together: their activations stay in the second-level cache.
const BLOCK: usize = 16 * TILE_ROWS;

/// A policy network with room for its intermediate results.
#[derive(Clone, Debug)]
pub struct Policy {
    /// Vectors of this machine.
    arch: Arch,
    shape: Shape,
    clip: f32,
    mean: Vec<f32>,
    inverse_deviation: Vec<f32>,
    gaussian: Gaussian,
    /// That of robots that explore calmly.
    calm: Gaussian,
    layers: Vec<Layer>,
    /// Results of the layer before and of the layer at work, for `BLOCK` rows.
    buffers: [Vec<f32>; 2],
}

impl Policy {
    /// A policy whose weights are zero: until some are loaded its mean action is zero, and its σ is one. It cuts normalised
    /// observations to ± `clip`, which belongs to its weights as their shape does: they were trained with it.
    ///
    /// # Panics
    /// If it sees nothing, a hidden layer has no units, or [`Self::check_clip`] refuses the clip.
    pub fn new(shape: Shape, clip: f32) -> Self {
        Self::check_clip(clip).expect("who takes a clip from elsewhere checks it");
        assert!(
            shape.inputs > 0 && !shape.hidden.contains(&0),
            "a layer without units passes nothing on: {shape:?}"
        );
        let layers: Vec<Layer> = shape
            .layers()
            .enumerate()
            .map(|(index, place)| {
                let activation = if index < shape.hidden.len() {
                    Activation::Elu
                } else {
                    Activation::None
                };
                Layer::new(place.inputs, place.outputs, activation)
            })
            .collect();
        let widest = layers
            .iter()
            .map(Layer::padded_outputs)
            .fold(shape.inputs, usize::max);
        Self {
            arch: Arch::new(),
            mean: vec![0.0; shape.inputs],
            inverse_deviation: vec![1.0; shape.inputs],
            clip,
            gaussian: Gaussian::new([1.0; OUTPUTS]),
            calm: Gaussian::new([CALM; OUTPUTS]),
            layers,
            buffers: [vec![0.0; BLOCK * widest], vec![0.0; BLOCK * widest]],
            shape,
        }
    }

    /// Its shape.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What normalised observations are cut to, ±.
    pub fn clip(&self) -> f32 {
        self.clip
    }

    /// Whether observations can be cut to ± `clip`.
    ///
    /// # Errors
    /// If it is not a finite number above zero.
    pub fn check_clip(clip: f32) -> Result<(), PolicyError> {
        if clip > 0.0 && clip.is_finite() {
            return Ok(());
        }
        Err(PolicyError::Clip { value: clip })
    }

    /// Its exploration.
    pub fn gaussian(&self) -> &Gaussian {
        &self.gaussian
    }

    /// Takes weights in the layout of [`Shape`]; refused weights leave those before in place.
    pub fn load(&mut self, flat: &[f32]) -> Result<(), PolicyError> {
        let expected = self.shape.len();
        if flat.len() != expected {
            return Err(PolicyError::Length {
                expected,
                found: flat.len(),
            });
        }
        if let Some(index) = flat.iter().position(|value| !value.is_finite()) {
            return Err(PolicyError::NotFinite {
                index,
                value: flat[index],
            });
        }
        let start = self.shape.sigma().start;
        let sigma: [f32; OUTPUTS] = std::array::from_fn(|action| flat[start + action]);
        if let Some(action) = sigma.iter().position(|&sigma| sigma <= 0.0) {
            return Err(PolicyError::Deviation {
                action,
                value: sigma[action],
            });
        }
        self.mean.copy_from_slice(&flat[self.shape.mean()]);
        self.inverse_deviation
            .copy_from_slice(&flat[self.shape.inverse_deviation()]);
        self.gaussian = Gaussian::new(sigma);
        self.calm = Gaussian::new(sigma.map(|sigma| CALM * sigma));
        for (layer, place) in self.layers.iter_mut().zip(self.shape.layers()) {
            layer.load(&flat[place.weights], &flat[place.bias]);
        }
        Ok(())
    }

    /// Mean actions `[n][joints]` of observations `[n][inputs]`: what the policy does without exploring.
    ///
    /// Does not allocate. A NaN in an observation makes that row's action NaN, and no other.
    ///
    /// # Panics
    /// If a slice does not hold exactly `n` rows.
    pub fn means(&mut self, observations: &[f32], n: usize, out: &mut [f32]) {
        let inputs = self.shape.inputs;
        assert_eq!(observations.len(), n * inputs, "observations of {n} rows");
        assert_eq!(out.len(), n * OUTPUTS, "actions of {n} rows");
        for (observations, out) in observations
            .chunks(BLOCK * inputs)
            .zip(out.chunks_mut(BLOCK * OUTPUTS))
        {
            self.block(observations, out);
        }
    }

    /// Draws actions around the means, with the log-density of each: all in `[n][joints]`, `log_probs` in `[n]`, whose
    /// length says n. In the last `calm` rows they are drawn with [`CALM`] times the width.
    ///
    /// Does not allocate.
    ///
    /// # Panics
    /// If a slice does not hold exactly `n` rows, or `calm` is more.
    pub fn sample<R: Rng + ?Sized>(
        &mut self,
        observations: &[f32],
        calm: usize,
        rng: &mut R,
        actions: &mut [f32],
        means: &mut [f32],
        log_probs: &mut [f32],
    ) {
        let n = log_probs.len();
        assert_eq!(actions.len(), n * OUTPUTS, "actions of {n} rows");
        self.means(observations, n, means);
        let wide = n - calm;
        let (means, calm_means) = means.split_at(wide * OUTPUTS);
        let (actions, calm_actions) = actions.split_at_mut(wide * OUTPUTS);
        let (log_probs, calm_log_probs) = log_probs.split_at_mut(wide);
        self.gaussian
            .sample(self.arch, means, rng, actions, log_probs);
        self.calm
            .sample(self.arch, calm_means, rng, calm_actions, calm_log_probs);
    }

    /// Up to `BLOCK` rows.
    fn block(&mut self, observations: &[f32], out: &mut [f32]) {
        let inputs = self.shape.inputs;
        let count = observations.len() / inputs;
        let [mut from, mut to] = self.buffers.each_mut();
        let (mean, inverse) = (&self.mean, &self.inverse_deviation);
        self.arch.dispatch(
            #[inline(always)]
            || normalise(observations, mean, inverse, self.clip, from),
        );
        let mut stride = inputs;
        for layer in &self.layers {
            layer.forward(
                self.arch,
                Rows {
                    values: from,
                    stride,
                },
                count,
                to,
            );
            stride = layer.padded_outputs();
            std::mem::swap(&mut from, &mut to);
        }
        for (out, result) in out.chunks_exact_mut(OUTPUTS).zip(from.chunks_exact(stride)) {
            out.copy_from_slice(&result[..OUTPUTS]);
        }
    }
}

/// clip((o − mean)·inverse deviation, ± `clip`) for rows `[n][inputs]`; what is no number stays none.
#[inline(always)]
fn normalise(
    observations: &[f32],
    mean: &[f32],
    inverse_deviation: &[f32],
    clip: f32,
    out: &mut [f32],
) {
    let inputs = mean.len();
    let inverse_deviation = &inverse_deviation[..inputs];
    let rows = observations.chunks_exact(inputs);
    for (row, out) in rows.zip(out.chunks_exact_mut(inputs)) {
        // By index over slices of one length, and not by `clamp`, which asks whether its limits are in order: so that
        // vectors do many numbers at a time.
        for i in 0..inputs {
            let scaled = (row[i] - mean[i]) * inverse_deviation[i];
            let scaled = if scaled < -clip { -clip } else { scaled };
            out[i] = if scaled > clip { clip } else { scaled };
        }
    }
}

#[cfg(test)]
mod tests;
