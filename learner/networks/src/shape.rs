//! Sizes of a perceptron and where its numbers lie in a flat vector.
//!
//! Layer after layer: weights `[in][out]` row by row, then biases `[out]`. The actors read the same layout.

use std::ops::Range;

/// What follows a hidden layer. Nothing follows the last one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activation {
    /// x itself.
    Identity,
    /// x above zero, eˣ − 1 below.
    Elu,
    /// x above zero, 0 below.
    Relu,
}

/// Sizes of a multilayer perceptron.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Numbers per input row.
    pub inputs: usize,
    /// Numbers per hidden layer, in order.
    pub hidden: Vec<usize>,
    /// Numbers per output row.
    pub outputs: usize,
    /// After every hidden layer.
    pub activation: Activation,
}

/// One layer's place in the flat vector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerLayout {
    /// Rows of the weight matrix.
    pub inputs: usize,
    /// Columns of the weight matrix.
    pub outputs: usize,
    /// Where the weights are, `[in][out]`.
    pub weights: Range<usize>,
    /// Where the biases are.
    pub bias: Range<usize>,
}

impl Shape {
    /// A perceptron of these sizes.
    pub fn new(inputs: usize, hidden: &[usize], outputs: usize, activation: Activation) -> Self {
        Self {
            inputs,
            hidden: hidden.to_vec(),
            outputs,
            activation,
        }
    }

    /// Layers from input to output, without gaps.
    pub fn layers(
        &self,
    ) -> impl DoubleEndedIterator<Item = LayerLayout> + ExactSizeIterator + use<> {
        let sizes: Vec<usize> = [self.inputs]
            .into_iter()
            .chain(self.hidden.iter().copied())
            .chain([self.outputs])
            .collect();
        let mut start = 0;
        let layers: Vec<_> = sizes
            .windows(2)
            .map(|pair| {
                let weights = start..start + pair[0] * pair[1];
                let bias = weights.end..weights.end + pair[1];
                start = bias.end;
                LayerLayout {
                    inputs: pair[0],
                    outputs: pair[1],
                    weights,
                    bias,
                }
            })
            .collect();
        layers.into_iter()
    }

    /// Numbers in the flat vector.
    pub fn len(&self) -> usize {
        self.layers().next_back().map_or(0, |last| last.bias.end)
    }

    /// Whether there is no number at all.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Name and sizes of each tensor in order: `layers.0.weight [82, 256]`, `layers.0.bias [256]`, …
    pub fn tensors(&self) -> impl Iterator<Item = (String, Vec<usize>, Range<usize>)> + use<> {
        self.layers().enumerate().flat_map(|(i, layer)| {
            [
                (
                    format!("layers.{i}.weight"),
                    vec![layer.inputs, layer.outputs],
                    layer.weights,
                ),
                (format!("layers.{i}.bias"), vec![layer.outputs], layer.bias),
            ]
        })
    }

    /// Where the last layer's numbers begin: what is before is the trunk, what follows the head.
    pub fn head(&self) -> usize {
        self.layers()
            .next_back()
            .map_or(0, |last| last.weights.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_follow_each_other_without_gaps() {
        // 3·4 + 4 = 16, then 4·2 + 2 = 10
        let shape = Shape::new(3, &[4], 2, Activation::Elu);
        let layers: Vec<_> = shape.layers().collect();
        assert_eq!(
            (layers[0].weights.clone(), layers[0].bias.clone()),
            (0..12, 12..16)
        );
        assert_eq!(
            (layers[1].weights.clone(), layers[1].bias.clone()),
            (16..24, 24..26)
        );
        assert_eq!((shape.len(), shape.head()), (26, 16));
        let names: Vec<_> = shape
            .tensors()
            .map(|(name, sizes, _)| (name, sizes))
            .collect();
        assert_eq!(names[0], ("layers.0.weight".to_owned(), vec![3, 4]));
        assert_eq!(names[3], ("layers.1.bias".to_owned(), vec![2]));
    }

    #[test]
    fn without_hidden_layers_it_is_linear() {
        assert_eq!(Shape::new(3, &[], 2, Activation::Elu).len(), 8);
    }
}
