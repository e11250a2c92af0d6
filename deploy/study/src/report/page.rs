//! The page: what was run, what came out, what may be said.

use std::fmt::Write;

use super::figures::Drawn;
use super::html::{self, Cell, escape, head, table};
use super::{gait, overhead, reading, runs, tables};
use crate::claims::{Claim, Verdict, claims};
use crate::paper::{self, ABLATION, AMPCO, COMPARISON};
use crate::results::{Results, State};
use crate::wilcoxon::smallest_p;

pub(super) fn page(results: &Results, figures: &[Drawn]) -> String {
    let mut body = opening(results);
    let claims = claims(results);
    body.push_str(&reading::reading(results, &claims));
    body.push_str(&said(claims));
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
    body.push_str(&overhead::overhead(results));
    body.push_str(&gait::gait(results));
    body.push_str(&runs::judged(results));
    body.push_str(&runs::runs(results));
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
        "<p>{} × {}: {finished} of {} finished, {failed} failed. The paper: 8 methods × {} seeds × \
         {} iterations of {} transitions.</p>",
        wording::count(results.entries.len(), "method"),
        wording::count(file.seeds.len(), "seed"),
        wording::count(results.runs.len(), "run"),
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
fn said(mut claims: Vec<Claim>) -> String {
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
         worse. Where a claim is of several methods, all must be found; that one contradicts it counts by Holm's corrected p, \
         which stands beside the uncorrected one. r is the matched-pairs rank-biserial correlation, the interval that of the \
         bootstrap over all draws. With fewer than six common seeds no outcome can count. Runs whose metric was still moving in the last \
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
