//! Training curves over seeds: mean and deviation on a common grid of iterations.

use crate::metric::Metric;
use crate::results::{Results, Run};
use crate::statistics::Spread;

/// Points of a curve at most: as many as a figure can show.
const POINTS: u64 = 150;

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Middle of the iterations that it stands for.
    pub iteration: f64,
    /// Over the runs that reached it; each run counts with its mean over these iterations.
    pub spread: Spread,
}

/// A method's curve over its finished runs.
pub fn curve(results: &Results, entry: &str, metric: Metric) -> Vec<Point> {
    let runs: Vec<&Run> = results.measured(entry).collect();
    let last = runs.iter().map(|run| run.target).max().unwrap_or(0);
    let size = last.div_ceil(POINTS).max(1);
    (0..last.div_ceil(size))
        .filter_map(|group| {
            let from = group * size;
            let until = (from + size).min(last);
            let means: Vec<f64> = runs
                .iter()
                .filter_map(|run| mean(run, metric, from, until))
                .collect();
            Some(Point {
                iteration: 0.5 * (from + until + 1) as f64,
                spread: Spread::of(&means)?,
            })
        })
        .collect()
}

/// Of a run over iterations `from` + 1 to `until`.
fn mean(run: &Run, metric: Metric, from: u64, until: u64) -> Option<f64> {
    let begin = run
        .records
        .partition_point(|record| record.iteration <= from);
    let end = run
        .records
        .partition_point(|record| record.iteration <= until);
    let values: Vec<f64> = run.records[begin..end.max(begin)]
        .iter()
        .filter_map(|record| record.value(metric))
        .collect();
    Spread::of(&values).map(|spread| spread.mean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::sample;

    #[test]
    fn a_curve_is_the_mean_of_the_runs() {
        let results = sample::results(&[("ampco", &[1.0, 2.0, 3.0])]);
        let curve = curve(&results, "ampco", Metric::Energy);
        assert_eq!(curve.len(), 100); // 200 iterations, two by two
        assert_eq!(curve[0].iteration, 1.5);
        let spread = curve[99].spread;
        assert_eq!(
            (spread.runs, spread.mean, spread.deviation),
            (3, 2000.0, 1000.0)
        );
    }
}
