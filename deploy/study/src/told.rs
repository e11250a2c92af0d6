//! What a run's lines of metrics come to: all that a report says of a run, without the lines.
//!
//! Separate because the lines stay on the machine that made them, and this goes on in the run's record.

use serde::{Deserialize, Serialize};

use crate::measure::Line;
use crate::metric::Metric;
use crate::overhead::Overhead;

/// Points of a curve at most: as many as a figure can show.
const POINTS: u64 = 150;

/// What was read in a run's lines of metrics.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Told {
    /// Iterations done.
    pub iteration: u64,
    /// Transitions of these.
    pub samples: u64,
    /// What they took, s.
    pub seconds: f64,
    /// Iteration whose report brought Phase II.
    pub switched_at: Option<u64>,
    /// Mean length of the episodes that ended in that iteration, as a share of the longest possible.
    pub episode_share_at_switch: Option<f64>,
    /// μ lower of Eq. 13.
    pub lower_bound: Option<f64>,
    /// μ upper of Eq. 13.
    pub upper_bound: Option<f64>,
    /// What scheduling cost.
    pub overhead: Option<Overhead>,
    /// Means of the metrics over groups of iterations.
    pub curves: Curves,
}

/// Means over the [`groups`] of a run's iterations; none where a group has no value.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curves {
    /// Planar velocity error, m/s.
    pub rmse: Vec<Option<f64>>,
    /// J per robot and 1,000 control steps.
    pub energy_j: Vec<Option<f64>>,
    /// r̄ˢ of the run's own discriminator.
    pub style: Vec<Option<f64>>,
    /// Length of episodes as a share of the longest possible.
    pub episode_share: Vec<Option<f64>>,
}

impl Curves {
    /// One of the metrics.
    pub fn of(&self, metric: Metric) -> &[Option<f64>] {
        match metric {
            Metric::Rmse => &self.rmse,
            Metric::Energy => &self.energy_j,
            Metric::Style => &self.style,
        }
    }
}

impl Told {
    /// Of a run that is to do `target` iterations.
    pub fn of(lines: &[Line], target: u64) -> Self {
        let newest = lines.last().cloned().unwrap_or_default();
        // The breakout that is found in the report of an iteration is told with the directive after it.
        let at_switch = newest
            .switched_at
            .and_then(|at| lines.iter().rfind(|line| line.iteration <= at));
        let curve = |value: &dyn Fn(&Line) -> Option<f64>| curve(lines, target, value);
        Self {
            iteration: newest.iteration,
            samples: newest.samples,
            seconds: newest.timing.seconds,
            switched_at: newest.switched_at,
            episode_share_at_switch: at_switch.and_then(|line| line.episode_share),
            lower_bound: newest.lower_bound,
            upper_bound: newest.upper_bound,
            overhead: Overhead::of(lines),
            curves: Curves {
                rmse: curve(&|line| line.value(Metric::Rmse)),
                energy_j: curve(&|line| line.value(Metric::Energy)),
                style: curve(&|line| line.value(Metric::Style)),
                episode_share: curve(&|line| line.episode_share),
            },
        }
    }
}

/// The groups of iterations that a curve of a run of `target` iterations has its points of: each is the iterations after
/// the first number up to the second.
pub fn groups(target: u64) -> impl Iterator<Item = (u64, u64)> {
    let size = target.div_ceil(POINTS).max(1);
    (0..target.div_ceil(size)).map(move |group| (group * size, (group * size + size).min(target)))
}

fn curve(lines: &[Line], target: u64, value: &dyn Fn(&Line) -> Option<f64>) -> Vec<Option<f64>> {
    groups(target)
        .map(|(from, until)| {
            let begin = lines.partition_point(|line| line.iteration <= from);
            let end = lines.partition_point(|line| line.iteration <= until);
            let values: Vec<f64> = lines[begin..end.max(begin)]
                .iter()
                .filter_map(value)
                .collect();
            let sum: f64 = values.iter().sum();
            (!values.is_empty()).then(|| rounded(sum / values.len() as f64))
        })
        .collect()
}

/// Five significant digits: more than a figure shows, and a third of the bytes.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(iteration: u64, rmse: Option<f64>) -> Line {
        Line {
            iteration,
            samples: 10 * iteration,
            rmse,
            episode_share: Some(0.01 * iteration as f64),
            switched_at: (iteration > 7).then_some(7),
            ..Line::default()
        }
    }

    #[test]
    fn a_curve_has_no_more_points_than_a_figure_shows() {
        let sizes: Vec<(u64, u64)> = groups(301).collect();
        assert_eq!(sizes.len(), 101); // three by three
        assert_eq!((sizes[0], sizes[100]), ((0, 3), (300, 301)));
        assert_eq!(groups(150).count(), 150);
        assert_eq!(groups(0).count(), 0);
    }

    #[test]
    fn points_are_means_of_what_their_lines_have() {
        let mut lines: Vec<Line> = (1..=10).map(|i| line(i, Some(i as f64 / 3.0))).collect();
        lines[4].rmse = None; // refused
        let told = Told::of(&lines, 300);
        // Pairs: (1/3 + 2/3) / 2, …, the sixth alone, (7/3 + 8/3) / 2; nothing after the tenth.
        assert_eq!(told.curves.rmse.len(), 150);
        assert_eq!(
            told.curves.rmse[..5],
            [Some(0.5), Some(1.1667), Some(2.0), Some(2.5), Some(3.1667)]
        );
        assert_eq!(told.curves.rmse[5], None);
        assert_eq!((told.iteration, told.samples), (10, 100));
        assert_eq!(
            (told.switched_at, told.episode_share_at_switch),
            (Some(7), Some(0.07))
        );
        assert_eq!(Told::of(&[], 300).iteration, 0);
    }
}
