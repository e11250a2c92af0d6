//! The report's numbers as CSV, in full precision.

use std::fmt::Write;

use super::curves::curve;
use crate::claims::claims as all_claims;
use crate::compare::Comparison;
use crate::metric::Metric;
use crate::overhead::Overhead;
use crate::results::{Column, Results, State};

const COLUMNS: [Column; 3] = [Column::Peak, Column::Last, Column::Convergence];

/// A row per run.
pub(super) fn runs(results: &Results) -> String {
    let mut text = "run,method,seed,state,iterations,samples,seconds,window_iterations".to_owned();
    each(|metric, column| {
        let _ = write!(text, ",{}_{}", metric.key(), column.key());
    });
    text.push_str(
        ",switched_at,lower_bound,upper_bound,decision_share,weighting_share,decision_share_of_sums,decision_us,weighting_us,cycle_s,record\n",
    );
    for run in &results.runs {
        let told = &run.told;
        let state = match &run.state {
            State::Finished => "finished",
            State::Unfinished => "unfinished",
            State::Failed(_) => "failed",
            State::Missing => "missing",
        };
        let window = run.measured.map(|measured| measured.window);
        let _ = write!(
            text,
            "{},{},{},{state},{},{},{},{}",
            run.name,
            run.entry,
            run.seed,
            told.iteration,
            told.samples,
            told.seconds,
            optional(window)
        );
        each(|metric, column| {
            let _ = write!(text, ",{}", optional(run.value(metric, column)));
        });
        let overhead = told.overhead;
        let of = |part: fn(&Overhead) -> f64| optional(overhead.as_ref().map(part));
        let _ = writeln!(
            text,
            ",{},{},{},{},{},{},{},{},{},{}",
            optional(told.switched_at),
            optional(told.lower_bound),
            optional(told.upper_bound),
            of(|overhead| overhead.decision_share),
            of(|overhead| overhead.weighting_share),
            of(|overhead| overhead.decision_share_of_sums),
            of(|overhead| 1e6 * overhead.decision),
            of(|overhead| 1e6 * overhead.weighting),
            of(|overhead| overhead.cycle),
            quoted(&run.link)
        );
    }
    text
}

/// A row per method: mean, deviation and number of runs of every column.
pub(super) fn methods(results: &Results) -> String {
    let mut text = "method".to_owned();
    each(|metric, column| {
        let name = format!("{}_{}", metric.key(), column.key());
        let _ = write!(text, ",{name}_mean,{name}_std,{name}_runs");
    });
    text.push('\n');
    for entry in &results.entries {
        text.push_str(&entry.name);
        each(|metric, column| {
            let spread = results.spread(&entry.name, metric, column);
            let deviation = spread
                .map(|spread| spread.deviation)
                .filter(|d| d.is_finite());
            let _ = write!(
                text,
                ",{},{},{}",
                optional(spread.map(|spread| spread.mean)),
                optional(deviation),
                spread.map_or(0, |spread| spread.runs)
            );
        });
        text.push('\n');
    }
    text
}

/// A row per pair of methods and column.
pub(super) fn tests(results: &Results) -> String {
    let mut text =
        "first,second,metric,column,pairs,first_mean,second_mean,statistic,p,smallest_p,rank_biserial,\
         median_difference,low,high\n"
            .to_owned();
    for (index, first) in results.entries.iter().enumerate() {
        for second in &results.entries[index + 1..] {
            each(|metric, column| {
                let (a, b) = (&first.name, &second.name);
                let Some(found) = Comparison::of(results, a, b, metric, column) else {
                    return;
                };
                let _ = writeln!(
                    text,
                    "{a},{b},{},{},{},{},{},{},{},{},{},{},{},{}",
                    metric.key(),
                    column.key(),
                    found.pairs,
                    found.first,
                    found.second,
                    optional(found.test.map(|test| test.statistic)),
                    found.p(),
                    found.smallest_p(),
                    found.rank_biserial(),
                    optional(found.difference.map(|found| found.median)),
                    optional(found.difference.map(|found| found.low)),
                    optional(found.difference.map(|found| found.high))
                );
            });
        }
    }
    text
}

/// A row per claim.
pub(super) fn claims(results: &Results) -> String {
    let mut text = "section,claim,verdict,evidence\n".to_owned();
    for claim in all_claims(results) {
        let _ = writeln!(
            text,
            "{},{},{},{}",
            quoted(claim.section),
            quoted(claim.text),
            claim.verdict.word(),
            quoted(&claim.evidence)
        );
    }
    text
}

/// Figure 3's points.
pub(super) fn curves(results: &Results) -> String {
    let mut text = "method,metric,iteration,mean,std,runs\n".to_owned();
    for entry in &results.entries {
        for metric in Metric::ALL {
            for point in curve(results, &entry.name, metric) {
                let spread = point.spread;
                let deviation = Some(spread.deviation).filter(|d| d.is_finite());
                let _ = writeln!(
                    text,
                    "{},{},{},{},{},{}",
                    entry.name,
                    metric.key(),
                    point.iteration,
                    spread.mean,
                    optional(deviation),
                    spread.runs
                );
            }
        }
    }
    text
}

fn each(mut write: impl FnMut(Metric, Column)) {
    for metric in Metric::ALL {
        for column in COLUMNS {
            write(metric, column);
        }
    }
}

fn optional(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}
