//! A multilayer perceptron on a burn device.
//!
//! Where many rows are differentiated, each thread has its own copy: burn keeps the records of tensors that share a
//! weight under one lock, so that copies run side by side and shared weights would not.

use crate::{NetworkError, Shape, fused, kernels};
use burn::module::{Module, Param};
use burn::tensor::{Device, Gradients, Tensor, TensorData};

/// Dense layers with an activation between them.
#[derive(Module, Debug)]
pub struct Mlp {
    layers: Vec<Dense>,
    #[module(skip)]
    shape: Shape,
}

#[derive(Module, Debug)]
struct Dense {
    /// `[in, out]`
    weight: Param<Tensor<2>>,
    /// `[out]`
    bias: Param<Tensor<1>>,
}

/// What a forward pass computed.
#[derive(Debug)]
pub struct Forward {
    /// Outputs of the hidden layers, each `[n, width]`.
    pub hidden: Vec<Tensor<2>>,
    /// `[n, outputs]`
    pub output: Tensor<2>,
}

impl Mlp {
    /// A network with these weights; they are differentiable if the device records derivatives.
    ///
    /// # Errors
    /// If `flat` is not as long as the shape says.
    pub fn new(shape: &Shape, flat: &[f32], device: &Device) -> Result<Self, NetworkError> {
        NetworkError::check_length("weights of a network", shape.len(), flat.len())?;
        let layers = shape
            .layers()
            .map(|layer| {
                let weight =
                    TensorData::new(flat[layer.weights].to_vec(), [layer.inputs, layer.outputs]);
                let bias = TensorData::new(flat[layer.bias].to_vec(), [layer.outputs]);
                Dense {
                    weight: Param::from_tensor(Tensor::from_data(weight, device)),
                    bias: Param::from_tensor(Tensor::from_data(bias, device)),
                }
            })
            .collect();
        Ok(Self {
            layers,
            shape: shape.clone(),
        })
    }

    /// Its sizes.
    pub fn shape(&self) -> &Shape {
        &self.shape
    }

    /// Writes all weights and biases, bit for bit, in the layout of [`Shape`].
    pub fn export(&self, flat: &mut Vec<f32>) {
        flat.clear();
        for layer in &self.layers {
            flat.extend(crate::values(layer.weight.val()));
            flat.extend(crate::values(layer.bias.val()));
        }
    }

    /// Outputs `[n, outputs]` for inputs `[n, inputs]`.
    pub fn forward(&self, inputs: Tensor<2>) -> Tensor<2> {
        let mut rows = inputs;
        for (i, layer) in self.layers.iter().enumerate() {
            rows = self.layer(i, layer, rows);
        }
        rows
    }

    /// The same, with the hidden layers' outputs.
    pub fn forward_all(&self, inputs: Tensor<2>) -> Forward {
        let mut hidden: Vec<Tensor<2>> = Vec::with_capacity(self.layers.len());
        for (i, layer) in self.layers.iter().enumerate() {
            let rows = hidden.last().unwrap_or(&inputs).clone();
            hidden.push(self.layer(i, layer, rows));
        }
        let output = hidden.pop().expect("a network has a last layer");
        Forward { hidden, output }
    }

    fn layer(&self, i: usize, layer: &Dense, rows: Tensor<2>) -> Tensor<2> {
        let activation = if i + 1 == self.layers.len() {
            crate::Activation::Identity
        } else {
            self.shape.activation
        };
        fused::activate(
            fused::product(rows, layer.weight.val()),
            layer.bias.val(),
            activation,
        )
    }

    /// Gradient ∇ₓD(x) `[n, inputs]` of the single output of a ReLU network, differentiable by the weights.
    ///
    /// burn has no second derivatives. Of a ReLU network the first is itself made of products with the weights, gated
    /// where a hidden output is zero:  g = wᵀ · 1\[h > 0\],  then  g ← (g Wᵀ) · 1\[h > 0\]  layer by layer down. The
    /// gates are constants almost everywhere, so the derivative of this by the weights is exact.
    ///
    /// # Panics
    /// If there is more than one output or the activation is not ReLU.
    pub fn input_gradient(&self, hidden: &[Tensor<2>]) -> Tensor<2> {
        assert_eq!(
            (self.shape.outputs, self.shape.activation),
            (1, crate::Activation::Relu),
            "the analytic input gradient is that of a ReLU network with one output"
        );
        assert_eq!(
            hidden.len(),
            self.layers.len() - 1,
            "one gate per hidden layer"
        );
        let mut gradient: Option<Tensor<2>> = None;
        for (layer, hidden) in self.layers[1..].iter().zip(hidden).rev() {
            let down = layer.weight.val().transpose();
            let ungated = match gradient {
                None => down, // the head: one row for all
                Some(gradient) => fused::product(gradient, down),
            };
            gradient = Some(fused::gate(ungated, hidden.clone()));
        }
        let first = self.layers[0].weight.val().transpose();
        match gradient {
            Some(gradient) => fused::product(gradient, first),
            None => first, // a linear network has the same gradient everywhere
        }
    }

    /// Adds the gradients of a backward pass to `flat`, in the layout of [`Shape`].
    ///
    /// # Panics
    /// If `flat` is not as long as the shape says.
    pub fn add_gradients(&self, gradients: &mut Gradients, flat: &mut [f32]) {
        assert_eq!(flat.len(), self.shape.len(), "one gradient per weight");
        for (dense, layer) in self.layers.iter().zip(self.shape.layers()) {
            // A bias that a loss does not depend on has none: the head's, when only the input gradient counts.
            if let Some(gradient) = dense.weight.val().grad_remove(gradients) {
                kernels::accumulate(&mut flat[layer.weights], &crate::values(gradient));
            }
            if let Some(gradient) = dense.bias.val().grad_remove(gradients) {
                kernels::accumulate(&mut flat[layer.bias], &crate::values(gradient));
            }
        }
    }
}
