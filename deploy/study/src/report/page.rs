//! The page: what was run, what came out, what may be said.

use std::fmt::Write;

use super::figures::Drawn;
use super::html::{self, Cell, escape, head, table};
use super::tables;
use crate::claims::{Verdict, claims};
use crate::metric::Metric;
use crate::overhead::Overhead;
use crate::paper::{self, ABLATION, AMPCO, COMPARISON};
use crate::results::{Column, Results, State};
use crate::statistics::median;
use crate::wilcoxon::smallest_p;

pub(super) fn page(results: &Results, figures: &[Drawn]) -> String {
    let mut body = opening(results);
    body.push_str(&said(results));
    let asked = |methods: &[&'static str]| -> Vec<&'static str> {
        methods
            .iter()
            .copied()
            .filter(|method| results.has(method))
            .collect()
    };
    let (comparison, ablation) = (asked(&COMPARISON), asked(&ABLATION));
    let others: Vec<&str> = results
        .entries
        .iter()
        .filter(|entry| paper::row(&entry.name).is_none())
        .map(|entry| entry.name.as_str())
        .collect();
    let tables = [
        ("Table III: comparison", &comparison, 1),
        ("Table IV: ablation", &ablation, 2),
        ("Other settings", &others, 1),
    ];
    for (title, methods, least) in tables
        .iter()
        .filter(|(_, methods, least)| methods.len() >= *least)
    {
        let _ = writeln!(body, "<h2>{title}</h2>\n<p>{}</p>", legend(results));
        body.push_str(&tables::performance(results, methods));
        let against = methods
            .iter()
            .find(|method| **method == AMPCO)
            .unwrap_or(&methods[0]);
        if methods.len() >= 2.max(*least) {
            let _ = write!(
                body,
                "<h3>{} against each: exact p, two-sided, pairs of equal seeds</h3>\n{}",
                escape(paper::label(against)),
                tables::tests(results, methods, against)
            );
        }
        let _ = write!(
            body,
            "<h3>Coefficient of variation of final values</h3>\n{}",
            tables::variation(results, methods)
        );
    }
    body.push_str("<h2>Figures</h2>\n");
    for figure in figures {
        let _ = writeln!(
            body,
            "<figure id=\"{}\">{}<figcaption>{}</figcaption></figure>",
            figure.name,
            figure.svg,
            escape(&figure.caption)
        );
    }
    body.push_str(&overhead(results));
    body.push_str(&judged(results));
    body.push_str(&runs(results));
    html::page(&results.file.title, &body)
}

fn opening(results: &Results) -> String {
    let file = &results.file;
    let count =
        |which: fn(&State) -> bool| results.runs.iter().filter(|run| which(&run.state)).count();
    let finished = count(|state| *state == State::Finished);
    let failed = count(|state| matches!(state, State::Failed(_)));
    let mut html = format!("<h1>{}</h1>\n", escape(&file.title));
    for paragraph in file
        .note
        .split("\n\n")
        .filter(|paragraph| !paragraph.trim().is_empty())
    {
        let _ = writeln!(html, "<p>{}</p>", escape(paragraph));
    }
    let _ = writeln!(
        html,
        "<p>{} methods × {} seeds: {finished} of {} runs finished, {failed} failed. The paper: 8 methods × {} seeds × \
         {} iterations of {} transitions.</p>",
        results.entries.len(),
        file.seeds.len(),
        results.runs.len(),
        paper::SEEDS,
        paper::ITERATIONS,
        paper::ROWS
    );
    let rows: Vec<Vec<Cell>> = results
        .facts
        .iter()
        .map(|(name, value)| vec![Cell::text(name), Cell::text(value)])
        .collect();
    html.push_str(&table("", &rows));
    html
}

/// What of the paper stands, in plain words.
fn said(results: &Results) -> String {
    let mut claims = claims(results);
    claims.sort_by_key(|claim| claim.verdict);
    let count = |verdict| {
        claims
            .iter()
            .filter(|claim| claim.verdict == verdict)
            .count()
    };
    let mut html = format!(
        "<h2>What of the paper these runs bear out</h2>\n<p>Of {} claims {} are supported, {} contradicted, {} cannot be \
         decided. A claim that one method is better is supported where the exact Wilcoxon signed-rank test finds it \
         (p &lt; 0.05, two-sided, over seeds that both have); one of equality is contradicted where the method is found \
         worse. With fewer than six common seeds no outcome can count. Runs whose metric was still moving in the last \
         fifth, or that had not entered Phase II, are too short.</p>\n",
        claims.len(),
        count(Verdict::Supported),
        count(Verdict::Contradicted),
        count(Verdict::Undecided)
    );
    let rows: Vec<Vec<Cell>> = claims
        .iter()
        .map(|claim| {
            vec![
                Cell {
                    class: claim.verdict.word(),
                    ..Cell::text(claim.verdict.word())
                },
                Cell::text(claim.section),
                Cell::text(claim.text),
                Cell::text(&claim.evidence),
            ]
        })
        .collect();
    let inner = table(
        &head(&["", "Section", "The paper says", "The runs say"]),
        &rows,
    );
    let _ = writeln!(html, "<div class=\"claims\">{inner}</div>");
    html
}

/// How to read the tables, and what so few seeds allow.
fn legend(results: &Results) -> String {
    let seeds = results.file.seeds.len();
    let least = smallest_p(seeds);
    let mut html = "Mean ± standard deviation over seeds; in grey the paper's own figures (10 seeds, another \
                    simulator, other motion data). Pointing at a number shows its runs. Bold green is the best mean, \
                    bold red the worst; not bold: not to be told from it (exact Wilcoxon signed-rank, p ≥ 0.05)."
        .to_owned();
    if least >= crate::compare::LEVEL {
        let _ = write!(
            html,
            " With {seeds} seeds the smallest reachable p = {}: no two methods can be told apart, and only the extreme \
             means are marked.",
            crate::compare::written(least)
        );
    }
    html
}

fn overhead(results: &Results) -> String {
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
                .filter_map(|run| Overhead::of(&run.records))
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

/// What the policies did without exploration noise.
fn judged(results: &Results) -> String {
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
fn runs(results: &Results) -> String {
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
            let newest = run.records.last().cloned().unwrap_or_default();
            let state = match &run.state {
                State::Finished => "finished".to_owned(),
                State::Unfinished => "unfinished".to_owned(),
                State::Failed(words) => format!("failed: {words}"),
                State::Missing => "not begun".to_owned(),
            };
            let mut row = vec![
                link(run),
                Cell::text(state),
                Cell::text(format!("{} of {}", newest.iteration, run.target)),
                Cell::text(newest.samples.to_string()),
                Cell::text(format!("{:.1}", newest.timing.seconds / 60.0)),
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
            row.push(Cell::text(
                match newest.lower_bound.zip(newest.upper_bound) {
                    Some((lower, upper)) => format!("{lower:.3} to {upper:.3}"),
                    None => "–".to_owned(),
                },
            ));
            row
        })
        .collect();
    format!(
        "<h2 id=\"runs\">Runs</h2>\n<p>Each folder lies in <code>runs/</code> of the study's folder and holds <code>config.toml</code> (every value) and \
         <code>metrics.jsonl</code> (a line per iteration), from which the numbers here are computed: final values from \
         the last lines that hold 1,000 control steps, peaks from the lines after the first 1,000.</p>\n{}",
        table(&head(&titles), &rows)
    )
}

fn link(run: &crate::results::Run) -> Cell {
    Cell::html(format!(
        "<a href=\"{}\">{}</a>",
        escape(&run.folder),
        escape(&run.name)
    ))
}
