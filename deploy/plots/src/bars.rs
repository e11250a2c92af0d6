//! Shares by name: a bar for what is usual, a thin one for the greatest.

use crate::Colour;
use crate::canvas::{self, Area, BOTTOM, Drawn, MARGIN, TOP};
use plotters::chart::ChartBuilder;
use plotters::element::{EmptyElement, PathElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

/// Room for the names, pixels.
const NAMES: u32 = 170;
/// Height of a bar with its gap, pixels.
const ROW: u32 = 15;

/// A panel of horizontal bars.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BarChart {
    /// What it shows.
    pub title: String,
    /// Quantity and unit of the bars.
    pub x_label: String,
    /// What the thick bars are; empty if there is no legend.
    pub usual_label: String,
    /// What the thin bars are.
    pub greatest_label: String,
    /// Where a limit is drawn.
    pub limit: Option<f64>,
    /// From top to bottom.
    pub bars: Vec<Bar>,
}

/// A name with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// The name.
    pub name: String,
    /// The thick bar's length.
    pub usual: f64,
    /// The thin bar's length.
    pub greatest: f64,
}

impl BarChart {
    pub(crate) fn height(&self) -> u32 {
        TOP.cast_unsigned() + BOTTOM + ROW * self.bars.len().max(3) as u32
    }

    pub(crate) fn draw(&self, area: &Area<'_>) -> Drawn {
        let legend = [
            (self.usual_label.as_str(), Colour::Series(0)),
            (self.greatest_label.as_str(), Colour::Series(1)),
        ];
        canvas::caption(area, &self.title, &legend)?;
        if self.bars.is_empty() {
            return canvas::nothing(area);
        }
        let rows = self.bars.len() as f64;
        let longest = self
            .bars
            .iter()
            .flat_map(|bar| [bar.usual, bar.greatest])
            .chain(self.limit)
            .filter(|length| length.is_finite())
            .fold(1e-9, f64::max);
        let mut chart = ChartBuilder::on(area)
            .margin_top(TOP)
            .margin_left(MARGIN)
            .margin_right(MARGIN)
            .x_label_area_size(BOTTOM)
            .y_label_area_size(NAMES)
            .build_cartesian_2d(0.0..1.04 * longest, rows..0.0)?;
        chart
            .configure_mesh()
            .disable_y_mesh()
            .light_line_style(RGBColor(255, 255, 255))
            .bold_line_style(RGBColor(225, 225, 225))
            .x_desc(self.x_label.as_str())
            .y_labels(0)
            .x_label_formatter(&canvas::tick)
            .label_style(canvas::style(12, (HPos::Left, VPos::Top)))
            .draw()?;
        let plot = chart.plotting_area();
        for (row, bar) in self.bars.iter().enumerate() {
            let top = row as f64;
            let style = canvas::style(12, (HPos::Right, VPos::Center));
            let name = Text::new(bar.name.clone(), (-8, 0), style);
            plot.draw(&(EmptyElement::at((0.0, top + 0.5)) + name))?;
            for (length, colour, inset) in [
                (bar.usual, Colour::Series(0), 0.15),
                (bar.greatest, Colour::Series(1), 0.42),
            ] {
                if length.is_finite() {
                    let corners = [(0.0, top + inset), (length, top + 1.0 - inset)];
                    plot.draw(&Rectangle::new(corners, colour.rgb().mix(0.8).filled()))?;
                }
            }
        }
        if let Some(limit) = self.limit {
            let across = vec![(limit, 0.0), (limit, rows)];
            plot.draw(&PathElement::new(
                across,
                Colour::Grey.rgb().stroke_width(1),
            ))?;
        }
        Ok(())
    }
}
