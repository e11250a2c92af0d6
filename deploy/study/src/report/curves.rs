//! Training curves over seeds: mean and deviation on a common grid of iterations.

use crate::metric::Metric;
use crate::results::{Results, Run};
use crate::statistics::Spread;
use crate::told::groups;

/// A point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Middle of the iterations that it stands for.
    pub iteration: f64,
    /// Over the runs that reached it; each run counts with its mean over these iterations.
    pub spread: Spread,
}

/// A method's curve over its finished runs, on the grid of the longest.
pub fn curve(results: &Results, entry: &str, metric: Metric) -> Vec<Point> {
    let runs: Vec<&Run> = results.measured(entry).collect();
    let last = runs.iter().map(|run| run.target).max().unwrap_or(0);
    groups(last)
        .filter_map(|(from, until)| {
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

/// Of a run's points whose iterations lie within `from` + 1 to `until`: one, if its grid is this one.
fn mean(run: &Run, metric: Metric, from: u64, until: u64) -> Option<f64> {
    let inside = |(begin, end): &(u64, u64)| *begin >= from && *end <= until;
    let points = groups(run.target).zip(run.told.curves.of(metric));
    let values: Vec<f64> = points
        .filter(|(group, _)| inside(group))
        .filter_map(|(_, value)| *value)
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
