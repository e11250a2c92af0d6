//! Numbers that do not exist yet, and answers that last.

use super::*;

#[test]
fn what_does_not_exist_yet_is_not_a_number() {
    let directive = Directive {
        switched_at: u64::MAX,
        lower: f64::NAN,
        upper: f64::NAN,
        breakout_rate: f64::NAN,
        trend: f64::NAN,
        decision_seconds: f64::NAN,
        ..Directive::default()
    };
    assert_eq!(directive.switched_at(), None);
    assert_eq!(directive.bounds(), None);
    assert_eq!(directive.breakout_rate(), None);
    assert_eq!(directive.trend(), None);
    assert_eq!(directive.decision_seconds(), None);
}

#[test]
fn phase_two_has_bounds() {
    let directive = Directive {
        switched_at: 40,
        lower: 0.25,
        upper: 0.75,
        breakout_rate: 0.04,
        trend: -1.0,
        ..Directive::default()
    };
    assert_eq!(directive.switched_at(), Some(40));
    assert_eq!(directive.bounds(), Some((0.25, 0.75)));
    assert_eq!(directive.breakout_rate(), Some(0.04));
    assert_eq!(directive.trend(), Some(-1.0));
}

#[test]
fn an_answer_is_for_one_learner_and_lasts() {
    let directive = Directive {
        learner: 7,
        iteration: 41,
        ..Directive::default()
    };
    assert!(directive.answers(7, 41));
    assert!(directive.answers(7, 40));
    assert!(!directive.answers(7, 42));
    assert!(!directive.answers(8, 41)); // the report of an earlier life of the learner
}
