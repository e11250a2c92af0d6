//! Figures as SVG text: panels of lines with bands, of bars, of contact patterns, one under another.
//!
//! Separate, and pure, because training curves and evaluations draw the same things: data in, text
//! out. Numbers that are not finite are gaps. The same data give the same bytes.
//!
//! | subject | file |
//! | --- | --- |
//! | curves over time, with bands and marks | [`lines`] |
//! | shares by name | [`bars`] |
//! | what is on the ground when | [`contacts`] |
//! | distributions of few numbers | [`violins`] |
//! | a noisy curve as a mean with its spread | [`smooth`] |
//! | panels under each other, colours, text | here, `canvas` |
#![forbid(unsafe_code)]

pub mod bars;
mod canvas;
pub mod contacts;
pub mod lines;
pub mod smooth;
pub mod violins;

pub use bars::{Bar, BarChart};
pub use contacts::{ContactRow, ContactStrip};
pub use lines::{Axis, Band, Line, LineChart, Mark};
pub use smooth::{Spread, smooth};
pub use violins::{Violin, ViolinChart};

use canvas::{Area, Drawn};
use plotters::prelude::{IntoDrawingArea, SVGBackend, WHITE};

/// Width of every figure, pixels.
const WIDTH: u32 = 900;
/// Height of the line that holds a figure's title, pixels.
const TITLE: u32 = 34;

/// Panels under each other, with a title.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What all of it is.
    pub title: String,
    /// From top to bottom.
    pub panels: Vec<Panel>,
}

/// One of a figure's panels.
#[derive(Clone, Debug, PartialEq)]
pub enum Panel {
    /// Curves.
    Lines(LineChart),
    /// Horizontal bars.
    Bars(BarChart),
    /// Contact over time.
    Contacts(ContactStrip),
    /// Distributions side by side.
    Violins(ViolinChart),
}

/// A colour: that of a series by its index, which repeats after eight, or grey for what is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// The n-th series.
    Series(usize),
    /// A command, a limit, a reference.
    Grey,
}

impl Figure {
    /// The figure as the text of an SVG file.
    pub fn svg(&self) -> String {
        let height = TITLE + self.panels.iter().map(Panel::height).sum::<u32>();
        let mut text = String::new();
        {
            let root = SVGBackend::with_string(&mut text, (WIDTH, height)).into_drawing_area();
            // Text is laid out without fonts and written to memory: nothing here can be refused.
            self.draw(&root).expect("an SVG in memory takes any figure");
        }
        text
    }

    fn draw(&self, root: &Area<'_>) -> Drawn {
        root.fill(&WHITE)?;
        canvas::heading(root, &self.title)?;
        let (_, mut rest) = root.split_vertically(TITLE);
        for panel in &self.panels {
            let (area, below) = rest.split_vertically(panel.height());
            panel.draw(&area)?;
            rest = below;
        }
        root.present()?;
        Ok(())
    }
}

impl Panel {
    fn height(&self) -> u32 {
        match self {
            Self::Lines(_) | Self::Violins(_) => 220,
            Self::Bars(chart) => chart.height(),
            Self::Contacts(strip) => strip.height(),
        }
    }

    fn draw(&self, area: &Area<'_>) -> Drawn {
        match self {
            Self::Lines(chart) => chart.draw(area),
            Self::Bars(chart) => chart.draw(area),
            Self::Contacts(strip) => strip.draw(area),
            Self::Violins(chart) => chart.draw(area),
        }
    }
}

#[cfg(test)]
mod tests;
