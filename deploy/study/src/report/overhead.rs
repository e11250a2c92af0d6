//! What scheduling costs: alone on this machine, and as a share of the runs' cycles.

use std::fmt::Write;

use super::html::{Cell, head, table};
use crate::overhead::Overhead;
use crate::paper;
use crate::results::Results;
use crate::statistics::median;

pub(super) fn overhead(results: &Results) -> String {
    let mut html = "<h2>Overhead of scheduling</h2>\n".to_owned();
    if let Some(bench) = &results.benchmark {
        let rows = [
            (
                "Phase I weighting, one control step of 4096 robots",
                bench.phase_one_us_per_step_of_4096,
                paper::PHASE_ONE_US,
            ),
            (
                "Phase II weighting, the same",
                bench.phase_two_us_per_step_of_4096,
                paper::PHASE_TWO_US,
            ),
            (
                "breakout detection, once per iteration",
                bench.decision_us,
                paper::DECISION_US,
            ),
        ];
        let rows: Vec<Vec<Cell>> = rows
            .iter()
            .map(|(what, ours, theirs)| {
                vec![
                    Cell::text(what),
                    Cell::text(format!("{ours:.2} µs")),
                    Cell::text(format!("{theirs:.2} µs")),
                ]
            })
            .collect();
        let _ = write!(
            html,
            "<p>Alone, on this machine (<code>ampco bench scheduler</code>, windows of {}):</p>\n{}",
            bench.window,
            table(&head(&["", "ours", "the paper's (II-B)"]), &rows)
        );
    }
    let rows: Vec<Vec<Cell>> = results
        .entries
        .iter()
        .filter_map(|entry| {
            let of_runs: Vec<Overhead> = results
                .runs
                .iter()
                .filter(|run| run.entry == entry.name)
                .filter_map(|run| run.told.overhead)
                .collect();
            if of_runs.is_empty() {
                return None;
            }
            let middle =
                |part: fn(&Overhead) -> f64| median(&of_runs.iter().map(part).collect::<Vec<_>>());
            Some(vec![
                Cell::text(paper::label(&entry.name)),
                Cell::text(format!("{:.0} ms", 1e3 * middle(|of| of.cycle))),
                Cell::text(format!("{:.2} µs", 1e6 * middle(|of| of.decision))),
                Cell::text(format!("{:.6} %", 100.0 * middle(|of| of.decision_share))),
                Cell::text(format!("{:.1} µs", 1e6 * middle(|of| of.weighting))),
                Cell::text(format!("{:.6} %", 100.0 * middle(|of| of.weighting_share))),
            ])
        })
        .collect();
    let head = head(&[
        "In the runs",
        "training cycle",
        "scheduler's decision",
        "share of a cycle",
        "weighting in the learner",
        "share of a cycle",
    ]);
    let _ = write!(
        html,
        "<p>Medians by the wall clock, and shares of the median cycle (sums, which hold whatever interrupted a decision, are in \
         runs.csv); the paper: less than 0.012 % for both together, of a cycle of 2.1 s.</p>\n{}",
        table(&head, &rows)
    );
    html
}
