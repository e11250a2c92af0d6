//! The metrics of III-F over one run, from the lines that its learner wrote.
//!
//! "Each metric is computed over 1,000-timestep windows. Final values represent the mean over the last 1,000 timesteps
//! of training, while peak values indicate worst-case performance after timestep 1,000. Convergence occurs when the
//! 100-step moving average remains within ±10 % of the final mean." We read:
//!
//! - A *timestep* is a control step of every robot, so an iteration of 24 holds 24. A window is the least number of
//!   whole iterations that hold 1,000 of them. Errors of a window are the root of their mean square; energy and style
//!   are means, energy being recorded per 1,000 steps already.
//! - *Peak* is the greatest value of any window that begins after the first 1,000 timesteps. For the style reward this
//!   is the best and not the worst: the paper's peaks lie above its final values.
//! - *Steps* of the moving average are iterations, as they are what the paper counts and plots. The run has converged
//!   at the first iteration after which the average never leaves the band again.

use serde::{Deserialize, Serialize};

use crate::metric::Metric;

/// Control steps of a window.
pub const WINDOW_STEPS: u64 = 1_000;
/// Iterations of the moving average.
const AVERAGED: usize = 100;
/// Half width of the band about the final mean.
const BAND: f64 = 0.1;

/// What the study reads of a line of `metrics.jsonl`; a refused iteration has less.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Line {
    /// Counted from 1.
    pub iteration: u64,
    /// Transitions so far.
    pub samples: u64,
    /// 1 or 2.
    pub phase: Option<u32>,
    /// Planar velocity error of the iteration, m/s.
    pub rmse: Option<f64>,
    /// J per robot and 1,000 control steps.
    pub energy_j: Option<f64>,
    /// r̄ˢ.
    pub style_mean: Option<f64>,
    /// Mean length of the episodes that ended, as a share of the longest possible.
    pub episode_share: Option<f64>,
    /// Iteration whose report brought Phase II.
    pub switched_at: Option<u64>,
    /// μ lower of Eq. 13.
    pub lower_bound: Option<f64>,
    /// μ upper of Eq. 13.
    pub upper_bound: Option<f64>,
    /// Where the time went.
    pub timing: Timing,
}

/// Seconds of wall clock.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Timing {
    /// Of the run so far.
    pub seconds: f64,
    /// The whole cycle: collecting, learning, telling.
    pub iteration_seconds: f64,
    /// The scheduler's decision that this iteration followed.
    pub decision_seconds: Option<f64>,
    /// The learner's parts.
    pub learning: Learning,
}

/// Seconds of parts of learning.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Learning {
    /// From two rewards to one, of all transitions.
    pub weighting: Option<f64>,
}

impl Line {
    /// A metric's value in this iteration, if it has one.
    pub fn value(&self, metric: Metric) -> Option<f64> {
        let value = match metric {
            Metric::Rmse => self.rmse,
            Metric::Energy => self.energy_j,
            Metric::Style => self.style_mean,
        };
        value.filter(|value| value.is_finite())
    }
}

/// One metric of one run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Figures {
    /// Greatest window after the first 1,000 timesteps; none if the run holds no second window.
    pub peak: Option<f64>,
    /// The last window.
    pub last: f64,
    /// Iteration from which the moving average stays in the band about the final mean.
    pub convergence: Option<u64>,
}

/// All metrics of one run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// Iterations of a window.
    pub window: usize,
    rmse: Figures,
    energy_j: Figures,
    style: Figures,
}

impl Measured {
    /// Of a run with `steps` control steps per iteration; `None` if it is shorter than a window or a window is empty.
    pub fn of(records: &[Line], steps: u64) -> Option<Self> {
        let window = usize::try_from(WINDOW_STEPS.div_ceil(steps.max(1))).ok()?;
        let [rmse, energy, style] = Metric::ALL.map(|metric| figures(records, metric, window));
        Some(Self {
            window,
            rmse: rmse?,
            energy_j: energy?,
            style: style?,
        })
    }

    /// One of the metrics.
    pub fn figures(&self, metric: Metric) -> &Figures {
        match metric {
            Metric::Rmse => &self.rmse,
            Metric::Energy => &self.energy_j,
            Metric::Style => &self.style,
        }
    }
}

fn figures(records: &[Line], metric: Metric, window: usize) -> Option<Figures> {
    let values: Vec<Option<f64>> = records.iter().map(|record| record.value(metric)).collect();
    let last = over_window(values.get(values.len().checked_sub(window)?..)?, metric)?;
    let later = values.get(window..).unwrap_or_default();
    let peak = later
        .windows(window)
        .filter_map(|values| over_window(values, metric))
        .reduce(f64::max);
    Some(Figures {
        peak,
        last,
        convergence: convergence(&values, last).map(|index| records[index].iteration),
    })
}

