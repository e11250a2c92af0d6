//! Answering a report: observe it, or first catch up with what was missed.
//!
//! Separate from the process so that gaps, repetitions and resumed learners can be tested without one.

use ampco::{Decision, Report, ReportError, Schedule};
use anyhow::Result;

use crate::history::rebuild;

/// The schedule and what is needed to put it together again.
#[derive(Debug)]
pub(crate) struct Desk {
    /// One that has seen nothing.
    fresh: Schedule,
    schedule: Schedule,
}

/// The answer to one report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Reply {
    /// What is in force from the next iteration on.
    pub(crate) decision: Decision,
    /// The state was rebuilt from the metrics before the report was observed.
    pub(crate) rebuilt: bool,
    /// Why the report was not observed; the decision is then what was in force before.
    pub(crate) refused: Option<ReportError>,
}

impl Desk {
    /// A desk with a `fresh` schedule that knows what the run has recorded so far.
    pub(crate) fn open(fresh: Schedule, records: &[Report]) -> Self {
        let schedule = rebuild(&fresh, records, u64::MAX);
        Self { fresh, schedule }
    }

    /// What is in force.
    pub(crate) fn schedule(&self) -> &Schedule {
        &self.schedule
    }

    /// Answers a report. If it is not the one after the newest, reports were missed or a learner was resumed: the state
    /// is then rebuilt from what `records` gives, up to the iteration before.
    pub(crate) fn answer(
        &mut self,
        report: Report,
        records: impl FnOnce() -> Result<Vec<Report>>,
    ) -> Result<Reply> {
        let newest = self.schedule.newest_iteration().unwrap_or(0);
        let rebuilt = newest.checked_add(1) != Some(report.iteration);
        if rebuilt {
            self.schedule = rebuild(&self.fresh, &records()?, report.iteration);
        }
        let refused = self.schedule.observe(report).err();
        Ok(Reply {
            decision: self.schedule.decision(report.iteration),
            rebuilt,
            refused,
        })
    }
}

#[cfg(test)]
mod tests {
    use ampco::ScheduleConfig;

    use super::*;

    fn fresh() -> Schedule {
        Schedule::new(ScheduleConfig {
            window: 5,
            percentile: 0.5,
            ..Default::default()
        })
        .unwrap()
    }

    fn report(iteration: u64) -> Report {
        Report {
            iteration,
            style_mean: iteration.min(10) as f64 / 16.0,
            style_std: 0.125,
            style_std_robots: Some(iteration as f64 / 300.0),
            task_mean: 0.5,
            episode_share: Some(iteration as f64 / 100.0),
        }
    }

    fn records(iterations: std::ops::RangeInclusive<u64>) -> Vec<Report> {
        iterations.map(report).collect()
    }

    /// What a desk that misses nothing answers to report `iteration`.
    fn expected(iteration: u64) -> Decision {
        let mut schedule = fresh();
        (1..=iteration)
            .map(|i| schedule.observe(report(i)).unwrap())
            .last()
            .unwrap()
    }

    fn unread() -> Result<Vec<Report>> {
        panic!("the metrics are read only when something was missed")
    }

    #[test]
    fn reports_in_order_are_answered_without_reading_the_metrics() {
        let mut desk = Desk::open(fresh(), &[]);
        for iteration in 1..=30 {
            let reply = desk.answer(report(iteration), unread).unwrap();
            assert_eq!(
                (reply.decision, reply.rebuilt, reply.refused),
                (expected(iteration), false, None)
            );
        }
    }

    #[test]
    fn a_restarted_desk_goes_on_where_the_metrics_end() {
        let mut desk = Desk::open(fresh(), &records(1..=17));
        assert_eq!(
            desk.answer(report(18), unread).unwrap().decision,
            expected(18)
        );
    }

    #[test]
    fn a_gap_is_filled_from_the_metrics() {
        let mut desk = Desk::open(fresh(), &records(1..=5));
        // The learner writes the line of an iteration before or after it reports: both must do.
        for recorded in [13, 14] {
            let reply = desk
                .answer(report(14), || Ok(records(1..=recorded)))
                .unwrap();
            assert_eq!((reply.decision, reply.rebuilt), (expected(14), true));
        }
    }

    #[test]
    fn a_report_that_was_already_read_from_the_metrics_is_answered() {
        let mut desk = Desk::open(fresh(), &records(1..=14));
        let reply = desk.answer(report(14), || Ok(records(1..=14))).unwrap();
        assert_eq!((reply.decision, reply.refused), (expected(14), None));
    }

    #[test]
    fn a_resumed_learner_is_followed_back_out_of_phase_two() {
        let mut desk = Desk::open(fresh(), &records(1..=30));
        assert_eq!(desk.schedule().phase().number(), 2);
        // Resumed at 8, before the switch.
        let reply = desk.answer(report(9), || Ok(records(1..=8))).unwrap();
        assert_eq!(
            (reply.decision, reply.decision.phase.number()),
            (expected(9), 1)
        );
        assert_eq!(
            desk.answer(report(10), unread).unwrap().decision,
            expected(10)
        );
    }

    #[test]
    fn a_refused_report_is_answered_with_what_was_in_force() {
        let mut desk = Desk::open(fresh(), &records(1..=20));
        let bad = Report {
            style_mean: f64::NAN,
            ..report(21)
        };
        let reply = desk.answer(bad, unread).unwrap();
        assert!(matches!(
            reply.refused,
            Some(ReportError::NotFinite { iteration: 21, .. })
        ));
        assert_eq!(
            reply.decision,
            Decision {
                iteration: 21,
                ..expected(20)
            }
        );
    }
}
