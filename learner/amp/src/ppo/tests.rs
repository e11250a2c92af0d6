//! PPO on cases whose answer is known.

use super::*;
use crate::config::{PolicyConfig, RateSchedule};
use crate::robot::tests::{ACTION, OBSERVATION, simple};
use networks::{Mlp, tensor};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

fn config() -> LearningConfig {
    LearningConfig {
        policy: PolicyConfig {
            hidden: vec![16],
            critic_hidden: vec![16],
            ..Default::default()
        },
        ppo: PpoConfig {
            schedule: RateSchedule::Fixed,
            learning_rate: 1e-2,
            minibatch: 64,
            ..Default::default()
        },
        ..Default::default()
    }
}

fn ppo(config: &LearningConfig) -> Ppo {
    Ppo::new(config, &simple(), &mut Pcg64::seed_from_u64(1))
}

fn means(ppo: &Ppo, observations: &[f32]) -> Vec<f32> {
    let device = networks::plain_device();
    let network = Mlp::new(&ppo.actor, ppo.actor(), &device).expect("weights of this shape");
    values(network.forward(tensor(observations.to_vec(), OBSERVATION, &device)))
}

/// Rows of a bandit: one observation, actions drawn with σ, paid by `reward`.
struct Bandit {
    observations: Vec<f32>,
    actions: Vec<f32>,
    means: Vec<f32>,
    log_probs: Vec<f32>,
    rewards: Vec<f32>,
}

impl Bandit {
    fn play(ppo: &Ppo, sigma: f32, rng: &mut Pcg64, reward: impl Fn(&[f32]) -> f32) -> Self {
        let observations: Vec<f32> = (0..64 * OBSERVATION)
            .map(|i| if i % OBSERVATION < 3 { 1.0 } else { 0.0 })
            .collect();
        let means = means(ppo, &observations);
        let actions: Vec<f32> = means
            .iter()
            .map(|mean| mean + sigma * Distribution::<f32>::sample(&StandardNormal, rng))
            .collect();
        let at_mean = -(ACTION as f32) * (sigma.ln() + 0.5 * std::f32::consts::TAU.ln());
        let rows = actions.chunks_exact(ACTION).zip(means.chunks_exact(ACTION));
        let log_probs = rows
            .map(|(a, m)| {
                at_mean
                    - 0.5
                        * a.iter()
                            .zip(m)
                            .map(|(a, m)| ((a - m) / sigma).powi(2))
                            .sum::<f32>()
            })
            .collect();
        let rewards = actions.chunks_exact(ACTION).map(reward).collect();
        Self {
            observations,
            actions,
            means,
            log_probs,
            rewards,
        }
    }

    fn rows(&self) -> Rows<'_> {
        Rows {
            observations: &self.observations,
            mirrored: &self.observations,
            critic: &[],
            mirrored_critic: &[],
            mirrored_share: 0.0,
            kl_target: config().ppo.kl_target.now(),
            critic_alone: false,
            actions: &self.actions,
            means: &self.means,
            log_probs: &self.log_probs,
            widths: &[],
            advantages: &self.rewards,
            returns: &self.rewards,
        }
    }
}

#[test]
fn a_bandit_is_won() {
    // Best action: 0.5 in every component. The distance has to shrink, and the critic to foresee the reward.
    let mut ppo = ppo(&config());
    let mut rng = Pcg64::seed_from_u64(2);
    let pay =
        |action: &[f32]| -action.iter().map(|a| (a - 0.5).powi(2)).sum::<f32>() / ACTION as f32;
    let distance = |ppo: &Ppo, bandit: &Bandit| -pay(&means(ppo, &bandit.observations)[..ACTION]);
    let first = Bandit::play(&ppo, 0.3, &mut rng, pay);
    let before = distance(&ppo, &first);
    let mut figures = Vec::new();
    for _ in 0..60 {
        let bandit = Bandit::play(&ppo, 0.3, &mut rng, pay);
        figures.push(
            ppo.update(&bandit.rows(), &[0.3; ACTION], &mut rng)
                .expect("finite"),
        );
    }
    assert!((before - 0.25).abs() < 0.02, "it starts near zero");
    assert!(distance(&ppo, &first) < 0.05, "{}", distance(&ppo, &first));
    let values = |i: usize| figures[i].value_loss;
    assert!(values(59) < 0.1 * values(0), "{} {}", values(0), values(59));
}

