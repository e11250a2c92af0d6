//! Curves over a common axis, with bands around them and marks across them.

use crate::Colour;
use crate::canvas::{self, Area, BOTTOM, Drawn, LEFT, MARGIN, TOP};
use plotters::chart::ChartBuilder;
use plotters::element::{EmptyElement, PathElement, Polygon, Text};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

/// A panel of curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineChart {
    /// What it shows.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves, the first undermost.
    pub lines: Vec<Line>,
    /// Under the curves.
    pub bands: Vec<Band>,
    /// Moments that matter.
    pub marks: Vec<Mark>,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Least and greatest number shown; without it, those of the data.
    pub range: Option<(f64, f64)>,
}

/// A curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its name in the legend; an empty one has no place there.
    pub label: String,
    /// Its colour.
    pub colour: Colour,
    /// Its points in order; a number that is not finite is a gap.
    pub points: Vec<(f64, f64)>,
}

/// The room between two curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Its colour, drawn pale.
    pub colour: Colour,
    /// x, lower y, upper y in order; a number that is not finite is a gap.
    pub points: Vec<(f64, f64, f64)>,
}

/// A vertical line at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Where.
    pub x: f64,
    /// What happened.
    pub label: String,
    /// Whose it is.
    pub colour: Colour,
}

impl LineChart {
    pub(crate) fn draw(&self, area: &Area<'_>) -> Drawn {
        let legend: Vec<_> = self
            .lines
            .iter()
            .map(|line| (line.label.as_str(), line.colour))
            .collect();
        canvas::caption(area, &self.title, &legend)?;
        let Some((x, y)) = self.ranges() else {
            return canvas::nothing(area);
        };
        let mut chart = ChartBuilder::on(area)
            .margin_top(TOP)
            .margin_left(MARGIN)
            .margin_right(MARGIN)
            .x_label_area_size(BOTTOM)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(x.0..x.1, y.0..y.1)?;
        chart
            .configure_mesh()
            .light_line_style(RGBColor(255, 255, 255))
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(self.x.label.as_str())
            .y_desc(self.y.label.as_str())
            .x_label_formatter(&canvas::tick)
            .y_label_formatter(&canvas::tick)
            .y_labels(6)
            .label_style(canvas::style(12, (HPos::Left, VPos::Top)))
            .draw()?;
        let plot = chart.plotting_area();
        let held = |value: f64| value.clamp(y.0, y.1);
        for band in &self.bands {
            for run in runs(&band.points, |p| {
                p.0.is_finite() && p.1.is_finite() && p.2.is_finite()
            }) {
                let upper = run.iter().map(|p| (p.0, held(p.2)));
                let lower = run.iter().rev().map(|p| (p.0, held(p.1)));
                let around: Vec<_> = upper.chain(lower).collect();
                plot.draw(&Polygon::new(around, band.colour.rgb().mix(0.18)))?;
            }
        }
        for mark in &self.marks {
            let ink = mark.colour.rgb();
            let across = vec![(mark.x, y.0), (mark.x, y.1)];
            plot.draw(&PathElement::new(across, ink.stroke_width(1)))?;
            let style = canvas::style(12, (HPos::Left, VPos::Top)).color(&ink);
            let text = Text::new(mark.label.clone(), (4, 2), style);
            plot.draw(&(EmptyElement::at((mark.x, y.1)) + text))?;
        }
        for line in &self.lines {
            let width = if line.colour == Colour::Grey { 1 } else { 2 };
            let ink = line.colour.rgb().stroke_width(width);
            for run in runs(&line.points, |p| p.0.is_finite() && p.1.is_finite()) {
                let points: Vec<_> = run.iter().map(|p| (p.0, held(p.1))).collect();
                plot.draw(&PathElement::new(points, ink))?;
            }
        }
        Ok(())
    }

    /// What the axes show; `None` if there is no finite point.
    fn ranges(&self) -> Option<((f64, f64), (f64, f64))> {
        let lines = self.lines.iter().flat_map(|line| &line.points);
        let bands = self.bands.iter().flat_map(|band| &band.points);
        let both = lines
            .copied()
            .chain(bands.flat_map(|&(x, low, high)| [(x, low), (x, high)]))
            .filter(|(x, y)| x.is_finite() && y.is_finite());
        let (mut x, mut y) = (None, None);
        for point in both {
            x = Some(widened(x, point.0));
            y = Some(widened(y, point.1));
        }
        let (low, high) = y?;
        let room = 0.06 * (high - low);
        let of_data = (low - room, high + room);
        let shown = |axis: &Axis, of_data| opened(axis.range.unwrap_or(of_data));
        Some((shown(&self.x, x?), shown(&self.y, of_data)))
    }
}

fn widened(range: Option<(f64, f64)>, value: f64) -> (f64, f64) {
    let (low, high) = range.unwrap_or((value, value));
    (low.min(value), high.max(value))
}

/// An axis needs a length.
fn opened((low, high): (f64, f64)) -> (f64, f64) {
    if high - low > f64::EPSILON * low.abs().max(high.abs()) {
        (low, high)
    } else {
        (low - 0.5, high + 0.5)
    }
}

/// The stretches of points that can be drawn.
fn runs<P>(points: &[P], drawable: impl Fn(&P) -> bool) -> impl Iterator<Item = &[P]> {
    points
        .split(move |point| !drawable(point))
        .filter(|run| !run.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(points: &[(f64, f64)]) -> LineChart {
        LineChart {
            lines: vec![Line {
                label: "a".into(),
                colour: Colour::Series(0),
                points: points.to_vec(),
            }],
            ..LineChart::default()
        }
    }

    #[test]
    fn axes_show_all_that_is_finite() {
        let gap = chart(&[
            (0.0, 1.0),
            (1.0, f64::NAN),
            (2.0, 3.0),
            (9.0, f64::INFINITY),
        ]);
        let (x, y) = gap.ranges().unwrap();
        assert_eq!(x, (0.0, 2.0));
        assert!((y.0 - 0.88).abs() < 1e-9 && (y.1 - 3.12).abs() < 1e-9); // 6 % of 2 on each side
        assert_eq!(chart(&[(1.0, f64::NAN)]).ranges(), None);
        assert_eq!(
            chart(&[(1.0, 4.0)]).ranges(),
            Some(((0.5, 1.5), (3.5, 4.5)))
        );
    }

    #[test]
    fn a_gap_parts_a_curve() {
        let points = [1.0, 2.0, f64::NAN, 3.0, f64::NAN, f64::NAN];
        let lengths: Vec<_> = runs(&points, |p: &f64| p.is_finite())
            .map(<[f64]>::len)
            .collect();
        assert_eq!(lengths, [2, 1]);
    }
}
