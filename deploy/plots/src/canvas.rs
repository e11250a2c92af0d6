//! What panels have in common: colours, text, and the row that holds a title and a legend.

use crate::Colour;
use plotters::coord::Shift;
use plotters::drawing::DrawingAreaErrorKind;
use plotters::prelude::{DrawingArea, IntoFont, RGBColor, Rectangle, SVGBackend, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, TextStyle};

/// A part of a figure.
pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
/// Whether it could be drawn.
pub(crate) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// Room for the title and the legend above a panel's axes, pixels.
pub(crate) const TOP: i32 = 26;
/// Room for the numbers left of the vertical axis, pixels.
pub(crate) const LEFT: u32 = 62;
/// Room for the numbers and the name under the horizontal axis, pixels.
pub(crate) const BOTTOM: u32 = 38;
/// Free room on both sides, pixels.
pub(crate) const MARGIN: i32 = 12;

const INK: RGBColor = RGBColor(40, 40, 40);
const GREY: RGBColor = RGBColor(120, 120, 120);

/// Okabe and Ito's colours, which the colour-blind can tell apart; yellow last, for it is pale.
const SERIES: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
    RGBColor(240, 228, 66),
];

impl Colour {
    pub(crate) fn rgb(self) -> RGBColor {
        match self {
            Self::Series(index) => SERIES[index % SERIES.len()],
            Self::Grey => GREY,
        }
    }
}

/// Text of a size, anchored at a point.
pub(crate) fn style<'a>(size: u32, at: (HPos, VPos)) -> TextStyle<'a> {
    ("sans-serif", size)
        .into_font()
        .color(&INK)
        .pos(Pos::new(at.0, at.1))
}

/// The figure's own title.
pub(crate) fn heading(area: &Area<'_>, title: &str) -> Drawn {
    let style = style(17, (HPos::Left, VPos::Top));
    area.draw(&Text::new(title.to_owned(), (12, 10), style))
}

/// A panel's title, and after it the names of what is drawn in which colour.
pub(crate) fn caption(area: &Area<'_>, title: &str, legend: &[(&str, Colour)]) -> Drawn {
    let style = || style(13, (HPos::Left, VPos::Top));
    let mut x = 12;
    area.draw(&Text::new(title.to_owned(), (x, 6), style()))?;
    x += width(title) + 24;
    for (name, colour) in legend.iter().filter(|(name, _)| !name.is_empty()) {
        area.draw(&Rectangle::new(
            [(x, 10), (x + 14, 14)],
            colour.rgb().filled(),
        ))?;
        area.draw(&Text::new((*name).to_owned(), (x + 19, 6), style()))?;
        x += 19 + width(name) + 18;
    }
    Ok(())
}

/// Says in place of a panel's axes that there is nothing to show.
pub(crate) fn nothing(area: &Area<'_>) -> Drawn {
    let (width, height) = area.dim_in_pixel();
    let middle = (width.cast_signed() / 2, height.cast_signed() / 2);
    let style = style(13, (HPos::Center, VPos::Center));
    area.draw(&Text::new("no data".to_owned(), middle, style))
}

/// About how wide a text is, pixels: no font is at hand.
fn width(text: &str) -> i32 {
    text.chars().count() as i32 * 7
}

/// A number at a tick, without the digits that rounding leaves.
pub(crate) fn tick(number: &f64) -> String {
    let text = format!("{number:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0" } else { text }.to_owned()
}
