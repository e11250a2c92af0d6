//! Every kind of message, with anything in its fields.

use ampco::{Numbers, Report, Schedule, ScheduleConfig, Weighting};
use proptest::collection::vec;
use proptest::prelude::*;
use protocol::{
    Directive, Entry, Ledger, Lists, MAX_HIDDEN_LAYERS, RolloutHeader, RolloutLayout, WeightsHeader,
};
use vocabulary::Cause;

use crate::{always, assert_clear};

/// Counts as they are, and as nobody sends them.
fn counts() -> impl Strategy<Value = u32> {
    prop_oneof![0..5_u32, any::<u32>(), Just(u32::MAX)]
}

fn longs() -> impl Strategy<Value = u64> {
    prop_oneof![0..5_u64, any::<u64>(), Just(u64::MAX)]
}

/// All bit patterns: NaN, infinities and subnormals among them.
fn floats() -> impl Strategy<Value = f32> {
    prop_oneof![
        any::<u32>().prop_map(f32::from_bits),
        -2.0..2.0_f32,
        Just(f32::NAN),
        Just(f32::INFINITY),
    ]
}

fn doubles() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        -2.0..2.0_f64,
        Just(f64::NAN),
        Just(f64::NEG_INFINITY),
    ]
}

#[test]
fn a_rollout_s_header_promises_what_the_message_holds_or_is_refused() {
    let inputs = (
        counts(),
        counts(),
        prop_oneof![0..4000_usize, any::<usize>()],
    );
    always(2000, &inputs, |(environments, steps, numbers)| {
        let header = RolloutHeader {
            environments,
            steps,
            ..RolloutHeader::default()
        };
        let lists = Lists::default();
        let header = RolloutHeader {
            lists: lists.into(),
            ..header
        };
        match header.layout(lists, numbers) {
            Ok(layout) => assert_eq!(layout.checked_len(), Some(numbers)),
            Err(error) => assert_clear(&error),
        }
    });
}

#[test]
fn a_rollout_s_numbers_are_sound_or_the_first_that_is_not_is_named() {
    let layout = RolloutLayout {
        environments: 2,
        steps: 2,
        lists: Lists::default(),
    };
    let inputs = vec((0..layout.len(), floats()), 0..4);
    always(1000, &inputs, |changes| {
        let mut numbers = vec![0.0; layout.len()];
        for (place, number) in changes {
            numbers[place] = number;
        }
        let view = layout.view(&numbers);
        match view.flaw() {
            Some(flaw) => assert!(!flaw.field.is_empty() && flaw.row < 4),
            None => {
                let sound = [
                    view.observations,
                    view.actions,
                    view.task_rewards,
                    view.features,
                ];
                assert!(
                    sound
                        .iter()
                        .all(|block| block.iter().all(|x| x.is_finite()))
                );
                assert!(view.ends.iter().all(|end| Cause::of(*end).is_ok()));
            }
        }
    });
}

#[test]
fn the_ledger_bears_any_header() {
    let header = (counts(), longs(), longs(), longs(), longs());
    let inputs = vec(header, 1..20);
    always(500, &inputs, |headers| {
        let mut ledger = Ledger::default();
        let mut seen = std::collections::BTreeSet::new();
        for (actor, incarnation, sequence, learner, policy_version) in headers {
            let header = RolloutHeader {
                actor,
                incarnation,
                sequence,
                learner,
                policy_version,
                ..RolloutHeader::default()
            };
            let entry = ledger.enter(&header, 3, 2);
            if entry == Entry::Fresh {
                assert!((learner, policy_version) >= (3, 2));
                // The last number of all cannot be told from its repetition; no actor reaches it.
                let first = seen.insert((actor, incarnation, sequence));
                assert!(first || sequence == u64::MAX, "used twice");
            }
        }
        let _ = (ledger.totals(), ledger.restarts());
    });
}

#[test]
fn a_weights_header_says_what_it_is_or_is_refused() {
    let hidden = proptest::array::uniform6(counts());
    let inputs = (
        counts(),
        counts(),
        hidden,
        counts(),
        counts(),
        floats(),
        0..100_000_usize,
    );
    always(
        2000,
        &inputs,
        |(order, layers, hidden, environments, steps, observation_clip, numbers)| {
            let header = WeightsHeader {
                order,
                layers,
                hidden,
                environments,
                steps,
                observation_clip,
                ..WeightsHeader::default()
            };
            assert_eq!(header.order().is_some(), order < 4);
            assert!(header.hidden().len() <= MAX_HIDDEN_LAYERS);
            // Nobody's lists are all zeros.
            let layout = RolloutLayout {
                environments: environments as usize,
                steps: steps as usize,
                lists: Lists::default(),
            };
            assert!(header.unlike(&layout).is_some());
            let widths: Vec<usize> = header
                .hidden()
                .iter()
                .map(|&width| width as usize)
                .collect();
            let shape = policy::Shape::new(Lists::default().widths.observation, &widths);
            if shape.fits(numbers) {
                if let Err(error) = policy::Policy::check_clip(observation_clip) {
                    return assert_clear(&error);
                }
                let mut policy = policy::Policy::new(shape, observation_clip);
                policy.load(&vec![0.5; numbers]).expect("so many numbers");
            }
        },
    );
}

#[test]
fn a_directive_is_a_rule_that_can_be_evaluated_or_is_refused() {
    let inputs = (counts(), counts(), floats(), floats(), doubles(), longs());
    always(
        2000,
        &inputs,
        |(rule, granularity, first, second, bound, switched_at)| {
            let directive = Directive {
                rule,
                granularity,
                first,
                second,
                lower: bound,
                upper: -bound,
                breakout_rate: bound,
                switched_at,
                ..Directive::default()
            };
            let numbers = Numbers {
                rule: directive.rule,
                first: directive.first,
                second: directive.second,
                granularity: directive.granularity,
            };
            match Weighting::try_from(numbers) {
                Err(error) => assert_clear(&error),
                Ok(weighting) => {
                    weighting
                        .rule
                        .validate()
                        .expect("what is accepted is valid");
                }
            }
            let _ = (
                directive.bounds(),
                directive.trend(),
                directive.breakout_rate(),
            );
            assert_eq!(directive.switched_at().is_none(), switched_at == u64::MAX);
        },
    );
}

#[test]
fn the_schedule_bears_any_report() {
    let report = (longs(), doubles(), doubles(), doubles());
    let inputs = vec(report, 1..40);
    always(500, &inputs, |reports| {
        let config = ScheduleConfig {
            window: 4,
            ..ScheduleConfig::default()
        };
        let mut schedule = Schedule::new(config).expect("valid");
        for (iteration, style_mean, style_std, task_mean) in reports {
            let report = Report {
                iteration,
                style_mean,
                style_std,
                style_std_robots: Some(task_mean),
                task_mean,
                episode_share: Some(style_std),
            };
            match schedule.observe(report) {
                Err(error) => assert_clear(&error),
                Ok(decision) => {
                    decision
                        .rule
                        .validate()
                        .expect("a rule that can be evaluated");
                }
            }
        }
    });
}
