//! Which rule each method gives in which phase, and what its ceiling follows.

use super::*;

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
