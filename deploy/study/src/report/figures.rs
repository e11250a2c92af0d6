//! Figure 3, training curves with their bands, and Figure 4, final values as violins.

use plots::{Axis, Band, Colour, Figure, Line, LineChart, Mark, Panel, Violin, ViolinChart};

use super::curves::curve;
use crate::metric::Metric;
use crate::paper::{self, ABLATION, AMPCO, COMPARISON};
use crate::results::{Column, Results};

/// A figure with its caption.
pub(super) struct Drawn {
    pub(super) name: &'static str,
    pub(super) caption: String,
    pub(super) svg: String,
}

pub(super) fn all(results: &Results) -> Vec<Drawn> {
    let swept: Vec<&str> = results
        .entries
        .iter()
        .filter(|entry| paper::row(&entry.name).is_none())
        .map(|entry| entry.name.as_str())
        .collect();
    let mut drawn = Vec::new();
    for (curves, violins, what, methods) in [
        ("figure3.svg", "figure4.svg", "comparison", &COMPARISON[..]),
        (
            "figure3-ablation.svg",
            "figure4-ablation.svg",
            "ablation",
            &ABLATION[..],
        ),
        (
            "figure3-others.svg",
            "figure4-others.svg",
            "other settings",
            &swept,
        ),
    ] {
        let there: Vec<&str> = methods
            .iter()
            .copied()
            .filter(|method| results.measured(method).next().is_some())
            .collect();
        if there.is_empty() || (what == "ablation" && there == [AMPCO]) {
            continue;
        }
        drawn.push(Drawn {
            name: curves,
            caption: format!(
                "As the paper's Figure 3, {what}: training. Lines are means over seeds, bands one standard deviation; \
                 a vertical line is where Phase II began on the mean."
            ),
            svg: training(results, &there, what),
        });
        drawn.push(Drawn {
            name: violins,
            caption: format!(
                "As the paper's Figure 4, {what}: final values. Dots are runs, stars means; the line across is AMPCO's \
                 mean. A method of fewer than three runs has no outline."
            ),
            svg: finals(results, &there, what),
        });
    }
    drawn
}

/// A method keeps its colour in every figure; settings of one's own count on from there.
fn colour(results: &Results, method: &str) -> Colour {
    const ORDER: [&str; 8] = [
        AMPCO,
        "amp-0.5",
        "amp-0.7",
        "amp-roger",
        "amp-0.8",
        "ampco-without-aig",
        "adamimic",
        "ampco-without-roger",
    ];
    let own = || {
        results
            .entries
            .iter()
            .position(|entry| entry.name == method)
    };
    let known = ORDER.iter().position(|known| *known == method);
    Colour::Series(known.or_else(own).unwrap_or(0))
}

fn training(results: &Results, methods: &[&str], what: &str) -> String {
    let panels = Metric::ALL.iter().enumerate().map(|(index, metric)| {
        let mut chart = LineChart {
            title: if index == 0 {
                String::new()
            } else {
                metric.heading().into()
            },
            x: axis("iteration"),
            y: axis(metric.heading()),
            ..LineChart::default()
        };
        for method in methods {
            let colour = colour(results, method);
            let points = curve(results, method, *metric);
            chart.bands.push(Band {
                colour,
                points: points
                    .iter()
                    .map(|point| {
                        let (mean, deviation) = (point.spread.mean, point.spread.deviation);
                        (point.iteration, mean - deviation, mean + deviation)
                    })
                    .collect(),
            });
            chart.lines.push(Line {
                label: if index == 0 {
                    paper::label(method).into()
                } else {
                    String::new()
                },
                colour,
                points: points
                    .iter()
                    .map(|point| (point.iteration, point.spread.mean))
                    .collect(),
            });
            chart.marks.extend(switch(results, method).map(|x| Mark {
                x,
                label: "Phase II".into(),
                colour,
            }));
        }
        Panel::Lines(chart)
    });
    Figure {
        title: format!("Training: {what}"),
        panels: panels.collect(),
    }
    .svg()
}

fn finals(results: &Results, methods: &[&str], what: &str) -> String {
    let panels = Metric::ALL.iter().map(|metric| {
        let ours = results.spread(AMPCO, *metric, Column::Last);
        Panel::Violins(ViolinChart {
            title: format!("final: {}", metric.heading()),
            y: axis(metric.heading()),
            reference: ours.map(|spread| spread.mean),
            violins: methods
                .iter()
                .map(|method| Violin {
                    name: paper::label(method).into(),
                    colour: colour(results, method),
                    values: results.values(method, *metric, Column::Last),
                })
                .collect(),
        })
    });
    Figure {
        title: format!("Final values: {what}"),
        panels: panels.collect(),
    }
    .svg()
}

/// Mean iteration at which a method's runs entered Phase II, of those that did.
fn switch(results: &Results, method: &str) -> Option<f64> {
    let at: Vec<f64> = results
        .measured(method)
        .filter_map(|run| run.switched_at().map(|at| at as f64))
        .collect();
    (!at.is_empty()).then(|| at.iter().sum::<f64>() / at.len() as f64)
}

fn axis(label: &str) -> Axis {
    Axis {
        label: label.into(),
        range: None,
    }
}
