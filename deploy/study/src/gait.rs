//! Measures of a policy without exploration noise: how it goes, beside the paper's three metrics of training.
//!
//! Separate because each is of the judgement and not of the lines of metrics: a run's number is its mean over commands.

use crate::judged::Judged;
use crate::results::{Results, Run};

/// One number of a judged run.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// Its heading, with its unit.
    pub heading: &'static str,
    /// Digits after the point.
    pub digits: usize,
    of: fn(&Judged) -> Option<f64>,
}

const fn measure(heading: &'static str, digits: usize, of: fn(&Judged) -> Option<f64>) -> Measure {
    Measure {
        heading,
        digits,
        of,
    }
}

/// Root of the mean squared planar velocity error, m/s.
pub const ERROR: Measure = measure("error, m/s", 3, |row| Some(row.rmse));
/// Positive work of 1,000 control steps, J.
pub const ENERGY: Measure = measure("energy, J", 0, |row| Some(row.energy_j));
/// How far strides a second are from those of the reference motion nearest to the command, 1/s.
pub const STRIDES_OFF: Measure = measure("strides off the reference, 1/s", 2, |row| {
    let reference = row.reference.as_ref()?.stride_rate_hz;
    Some((row.stride_rate_hz? - reference).abs())
});
/// Mean style reward by whoever judged it.
pub const STYLE: Measure = measure("style", 3, |row| row.style_reward);

/// In the order of the table.
pub const MEASURES: [Measure; 9] = [
    measure("survival, %", 0, |row| Some(100.0 * row.survival)),
    ERROR,
    ENERGY,
    measure("strides, 1/s", 2, |row| row.stride_rate_hz),
    STRIDES_OFF,
    measure("duty", 2, |row| row.duty_factor),
    measure("hip correlation", 2, |row| row.hip_correlation),
    measure("slip, m/s", 3, |row| row.foot_slip),
    STYLE,
];

impl Measure {
    /// A run's mean over its commands; `None` where one of them has no value: a robot that stands has no strides.
    pub fn of_run(&self, run: &Run) -> Option<f64> {
        let values: Option<Vec<f64>> = run.judged.iter().map(self.of).collect();
        let values = values.filter(|values| !values.is_empty())?;
        Some(values.iter().sum::<f64>() / values.len() as f64)
    }

    /// Of the runs of an entry that have it.
    pub fn values(&self, results: &Results, entry: &str) -> Vec<f64> {
        let runs = results.runs.iter().filter(|run| run.entry == entry);
        runs.filter_map(|run| self.of_run(run)).collect()
    }

    /// Of two entries over the seeds that both have.
    pub fn paired(&self, results: &Results, a: &str, b: &str) -> Vec<(f64, f64)> {
        let of = |entry: &str, seed: u64| {
            let mut runs = results.runs.iter();
            let run = runs.find(|run| run.entry == entry && run.seed == seed)?;
            self.of_run(run)
        };
        let seeds = results
            .runs
            .iter()
            .filter(|run| run.entry == a)
            .map(|run| run.seed);
        seeds
            .filter_map(|seed| Some((of(a, seed)?, of(b, seed)?)))
            .collect()
    }

    /// A value with its digits.
    pub fn written(&self, value: f64) -> String {
        let digits = self.digits;
        format!("{value:.digits$}").replace('-', "−")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judged::Reference;
    use crate::results::sample;

    #[test]
    fn a_run_has_the_mean_over_its_commands() {
        let mut results = sample::results(&[("ampco", &[1.0, 2.0]), ("amp-0.5", &[3.0, 4.0])]);
        let row = |rmse, strides| Judged {
            rmse,
            stride_rate_hz: strides,
            reference: Some(Reference {
                stride_rate_hz: 1.0,
            }),
            ..Judged::default()
        };
        results.runs[0].judged = vec![row(0.1, Some(0.75)), row(0.3, Some(1.75))];
        results.runs[1].judged = vec![row(0.4, None)];
        results.runs[2].judged = vec![row(0.5, Some(2.0))];
        let of = |measure: Measure, run: usize| measure.of_run(&results.runs[run]);
        assert_eq!(of(ERROR, 0), Some(0.2));
        assert_eq!(of(STRIDES_OFF, 0), Some(0.5)); // (0.25 + 0.75) / 2
        assert_eq!((of(STRIDES_OFF, 1), of(ERROR, 3)), (None, None));
        assert_eq!(ERROR.paired(&results, "ampco", "amp-0.5"), [(0.2, 0.5)]);
        assert_eq!(ERROR.values(&results, "ampco"), [0.2, 0.4]);
        assert_eq!(STYLE.written(-0.12345), "−0.123");
    }
}
