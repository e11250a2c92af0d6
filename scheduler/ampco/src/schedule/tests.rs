//! Whole runs: windows small enough to follow by hand, then seeded streams of the shapes that training shows.

use rand::{RngExt, SeedableRng};

use super::*;
use crate::{ArmKind, CeilingKind, Method, Warning};

mod pause;
mod reports;
mod rules;

fn report(iteration: u64, style_mean: f64) -> Report {
    Report {
        iteration,
        style_mean,
        style_std: 0.125,
        style_std_robots: Some(0.0625),
        task_mean: 0.5,
        episode_share: None,
    }
}

/// Feeds a stream and returns every decision.
fn run(config: &ScheduleConfig, stream: impl IntoIterator<Item = f64>) -> Vec<Decision> {
    let mut schedule = Schedule::new(config.clone()).unwrap();
    (1..)
        .zip(stream)
        .map(|(iteration, reward)| schedule.observe(report(iteration, reward)).unwrap())
        .collect()
}

fn switch_of(config: &ScheduleConfig, stream: impl IntoIterator<Item = f64>) -> Option<u64> {
    run(config, stream).last().and_then(Decision::switched_at)
}

/// W = 3, median, k = 2: small enough for the head.
fn tiny() -> ScheduleConfig {
    ScheduleConfig {
        window: 3,
        percentile: 0.5,
        alpha: 0.75,
        ..Default::default()
    }
}

/// A window that fits a stream of some hundred iterations.
fn short() -> ScheduleConfig {
    ScheduleConfig {
        window: 50,
        ..Default::default()
    }
}

/// The shape plus uniform noise of ± 0.01.
fn noisy(seed: u64, length: usize, shape: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    (0..length)
        .map(|t| shape(t as f64) + rng.random_range(-0.01..0.01))
        .collect()
}

/// See `breakout`: of these rewards the seventh brings β = 1/3 < 1/2.
const SEVEN: [f64; 7] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.4, 0.3];

#[test]
fn the_switch_comes_when_the_rate_falls_below_the_threshold() {
    let decisions = run(&tiny(), SEVEN);
    assert!(
        decisions[..6]
            .iter()
            .all(|d| d.phase == Phase::One && d.bounds().is_none())
    );
    let last = decisions[6];
    assert_eq!(
        (
            last.switched_at(),
            last.just_switched(),
            last.phase.number()
        ),
        (Some(7), true, 2)
    );
    assert_eq!((last.breakout_rate, last.threshold), (Some(1.0 / 3.0), 0.5));
}

#[test]
fn bounds_come_from_the_batch_of_the_switch() {
    let last = run(&tiny(), SEVEN)[6];
    // 0.3 ± 2·0.125
    let bounds = last.bounds().unwrap();
    assert!((bounds.lower() - 0.05).abs() < 1e-12 && (bounds.upper() - 0.55).abs() < 1e-12);
    assert_eq!(
        last.rule,
        Rule::Bounded {
            lower: 0.05,
            upper: 0.55
        }
    );
    assert_eq!(last.granularity, Granularity::Mean);
}

#[test]
fn bounds_can_come_from_the_window_means() {
    let config = ScheduleConfig {
        bounds_from: BoundsSource::Window,
        ..tiny()
    };
    // 0.5 0.4 0.3: mean 0.4, deviation √(0.02/3) = 0.0816497, times 2
    let bounds = run(&config, SEVEN)[6].bounds().unwrap();
    assert!((bounds.lower() - (0.4 - 0.163_299_3)).abs() < 1e-6);
    assert!((bounds.upper() - (0.4 + 0.163_299_3)).abs() < 1e-6);
}

#[test]
fn bounds_can_come_from_the_robots_means() {
    let config = ScheduleConfig {
        bounds_from: BoundsSource::Robots,
        ..tiny()
    };
    // The last reward is 0.3, the robots' deviation 0.0625, times 2.
    let bounds = run(&config, SEVEN)[6].bounds().unwrap();
    assert!((bounds.lower() - 0.175).abs() < 1e-9);
    assert!((bounds.upper() - 0.425).abs() < 1e-9);
}

#[test]
fn a_negative_trend_at_the_switch_is_warned_of() {
    let last = run(&tiny(), SEVEN)[6];
    // The window 0.5 0.4 0.3 falls by 0.1 an iteration.
    let Some(Warning::RewardWasFalling { trend }) = last.warning() else {
        panic!("no warning")
    };
    assert!((trend + 0.1).abs() < 1e-9);
}

