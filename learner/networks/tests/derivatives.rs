//! Gradients against finite differences, and threads against one.

use burn::tensor::Tensor;
use networks::{Activation, Mlp, Shape, fused, orthogonal, shards, tensor, tracked_device, values};
use rand::{RngExt, SeedableRng};

const ROWS: usize = 7;

fn rows(columns: usize, seed: u64) -> Vec<f32> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    (0..ROWS * columns)
        .map(|_| rng.random_range(-1.5..1.5))
        .collect()
}

fn weights(shape: &Shape) -> Vec<f32> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(9);
    let mut flat = orthogonal(shape, 1.2, 0.7, &mut rng);
    // Biases that are not zero, so that their place is tested too.
    flat.iter_mut()
        .for_each(|w| *w += rng.random_range(-0.1..0.1));
    flat
}

/// Loss and its gradient by burn.
fn differentiate(shape: &Shape, flat: &[f32], loss: impl Fn(&Mlp) -> Tensor<1>) -> (f64, Vec<f32>) {
    let network = Mlp::new(shape, flat, &tracked_device()).expect("weights of this shape");
    let loss = loss(&network);
    let mut gradients = loss.backward();
    let mut flat = vec![0.0; shape.len()];
    network.add_gradients(&mut gradients, &mut flat);
    (f64::from(values(loss)[0]), flat)
}

/// The largest deviation of the gradient from central differences, relative to its largest number.
fn deviation(shape: &Shape, flat: &[f32], loss: impl Fn(&Mlp) -> Tensor<1>) -> f64 {
    let (_, gradient) = differentiate(shape, flat, &loss);
    let largest = gradient.iter().fold(0.0_f32, |a, g| a.max(g.abs()));
    assert!(largest > 1e-3, "a gradient of zeros tests nothing");
    let step = 2e-3_f32;
    let mut worst = 0.0_f64;
    for i in 0..flat.len() {
        let at = |w: f32| {
            let mut moved = flat.to_vec();
            moved[i] = w;
            differentiate(shape, &moved, &loss).0
        };
        let [up, down] = [flat[i] + step, flat[i] - step];
        let difference = (at(up) - at(down)) / f64::from(up - down);
        worst = worst.max((difference - f64::from(gradient[i])).abs());
    }
    worst / f64::from(largest)
}

#[test]
fn products_and_their_gradients_are_burn_s_bit_by_bit() {
    type Product = fn(Tensor<2>, Tensor<2>) -> Tensor<2>;
    let (left, right) = (rows(5, 4), rows(5, 5)); // [7, 5] and the transpose of [7, 5]
    let of = |multiply: Product| {
        let device = tracked_device();
        let left = tensor(left.clone(), 5, &device).require_grad();
        let right = tensor(right.clone(), 5, &device).require_grad();
        let product = multiply(left.clone(), right.clone().transpose());
        let mut gradients = product.clone().square().sum().backward();
        let mut gradient = |of: &Tensor<2>| values(of.grad_remove(&mut gradients).unwrap());
        (values(product), gradient(&left), gradient(&right))
    };
    assert_eq!(of(fused::product), of(Tensor::matmul));
}

#[test]
fn gradients_of_an_elu_network() {
    let shape = Shape::new(3, &[5, 4], 2, Activation::Elu);
    let inputs = rows(3, 1);
    let found = deviation(&shape, &weights(&shape), |network| {
        network
            .forward(tensor(inputs.clone(), 3, &tracked_device()))
            .square()
            .sum()
    });
    assert!(found < 2e-3, "{found}");
}

#[test]
fn the_input_gradient_is_that_of_the_output() {
    // ∂D/∂x by central differences of the outputs, row by row
    let shape = Shape::new(3, &[6, 5], 1, Activation::Relu);
    let flat = weights(&shape);
    let inputs = rows(3, 2);
    let network = Mlp::new(&shape, &flat, &tracked_device()).expect("weights of this shape");
    let forward = |inputs: Vec<f32>| network.forward_all(tensor(inputs, 3, &tracked_device()));
    let gradient = values(network.input_gradient(&forward(inputs.clone()).hidden));
    for i in 0..inputs.len() {
        let at = |x: f32| {
            let mut moved = inputs.clone();
            moved[i] = x;
            values(forward(moved).output)[i / 3]
        };
        let difference = (at(inputs[i] + 1e-3) - at(inputs[i] - 1e-3)) / 2e-3;
        assert!(
            (difference - gradient[i]).abs() < 2e-3,
            "{i}: {difference} {}",
            gradient[i]
        );
    }
}

#[test]
fn gradients_of_the_input_gradients_length() {
    // What the gradient penalty needs. Differences stay on one side of every kink for this seed and step.
    let shape = Shape::new(3, &[6, 5], 1, Activation::Relu);
    let inputs = rows(3, 2);
    let found = deviation(&shape, &weights(&shape), |network| {
        let forward = network.forward_all(tensor(inputs.clone(), 3, &tracked_device()));
        network.input_gradient(&forward.hidden).square().sum()
    });
    assert!(found < 2e-3, "{found}");
}

#[test]
fn shards_add_up_to_the_whole() {
    let shape = Shape::new(3, &[16, 8], 1, Activation::Elu);
    let flat = weights(&shape);
    let inputs = rows(3, 3);
    let gradient = |inputs: &[f32]| {
        differentiate(&shape, &flat, |network| {
            network
                .forward(tensor(inputs.to_vec(), 3, &tracked_device()))
                .square()
                .sum()
        })
        .1
    };
    let whole = gradient(&inputs);
    let sharded = || {
        let parts = shards::run(&mut [(); 3], |i, ()| {
            let part = shards::part(ROWS, i, 3);
            gradient(&inputs[part.start * 3..part.end * 3])
        });
        (0..whole.len())
            .map(|i| parts.iter().map(|part| part[i]).sum())
            .collect::<Vec<f32>>()
    };
    let first = sharded();
    for (a, b) in whole.iter().zip(&first) {
        assert!((a - b).abs() < 1e-4 * (1.0 + a.abs()));
    }
    // Side by side or not: the same bits each time.
    for _ in 0..20 {
        assert_eq!(first, sharded());
    }
}

#[test]
fn weights_come_back_bit_by_bit() {
    let shape = Shape::new(4, &[3, 5], 2, Activation::Elu);
    let flat = weights(&shape);
    let network = Mlp::new(&shape, &flat, &tracked_device()).expect("weights of this shape");
    let mut out = Vec::new();
    network.export(&mut out);
    let bits = |x: &[f32]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&flat), bits(&out));
    assert!(Mlp::new(&shape, &flat[1..], &tracked_device()).is_err());
}

#[test]
fn large_inputs_have_finite_gradients() {
    // burn's own ELU gives NaN here
    let shape = Shape::new(1, &[2], 1, Activation::Elu);
    let (loss, gradient) =
        differentiate(&shape, &[1.0, -1.0, 0.0, 0.0, 1.0, 1.0, 0.0], |network| {
            network
                .forward(tensor(vec![200.0, -200.0], 1, &tracked_device()))
                .sum()
        });
    assert_eq!(loss, 398.0); // 200 − 1 twice
    assert!(gradient.iter().all(|g| g.is_finite()));
}
