//! Every key of learning that a resume may change really counts after it.

use std::collections::BTreeSet;

use amp::{Batch, LearningConfig};
use ampco::Granularity;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use run::Config;
use run::resume::{Rule, rule};
use vocabulary::Cause;

use super::*;

/// Small networks, and a schedule of exploration in the middle of which the state is.
const BASE: &str = "
[policy]
hidden = [8]
critic_hidden = [8]
[exploration]
sigma = { from = 0.6, to = 0.2, samples = [0.0, 1000.0] }
[ppo]
minibatch = 32
epochs = 2
[discriminator]
hidden = [8]
batch = 24
steps = 2
replay_capacity = 100
replay_insert = 30
command_blur = [0.1, 0.1, 0.1]
";

/// A key, what has to be set for it to matter, and another value.
const CASES: &[(&str, &str, &str)] = &[
    ("policy.observation_clip", "", "0.1"),
    ("exploration.sigma.from", "", "0.5"),
    ("exploration.sigma.to", "", "0.1"),
    ("exploration.sigma.samples", "", "[500.0, 1000.0]"),
    ("exploration.waist_factor", "", "0.5"),
    ("exploration.arm_factor", "", "0.5"),
    ("ppo.gamma", "", "0.5"),
    ("ppo.lambda", "", "0.5"),
    ("ppo.reward_scale", "", "0.5"),
    ("ppo.clip", "", "0.001"),
    ("ppo.epochs", "", "3"),
    ("ppo.minibatch", "", "16"),
    ("ppo.learning_rate", "", "2e-5"),
    ("ppo.schedule", "", "fixed"),
    ("ppo.kl_target", "", "1e-9"),
    ("ppo.mirrored_share", "", "0.0"),
    ("ppo.critic_first", "", "1e9"),
    ("ppo.symmetry_weight", "ppo.mirrored_share=0.0", "0.5"),
    ("ppo.symmetry_share", "ppo.symmetry_weight=0.5", "0.75"),
    ("ppo.off_policy", "", "v_trace"),
    ("ppo.threads", "", "3"),
    ("discriminator.steps", "", "3"),
    ("discriminator.batch", "", "16"),
    ("discriminator.learning_rate", "", "1e-2"),
    ("discriminator.gradient_penalty", "", "1.0"),
    ("discriminator.replay_capacity", "", "40"),
    ("discriminator.replay_insert", "", "20"),
];

fn sections(config: &Config) -> LearningConfig {
    LearningConfig {
        policy: config.section().unwrap(),
        exploration: config.section().unwrap(),
        ppo: config.section().unwrap(),
        discriminator: config.section().unwrap(),
    }
}

fn learning(config: &Config) -> Learning {
    Learning::new(sections(config), robot(&Tables::default()), 3).unwrap()
}

/// One iteration on a rollout of 12 steps of 5 robots.
fn iterate(learning: &mut Learning, seed: u64, width: usize) {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let mut batch = Batch::new(robot(&Tables::default()).widths());
    batch.resize(1, 12, 5);
    for part in [
        &mut batch.observations,
        &mut batch.features,
        &mut batch.next_features,
        &mut batch.last_observations,
        &mut batch.timeout_observations,
        &mut batch.actions,
        &mut batch.task_rewards,
    ] {
        part.iter_mut()
            .for_each(|x| *x = rng.random_range(-1.0..1.0));
    }
    // Near the density of the policy that acts, whose means are near 0.
    let sigma = learning.sigma();
    let actions = batch.actions.chunks_exact(g1::ACTION);
    for (log_prob, action) in batch.log_probs.iter_mut().zip(actions) {
        let log = |(a, s): (&f32, &f32)| {
            -0.5 * (a / s).powi(2) - s.ln() - 0.5 * std::f32::consts::TAU.ln()
        };
        *log_prob = action.iter().zip(&sigma).map(log).sum();
    }
    batch.episode_steps.fill(40.0);
    (batch.ends[7], batch.ends[44]) = (Cause::Fall.code(), Cause::TimeOut.code());
    let mut experts = |rows: &mut [f32]| {
        assert!(rows.len().is_multiple_of(width));
        rows.iter_mut()
            .for_each(|x| *x = rng.random_range(-1.0..1.0));
    };
    let weighting = ampco::Rule::Fixed { style_weight: 0.5 };
    learning
        .iterate(&batch, &mut experts, weighting, Granularity::Sample)
        .unwrap();
}

/// What an iteration after a resume leaves, of a state that was learned under `before` and goes on under `after`.
fn resumed(before: &Config, after: &Config) -> (Vec<u8>, Vec<f32>) {
    let width = sections(before).discriminator.width(g1::FEATURES);
    let mut first = learning(before);
    iterate(&mut first, 1, width);
    iterate(&mut first, 2, width);
    let mut second = learning(after);
    second.load(&first.save()).unwrap();
    second.retune(&sections(before).ppo);
    iterate(&mut second, 3, width);
    (second.save(), second.policy_flat().to_vec())
}

#[test]
fn what_a_resume_may_change_changes_what_is_learned() {
    let mut ignored = Vec::new();
    for (key, needs, value) in CASES {
        let mut before = Config::parse(BASE, "a test").unwrap();
        if !needs.is_empty() {
            before.set(needs).unwrap();
        }
        let mut after = before.clone();
        after.set(&format!("{key}={value}")).unwrap();
        if resumed(&before, &after) == resumed(&before, &before) {
            ignored.push(*key);
        }
    }
    assert_eq!(ignored, [""; 0]);
}

#[test]
fn every_key_that_may_change_is_among_them() {
    let mut config = Config::parse(BASE, "a test").unwrap();
    let given = config.clone();
    let sections = sections(&Config::parse(BASE, "a test").unwrap());
    config.resolve(&sections.policy);
    config.resolve(&sections.exploration);
    config.resolve(&sections.ppo);
    config.resolve(&sections.discriminator);
    // Every default, and what is given beside them.
    config.merge(given);
    let leaves = config.leaves();
    let may_change = |path: &&str| matches!(rule(path), Some(Rule::Free | Rule::While(..)));
    let free: BTreeSet<&str> = leaves
        .keys()
        .map(String::as_str)
        .filter(may_change)
        .collect();
    let tried: BTreeSet<&str> = CASES.iter().map(|(key, ..)| *key).collect();
    assert_eq!(tried, free);
}
