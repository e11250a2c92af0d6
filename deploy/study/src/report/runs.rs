//! Every run by itself: what its policy did, and its numbers.

use super::html::{Cell, escape, head, table};
use crate::metric::Metric;
use crate::results::{Column, Results, State};

/// What the policies did without exploration noise.
pub(super) fn judged(results: &Results) -> String {
    let rows: Vec<Vec<Cell>> = results
        .runs
        .iter()
        .flat_map(|run| run.judged.iter().map(move |judged| (run, judged)))
        .map(|(run, judged)| {
            let [x, y, yaw] = judged.command;
            vec![
                link(run),
                Cell::text(format!("{x}, {y}, {yaw}")),
                Cell::text(format!("{:.0} %", 100.0 * judged.survival)),
                Cell::text(Metric::Rmse.written(judged.rmse)),
                Cell::text(format!("{:.3}", judged.rmse_yaw_rate)),
                Cell::text(Metric::Energy.written(judged.energy_j)),
                Cell::text(&judged.gait),
            ]
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let head = head(&[
        "Run",
        "command",
        "survival",
        "RMSE, m/s",
        "of the yaw rate, rad/s",
        "energy, J",
        "gait",
    ]);
    format!(
        "<h2>Without exploration, in rapier</h2>\n<p><code>ampco evaluate</code> of the last checkpoint from standing, \
         whatever engine it was trained in. Training figures above hold the exploration noise.</p>\n{}",
        table(&head, &rows)
    )
}

/// Every run with its numbers.
pub(super) fn runs(results: &Results) -> String {
    let mut titles = vec!["Run", "state", "iterations", "samples", "minutes"];
    titles.extend([
        "RMSE peak",
        "final",
        "conv.",
        "Energy peak",
        "final",
        "conv.",
        "Disc peak",
        "final",
        "conv.",
    ]);
    titles.extend(["Phase II at", "bounds of Eq. 13"]);
    let rows: Vec<Vec<Cell>> = results
        .runs
        .iter()
        .map(|run| {
            let told = &run.told;
            let state = match &run.state {
                State::Finished => "finished".to_owned(),
                State::Unfinished => "unfinished".to_owned(),
                State::Failed(words) => format!("failed: {words}"),
                State::Missing => "not begun".to_owned(),
            };
            let mut row = vec![
                link(run),
                Cell::text(state),
                Cell::text(format!("{} of {}", told.iteration, run.target)),
                Cell::text(told.samples.to_string()),
                Cell::text(format!("{:.1}", told.seconds / 60.0)),
            ];
            for metric in Metric::ALL {
                for column in [Column::Peak, Column::Last] {
                    let value = run.value(metric, column);
                    row.push(Cell {
                        hint: value.map_or_else(String::new, |value| value.to_string()),
                        ..Cell::text(value.map_or("–".to_owned(), |value| metric.written(value)))
                    });
                }
                let at = run.value(metric, Column::Convergence);
                row.push(Cell::text(at.map_or("–".to_owned(), |at| at.to_string())));
            }
            let switched = run.switched_at();
            row.push(Cell::text(
                switched.map_or("–".to_owned(), |at| at.to_string()),
            ));
            row.push(Cell::text(match told.lower_bound.zip(told.upper_bound) {
                Some((lower, upper)) => format!("{lower:.3} to {upper:.3}"),
                None => "–".to_owned(),
            }));
            row
        })
        .collect();
    format!(
        "<h2 id=\"runs\">Runs</h2>\n<p>Each name leads to the run's record: every value of its configuration, what its lines of metrics came to, the \
         judgement, and what it cost. Final values are of the last lines that hold 1,000 control steps, peaks of the lines \
         after the first 1,000. A run without a record yet leads to its folder.</p>\n{}",
        table(&head(&titles), &rows)
    )
}

fn link(run: &crate::results::Run) -> Cell {
    Cell::html(format!(
        "<a href=\"{}\">{}</a>",
        escape(&run.link),
        escape(&run.name)
    ))
}
