//! Distributions of few numbers: an outline of their density, a dot per number, a star for the mean.

use crate::canvas::{self, Area, BOTTOM, Drawn, LEFT, MARGIN, TOP};
use crate::{Axis, Colour};
use plotters::chart::ChartBuilder;
use plotters::element::{Circle, EmptyElement, PathElement, Polygon, Text};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{BLACK, Color, RGBColor};

/// Numbers of which an outline says something.
const LEAST: usize = 3;
/// Half width of the widest outline, in the distance of two violins.
const HALF_WIDTH: f64 = 0.38;
/// Heights at which an outline is computed.
const HEIGHTS: usize = 48;

/// A panel of violins side by side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViolinChart {
    /// What it shows.
    pub title: String,
    /// The vertical axis.
    pub y: Axis,
    /// From left to right.
    pub violins: Vec<Violin>,
    /// Where a dashed line goes across.
    pub reference: Option<f64>,
}

/// One distribution.
#[derive(Clone, Debug, PartialEq)]
pub struct Violin {
    /// Its name.
    pub name: String,
    /// Its colour.
    pub colour: Colour,
    /// Its numbers; those that are not finite are left out. Fewer than three have no outline.
    pub values: Vec<f64>,
}

impl Violin {
    fn finite(&self) -> Vec<f64> {
        let finite = self.values.iter().copied().filter(|x| x.is_finite());
        finite.collect()
    }

    /// Heights with the density there, greatest 1; `None` of too few numbers or of equal ones.
    ///
    /// Gaussian kernels of Scott's width: σ·n^(−1/5).
    fn outline(&self) -> Option<Vec<(f64, f64)>> {
        let values = self.finite();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let width = variance.sqrt() * n.powf(-0.2);
        if values.len() < LEAST || width.is_nan() || width <= 0.0 {
            return None;
        }
        let (low, high) = extremes(values.iter().copied())?;
        let (low, high) = (low - 1.5 * width, high + 1.5 * width);
        let density = |y: f64| -> f64 {
            let kernel = |x: &f64| (-0.5 * ((y - x) / width).powi(2)).exp();
            values.iter().map(kernel).sum()
        };
        let points: Vec<(f64, f64)> = (0..=HEIGHTS)
            .map(|step| low + (high - low) * step as f64 / HEIGHTS as f64)
            .map(|y| (y, density(y)))
            .collect();
        let greatest = points.iter().map(|point| point.1).fold(0.0, f64::max);
        Some(points.iter().map(|(y, d)| (*y, d / greatest)).collect())
    }
}

impl ViolinChart {
    pub(crate) fn draw(&self, area: &Area<'_>) -> Drawn {
        canvas::caption(area, &self.title, &[])?;
        let Some((low, high)) = self.range() else {
            return canvas::nothing(area);
        };
        let mut chart = ChartBuilder::on(area)
            .margin_top(TOP)
            .margin_left(MARGIN)
            .margin_right(MARGIN)
            .x_label_area_size(BOTTOM)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(-0.5..self.violins.len() as f64 - 0.5, low..high)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(RGBColor(255, 255, 255))
            .bold_line_style(RGBColor(225, 225, 225))
            .x_labels(0)
            .y_labels(6)
            .y_desc(self.y.label.as_str())
            .y_label_formatter(&canvas::tick)
            .label_style(canvas::style(12, (HPos::Left, VPos::Top)))
            .draw()?;
        let plot = chart.plotting_area();
        if let Some(reference) = self.reference.filter(|y| (low..=high).contains(y)) {
            let dashes = 60;
            let across = |part: usize| {
                let whole = self.violins.len() as f64;
                -0.5 + whole * part as f64 / (2.0 * f64::from(dashes))
            };
            for dash in 0..dashes as usize {
                let ends = vec![
                    (across(2 * dash), reference),
                    (across(2 * dash + 1), reference),
                ];
                plot.draw(&PathElement::new(ends, Colour::Grey.rgb().stroke_width(1)))?;
            }
        }
        for (index, violin) in self.violins.iter().enumerate() {
            let x = index as f64;
            let ink = violin.colour.rgb();
            if let Some(outline) = violin.outline() {
                let right = outline.iter().map(|(y, d)| (x + HALF_WIDTH * d, *y));
                let left = outline.iter().rev().map(|(y, d)| (x - HALF_WIDTH * d, *y));
                let around: Vec<_> = right.chain(left).collect();
                plot.draw(&Polygon::new(around, ink.mix(0.25)))?;
            }
            let values = violin.finite();
            for value in &values {
                plot.draw(&Circle::new((x, *value), 3, ink.filled()))?;
            }
            if !values.is_empty() {
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                let star = Polygon::new(star(), BLACK.filled());
                plot.draw(&(EmptyElement::at((x, mean)) + star))?;
            }
            let style = canvas::style(12, (HPos::Center, VPos::Top));
            let name = Text::new(violin.name.clone(), (0, 8), style);
            plot.draw(&(EmptyElement::at((x, low)) + name))?;
        }
        Ok(())
    }

    /// What the vertical axis shows; `None` if there is no finite number.
    fn range(&self) -> Option<(f64, f64)> {
        let outlines = self.violins.iter().filter_map(Violin::outline);
        let outlines = outlines.flatten().map(|point| point.0);
        let values = self.violins.iter().flat_map(Violin::finite);
        let (low, high) = extremes(values.chain(outlines))?;
        if let Some(range) = self.y.range {
            return Some(range);
        }
        let room = if high > low { 0.06 * (high - low) } else { 0.5 };
        Some((low - room, high + room))
    }
}

fn extremes(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((value.min(low), value.max(high))),
    })
}

/// A five-pointed star about the origin, pixels.
fn star() -> Vec<(i32, i32)> {
    (0..10)
        .map(|corner| {
            let radius = if corner % 2 == 0 { 7.0 } else { 2.8 };
            let angle = std::f64::consts::PI * (0.2 * f64::from(corner) - 0.5);
            let place = |part: f64| (radius * part).round() as i32;
            (place(angle.cos()), place(angle.sin()))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn violin(values: &[f64]) -> Violin {
        Violin {
            name: "a".into(),
            colour: Colour::Series(0),
            values: values.to_vec(),
        }
    }

    #[test]
    fn an_outline_is_widest_where_the_numbers_are() {
        let outline = violin(&[1.0, 1.1, 0.9, 1.0, 3.0]).outline().unwrap();
        let widest = outline.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        assert!(
            (widest.0 - 1.0).abs() < 0.15 && widest.1 == 1.0,
            "{widest:?}"
        );
        assert_eq!(violin(&[1.0, 2.0]).outline(), None);
        assert_eq!(violin(&[2.0, 2.0, 2.0]).outline(), None);
        assert_eq!(violin(&[f64::NAN, 1.0, 2.0]).outline(), None);
    }

    #[test]
    fn the_axis_shows_every_number() {
        let chart = ViolinChart {
            violins: vec![violin(&[1.0, 2.0]), violin(&[5.0])],
            ..ViolinChart::default()
        };
        let (low, high) = chart.range().unwrap();
        assert!((low - 0.76).abs() < 1e-9 && (high - 5.24).abs() < 1e-9); // 6 % of 4
        assert_eq!(ViolinChart::default().range(), None);
    }
}
