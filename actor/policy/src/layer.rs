//! A linear layer with its weights packed for the kernel.

use pulp::Arch;

use crate::elu;
use crate::kernel::{COLUMNS, Product, Rows};

/// What is done with a layer's sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Activation {
    Elu,
    None,
}

/// Weights `[in][out]` regrouped into panels of 32 outputs, padded with zeros.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    inputs: usize,
    outputs: usize,
    /// `[panel][in]` of 32 weights.
    panels: Vec<[f32; COLUMNS]>,
    /// `[panel]` of 32 biases.
    bias: Vec<[f32; COLUMNS]>,
    activation: Activation,
}

impl Layer {
    /// A layer whose weights are zero.
    pub(crate) fn new(inputs: usize, outputs: usize, activation: Activation) -> Self {
        let panels = outputs.div_ceil(COLUMNS);
        Self {
            inputs,
            outputs,
            panels: vec![[0.0; COLUMNS]; panels * inputs],
            bias: vec![[0.0; COLUMNS]; panels],
            activation,
        }
    }

    /// Outputs rounded up to whole panels: the distance between rows of the result.
    pub(crate) fn padded_outputs(&self) -> usize {
        self.bias.len() * COLUMNS
    }

    /// Packs weights `[in][out]` and bias `[out]`.
    pub(crate) fn load(&mut self, weights: &[f32], bias: &[f32]) {
        for (panel, rows) in self.panels.chunks_exact_mut(self.inputs).enumerate() {
            let columns = panel * COLUMNS..((panel + 1) * COLUMNS).min(self.outputs);
            let width = columns.len();
            for (row, weights) in rows.iter_mut().zip(weights.chunks_exact(self.outputs)) {
                row[..width].copy_from_slice(&weights[columns.clone()]);
            }
            self.bias[panel][..width].copy_from_slice(&bias[columns]);
        }
    }

    /// Evaluates `count` rows; a result row every [`Self::padded_outputs`] numbers.
    pub(crate) fn forward(&self, arch: Arch, input: Rows<'_>, count: usize, output: &mut [f32]) {
        for (index, (panel, bias)) in self
            .panels
            .chunks_exact(self.inputs)
            .zip(&self.bias)
            .enumerate()
        {
            Product {
                input,
                count,
                panel,
                bias,
                output: &mut output[index * COLUMNS..],
                output_stride: self.padded_outputs(),
            }
            .evaluate(arch);
        }
        if self.activation == Activation::Elu {
            elu::apply(arch, &mut output[..count * self.padded_outputs()]);
        }
    }
}
