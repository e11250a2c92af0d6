//! Whole figures: that what is given is in the picture, and that odd data do no harm.

use super::*;

fn curve(points: &[(f64, f64)]) -> Panel {
    Panel::Lines(LineChart {
        title: "velocity <m/s>".into(),
        x: Axis {
            label: "time, s".into(),
            range: None,
        },
        lines: vec![Line {
            label: "forward".into(),
            colour: Colour::Series(0),
            points: points.to_vec(),
        }],
        bands: vec![Band {
            colour: Colour::Series(0),
            points: points.iter().map(|p| (p.0, p.1 - 0.1, p.1 + 0.1)).collect(),
        }],
        marks: vec![Mark {
            x: 1.0,
            label: "phase II".into(),
            colour: Colour::Grey,
        }],
        ..LineChart::default()
    })
}

fn figure(panels: Vec<Panel>) -> String {
    Figure {
        title: "a walk & a run".into(),
        panels,
    }
    .svg()
}

fn count(svg: &str, what: &str) -> usize {
    svg.matches(what).count()
}

/// One panel of each kind.
fn one_of_each() -> Vec<Panel> {
    let strip = ContactStrip {
        title: "contact".into(),
        x_label: "time, s".into(),
        range: (0.0, 2.0),
        rows: vec![ContactRow {
            name: "left foot".into(),
            colour: Colour::Series(1),
            down: vec![(0.0, 0.5), (1.0, 1.5), (5.0, 6.0)],
        }],
    };
    let bars = BarChart {
        title: "torque".into(),
        limit: Some(1.0),
        bars: vec![Bar {
            name: "left knee".into(),
            usual: 0.4,
            greatest: 0.9,
        }],
        ..BarChart::default()
    };
    vec![
        curve(&[(0.0, 0.0), (2.0, 1.0)]),
        Panel::Contacts(strip),
        Panel::Bars(bars),
    ]
}

#[test]
fn a_figure_holds_what_it_was_given() {
    let svg = figure(one_of_each());
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for text in [
        "a walk &amp; a run",
        "velocity &lt;m/s&gt;",
        "phase II",
        "left foot",
        "left knee",
    ] {
        assert!(svg.contains(text), "{text} is missing");
    }
    assert_eq!(count(&svg, "<polygon"), 1);
    // Two contacts, for the third is out of range, and the bar of the greatest.
    assert_eq!(count(&svg, "fill=\"#D55E00\""), 2 + 1);
    assert_eq!(svg, figure(one_of_each()));
}

#[test]
fn data_without_a_finite_number_are_said_to_be_none() {
    for panel in [
        curve(&[]),
        curve(&[(0.0, f64::NAN), (1.0, f64::INFINITY)]),
        Panel::Bars(BarChart::default()),
        Panel::Contacts(ContactStrip::default()),
        Panel::Violins(ViolinChart::default()),
    ] {
        assert_eq!(count(&figure(vec![panel]), "no data"), 1);
    }
}

#[test]
fn a_violin_has_an_outline_a_dot_per_number_and_a_star() {
    let chart = ViolinChart {
        title: "energy".into(),
        reference: Some(2.0),
        violins: vec![Violin {
            name: "a & b".into(),
            colour: Colour::Series(0),
            values: vec![1.0, 2.0, 3.0, f64::NAN],
        }],
        ..ViolinChart::default()
    };
    let svg = figure(vec![Panel::Violins(chart)]);
    assert_eq!(count(&svg, "<circle"), 3);
    assert_eq!(count(&svg, "<polygon"), 2); // the outline and the star
    assert!(svg.contains("a &amp; b"));
}

#[test]
fn a_gap_makes_two_lines_of_one() {
    let whole = figure(vec![curve(&[
        (0.0, 0.0),
        (1.0, 1.0),
        (2.0, 0.0),
        (3.0, 1.0),
    ])]);
    let parted = figure(vec![curve(&[
        (0.0, 0.0),
        (1.0, 1.0),
        (1.5, f64::NAN),
        (2.0, 0.0),
        (3.0, 1.0),
    ])]);
    assert_eq!(count(&parted, "<polyline"), count(&whole, "<polyline") + 1);
}

#[test]
fn numbers_at_ticks_are_short() {
    assert_eq!(canvas::tick(&0.6000000000000001), "0.6");
    assert_eq!(canvas::tick(&-0.0), "0");
    assert_eq!(canvas::tick(&1200.0), "1200");
}
