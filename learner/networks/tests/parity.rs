//! The actors' inference computes what the learner's network computes, from the same snapshot.

use networks::{
    Activation, Mlp, Normalizer, Shape, orthogonal, plain_device, snapshot, tensor, values,
};
use rand::{RngExt, SeedableRng};

/// Numbers of an observation; any number would do.
const INPUTS: usize = 29;

#[test]
fn a_snapshot_means_the_same_to_both_readers() {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(4);
    let shape = Shape::new(INPUTS, &[256, 128, 64], policy::OUTPUTS, Activation::Elu);
    let weights = orthogonal(&shape, 2.0_f32.sqrt(), 0.5, &mut rng);
    let rows: Vec<f32> = (0..100 * INPUTS)
        .map(|_| rng.random_range(-3.0..3.0))
        .collect();
    let mut normalizer = Normalizer::new(vec![0.01; INPUTS], 1.5);
    normalizer.update(&rows[..50 * INPUTS]);
    let scaling = normalizer.scaling();
    let mut flat = Vec::new();
    snapshot::export(&scaling, &[0.3; policy::OUTPUTS], &weights, &mut flat);

    let mut policy = policy::Policy::new(policy::Shape::new(INPUTS, &[256, 128, 64]), scaling.clip);
    policy.load(&flat).expect("a snapshot of this shape");
    let mut theirs = vec![0.0; 100 * policy::OUTPUTS];
    policy.means(&rows, 100, &mut theirs);

    let parts = snapshot::import(&shape, &flat).expect("the snapshot just written");
    let network = Mlp::new(&shape, parts.actor, &plain_device()).expect("weights of this shape");
    let mut scaled = Vec::new();
    scaling.apply(&rows, &mut scaled);
    let ours = values(network.forward(tensor(scaled, INPUTS, &plain_device())));

    let largest = ours.iter().fold(0.0_f32, |a, x| a.max(x.abs()));
    assert!(largest > 0.1, "outputs near zero would agree by themselves");
    for (ours, theirs) in ours.iter().zip(&theirs) {
        assert!((ours - theirs).abs() < 1e-5, "{ours} {theirs}");
    }
}
