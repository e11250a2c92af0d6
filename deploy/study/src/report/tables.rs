//! Tables III and IV in the paper's layout, with the paper's own figures under ours.

use super::html::{Cell, head, table};
use crate::compare::{Comparison, LEVEL, written};
use crate::metric::Metric;
use crate::paper;
use crate::results::{Column, Results};
use crate::statistics::Spread;

/// The columns of the paper, in its order.
const COLUMNS: [(Metric, Column); 6] = [
    (Metric::Rmse, Column::Peak),
    (Metric::Rmse, Column::Last),
    (Metric::Energy, Column::Peak),
    (Metric::Energy, Column::Last),
    (Metric::Style, Column::Peak),
    (Metric::Style, Column::Last),
];

/// One of the paper's tables.
pub(super) fn performance(results: &Results, methods: &[&str]) -> String {
    let marks: Vec<Marks> = COLUMNS
        .iter()
        .map(|(metric, column)| Marks::of(results, methods, *metric, *column))
        .collect();
    let rows: Vec<Vec<Cell>> = methods
        .iter()
        .map(|method| {
            let mut row = vec![Cell::text(paper::label(method))];
            for ((metric, column), marks) in COLUMNS.iter().zip(&marks) {
                row.push(value(results, method, *metric, *column, marks));
            }
            for metric in Metric::ALL {
                row.push(convergence(results, method, metric));
            }
            row.push(Cell::text(results.measured(method).count().to_string()));
            row
        })
        .collect();
    table(HEAD, &rows)
}

const HEAD: &str = "<tr><th rowspan=2>Method</th><th colspan=2>RMSE Velocity Tracking (m/s)</th>\
<th colspan=2>Energy Consumption (J)</th><th colspan=2>Discriminator Reward</th><th colspan=3>Convergence \
iterations</th><th rowspan=2>n</th></tr><tr><th>Peak ↓</th><th>Final ↓</th><th>Peak ↓</th><th>Final ↓</th>\
<th>Peak ↑</th><th>Final ↑</th><th>RMSE</th><th>Energy</th><th>Disc</th></tr>";

/// Coefficients of variation of final values, ours and the paper's.
pub(super) fn variation(results: &Results, methods: &[&str]) -> String {
    let rows: Vec<Vec<Cell>> = methods
        .iter()
        .map(|method| {
            let mut row = vec![Cell::text(paper::label(method))];
            for metric in Metric::ALL {
                let ours = results.spread(method, metric, Column::Last);
                let ours = ours.map_or(f64::NAN, |spread| spread.variation());
                let theirs = paper::row(method).map_or(f64::NAN, |row| {
                    let (mean, deviation) = row.column(metric).last;
                    deviation / mean
                });
                row.push(Cell::html(format!(
                    "{}<br><small>{}</small>",
                    percent(ours),
                    percent(theirs)
                )));
            }
            row
        })
        .collect();
    table(&head(&["Method", "RMSE", "Energy", "Disc"]), &rows)
}

/// AMPCO, or the first method, against each other one: exact p of peak and final values.
pub(super) fn tests(results: &Results, methods: &[&str], against: &str) -> String {
    let rows: Vec<Vec<Cell>> = methods
        .iter()
        .filter(|method| **method != against)
        .map(|method| {
            let mut row = vec![Cell::text(paper::label(method))];
            let mut pairs = 0;
            for (metric, column) in COLUMNS {
                let comparison = Comparison::of(results, against, method, metric, column);
                pairs = pairs.max(comparison.map_or(0, |comparison| comparison.pairs));
                row.push(comparison.map_or_else(
                    || Cell::text("–"),
                    |comparison| {
                        let statistic = comparison.test.map_or(0.0, |test| test.statistic);
                        Cell {
                            hint: format!("W = {statistic}, {}", comparison.words()),
                            ..Cell::text(written(comparison.p()))
                        }
                    },
                ));
            }
            row.push(Cell::text(pairs.to_string()));
            row.push(Cell::text(written(crate::wilcoxon::smallest_p(pairs))));
            row
        })
        .collect();
    let head = head(&[
        "Method",
        "RMSE peak",
        "RMSE final",
        "Energy peak",
        "Energy final",
        "Disc peak",
        "Disc final",
        "pairs",
        "smallest reachable p",
    ]);
    table(&head, &rows)
}