#[test]
fn bounds_that_bind_nothing_are_told_where_they_would_bind() {
    let config = ScheduleConfig {
        alpha: 0.96, // k = √(1/0.04) = 5
        bounds_from: BoundsSource::Window,
        ..tiny()
    };
    // 0.5 0.4 0.3: 0.4 ± 5·0.0816497 = −0.008 and 0.808
    let last = run(&config, SEVEN)[6];
    let Some(Warning::LowerBoundIsIdle { lower }) = last.idle_bounds() else {
        panic!("{last:?}")
    };
    assert!((lower + 0.008_248).abs() < 1e-6);
    assert_eq!(run(&config, SEVEN)[0].idle_bounds(), None);
    // A rule that is not made of bounds has none that could bind.
    let fixed = Decision {
        rule: Rule::Fixed { style_weight: 0.5 },
        ..last
    };
    assert_eq!(fixed.idle_bounds(), None);
}

#[test]
fn half_full_windows_decide_nothing() {
    let decisions = run(&short(), (0..51).map(|_| 0.3));
    assert!(
        decisions
            .iter()
            .all(|d| d.breakout_rate.is_none() && d.phase == Phase::One)
    );
    // A constant reward never exceeds itself: β = 0 with the first full pair of windows, at W + 2.
    assert_eq!(switch_of(&short(), (0..100).map(|_| 0.3)), Some(52));
    assert!(run(&short(), (0..100).map(|_| 0.3))[99].warning().is_none());
}

#[test]
fn a_climb_is_not_a_plateau_and_the_plateau_is_found() {
    for seed in 0..20 {
        let climb = noisy(seed, 2000, |t| 0.2 + 0.2 * (t / 400.0).min(1.0));
        for arm in [ArmKind::WindowFull, ArmKind::AfterRise] {
            let switched = switch_of(&ScheduleConfig { arm, ..short() }, climb.clone()).unwrap();
            // Never while climbing; soon after, as β wanders around 1 − p on a plateau.
            assert!(
                (400..800).contains(&switched),
                "seed {seed}, {arm:?}: {switched}"
            );
        }
    }
}

#[test]
fn the_literal_test_takes_a_fall_for_convergence_and_says_so() {
    let fall = noisy(1, 600, |t| 0.47 - 0.0003 * t);
    let literal = run(&short(), fall.clone());
    assert!(literal.last().unwrap().switched_at().unwrap() < 200);
    assert!(matches!(
        literal.last().unwrap().warning(),
        Some(Warning::RewardWasFalling { .. })
    ));
    assert_eq!(
        switch_of(
            &ScheduleConfig {
                arm: ArmKind::AfterRise,
                ..short()
            },
            fall
        ),
        None
    );
}

#[test]
fn a_dip_followed_by_a_climb_is_waited_out_after_rise() {
    for seed in 0..20 {
        // As seen in training: 0.47 falls to 0.29 in 100 iterations, climbs to 0.39 in 400 more, stays.
        let dip = noisy(seed, 2000, |t| {
            if t < 100.0 {
                0.47 - 0.0018 * t
            } else {
                0.29 + 0.1 * ((t - 100.0) / 400.0).min(1.0)
            }
        });
        assert!(switch_of(&short(), dip.clone()).unwrap() < 100);
        let switched = switch_of(
            &ScheduleConfig {
                arm: ArmKind::AfterRise,
                ..short()
            },
            dip,
        )
        .unwrap();
        assert!((500..900).contains(&switched), "seed {seed}: {switched}");
    }
}

#[test]
fn a_stationary_reward_breaks_out_as_often_as_chance() {
    // W = 100, p = 0.95: h = 94.05. Among the 101 gaps between 100 sorted values a new one falls above x₉₅ in 5, and
    // above the boundary but below x₉₅ in 0.95 of one: 5.95/101 = 0.0589.
    let config = ScheduleConfig {
        window: 100,
        method: Method::Amp { style_weight: 0.5 },
        ..Default::default()
    };
    let rates: Vec<f64> = run(&config, noisy(3, 100_000, |_| 0.3))
        .iter()
        .filter_map(|d| d.breakout_rate)
        .collect();
    let mean = rates.iter().sum::<f64>() / rates.len() as f64;
    assert!((mean - 5.95 / 101.0).abs() < 0.003, "{mean}");
}

#[test]
fn phase_two_never_returns_and_its_bounds_never_move() {
    let stream = noisy(5, 1000, |t| {
        if t < 300.0 {
            0.3
        } else {
            0.3 + 0.001 * (t - 300.0)
        }
    });
    let decisions = run(&short(), stream);
    let first = decisions.iter().position(Decision::just_switched).unwrap();
    assert!(first < 300);
    let phase = decisions[first].phase;
    assert!(
        decisions[first..]
            .iter()
            .all(|d| d.phase == phase && d.rule == decisions[first].rule)
    );
    assert_eq!(decisions.iter().filter(|d| d.just_switched()).count(), 1);
    // The climb after the switch breaks out again, and changes nothing.
    assert!(decisions[999].breakout_rate.unwrap() > decisions[999].threshold);
}

#[test]
fn a_bad_configuration_makes_no_schedule() {
    let refused = Schedule::new(ScheduleConfig {
        window: 1,
        ..Default::default()
    })
    .unwrap_err();
    assert_eq!((&*refused.path, &*refused.value), ("window", "1"));
}
