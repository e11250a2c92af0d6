//! Messages and the types of `ampco`: reports on their way in, decisions on their way out.

use ampco::{Decision, Numbers, Report};
use protocol::{Directive, RewardReport};

/// The report as the schedule takes it.
pub(crate) fn report(message: &RewardReport) -> Report {
    Report {
        iteration: message.iteration,
        style_mean: message.style_mean,
        style_std: message.style_std,
        style_std_robots: Some(message.style_std_robots).filter(|std| !std.is_nan()),
        task_mean: message.task_mean,
        episode_share: Some(message.episode_share).filter(|share| !share.is_nan()),
    }
}

/// The decision as a message that answers the learner with incarnation `learner`; its time is not known yet.
pub(crate) fn directive(learner: u64, decision: &Decision) -> Directive {
    let Numbers {
        rule,
        first,
        second,
        granularity,
    } = decision.weighting().into();
    let bounds = decision.bounds();
    Directive {
        learner,
        iteration: decision.iteration,
        switched_at: decision.switched_at().unwrap_or(u64::MAX),
        held: decision.held,
        phase: decision.phase.number(),
        rule,
        first,
        second,
        granularity,
        warned: u32::from(decision.warning().is_some()),
        lower: bounds.map_or(f64::NAN, |bounds| bounds.lower()),
        upper: bounds.map_or(f64::NAN, |bounds| bounds.upper()),
        breakout_rate: decision.breakout_rate.unwrap_or(f64::NAN),
        threshold: decision.threshold,
        trend: decision.trend.unwrap_or(f64::NAN),
        decision_seconds: f64::NAN,
        // Filled when it is sent.
        scheduler: 0,
        sequence: 0,
    }
}

#[cfg(test)]
mod tests {
    use ampco::{Bounds, Granularity, Phase, Rule, Switch};

    use super::*;

    fn decision(phase: Phase) -> Decision {
        Decision {
            iteration: 41,
            phase,
            rule: Rule::Bounded {
                lower: 0.25,
                upper: 0.75,
            },
            granularity: Granularity::Mean,
            breakout_rate: None,
            threshold: 0.05,
            trend: Some(-0.5),
            held: 3,
        }
    }

    #[test]
    fn phase_one_has_neither_bounds_nor_a_switch() {
        let message = directive(7, &decision(Phase::One));
        assert_eq!((message.learner, message.iteration), (7, 41));
        assert_eq!((message.phase, message.switched_at()), (1, None));
        assert_eq!(message.held, 3);
        assert_eq!((message.rule, message.granularity), (3, 1));
        assert_eq!((message.first, message.second), (0.25, 0.75));
        assert_eq!((message.bounds(), message.breakout_rate()), (None, None));
        assert_eq!((message.threshold, message.trend()), (0.05, Some(-0.5)));
        assert_eq!((message.warned, message.decision_seconds()), (0, None));
    }

    #[test]
    fn phase_two_brings_its_bounds_and_its_doubt() {
        let switch = Switch {
            iteration: 40,
            bounds: Bounds::around(0.5, 0.125, 0.75), // 0.5 ± 2·0.125
            trend: -1.0,                              // falling: a warning
        };
        let message = directive(7, &decision(Phase::Two(switch)));
        assert_eq!(message.phase, 2);
        assert_eq!(message.bounds(), Some((0.25, 0.75)));
        assert_eq!(message.switched_at(), Some(40));
        assert_eq!(message.warned, 1);
    }

    #[test]
    fn a_share_that_is_no_number_is_none() {
        let message = RewardReport {
            iteration: 3,
            style_mean: 0.5,
            episode_share: f64::NAN,
            style_std_robots: f64::NAN,
            ..RewardReport::default()
        };
        assert_eq!(report(&message).episode_share, None);
        assert_eq!(report(&message).style_std_robots, None);
        assert_eq!(report(&message).style_mean, 0.5);
        let ended = RewardReport {
            episode_share: 0.25,
            style_std_robots: 0.125,
            ..message
        };
        assert_eq!(report(&ended).episode_share, Some(0.25));
        assert_eq!(report(&ended).style_std_robots, Some(0.125));
    }
}
