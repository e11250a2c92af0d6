//! The network against hand values, against plain loops, and against itself in other batches.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::*;

/// Numbers that the policies here see.
const INPUTS: usize = 82;

/// Weights of a plausible network: means near zero, layers scaled by √(1/in), σ between 0.2 and 1.
fn random_weights(shape: &Shape, seed: u64) -> Vec<f32> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut flat = vec![0.0; shape.len()];
    flat[shape.mean()]
        .iter_mut()
        .for_each(|x| *x = rng.random_range(-1.0..1.0));
    flat[shape.inverse_deviation()]
        .iter_mut()
        .for_each(|x| *x = rng.random_range(0.5..3.0));
    flat[shape.sigma()]
        .iter_mut()
        .for_each(|x| *x = rng.random_range(0.2..1.0));
    for place in shape.layers() {
        let scale = (3.0 / place.inputs as f32).sqrt();
        flat[place.weights]
            .iter_mut()
            .for_each(|x| *x = rng.random_range(-scale..scale));
        flat[place.bias]
            .iter_mut()
            .for_each(|x| *x = rng.random_range(-0.5..0.5));
    }
    flat
}

fn random_observations(n: usize, seed: u64) -> Vec<f32> {
    let mut rng = Pcg64::seed_from_u64(seed);
    (0..n * INPUTS)
        .map(|_| rng.random_range(-3.0..3.0))
        .collect()
}

fn loaded(shape: &Shape, flat: &[f32]) -> Policy {
    clipping(shape, flat, 5.0)
}

fn clipping(shape: &Shape, flat: &[f32], clip: f32) -> Policy {
    let mut policy = Policy::new(shape.clone(), clip);
    policy.load(flat).unwrap();
    policy
}

fn means(policy: &mut Policy, observations: &[f32]) -> Vec<f32> {
    let n = observations.len() / INPUTS;
    let mut out = vec![f32::NAN; n * OUTPUTS];
    policy.means(observations, n, &mut out);
    out
}

/// The definition, in double precision and plain loops over the flat vector.
fn reference(shape: &Shape, flat: &[f32], observation: &[f32]) -> Vec<f64> {
    let at = |index: usize| f64::from(flat[index]);
    let mut values: Vec<f64> = (0..INPUTS)
        .map(|i| ((f64::from(observation[i]) - at(i)) * at(INPUTS + i)).clamp(-5.0, 5.0))
        .collect();
    let widths: Vec<usize> = shape.hidden.iter().copied().chain([OUTPUTS]).collect();
    let mut start = 2 * INPUTS + OUTPUTS;
    for (layer, &outputs) in widths.iter().enumerate() {
        let bias = start + values.len() * outputs;
        let sums = (0..outputs).map(|j| {
            (0..values.len())
                .map(|i| values[i] * at(start + i * outputs + j))
                .sum::<f64>()
                + at(bias + j)
        });
        let last = layer + 1 == widths.len();
        values = sums
            .map(|sum| if last || sum > 0.0 { sum } else { sum.exp_m1() })
            .collect();
        start = bias + outputs;
    }
    values
}