/// A metric over the iterations of a window; refused ones count for nothing.
fn over_window(values: &[Option<f64>], metric: Metric) -> Option<f64> {
    match metric {
        Metric::Rmse => mean(values.iter().flatten().map(|error| error * error)).map(f64::sqrt),
        Metric::Energy | Metric::Style => mean(values.iter().flatten().copied()),
    }
}

/// Index of the first value from which on the trailing mean of 100 stays within the band about `last`.
fn convergence(values: &[Option<f64>], last: f64) -> Option<usize> {
    let inside = |window: &[Option<f64>]| {
        mean(window.iter().flatten().copied())
            .is_some_and(|mean| (mean - last).abs() <= BAND * last.abs())
    };
    let settled = values
        .windows(AVERAGED)
        .rev()
        .take_while(|window| inside(window))
        .count();
    (settled > 0).then(|| values.len() - settled)
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(iteration: u64, value: f64) -> Line {
        Line {
            iteration,
            rmse: Some(value),
            energy_j: Some(1000.0 * value),
            style_mean: Some(value / 10.0),
            ..Line::default()
        }
    }

    fn run(values: &[f64]) -> Vec<Line> {
        (1..)
            .zip(values)
            .map(|(i, value)| record(i, *value))
            .collect()
    }

    #[test]
    fn final_and_peak_are_windows_of_a_thousand_steps() {
        // 500 steps an iteration: windows of two. The first two are before timestep 1,000.
        let records = run(&[9.0, 9.0, 1.0, 7.0, 1.0, 3.0]);
        let measured = Measured::of(&records, 500).unwrap();
        assert_eq!(measured.window, 2);
        let rmse = measured.figures(Metric::Rmse);
        assert_eq!(rmse.last, 5.0_f64.sqrt()); // √((1 + 9) / 2)
        assert_eq!(rmse.peak, Some(5.0)); // √((1 + 49) / 2), also of 7 and 1
        let energy = measured.figures(Metric::Energy);
        assert_eq!((energy.last, energy.peak), (2000.0, Some(4000.0)));
        let style = measured.figures(Metric::Style);
        assert!((style.last - 0.2).abs() < 1e-12 && (style.peak.unwrap() - 0.4).abs() < 1e-12);
        assert_eq!(style.convergence, None); // shorter than the moving average
    }

    #[test]
    fn iterations_of_24_steps_make_windows_of_42() {
        let records = run(&[1.0; 42]);
        let measured = Measured::of(&records, 24).unwrap();
        assert_eq!(measured.window, 42); // 41 · 24 = 984
        assert_eq!(measured.figures(Metric::Rmse).peak, None);
        assert_eq!(Measured::of(&records[1..], 24), None);
    }

    #[test]
    fn a_refused_iteration_counts_for_nothing() {
        let mut records = run(&[1.0, 1.0, 3.0, 5.0]);
        records[3] = Line {
            iteration: 4,
            ..Line::default()
        };
        let measured = Measured::of(&records, 500).unwrap();
        assert_eq!(measured.figures(Metric::Energy).last, 3000.0);
    }

    #[test]
    fn convergence_is_the_last_entry_into_the_band() {
        // 100 of 2.5, then 200 of 1. After k ones the mean of 100 is 2.5 − 1.5·k/100: 1.105 at 93, 1.09 at 94.
        let values: Vec<f64> = [vec![2.5; 100], vec![1.0; 200]].concat();
        let measured = Measured::of(&run(&values), 1000).unwrap();
        assert_eq!(measured.figures(Metric::Energy).convergence, Some(194));
        // A bump near the end takes it out of the band: 20 of 2 in the last 100 mean 1.2.
        let values: Vec<f64> = [vec![1.0; 300], vec![2.0; 20], vec![1.0; 1]].concat();
        let measured = Measured::of(&run(&values), 1000).unwrap();
        assert_eq!(measured.figures(Metric::Energy).convergence, None);
        let steady = Measured::of(&run(&[1.0; 150]), 1000).unwrap();
        assert_eq!(steady.figures(Metric::Style).convergence, Some(100)); // the first mean of 100
    }

    #[test]
    fn a_line_of_metrics_is_read_by_its_keys() {
        let line = serde_json::json!({
            "iteration": 7, "samples": 70, "rmse": 0.5, "energy_j": null, "gait": "walk",
            "timing": { "iteration_seconds": 0.5, "decision_seconds": 1e-6, "learning": { "weighting": 1e-5 } },
        });
        let record: Line = serde_json::from_value(line).unwrap();
        assert_eq!(record.value(Metric::Rmse), Some(0.5));
        assert_eq!(record.value(Metric::Energy), None);
        assert_eq!(record.timing.learning.weighting, Some(1e-5));
    }
}
