//! Quantiles by hand, and the panels of a figure.

use super::*;

const CONDITIONS: Conditions = Conditions {
    steps: 10,
    episodes: 2,
    seed: 1,
    traced: true,
};

fn trace(steps: usize, speed: f32) -> Trace {
    let sample = Sample {
        velocity: [speed, 0.0, 0.0],
        hips: [0.2, -0.2],
        down: [true, false],
    };
    Trace {
        samples: vec![sample; steps],
    }
}

#[test]
fn robots_that_fell_leave_the_band() {
    let scenario = Scenario::holding("x", [1.0, 0.0, 0.0]);
    let traces = [trace(10, 1.0), trace(7, 3.0)];
    let chart = tracking(&scenario, &traces, &CONDITIONS, 0);
    let band: Vec<_> = chart.bands[0].points.iter().map(|p| (p.1, p.2)).collect();
    assert_eq!(band, [(1.0, 3.0), (1.0, 1.0)]); // steps 0–4 both, 5–9 one
    let fallen = tracking(&scenario, &[trace(3, 1.0)], &CONDITIONS, 0);
    assert!(fallen.lines[1].points.iter().all(|p| p.1.is_nan()));
}

#[test]
fn a_scenario_has_a_file_with_its_panels() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = Scenario::holding("turn", [0.5, 0.0, 0.5]);
    let tally = Tally {
        episodes: 1,
        steps: 10.0,
        squared_error: 0.9,
        squared_errors: [0.0, 0.0, 2.5],
        traces: vec![trace(10, 0.5)],
        ..Tally::default()
    };
    write(folder.path(), &[scenario], &[tally], &CONDITIONS).unwrap();
    let svg = std::fs::read_to_string(folder.path().join("plots/turn.svg")).unwrap();
    for text in [
        "RMSE 0.30 m/s and 0.50 rad/s", // √(0.9 / 10), √(2.5 / 10)
        "forward velocity",
        "yaw rate",
        "hip pitch",
        "feet on the ground",
        "left knee",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("leftward velocity"));
}

#[test]
fn quantiles_by_hand() {
    let sorted = [1.0, 2.0, 3.0, 4.0, 5.0];
    assert_eq!(quantile(&sorted, 0.5), 3.0);
    assert_eq!(quantile(&sorted, 0.9), 5.0); // 0.9·4 = 3.6, the fifth
    assert!(quantile(&[], 0.5).is_nan());
}
