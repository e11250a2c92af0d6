//! The schedule put together again from what the run has recorded.
//!
//! A report that was sent while this process was away is gone, but its numbers are in `metrics.jsonl`. The schedule is a
//! function of its configuration and of the reports in their order, so that observing the recorded ones anew gives the
//! state, bit by bit, in which an uninterrupted scheduler would be.

use ampco::{Report, Schedule};

/// The schedule after the recorded iterations below `before`; `fresh` is one that has seen nothing.
///
/// Where the record goes back, a learner was resumed: what it did anew replaces what was there. Reports that the
/// schedule refuses are left out, as they were when they arrived.
pub(crate) fn rebuild(fresh: &Schedule, records: &[Report], before: u64) -> Schedule {
    let mut lasting: Vec<Report> = Vec::with_capacity(records.len());
    for record in records.iter().filter(|record| record.iteration < before) {
        while lasting
            .last()
            .is_some_and(|last| last.iteration >= record.iteration)
        {
            lasting.pop();
        }
        lasting.push(*record);
    }
    let mut schedule = fresh.clone();
    for report in lasting {
        let _refused_then_and_now = schedule.observe(report);
    }
    schedule
}

#[cfg(test)]
mod tests {
    use std::fs;

    use ampco::{Decision, ScheduleConfig};

    use super::*;

    /// Windows of five: they fill and switch within a few lines.
    fn config() -> ScheduleConfig {
        ScheduleConfig {
            window: 5,
            percentile: 0.5,
            ..Default::default()
        }
    }

    fn fresh() -> Schedule {
        Schedule::new(config()).unwrap()
    }

    /// A reward that climbs for ten iterations and stays; thirds, so that no decimal is exact.
    fn report(iteration: u64) -> Report {
        let style_mean = iteration.min(10) as f64 / 3.0;
        Report {
            iteration,
            style_mean,
            style_std: 0.1 / 3.0,
            style_std_robots: Some(0.1 / 7.0),
            task_mean: 0.5,
            episode_share: Some(iteration as f64 / 7.0),
        }
    }

    fn line(report: Report) -> String {
        let Report {
            iteration,
            style_mean,
            style_std,
            style_std_robots,
            task_mean,
            episode_share,
        } = report;
        let line = serde_json::json!({
            "iteration": iteration, "episode_length": 12.5, "style_mean": style_mean, "style_std": style_std,
            "style_std_robots": style_std_robots, "task_mean": task_mean, "episode_share": episode_share
        });
        format!("{line}\n")
    }

    fn records(text: &str) -> Vec<Report> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("metrics.jsonl");
        fs::write(&path, text).unwrap();
        run::metrics::read(&path).unwrap()
    }

    /// What a scheduler decides from iteration `from` on that has observed 1 to `from` − 1 by now.
    fn decisions(mut schedule: Schedule, from: u64) -> Vec<Decision> {
        (from..=30)
            .map(|iteration| schedule.observe(report(iteration)).unwrap())
            .collect()
    }

    #[test]
    fn a_rebuilt_schedule_decides_as_one_that_was_never_away() {
        let uninterrupted = decisions(fresh(), 1);
        let switched = uninterrupted
            .iter()
            .position(Decision::just_switched)
            .unwrap();
        assert!(
            (10..25).contains(&switched),
            "the stream must switch between the restarts below"
        );
        for restart in [1, 2, 4, 8, 20, 29] {
            let text: String = (1..restart)
                .map(|iteration| line(report(iteration)))
                .collect();
            let rebuilt = rebuild(&fresh(), &records(&text), u64::MAX);
            assert_eq!(
                decisions(rebuilt, restart),
                uninterrupted[restart as usize - 1..],
                "restart at {restart}"
            );
        }
    }

    #[test]
    fn what_arms_is_rebuilt_with_it() {
        let waits = ScheduleConfig {
            arm: ampco::ArmKind::EpisodesLast,
            smoothing: 4.0,
            ..config()
        };
        let fresh = Schedule::new(waits).unwrap();
        let mut live = fresh.clone();
        for restart in 2..=30 {
            live.observe(report(restart - 1)).unwrap();
            let text: String = (1..restart).map(|i| line(report(i))).collect();
            let rebuilt = rebuild(&fresh, &records(&text), u64::MAX);
            assert_eq!(rebuilt.decision(restart), live.decision(restart));
        }
        assert!(live.decision(30).switched_at().is_some());
    }

    #[test]
    fn a_torn_last_line_is_passed_over() {
        let mut text: String = (1..=8).map(|iteration| line(report(iteration))).collect();
        text.push_str(&line(report(9))[..20]);
        assert_eq!(
            rebuild(&fresh(), &records(&text), u64::MAX).newest_iteration(),
            Some(8)
        );
    }

    #[test]
    fn what_a_resumed_learner_does_anew_replaces_what_was_there() {
        // 1 to 20 with a reward that would have switched, then again from 6 on.
        let abandoned = (6..=20).map(|i| Report {
            style_mean: 0.1,
            ..report(i)
        });
        let whole = (1..=5)
            .map(report)
            .chain(abandoned)
            .chain((6..=9).map(report));
        let text: String = whole.map(line).collect();
        let rebuilt = rebuild(&fresh(), &records(&text), u64::MAX);
        assert_eq!(decisions(rebuilt, 10), decisions(fresh(), 1)[9..]);
    }

    #[test]
    fn only_what_lies_before_counts() {
        let text: String = (1..=20).map(|iteration| line(report(iteration))).collect();
        assert_eq!(
            rebuild(&fresh(), &records(&text), 7).newest_iteration(),
            Some(6)
        );
        assert_eq!(
            rebuild(&fresh(), &records(&text), 1).newest_iteration(),
            None
        );
    }

    #[test]
    fn a_line_without_a_finite_reward_is_left_out_as_its_report_was() {
        let text = line(report(1))
            + &line(Report {
                style_mean: f64::NAN,
                ..report(2)
            })
            + &line(report(3));
        assert!(text.contains("null"));
        let rebuilt = rebuild(&fresh(), &records(&text), u64::MAX);
        let mut live = fresh();
        live.observe(report(1)).unwrap();
        live.observe(Report {
            style_mean: f64::NAN,
            ..report(2)
        })
        .unwrap_err();
        live.observe(report(3)).unwrap();
        assert_eq!(rebuilt.decision(3), live.decision(3));
    }
}