#[test]
fn a_network_of_one_unit_by_hand() {
    let shape = Shape::new(INPUTS, &[1]);
    let mut flat = vec![0.0; shape.len()];
    flat[shape.inverse_deviation()].fill(2.0);
    flat[shape.sigma()].fill(1.0);
    flat[0] = 1.0; // mean of the first observation
    let layers: Vec<_> = shape.layers().collect();
    flat[layers[0].weights.start] = 0.5; // first observation → unit
    flat[layers[0].weights.start + 1] = 1.0; // second observation → unit
    flat[layers[0].bias.start] = -1.0;
    flat[layers[1].weights.start + 4] = 3.0; // unit → action 4
    flat[layers[1].bias.start + 4] = 0.25;
    let mut policy = loaded(&shape, &flat);
    let mut action = |first, second| {
        let mut observation = [0.0; INPUTS];
        (observation[0], observation[1]) = (first, second);
        let out = means(&mut policy, &observation);
        assert!(out.iter().enumerate().all(|(i, &a)| i == 4 || a == 0.0));
        out[4]
    };
    // (2 − 1)·2 = 2, 1·2 = 2: unit 0.5·2 + 2 − 1 = 2, action 3·2 + 0.25
    assert_eq!(action(2.0, 1.0), 6.25);
    // (1 − 1)·2 = 0, 0: unit −1 → e⁻¹ − 1 = −0.6321206, action −1.8963617 + 0.25
    assert!((action(1.0, 0.0) + 1.646_361_7).abs() < 1e-6);
    // Both clipped: 5 and −5: unit 2.5 − 5 − 1 = −3.5 → e⁻³·⁵ − 1 = −0.9698026, action −2.9094079 + 0.25
    assert!((action(100.0, -100.0) + 2.659_407_9).abs() < 1e-6);
}

#[test]
fn it_agrees_with_plain_loops() {
    for hidden in [&[][..], &[1], &[33, 31], &[256, 128, 64], &[512, 256, 128]] {
        let shape = Shape::new(INPUTS, hidden);
        let flat = random_weights(&shape, 3);
        let observations = random_observations(101, 4);
        let out = means(&mut loaded(&shape, &flat), &observations);
        for (row, out) in observations
            .chunks_exact(INPUTS)
            .zip(out.chunks_exact(OUTPUTS))
        {
            for (expected, &found) in reference(&shape, &flat, row).iter().zip(out) {
                assert!(
                    (expected - f64::from(found)).abs() < 1e-5,
                    "{hidden:?}: {found} for {expected}"
                );
            }
        }
    }
}

#[test]
fn a_row_has_the_same_bits_in_every_batch() {
    let shape = Shape::new(INPUTS, &[64, 40]);
    let mut policy = loaded(&shape, &random_weights(&shape, 5));
    let observations = random_observations(300, 6);
    let alone: Vec<f32> = observations
        .chunks_exact(INPUTS)
        .flat_map(|row| means(&mut policy, row))
        .collect();
    for n in [2, 3, 11, 12, 13, 95, 96, 97, 256, 300] {
        let together = means(&mut policy, &observations[..n * INPUTS]);
        assert!(
            together
                .iter()
                .zip(&alone)
                .all(|(a, b)| a.to_bits() == b.to_bits()),
            "batch of {n}"
        );
        // Also away from the batch's start.
        let last = means(&mut policy, &observations[(300 - n) * INPUTS..]);
        assert!(
            last.iter()
                .rev()
                .zip(alone.iter().rev())
                .all(|(a, b)| a.to_bits() == b.to_bits())
        );
    }
}

#[test]
fn samples_repeat_with_the_seed_and_their_density_is_that_of_the_action() {
    let shape = Shape::new(INPUTS, &[32]);
    let flat = random_weights(&shape, 7);
    let mut policy = loaded(&shape, &flat);
    let n = 50;
    let observations = random_observations(n, 8);
    let mut draw = |seed| {
        let (mut actions, mut means) = (vec![0.0; n * OUTPUTS], vec![0.0; n * OUTPUTS]);
        let mut log_probs = vec![0.0; n];
        let mut rng = Pcg64::seed_from_u64(seed);
        policy.sample(
            &observations,
            20,
            &mut rng,
            &mut actions,
            &mut means,
            &mut log_probs,
        );
        (actions, means, log_probs)
    };
    let (actions, drawn_means, log_probs) = draw(1);
    assert_eq!(
        draw(1),
        (actions.clone(), drawn_means.clone(), log_probs.clone())
    );
    assert_ne!(draw(2).0, actions);
    for row in 0..n {
        let at = |values: &[f32], i: usize| f64::from(values[row * OUTPUTS + i]);
        let expected: f64 = (0..OUTPUTS)
            .map(|i| {
                // The last twenty explore half as widely.
                let part = if row < 30 { 1.0 } else { 0.5 };
                let sigma = part * f64::from(flat[shape.sigma().start + i]);
                let z = (at(&actions, i) - at(&drawn_means, i)) / sigma;
                -0.5 * z * z - sigma.ln() - 0.5 * std::f64::consts::TAU.ln()
            })
            .sum();
        assert!((expected - f64::from(log_probs[row])).abs() < 1e-4);
    }
    assert_eq!(means(&mut policy, &observations), drawn_means);
}