#[test]
fn one_step_moves_toward_the_better_action() {
    // Two kinds of action; the one with +1 in component 0 is better than the one with −1: the mean has to rise there.
    let mut config = config();
    config.ppo.epochs = 1;
    let mut ppo = ppo(&config);
    let mut rng = Pcg64::seed_from_u64(3);
    let bandit = Bandit::play(&ppo, 1.0, &mut rng, |action| action[0].signum());
    let before = means(&ppo, &bandit.observations)[0];
    let figures = ppo
        .update(&bandit.rows(), &[1.0; ACTION], &mut rng)
        .expect("finite");
    assert!(means(&ppo, &bandit.observations)[0] > before);
    // One step on one minibatch: every ratio was 1 when it was taken, so nothing was clipped and KL was 0,
    // and the surrogate is the mean of normalised advantages: 0.
    assert!(
        figures.surrogate.abs() < 1e-4 && figures.kl.abs() < 1e-6 && figures.clip_fraction == 0.0
    );
}

#[test]
fn mirrored_rows_teach_the_mirror_image() {
    // All rows mirrored; the mirror swaps components 0 and 1 with a minus. Paid for component 0, the policy has to learn
    // less of component 1. One update only: the policy that plays on has no symmetry to share with its mirror image.
    let mut ppo = ppo(&config());
    let mut rng = Pcg64::seed_from_u64(4);
    let bandit = Bandit::play(&ppo, 0.5, &mut rng, |action| action[0]);
    let rows = Rows {
        mirrored_share: 1.0,
        ..bandit.rows()
    };
    ppo.update(&rows, &[0.5; ACTION], &mut rng).expect("finite");
    let means = means(&ppo, &bandit.observations);
    assert!(
        means[1] < -0.05 && means[1] < -2.0 * means[0].abs(),
        "{:?}",
        &means[..3]
    );
}

#[test]
fn lessons_in_symmetry_make_the_policy_symmetric_and_spend_no_ratio() {
    // Paid for component 0 alone, the policy is not symmetric: that takes component 1 to be the opposite.
    let mut config = config();
    config.ppo.symmetry_share = 1.0;
    let mut rng = Pcg64::seed_from_u64(5);
    let pay = |action: &[f32]| -(action[0] - 0.5).powi(2);
    let mut ppo = ppo(&config);
    for _ in 0..20 {
        let bandit = Bandit::play(&ppo, 0.3, &mut rng, pay);
        ppo.update(&bandit.rows(), &[0.3; ACTION], &mut rng)
            .expect("finite");
    }
    let bandit = Bandit::play(&ppo, 0.3, &mut rng, pay);
    let off = |ppo: &Ppo| {
        let means = means(ppo, &bandit.observations);
        (means[0] + means[1]).abs()
    };
    let before = off(&ppo);
    assert!(before > 0.2, "{before}");
    ppo.config.symmetry_weight = 1.0;
    let figures = ppo
        .update(&bandit.rows(), &[0.3; ACTION], &mut rng)
        .expect("finite");
    assert!(off(&ppo) < 0.8 * before, "{} of {before}", off(&ppo));
    assert!(figures.asymmetry > Some(0.0) && figures.clip_fraction == 0.0);
}

#[test]
fn threads_change_only_the_order_of_sums() {
    let updated = |threads: usize| {
        let mut config = config();
        config.ppo.threads = threads;
        config.ppo.epochs = 2;
        let mut ppo = ppo(&config);
        let mut rng = Pcg64::seed_from_u64(5);
        let bandit = Bandit::play(&ppo, 0.3, &mut rng, |action| action[2]);
        ppo.update(&bandit.rows(), &[0.3; ACTION], &mut rng)
            .expect("finite");
        ppo.weights
    };
    assert_eq!(updated(2), updated(2));
    let pairs = updated(1).into_iter().zip(updated(3));
    assert!(
        pairs
            .into_iter()
            .all(|(one, three)| (one - three).abs() < 1e-3)
    );
}

