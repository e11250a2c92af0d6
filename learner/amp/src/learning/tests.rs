//! Whole iterations: the same bits again, through a saved state, and after a failure.

mod critic;
mod saved;

use super::*;
use crate::config::OffPolicy;
use crate::robot::tests::{ACTION, OBSERVATION, simple};
use rand::RngExt;
use vocabulary::Cause;

fn config() -> LearningConfig {
    let mut config = LearningConfig::default();
    config.policy.hidden = vec![16, 8];
    config.policy.critic_hidden = vec![16];
    config.ppo.minibatch = 32;
    config.ppo.epochs = 2;
    config.discriminator.hidden = vec![16];
    config.discriminator.batch = 24;
    config.discriminator.steps = 2;
    config.discriminator.replay_capacity = 100;
    config.discriminator.replay_insert = 30;
    config
}

fn learning() -> Learning {
    Learning::new(config(), simple(), 11).expect("usable")
}

/// Two rollouts of 6 steps of 5 robots: plausible numbers, a fall and a time-out.
fn batch(learning: &Learning, seed: u64) -> Batch {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut batch = Batch::new(simple().widths());
    batch.resize(2, 6, 5);
    let sigma = learning.sigma();
    let mut draw = |numbers: &mut [f32], low: f32, high: f32| {
        numbers
            .iter_mut()
            .for_each(|x| *x = rng.random_range(low..high));
    };
    for part in [
        &mut batch.observations,
        &mut batch.features,
        &mut batch.next_features,
        &mut batch.last_observations,
        &mut batch.timeout_observations,
        &mut batch.actions,
    ] {
        draw(part, -1.0, 1.0);
    }
    for part in [
        &mut batch.task_rewards,
        &mut batch.energies,
        &mut batch.tracking_errors,
    ] {
        draw(part, 0.0, 1.0);
    }
    batch.episode_steps.fill(40.0);
    (batch.ends[7], batch.ends[44]) = (Cause::Fall.code(), Cause::TimeOut.code());
    batch.episode_steps[44] = 100.0;
    for (row, log_prob) in batch.log_probs.iter_mut().enumerate() {
        let action = &batch.actions[row * ACTION..][..ACTION];
        *log_prob = action
            .iter()
            .zip(&sigma)
            .map(|(a, s)| -0.5 * (a / s).powi(2) - s.ln() - 0.5 * std::f32::consts::TAU.ln())
            .sum();
    }
    batch
}

const RULE: Rule = Rule::Guided { ceiling: 1.0 };

/// Iterations `from..to`, each with its own batch and experts; returns the last report.
fn run(learning: &mut Learning, from: u64, to: u64) -> IterationReport {
    let mut last = None;
    for i in from..to {
        let batch = batch(learning, i);
        let mut rng = Pcg64::seed_from_u64(1000 + i);
        let mut experts = |rows: &mut [f32]| {
            rows.iter_mut()
                .for_each(|x| *x = rng.random_range(-1.0..1.0))
        };
        let report = learning.iterate(&batch, &mut experts, RULE, Granularity::Sample);
        last = Some(report.expect("finite"));
    }
    last.expect("at least one iteration")
}

#[test]
fn the_same_inputs_give_the_same_bits() {
    let (mut a, mut b) = (learning(), learning());
    assert_eq!(run(&mut a, 0, 4), run(&mut b, 0, 4));
    assert_eq!(a.save(), b.save());
    let first = a.policy_flat().to_vec();
    assert_eq!(first, b.policy_flat());
    assert!(first.iter().all(|x| x.is_finite()));
    run(&mut a, 4, 5);
    assert_ne!(first, a.policy_flat());
}

