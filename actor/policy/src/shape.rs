//! The flat layout of a policy's weights, as the learner exports it and the processes ship it.
//!
//! One vector of f32, in this order: observation mean `[inputs]`, observation inverse standard deviation `[inputs]`,
//! exploration standard deviation per action `[joints]`, then for each layer its weights `[in][out]` row by row and its bias
//! `[out]`. Beside it, as the widths of the layers, goes what normalised observations are cut to.

use std::ops::Range;

use serde::{Deserialize, Serialize};

/// Numbers in an action, one target per joint.
pub const OUTPUTS: usize = g1::ACTION;

/// Widths of the layers; the last one's is [`OUTPUTS`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shape {
    /// Numbers in an observation.
    pub inputs: usize,
    /// Units of each hidden layer, from the observation on. Empty makes a linear policy.
    pub hidden: Vec<usize>,
}

/// Where one layer's numbers are in the flat vector.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerPlace {
    /// Numbers that go in.
    pub inputs: usize,
    /// Numbers that come out.
    pub outputs: usize,
    /// Its weights `[in][out]`, row by row.
    pub weights: Range<usize>,
    /// Its bias `[out]`.
    pub bias: Range<usize>,
}

impl Shape {
    /// A policy that sees so many numbers, with these hidden layers.
    pub fn new(inputs: usize, hidden: &[usize]) -> Self {
        Self {
            inputs,
            hidden: hidden.to_vec(),
        }
    }

    /// Observation means, in the flat vector.
    pub fn mean(&self) -> Range<usize> {
        0..self.inputs
    }

    /// Observation inverse standard deviations, in the flat vector.
    pub fn inverse_deviation(&self) -> Range<usize> {
        self.inputs..2 * self.inputs
    }

    /// Exploration standard deviations, in the flat vector.
    pub fn sigma(&self) -> Range<usize> {
        2 * self.inputs..2 * self.inputs + OUTPUTS
    }

    /// Length of the flat vector.
    pub fn len(&self) -> usize {
        self.layers()
            .last()
            .map_or(self.sigma().end, |layer| layer.bias.end)
    }

    /// Whether a flat vector of `numbers` numbers is one of this shape, however absurd the shape.
    pub fn fits(&self, numbers: usize) -> bool {
        // Every unit has a bias, so no layer of a vector is wider than the vector is long.
        let possible = |width: &usize| (1..=numbers).contains(width);
        // What is seen has a mean and a deviation each.
        let before_last = [self.inputs].into_iter().chain(self.hidden.iter().copied());
        let widths: Vec<usize> = before_last.chain([OUTPUTS]).collect();
        widths.iter().all(possible)
            && widths
                .windows(2)
                .try_fold(self.sigma().end, |sum, pair| {
                    sum.checked_add(pair[0].checked_mul(pair[1])?)?
                        .checked_add(pair[1])
                })
                .is_some_and(|sum| sum == numbers)
    }

    /// Never: even a linear policy has weights.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Every layer's place, from the observation on.
    pub fn layers(&self) -> impl Iterator<Item = LayerPlace> + '_ {
        let outputs = self.hidden.iter().copied().chain([OUTPUTS]);
        outputs.scan(
            (self.sigma().end, self.inputs),
            |(start, inputs), outputs| {
                let weights = *start..*start + *inputs * outputs;
                let bias = weights.end..weights.end + outputs;
                let place = LayerPlace {
                    inputs: *inputs,
                    outputs,
                    weights,
                    bias: bias.clone(),
                };
                (*start, *inputs) = (bias.end, outputs);
                Some(place)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vector_is_the_sum_of_its_parts() {
        // 82 + 82 + 23 = 187; a linear policy adds 82·23 + 23 = 1909
        assert_eq!(Shape::new(82, &[]).len(), 187 + 1909);
        // 82·4 + 4 = 332, 4·23 + 23 = 115
        assert_eq!(Shape::new(82, &[4]).len(), 187 + 332 + 115);
    }

    #[test]
    fn a_shape_fits_its_own_length_and_no_other() {
        let shape = Shape::new(82, &[4, 3]);
        assert!(shape.fits(shape.len()) && !shape.fits(shape.len() + 1));
        assert!(Shape::new(82, &[]).fits(187 + 1909));
        let most = u32::MAX as usize;
        assert!(!Shape::new(82, &[most; 6]).fits(2_000));
        assert!(!Shape::new(82, &[0]).fits(187 + 23));
        assert!(!Shape::new(most, &[]).fits(2_000) && !Shape::new(0, &[]).fits(2 * 23));
    }

    #[test]
    fn layers_follow_each_other_without_gaps() {
        let layers: Vec<_> = Shape::new(82, &[4, 3]).layers().collect();
        assert_eq!(
            layers
                .iter()
                .map(|l| (l.inputs, l.outputs))
                .collect::<Vec<_>>(),
            [(82, 4), (4, 3), (3, 23)]
        );
        assert_eq!(
            (layers[0].weights.clone(), layers[0].bias.clone()),
            (187..515, 515..519)
        );
        assert_eq!(
            (layers[1].weights.clone(), layers[1].bias.clone()),
            (519..531, 531..534)
        );
        assert_eq!(layers[2].weights.start, 534);
    }
}
