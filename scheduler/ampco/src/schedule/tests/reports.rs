//! Reports that are refused, and reports that are the same.

use super::*;

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
                style_std_robots: Some(f64::NAN),
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
        assert!(matches!(
            schedule.observe(Report {
                style_std_robots: Some(-0.1),
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