/// What of a column is marked: the extremes, and who cannot be told from them.
struct Marks {
    best: Option<String>,
    worst: Option<String>,
    like_best: Vec<String>,
    like_worst: Vec<String>,
}

impl Marks {
    fn of(results: &Results, methods: &[&str], metric: Metric, column: Column) -> Self {
        let mut means: Vec<(f64, &str)> = methods
            .iter()
            .filter_map(|method| Some((results.spread(method, metric, column)?.mean, *method)))
            .collect();
        means.sort_by(|a, b| a.0.total_cmp(&b.0));
        if metric == Metric::Style {
            means.reverse();
        }
        // One method alone is neither best nor worst.
        let (best, worst) = match means.as_slice() {
            [best, .., worst] => (Some(best.1), Some(worst.1)),
            _ => (None, None),
        };
        let like = |extreme: Option<&str>| -> Vec<String> {
            let Some(extreme) = extreme else {
                return Vec::new();
            };
            let others = means.iter().filter(|(_, method)| *method != extreme);
            others
                .filter(|(_, method)| {
                    Comparison::of(results, extreme, method, metric, column)
                        .is_some_and(|found| found.can_decide() && found.p() >= LEVEL)
                })
                .map(|(_, method)| (*method).to_owned())
                .collect()
        };
        Self {
            like_best: like(best),
            like_worst: like(worst),
            best: best.map(str::to_owned),
            worst: worst.map(str::to_owned),
        }
    }

    fn class(&self, method: &str) -> &'static str {
        let holds = |names: &[String]| names.iter().any(|name| name == method);
        if self.best.as_deref() == Some(method) {
            "best"
        } else if self.worst.as_deref() == Some(method) {
            "worst"
        } else if holds(&self.like_best) {
            "like-best"
        } else if holds(&self.like_worst) {
            "like-worst"
        } else {
            ""
        }
    }
}

fn value(results: &Results, method: &str, metric: Metric, column: Column, marks: &Marks) -> Cell {
    let theirs = paper::row(method).map_or_else(String::new, |row| {
        let columns = row.column(metric);
        let (mean, deviation) = match column {
            Column::Peak => columns.peak,
            _ => columns.last,
        };
        format!(
            "<br><small>{} ± {}</small>",
            metric.written(mean),
            metric.written(deviation)
        )
    });
    let ours = results.spread(method, metric, column).map_or_else(
        || "–".to_owned(),
        |spread| mean_and_deviation(metric, &spread),
    );
    let runs = results
        .measured(method)
        .filter_map(|run| Some(format!("{} {}", run.name, run.value(metric, column)?)));
    Cell {
        content: format!("{ours}{theirs}"),
        class: marks.class(method),
        hint: runs.collect::<Vec<_>>().join("\n"),
    }
}

/// "0.288 ± 0.017"; of one run its value alone.
pub(super) fn mean_and_deviation(metric: Metric, spread: &Spread) -> String {
    let mean = metric.written(spread.mean);
    if spread.runs == 1 {
        mean
    } else {
        format!("{mean} ± {}", metric.written(spread.deviation))
    }
}

fn convergence(results: &Results, method: &str, metric: Metric) -> Cell {
    let theirs = paper::row(method).map_or_else(String::new, |row| {
        format!(
            "<br><small>{:.1}k</small>",
            row.convergence(metric) / 1000.0
        )
    });
    let runs = results.measured(method).count();
    let ours = match results.spread(method, metric, Column::Convergence) {
        Some(spread) if spread.runs == runs => format!("{:.0}", spread.mean),
        // A mean over those that did would flatter a method.
        Some(spread) => format!("{:.0} ({} of {runs})", spread.mean, spread.runs),
        None => "–".to_owned(),
    };
    Cell::html(format!("{ours}{theirs}"))
}

fn percent(share: f64) -> String {
    if share.is_finite() {
        format!("{:.1} %", 100.0 * share)
    } else {
        "–".to_owned()
    }
}
