//! Rules there and back, and answers that last.

use ampco::{Bounds, Phase, Switch};

use super::*;

fn decision(rule: Rule) -> Decision {
    Decision {
        iteration: 41,
        phase: Phase::One,
        rule,
        granularity: Granularity::Mean,
        breakout_rate: None,
        threshold: 0.05,
        trend: Some(-0.5),
    }
}

#[test]
fn every_rule_comes_back_as_it_was() {
    for rule in [
        Rule::Fixed { style_weight: 0.7 },
        Rule::Guided { ceiling: 0.9 },
        Rule::AdaMimic { ceiling: 1.5 },
        Rule::Bounded {
            lower: -0.25,
            upper: 0.75,
        },
    ] {
        let directive = Directive::new(7, &decision(rule));
        assert_eq!(directive.rule(), Ok(rule));
        assert_eq!(directive.granularity(), Ok(Granularity::Mean));
        assert_eq!(directive.phase, 1);
        assert_eq!(directive.switched_at(), None);
        assert_eq!(directive.bounds(), None);
        assert_eq!(directive.breakout_rate(), None);
        assert_eq!(directive.trend(), Some(-0.5));
        assert_eq!(directive.decision_seconds(), None);
    }
}

#[test]
fn phase_two_brings_its_bounds_and_its_doubt() {
    let switch = Switch {
        iteration: 40,
        bounds: Bounds::around(0.5, 0.125, 0.75), // 0.5 ± 2·0.125
        trend: -1.0,                              // falling: a warning
    };
    let directive = Directive::new(
        7,
        &Decision {
            phase: Phase::Two(switch),
            breakout_rate: Some(0.04),
            ..decision(Rule::Fixed { style_weight: 0.5 })
        },
    );
    assert_eq!(directive.phase, 2);
    assert_eq!(directive.bounds(), Some((0.25, 0.75)));
    assert_eq!(directive.switched_at(), Some(40));
    assert_eq!(directive.breakout_rate(), Some(0.04));
    assert_eq!(directive.warned, 1);
}

#[test]
fn what_names_no_rule_is_refused() {
    let wrong = Directive {
        rule: 9,
        ..Directive::default()
    };
    assert_eq!(wrong.rule(), Err(RuleError::UnknownRule(9)));
    let wrong = Directive {
        rule: GUIDED,
        first: f32::NAN,
        ..Directive::default()
    };
    assert!(matches!(wrong.rule(), Err(RuleError::Parameters(_))));
}

#[test]
fn an_answer_is_for_one_learner_and_lasts() {
    let directive = Directive::new(7, &decision(Rule::Guided { ceiling: 1.0 }));
    assert!(directive.answers(7, 41));
    assert!(directive.answers(7, 40));
    assert!(!directive.answers(7, 42));
    assert!(!directive.answers(8, 41)); // the report of an earlier life of the learner
}