#[test]
fn v_trace_changes_what_an_older_policy_made_and_hardly_what_the_present_one_did() {
    let returns = |off_policy, older: f32| {
        let mut config = config();
        config.ppo.off_policy = off_policy;
        let mut learning = Learning::new(config, simple(), 11).expect("usable");
        let mut batch = batch(&learning, 0);
        // What first actors answer is near 0, and so are these actions: their density is that of the mean.
        batch.actions.fill(0.0);
        let half_log_tau = 0.5 * std::f32::consts::TAU.ln();
        let density: f32 = learning
            .sigma()
            .iter()
            .map(|s| -s.ln() - half_log_tau)
            .sum();
        // As if the policy that acted had been so much surer.
        batch.log_probs.fill(density + older);
        let mut experts = |rows: &mut [f32]| rows.fill(0.5);
        let report = learning.iterate(&batch, &mut experts, RULE, Granularity::Sample);
        report.expect("finite");
        learning.scratch.returns
    };
    let distance = |older| {
        let ignored = returns(OffPolicy::Ignored, older);
        let corrected = returns(OffPolicy::VTrace, older);
        let pairs = ignored.iter().zip(&corrected);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    assert!(distance(0.0) < 0.05, "{}", distance(0.0));
    assert!(distance(2.0) > 0.1, "{}", distance(2.0));
}

#[test]
fn a_bad_batch_or_a_failed_update_changes_nothing() {
    let mut learning = learning();
    run(&mut learning, 0, 2);
    let before = learning.save();
    let mut bad = batch(&learning, 2);
    bad.actions[3 * ACTION + 1] = f32::NAN;
    let mut no_experts = |_: &mut [f32]| unreachable!("the batch is refused before");
    let error = learning.iterate(&bad, &mut no_experts, RULE, Granularity::Sample);
    assert!(
        error
            .expect_err("NaN")
            .to_string()
            .starts_with("field `actions` of the batch, row 3, holds NaN")
    );

    let good = batch(&learning, 2);
    let mut broken_experts = |rows: &mut [f32]| rows.fill(f32::INFINITY);
    let error = learning.iterate(&good, &mut broken_experts, RULE, Granularity::Sample);
    assert_eq!(
        error.expect_err("infinite experts"),
        LearningError::NotFinite {
            what: "expert window 0".to_owned(),
            value: f64::INFINITY,
            iteration: 2
        }
    );
    // Far too large a reward: the gradient overflows, after weights may have moved already.
    let mut huge = batch(&learning, 2);
    huge.task_rewards[0] = 1e38;
    huge.task_rewards[1] = -1e38;
    let error = learning.iterate(
        &huge,
        &mut |rows| rows.fill(0.0),
        Rule::Fixed { style_weight: 0.0 },
        Granularity::Sample,
    );
    assert!(
        matches!(error, Err(LearningError::NotFinite { .. })),
        "{error:?}"
    );
    assert_eq!(learning.save(), before);
}

/// Makes an optimizer put an infinite number into the first weight that it moves.
fn spoil(adam: &mut networks::Adam) {
    let mut state = adam.state().clone();
    state.first[0] = f32::INFINITY;
    adam.restore(state).expect("the same length");
}

#[test]
fn a_weight_that_breaks_in_an_update_is_named_and_the_good_ones_are_kept() {
    for (in_policy, name) in [
        (true, "actor.layers.0.weight"),
        (false, "discriminator.layers.0.weight"),
    ] {
        let mut learning = learning();
        run(&mut learning, 0, 2);
        if in_policy {
            spoil(learning.core.ppo.state_mut().1);
        } else {
            spoil(learning.core.discriminator.state_mut().1);
        }
        let before = learning.save();
        let policy = learning.policy_flat().to_vec();
        let next = batch(&learning, 2);
        let error = learning.iterate(
            &next,
            &mut |rows: &mut [f32]| rows.fill(0.0),
            RULE,
            Granularity::Sample,
        );
        match error {
            Err(LearningError::NotFinite { what, .. }) => assert_eq!(what, name),
            other => panic!("{other:?}"),
        }
        assert_eq!(learning.save(), before);
        assert_eq!(learning.policy_flat(), policy);
        assert!(policy.iter().all(|weight| weight.is_finite()));
    }
}

#[test]
fn the_report_counts_what_the_batch_holds() {
    let mut learning = learning();
    let batch = batch(&learning, 0);
    let mut experts = |rows: &mut [f32]| rows.fill(0.1);
    let report = learning
        .iterate(
            &batch,
            &mut experts,
            Rule::Fixed { style_weight: 0.25 },
            Granularity::Mean,
        )
        .expect("finite");
    assert_eq!((report.iteration, report.samples, report.rows), (1, 60, 60));
    let told = toml::Table::try_from(&report).expect("a record");
    let ended = ["fall", "time_out", "stray", "fault"]
        .map(|cause| told[&format!("termination/{cause}")].as_integer());
    assert_eq!(ended, [Some(1), Some(1), Some(0), Some(0)]);
    assert_eq!(report.episode_length, Some(70.0)); // (40 + 100) / 2
    assert_eq!(report.style_weight, 0.25);
    let mean = |x: &[f32]| x.iter().map(|x| f64::from(*x)).sum::<f64>() / 60.0;
    assert!((report.energy_j - 1000.0 * mean(&batch.energies)).abs() < 1e-6);
    assert!((report.rmse.powi(2) - mean(&batch.tracking_errors)).abs() < 1e-9);
    let squares: Vec<f32> = batch.task_rewards.iter().map(|x| x * x).collect();
    let variance = mean(&squares) - mean(&batch.task_rewards).powi(2);
    assert!(variance > 0.05 && (report.task_std.powi(2) - variance).abs() < 1e-6);
    let blended = 0.75 * report.task_mean + 0.25 * report.style_mean;
    assert!((report.reward_mean - blended).abs() < 1e-6);
    assert!(report.style_min <= report.style_mean && report.style_mean <= report.style_max);
    assert!(report.kl >= 0.0 && report.gradient_norm > 0.0);
    assert_eq!(report.asymmetry, None); // off by default, and then not measured
}

#[test]
fn the_symmetry_loss_is_told_where_it_is_measured() {
    let mut config = config();
    config.ppo.symmetry_weight = 1.0;
    for (mirrored_share, told) in [(0.0, true), (0.5, false)] {
        // Every other row mirrored: those of the quarter that would be lessons are among them.
        config.ppo.mirrored_share = mirrored_share.into();
        let mut learning = Learning::new(config.clone(), simple(), 11).expect("usable");
        let batch = batch(&learning, 0);
        let mut experts = |rows: &mut [f32]| rows.fill(0.1);
        let report = learning
            .iterate(&batch, &mut experts, RULE, Granularity::Sample)
            .expect("finite");
        assert_eq!(
            report.asymmetry.is_some_and(|loss| loss > 0.0),
            told,
            "{:?}",
            report.asymmetry
        );
    }
}

#[test]
fn the_policy_is_told_with_its_statistics() {
    let mut learning = learning();
    let flat = learning.policy_flat().to_vec();
    // Before any batch: mean 0, inverse deviation 1, σ 0.6 for legs, 0.18 for waist and arms.
    assert!(
        flat[..OBSERVATION].iter().all(|x| *x == 0.0)
            && flat[OBSERVATION..2 * OBSERVATION].iter().all(|x| *x == 1.0)
    );
    assert_eq!(flat[164], 0.6);
    assert!((flat[164 + 22] - 0.18).abs() < 1e-6);
    let mean = |learning: &mut Learning| learning.policy_flat()[2];
    let batch = batch(&learning, 0);
    learning
        .iterate(
            &batch,
            &mut |rows| rows.fill(0.1),
            RULE,
            Granularity::Sample,
        )
        .expect("finite");
    let column: f32 = (0..60)
        .map(|row| batch.observations[row * OBSERVATION + 2])
        .sum::<f32>()
        / 60.0;
    assert!((mean(&mut learning) - column).abs() < 1e-5);
    // Columns 0 and 1 are each other's mirror image here, so their statistics agree.
    let flat = learning.policy_flat();
    assert_eq!(flat[0], flat[1]);
}