#[test]
fn the_rate_follows_the_divergence() {
    let mut config = config();
    config.ppo.learning_rate = 1e-3;
    config.ppo.schedule = RateSchedule::PerIteration;
    let rate = |kl| {
        let mut ppo = ppo(&config);
        ppo.follow(kl, 0.025);
        ppo.rate()
    };
    // band 1.5, factor 1.3
    assert!((rate(0.05) - 1e-3 / 1.3).abs() < 1e-9);
    assert!((rate(0.01) - 1.3e-3).abs() < 1e-9);
    assert_eq!(rate(0.03), 1e-3);
    // 9e-3 · 1.3 is beyond the highest rate, 1.1e-5 / 1.3 below the lowest.
    for (begins, kl, ends) in [(9e-3, 0.0, 1e-2), (1.1e-5, 1.0, 1e-5)] {
        config.ppo.learning_rate = begins;
        let mut ppo = ppo(&config);
        ppo.follow(kl, 0.025);
        assert_eq!(ppo.rate(), ends);
    }
}

#[test]
fn learned_exploration_shrinks_when_it_does_not_pay() {
    let mut config = config();
    config.exploration.kind = ExplorationKind::Learned;
    config.exploration.sigma = 0.5.into();
    config.exploration.waist_factor = 1.0;
    config.exploration.arm_factor = 1.0;
    let mut ppo = ppo(&config);
    let mut rng = Pcg64::seed_from_u64(6);
    for _ in 0..15 {
        let sigma = ppo.log_sigma()[0].exp();
        let bandit = Bandit::play(&ppo, sigma, &mut rng, |action| {
            -action.iter().map(|a| a * a).sum::<f32>()
        });
        // Each joint has its own width; the bandit plays all with the first one's, near enough for a direction.
        ppo.update(&bandit.rows(), &[sigma; ACTION], &mut rng)
            .expect("finite");
    }
    let mean = ppo.log_sigma().iter().sum::<f32>() / ACTION as f32;
    assert!(mean < 0.5_f32.ln() - 0.1, "{mean}");
}

#[test]
fn what_becomes_infinite_is_named() {
    let mut ppo = ppo(&config());
    let mut rng = Pcg64::seed_from_u64(7);
    let mut bandit = Bandit::play(&ppo, 0.3, &mut rng, |action| action[0]);
    bandit.rewards[5] = f32::INFINITY;
    let fault = ppo
        .update(&bandit.rows(), &[0.3; ACTION], &mut rng)
        .expect_err("infinite");
    assert!(
        !fault.value.is_finite() && fault.what.contains("loss"),
        "{fault:?}"
    );
    let first = ppo.actor.len();
    assert_eq!(ppo.name(0), "actor.layers.0.weight");
    assert_eq!(ppo.name(first), "critic.layers.0.weight");
    assert_eq!(ppo.name(ppo.weights.len() - 1), "log_sigma");
}

#[test]
fn a_gradient_that_is_none_is_named_and_not_followed() {
    let ppo = ppo(&config());
    let critic = ppo.actor.len();
    for (place, value, name) in [
        (3, f32::NAN, "gradient of actor.layers.0.weight"),
        (critic, f32::INFINITY, "gradient of critic.layers.0.weight"),
        (
            ppo.weights.len() - 1,
            f32::NEG_INFINITY,
            "gradient of log_sigma",
        ),
    ] {
        let mut sums = part::Sums {
            gradient: vec![0.1; ppo.weights.len()],
            ..part::Sums::default()
        };
        assert!(ppo.check(&mut sums).is_ok());
        sums.gradient[place] = value;
        assert_eq!(ppo.check(&mut sums).expect_err("not finite").what, name);
    }
}

#[test]
fn a_broken_weight_is_named_before_the_losses_that_it_breaks() {
    let mut ppo = ppo(&config());
    let sums = part::Sums {
        surrogate: f64::NAN,
        gradient: vec![0.0; ppo.weights.len()],
        ..part::Sums::default()
    };
    let loss = ppo.check(&mut sums.clone()).expect_err("NaN");
    assert_eq!(loss.what, "surrogate loss");
    ppo.weights[0] = f32::INFINITY;
    let weight = ppo.check(&mut sums.clone()).expect_err("infinite");
    assert_eq!(weight, Fault::new("actor.layers.0.weight", f32::INFINITY));
}
