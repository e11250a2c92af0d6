//! First weights: orthogonal matrices, zero biases.

use crate::Shape;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// Weights whose matrices have orthonormal columns (or rows, if there are fewer), times `gain` in hidden layers and
/// `last_gain` in the last one; zero biases.
///
/// An orthogonal matrix keeps the length of what passes through it, so that neither signals nor gradients shrink with
/// depth; √2 makes up for what ReLU cuts away. A small last gain lets a policy start near its mean pose.
pub fn orthogonal<R: Rng + ?Sized>(
    shape: &Shape,
    gain: f32,
    last_gain: f32,
    rng: &mut R,
) -> Vec<f32> {
    let mut flat = vec![0.0; shape.len()];
    let last = shape.layers().len() - 1;
    for (i, layer) in shape.layers().enumerate() {
        let gain = if i == last { last_gain } else { gain };
        let (inputs, outputs) = (layer.inputs, layer.outputs);
        let (count, length) = (inputs.min(outputs), inputs.max(outputs));
        let vectors = orthonormal(count, length, rng);
        for (row, weights) in flat[layer.weights].chunks_exact_mut(outputs).enumerate() {
            for (column, weight) in weights.iter_mut().enumerate() {
                let value = if outputs <= inputs {
                    vectors[column][row]
                } else {
                    vectors[row][column]
                };
                *weight = gain * value as f32;
            }
        }
    }
    flat
}

/// `count` orthonormal vectors by Gram–Schmidt on normal ones, each made orthogonal twice, which rounding needs.
fn orthonormal<R: Rng + ?Sized>(count: usize, length: usize, rng: &mut R) -> Vec<Vec<f64>> {
    let mut vectors: Vec<Vec<f64>> = Vec::with_capacity(count);
    while vectors.len() < count {
        let mut vector: Vec<f64> = (0..length).map(|_| StandardNormal.sample(rng)).collect();
        for _ in 0..2 {
            for other in &vectors {
                let along: f64 = vector.iter().zip(other).map(|(a, b)| a * b).sum();
                vector
                    .iter_mut()
                    .zip(other)
                    .for_each(|(a, b)| *a -= along * b);
            }
        }
        let length = vector.iter().map(|a| a * a).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|a| *a /= length);
        vectors.push(vector);
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Activation;
    use rand::SeedableRng;

    #[test]
    fn matrices_are_orthogonal_with_their_gain() {
        let shape = Shape::new(6, &[9], 4, Activation::Elu);
        let flat = orthogonal(&shape, 2.0, 0.01, &mut rand_pcg::Pcg64::seed_from_u64(3));
        let [first, second] = [0, 1].map(|i| shape.layers().nth(i).expect("two layers"));
        // 6 rows of 9: rows orthogonal, length 2
        let rows: Vec<&[f32]> = flat[first.weights].chunks_exact(9).collect();
        for (i, a) in rows.iter().enumerate() {
            for (j, b) in rows.iter().enumerate() {
                let product: f32 = a.iter().zip(*b).map(|(a, b)| a * b).sum();
                assert!((product - if i == j { 4.0 } else { 0.0 }).abs() < 1e-5);
            }
        }
        // 9 rows of 4: columns orthogonal, length 0.01
        let head = &flat[second.weights];
        for i in 0..4 {
            for j in 0..4 {
                let product: f32 = (0..9)
                    .map(|row| head[row * 4 + i] * head[row * 4 + j])
                    .sum();
                assert!((product - if i == j { 1e-4 } else { 0.0 }).abs() < 1e-9);
            }
        }
        assert!(
            flat[first.bias]
                .iter()
                .chain(&flat[second.bias])
                .all(|b| *b == 0.0)
        );
    }

    #[test]
    fn a_seed_gives_the_same_weights() {
        let shape = Shape::new(3, &[5], 2, Activation::Relu);
        let weights =
            |seed| orthogonal(&shape, 1.0, 1.0, &mut rand_pcg::Pcg64::seed_from_u64(seed));
        assert_eq!(weights(1), weights(1));
        assert_ne!(weights(1), weights(2));
    }
}
