//! Whole runs: windows small enough to follow by hand, then seeded streams of the shapes that training shows.

use rand::{RngExt, SeedableRng};

use super::*;
use crate::{ArmKind, CeilingKind, Method, Warning};

mod pause;

fn report(iteration: u64, style_mean: f64) -> Report {
    Report {
        iteration,
        style_mean,
        style_std: 0.125,
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
fn a_negative_trend_at_the_switch_is_warned_of() {
    let last = run(&tiny(), SEVEN)[6];
    // The window 0.5 0.4 0.3 falls by 0.1 an iteration.
    let Some(Warning::RewardWasFalling { trend }) = last.warning() else {
        panic!("no warning")
    };
    assert!((trend + 0.1).abs() < 1e-9);
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
fn methods_are_their_rules_in_both_phases() {
    let rules = |method| {
        let decisions = run(&ScheduleConfig { method, ..tiny() }, SEVEN);
        (
            decisions[0].rule,
            decisions[6].rule,
            decisions[6].phase.number(),
        )
    };
    let bounded = Rule::Bounded {
        lower: 0.05,
        upper: 0.55,
    };
    let guided = Rule::Guided { ceiling: 1.0 };
    let fixed = |style_weight| Rule::Fixed { style_weight };
    let mimic = Rule::AdaMimic { ceiling: 1.0 };
    let by_hand = Rule::Bounded {
        lower: 0.25,
        upper: 0.5,
    };
    assert_eq!(rules(Method::Ampco), (guided, bounded, 2));
    assert_eq!(rules(Method::AmpcoWithoutAig), (fixed(0.5), bounded, 2));
    assert_eq!(rules(Method::AmpcoWithoutRoger), (guided, guided, 2));
    assert_eq!(
        rules(Method::Amp { style_weight: 0.7 }),
        (fixed(0.7), fixed(0.7), 1)
    );
    assert_eq!(rules(Method::AdaMimic), (mimic, mimic, 1));
    assert_eq!(
        rules(Method::AmpRoger {
            lower: 0.25,
            upper: 0.5
        }),
        (by_hand, by_hand, 1)
    );
}

#[test]
fn a_running_maximum_follows_the_reward_that_its_rule_listens_to() {
    let rule = |method| {
        run(
            &ScheduleConfig {
                method,
                ceiling: CeilingKind::RunningMax,
                ..short()
            },
            [0.25, 0.375, 0.125],
        )[2]
        .rule
    };
    assert_eq!(rule(Method::Ampco), Rule::Guided { ceiling: 0.375 });
    assert_eq!(rule(Method::AdaMimic), Rule::AdaMimic { ceiling: 0.5 }); // every report's task mean
}

#[test]
fn a_refused_report_changes_nothing() {
    let stream = noisy(9, 300, |_| 0.3);
    let undisturbed = run(&short(), stream.clone());
    let mut schedule = Schedule::new(short()).unwrap();
    for (i, &reward) in stream.iter().enumerate() {
        let good = report(i as u64 + 1, reward);
        for bad in [
            Report {
                style_mean: f64::NAN,
                ..good
            },
            Report {
                style_std: f64::INFINITY,
                ..good
            },
            Report {
                task_mean: f64::NEG_INFINITY,
                ..good
            },
            Report {
                episode_share: Some(f64::NAN),
                ..good
            },
        ] {
            assert!(matches!(
                schedule.observe(bad),
                Err(ReportError::NotFinite { .. })
            ));
        }
        assert!(matches!(
            schedule.observe(Report {
                style_std: -0.1,
                ..good
            }),
            Err(ReportError::NegativeDeviation { .. })
        ));
        assert_eq!(schedule.observe(good), Ok(undisturbed[i]));
        assert_eq!(schedule.decision(good.iteration), undisturbed[i]);
        assert_eq!(
            schedule.observe(good),
            Err(ReportError::OutOfOrder {
                iteration: good.iteration,
                newest: good.iteration
            })
        );
    }
}

#[test]
fn equal_reports_give_equal_decisions() {
    let config = ScheduleConfig {
        arm: ArmKind::AfterRise,
        ceiling: CeilingKind::RunningMax,
        ..short()
    };
    let stream = noisy(11, 1000, |t| 0.2 + 0.2 * (t / 300.0).min(1.0));
    assert_eq!(run(&config, stream.clone()), run(&config, stream));
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
