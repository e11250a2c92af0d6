//! How the policies go without exploration noise: a row per method, and whether any beats AMPCO in everything.

use super::html::{Cell, head, table};
use crate::compare::{Comparison, written};
use crate::gait::{MEASURES, Measure};
use crate::holm;
use crate::paper::{self, AMPCO};
use crate::pareto::{self, AIMS, Place};
use crate::results::Results;
use crate::statistics::Spread;

pub(super) fn gait(results: &Results) -> String {
    let methods: Vec<&str> = results
        .entries
        .iter()
        .map(|entry| entry.name.as_str())
        .filter(|entry| {
            results
                .runs
                .iter()
                .any(|run| run.entry == *entry && !run.judged.is_empty())
        })
        .collect();
    if methods.is_empty() {
        return String::new();
    }
    let columns = MEASURES.map(|measure| column(results, &methods, &measure));
    let rows: Vec<Vec<Cell>> = methods
        .iter()
        .enumerate()
        .map(|(row, method)| {
            let mut cells = vec![Cell::text(paper::label(method))];
            cells.extend(columns.iter().map(|column| column[row].clone()));
            cells
        })
        .collect();
    let mut titles = vec!["Method"];
    titles.extend(MEASURES.iter().map(|measure| measure.heading));
    let judge = results
        .file
        .evaluate
        .as_ref()
        .and_then(|evaluate| evaluate.judge.as_ref());
    let style = match judge {
        Some(_) => "style is by one frozen discriminator for all",
        None => "style is by each run's own discriminator, so that it cannot be compared",
    };
    format!(
        "<h2>Gait without exploration, in rapier</h2>\n<p>Mean ± standard deviation over runs, of each its mean over the \
         commands; {style}. In grey the exact p against AMPCO; pointing at it shows Holm's p over the methods of the column, \
         effect and interval. The hips of a walk alternate (−1), those of a hop do not.</p>\n{}<p>{}</p>\n",
        table(&head(&titles), &rows),
        super::html::escape(&sentence(results))
    )
}

/// A measure's cells, a method each.
fn column(results: &Results, methods: &[&str], measure: &Measure) -> Vec<Cell> {
    let compared: Vec<Option<Comparison>> = methods
        .iter()
        .map(|method| {
            let pairs = measure.paired(results, AMPCO, method);
            Comparison::of_pairs(&pairs).filter(|_| *method != AMPCO)
        })
        .collect();
    let p: Vec<f64> = compared.iter().flatten().map(Comparison::p).collect();
    let mut corrected = holm::corrected(&p).into_iter();
    let cells = methods.iter().zip(&compared).map(|(method, comparison)| {
        let Some(spread) = Spread::of(&measure.values(results, method)) else {
            return Cell::text("–");
        };
        let mean = measure.written(spread.mean);
        let ours = match spread.runs {
            1 => mean,
            _ => format!("{mean} ± {}", measure.written(spread.deviation)),
        };
        let Some(comparison) = comparison else {
            return Cell::text(ours);
        };
        let corrected = corrected.next().unwrap_or(1.0);
        Cell {
            hint: format!(
                "AMPCO less this: {}, Holm's p = {}, {}",
                comparison.words(),
                written(corrected),
                comparison.size(|value| measure.written(value))
            ),
            ..Cell::html(format!(
                "{ours}<br><small>{}</small>",
                written(comparison.p())
            ))
        }
    });
    cells.collect()
}

/// Whether any method is better than AMPCO in all aims at once.
pub(super) fn sentence(results: &Results) -> String {
    let places = pareto::places(results);
    let Some(ours) = places.iter().find(|place| place.entry == AMPCO) else {
        return "Whether a method is better than AMPCO in error, energy and strides at once cannot be said: AMPCO has no \
                judged runs with all three."
            .to_owned();
    };
    let told = |place: &Place| {
        let numbers: Vec<String> = AIMS
            .iter()
            .zip(place.means)
            .map(|(aim, mean)| aim.written(mean))
            .collect();
        format!("{} ({})", paper::label(&place.entry), numbers.join(", "))
    };
    let better: Vec<String> = places
        .iter()
        .filter(|place| place.beats(ours))
        .map(told)
        .collect();
    let front: Vec<String> = pareto::front(&places).into_iter().map(told).collect();
    let verdict = match better.as_slice() {
        [] => "no method is better than AMPCO in all three at once".to_owned(),
        some => format!(
            "better than AMPCO in all three at once: {}",
            some.join("; ")
        ),
    };
    format!(
        "By the means of error (m/s), energy (J) and strides off the reference (1/s): {verdict}. For comparison: {}. \
         No other beats: {}.",
        told(ours),
        front.join("; ")
    )
}
