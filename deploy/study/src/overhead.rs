//! What the scheduler costs (II-B), in runs and alone.

use serde::{Deserialize, Serialize};

use crate::measure::Line;
use crate::statistics::median;

/// The last line of `ampco bench scheduler`, as far as it is told here.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Benchmark {
    /// A decision with both windows full, µs.
    pub decision_us: f64,
    /// Iterations that the windows hold.
    pub window: u64,
    /// Eq. 9 and the blend for one control step of 4096 robots, µs.
    pub phase_one_us_per_step_of_4096: f64,
    /// Eq. 12 and the blend for the same.
    pub phase_two_us_per_step_of_4096: f64,
}

/// Medians over a run's iterations, and shares of them. Times are by the wall clock: a decision in whose midst another
/// program was given the core takes milliseconds, and sums would tell of that program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Overhead {
    /// Iterations that told.
    pub iterations: usize,
    /// A training cycle, s.
    pub cycle: f64,
    /// The scheduler's decision: from a report to the rule, s.
    pub decision: f64,
    /// The learner's weighting and blending of all transitions of a cycle, s.
    pub weighting: f64,
    /// The median decision over the median cycle.
    pub decision_share: f64,
    /// The median weighting over the median cycle.
    pub weighting_share: f64,
    /// Sum of all decisions over the sum of all cycles, whatever interrupted them.
    pub decision_share_of_sums: f64,
}

impl Overhead {
    /// Of a run; `None` if no line of its metrics tells.
    pub fn of(records: &[Line]) -> Option<Self> {
        let told: Vec<(f64, f64, f64)> = records
            .iter()
            .filter_map(|record| {
                let timing = &record.timing;
                let decision = timing.decision_seconds?;
                let weighting = timing.learning.weighting?;
                (timing.iteration_seconds > 0.0).then_some((
                    timing.iteration_seconds,
                    decision,
                    weighting,
                ))
            })
            .collect();
        if told.is_empty() {
            return None;
        }
        let column =
            |part: fn(&(f64, f64, f64)) -> f64| -> Vec<f64> { told.iter().map(part).collect() };
        let (cycles, decisions, weightings) = (
            column(|told| told.0),
            column(|told| told.1),
            column(|told| told.2),
        );
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        let (cycle, decision, weighting) =
            (median(&cycles), median(&decisions), median(&weightings));
        Some(Self {
            iterations: told.len(),
            cycle,
            decision,
            weighting,
            decision_share: decision / cycle,
            weighting_share: weighting / cycle,
            decision_share_of_sums: sum(&decisions) / sum(&cycles),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{Learning, Timing};

    fn record(cycle: f64, decision: Option<f64>) -> Line {
        Line {
            timing: Timing {
                iteration_seconds: cycle,
                decision_seconds: decision,
                learning: Learning {
                    weighting: Some(1e-5),
                },
                ..Timing::default()
            },
            ..Line::default()
        }
    }

    #[test]
    fn an_interrupted_decision_does_not_count_for_the_scheduler() {
        let records = [
            record(0.5, None),
            record(0.5, Some(1e-6)),
            record(0.5, Some(1e-6)),
            record(1.0, Some(2e-2)), // another program had the core
        ];
        let overhead = Overhead::of(&records).unwrap();
        assert_eq!(overhead.iterations, 3);
        assert_eq!((overhead.cycle, overhead.decision), (0.5, 1e-6));
        assert!((overhead.decision_share - 2e-6).abs() < 1e-18); // 1 µs of 0.5 s
        assert!((overhead.weighting_share - 2e-5).abs() < 1e-17); // 10 µs of 0.5 s
        assert!((overhead.decision_share_of_sums - 0.010_001).abs() < 1e-12); // 20.002 ms of 2 s
        assert_eq!(Overhead::of(&records[..1]), None);
    }
}