#[test]
fn refused_weights_leave_the_old_ones() {
    let shape = Shape::new(INPUTS, &[8]);
    let good = random_weights(&shape, 9);
    let mut policy = loaded(&shape, &good);
    let observations = random_observations(3, 10);
    let before = means(&mut policy, &observations);

    let expected = shape.len();
    assert_eq!(
        policy.load(&good[1..]),
        Err(PolicyError::Length {
            expected,
            found: expected - 1
        })
    );
    let mut bad = good.clone();
    bad[200] = f32::NAN;
    assert!(matches!(
        policy.load(&bad),
        Err(PolicyError::NotFinite { index: 200, .. })
    ));
    bad[200] = f32::INFINITY;
    assert!(matches!(
        policy.load(&bad),
        Err(PolicyError::NotFinite { index: 200, .. })
    ));
    bad[200] = 0.0;
    bad[shape.sigma().start + 5] = 0.0;
    assert_eq!(
        policy.load(&bad),
        Err(PolicyError::Deviation {
            action: 5,
            value: 0.0
        })
    );

    assert_eq!(means(&mut policy, &observations), before);
}

#[test]
fn a_nan_observation_spoils_its_own_row_only() {
    let shape = Shape::new(INPUTS, &[16, 16]);
    let mut policy = loaded(&shape, &random_weights(&shape, 11));
    let mut observations = random_observations(14, 12);
    let clean = means(&mut policy, &observations);
    observations[5 * INPUTS + 40] = f32::NAN;
    let out = means(&mut policy, &observations);
    assert!(out[5 * OUTPUTS..6 * OUTPUTS].iter().all(|a| a.is_nan()));
    assert_eq!(out[..5 * OUTPUTS], clean[..5 * OUTPUTS]);
    assert_eq!(out[6 * OUTPUTS..], clean[6 * OUTPUTS..]);
}

#[test]
fn without_weights_the_mean_action_is_zero() {
    let out = means(
        &mut Policy::new(Shape::new(INPUTS, &[512, 256, 128]), 5.0),
        &random_observations(2, 13),
    );
    assert!(out.iter().all(|&action| action == 0.0));
}

#[test]
fn observations_are_cut_to_the_clip_that_the_weights_were_trained_with() {
    // A linear policy whose action 2 is the first observation, normalised by mean 0 and deviation 1.
    let shape = Shape::new(INPUTS, &[]);
    let mut flat = vec![0.0; shape.len()];
    flat[shape.inverse_deviation()].fill(1.0);
    flat[shape.sigma()].fill(1.0);
    let layer = shape.layers().next().unwrap();
    flat[layer.weights.start + 2] = 1.0;
    let mut observation = [0.0; INPUTS];
    for (clip, seen, expected) in [
        (1.5, 100.0, 1.5),
        (1.5, -100.0, -1.5),
        (1.5, 1.25, 1.25),
        (5.0, 100.0, 5.0),
        (20.0, 7.0, 7.0), // 5 is nobody's limit but the default's
    ] {
        let mut policy = clipping(&shape, &flat, clip);
        assert_eq!(policy.clip(), clip);
        observation[0] = seen;
        assert_eq!(means(&mut policy, &observation)[2], expected);
    }
    for clip in [0.0, -5.0, f32::INFINITY, f32::NAN] {
        let refused = Policy::check_clip(clip).unwrap_err().to_string();
        assert!(refused.contains(&format!("{clip}")), "{refused}");
    }
}
