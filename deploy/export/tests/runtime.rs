//! The exported ONNX model in another runtime, compared with this project's own inference.

use export::{Network, onnx};
use policy::{OUTPUTS, Policy, Shape};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rten::Model;
use rten_tensor::prelude::*;
use rten_tensor::{NdTensor, Tensor};

/// Weights of the size that training makes: means of order 1, deviations from 0.05 to 20, layers that keep variance.
fn network(inputs: usize, hidden: &[usize], random: &mut Pcg64) -> (Shape, Vec<f32>) {
    let shape = Shape::new(inputs, hidden);
    let mut flat = vec![0.0; shape.len()];
    for value in &mut flat[shape.mean()] {
        *value = random.random_range(-1.0..1.0);
    }
    for value in &mut flat[shape.inverse_deviation()] {
        *value = random.random_range(0.05..20.0);
    }
    flat[shape.sigma()].fill(0.3);
    for layer in shape.layers() {
        let width = (3.0 / layer.inputs as f32).sqrt();
        for value in &mut flat[layer.weights.start..layer.bias.end] {
            *value = random.random_range(-width..width);
        }
    }
    (shape, flat)
}

#[test]
fn another_runtime_gives_the_same_actions() {
    let mut random = Pcg64::seed_from_u64(7);
    for (inputs, hidden, clip) in [
        (82, &[][..], 5.0),
        (9, &[256, 128], 0.75),
        (492, &[512, 256, 128], 20.0),
    ] {
        let (shape, flat) = network(inputs, hidden, &mut random);
        let mut ours = Policy::new(shape.clone(), clip);
        ours.load(&flat).unwrap();
        let model = onnx::model(
            &Network::new(shape, clip, flat).unwrap(),
            &[("run".to_owned(), "test".to_owned())],
        );
        let theirs = Model::load(model).unwrap();
        // Batches of different sizes go through the same file; large numbers reach the clipping.
        for rows in [1, 7, 992] {
            let seen: Vec<f32> = (0..rows * inputs)
                .map(|_| random.random_range(-3.0..3.0))
                .collect();
            let mut expected = vec![0.0; rows * OUTPUTS];
            ours.means(&seen, rows, &mut expected);
            let input = NdTensor::from_data([rows, inputs], seen);
            let got: Tensor<f32> = theirs
                .run_one(input.into(), None)
                .unwrap()
                .try_into()
                .unwrap();
            assert_eq!(got.shape(), [rows, OUTPUTS]);
            let worst = got
                .iter()
                .zip(&expected)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f32::max);
            // Rounding grows with the numbers that are let in.
            let bound = 2e-6 * clip.max(5.0);
            assert!(worst < bound, "{hidden:?}, ±{clip}, {rows} rows: {worst}");
            let largest = expected.iter().fold(0.0_f32, |m, x| m.max(x.abs()));
            assert!(largest > 0.1, "the actions are not all nothing: {largest}");
        }
    }
}
