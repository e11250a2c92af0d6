//! What is on the ground when: a row per foot, filled while it carries.

use crate::Colour;
use crate::canvas::{self, Area, BOTTOM, Drawn, LEFT, MARGIN, TOP};
use plotters::chart::ChartBuilder;
use plotters::element::{EmptyElement, Rectangle, Text};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBColor};

/// Height of a row, pixels.
const ROW: u32 = 26;

/// A panel of contact patterns.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactStrip {
    /// What it shows.
    pub title: String,
    /// Quantity and unit of the horizontal axis.
    pub x_label: String,
    /// Least and greatest x shown.
    pub range: (f64, f64),
    /// From top to bottom.
    pub rows: Vec<ContactRow>,
}

/// One foot.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRow {
    /// Its name.
    pub name: String,
    /// Its colour.
    pub colour: Colour,
    /// From when to when it is down.
    pub down: Vec<(f64, f64)>,
}

impl ContactRow {
    /// From samples `interval` apart, the first at `start`: each holds for the interval before it.
    pub fn of_samples(
        name: impl Into<String>,
        colour: Colour,
        down: &[bool],
        start: f64,
        interval: f64,
    ) -> Self {
        let mut spans: Vec<(f64, f64)> = Vec::new();
        for (i, _) in down.iter().enumerate().filter(|(_, down)| **down) {
            let end = start + i as f64 * interval;
            match spans.last_mut() {
                Some(span) if i > 0 && down[i - 1] => span.1 = end,
                _ => spans.push((end - interval, end)),
            }
        }
        Self {
            name: name.into(),
            colour,
            down: spans,
        }
    }
}

impl ContactStrip {
    pub(crate) fn height(&self) -> u32 {
        TOP.cast_unsigned() + BOTTOM + ROW * self.rows.len().max(1) as u32
    }

    pub(crate) fn draw(&self, area: &Area<'_>) -> Drawn {
        canvas::caption(area, &self.title, &[])?;
        let (from, to) = self.range;
        let has_length = to > from && (to - from).is_finite();
        if self.rows.is_empty() || !has_length {
            return canvas::nothing(area);
        }
        let mut chart = ChartBuilder::on(area)
            .margin_top(TOP)
            .margin_left(MARGIN)
            .margin_right(MARGIN)
            .x_label_area_size(BOTTOM)
            .y_label_area_size(LEFT)
            .build_cartesian_2d(from..to, self.rows.len() as f64..0.0)?;
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
        for (row, foot) in self.rows.iter().enumerate() {
            let top = row as f64;
            let style = canvas::style(12, (HPos::Right, VPos::Center));
            let name = Text::new(foot.name.clone(), (-8, 0), style);
            plot.draw(&(EmptyElement::at((from, top + 0.5)) + name))?;
            for &(begin, end) in &foot.down {
                let (begin, end) = (begin.max(from), end.min(to));
                if begin < end {
                    let corners = [(begin, top + 0.15), (end, top + 0.85)];
                    plot.draw(&Rectangle::new(corners, foot.colour.rgb().filled()))?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_become_spans() {
        let row = ContactRow::of_samples(
            "left",
            Colour::Series(0),
            &[true, true, false, true],
            1.0,
            0.5,
        );
        // Sample 0 holds over 0.5–1.0, sample 1 over 1.0–1.5, sample 3 over 2.0–2.5.
        assert_eq!(row.down, [(0.5, 1.5), (2.0, 2.5)]);
        assert_eq!(
            ContactRow::of_samples("none", Colour::Grey, &[false; 3], 0.0, 0.5).down,
            []
        );
    }
}
