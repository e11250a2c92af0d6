//! A clip as a figure: speeds, feet and joints over time.
//!
//! Separate because it chooses what is worth seeing; the drawing is `plots`'.

use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_LEG, WAIST};
use g1::kinematics::{forward_state, lowest_sole_point};
use g1::{JOINT_TABLE, LEFT_FOOT, RIGHT_FOOT};
use motion::quality::{TOUCHING, speeds};
use motion::{Clip, FRAME_SECONDS};
use plots::{Axis, Colour, ContactRow, ContactStrip, Figure, Line, LineChart, Panel};

/// What the description in a figure's file begins with: no other figure is ever written over.
const MARK: &str = "<desc>ampco motions inspect: ";

/// A clip's figure as the text of an SVG file, which says what the clip is made from.
pub(super) fn svg(clip: &Clip, origin: &str) -> String {
    let svg = figure(clip).svg();
    let opened = svg.find('>').map_or(0, |at| at + 1);
    let (tag, rest) = svg.split_at(opened);
    let origin = origin
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    format!("{tag}\n{MARK}{origin}</desc>{rest}")
}

/// What the clip of a figure is made from; `None` of what was not drawn by [`svg`].
pub(super) fn origin(text: &str) -> Option<String> {
    let (_, rest) = text.strip_prefix("<svg")?.split_once('>')?;
    let (origin, _) = rest
        .trim_start()
        .strip_prefix(MARK)?
        .split_once("</desc>")?;
    let origin = origin.replace("&lt;", "<").replace("&gt;", ">");
    Some(origin.replace("&amp;", "&"))
}

fn figure(clip: &Clip) -> Figure {
    let [left, right] = [LEFT_FOOT, RIGHT_FOOT].map(|foot| {
        let low = |frame| f64::from(lowest_sole_point(&forward_state(frame), foot));
        clip.frames.iter().map(low).collect::<Vec<f64>>()
    });
    let legs = [
        LEFT_LEG,
        LEFT_LEG + 3,
        LEFT_LEG + 4,
        RIGHT_LEG,
        RIGHT_LEG + 3,
        RIGHT_LEG + 4,
    ];
    let upper = [WAIST, LEFT_ARM, LEFT_ARM + 1, LEFT_ARM + 3];
    let soles = [("left", left.clone()), ("right", right.clone())];
    Figure {
        title: clip.name.clone(),
        panels: vec![
            curves("speed over half a second", "m/s", [("", speeds(clip))]),
            curves("lowest point of the soles", "m", soles),
            contacts(clip, &[("left", &left), ("right", &right)]),
            curves("legs", "rad", joints(clip, &legs)),
            curves("waist and left arm", "rad", joints(clip, &upper)),
        ],
    }
}

fn joints<'a>(
    clip: &'a Clip,
    which: &'a [usize],
) -> impl Iterator<Item = (&'static str, Vec<f64>)> + 'a {
    which.iter().map(|&j| {
        let angles = clip
            .frames
            .iter()
            .map(move |f| f64::from(f.joint_positions[j]));
        let name = JOINT_TABLE[j].name;
        (
            name.strip_suffix("_joint").unwrap_or(name),
            angles.collect(),
        )
    })
}

/// A panel of curves with a value per frame.
fn curves<'a>(
    title: &str,
    unit: &str,
    series: impl IntoIterator<Item = (&'a str, Vec<f64>)>,
) -> Panel {
    let line = |(i, (name, values)): (usize, (&str, Vec<f64>))| Line {
        label: name.into(),
        colour: Colour::Series(i),
        points: values
            .into_iter()
            .enumerate()
            .map(|(k, value)| (k as f64 * FRAME_SECONDS, value))
            .collect(),
    };
    Panel::Lines(LineChart {
        title: title.into(),
        x: axis("s"),
        y: axis(unit),
        lines: series.into_iter().enumerate().map(line).collect(),
        ..LineChart::default()
    })
}

fn contacts(clip: &Clip, feet: &[(&str, &Vec<f64>)]) -> Panel {
    let row = |(i, (name, low)): (usize, &(&str, &Vec<f64>))| {
        let down: Vec<bool> = low.iter().map(|z| *z < f64::from(TOUCHING)).collect();
        ContactRow::of_samples(*name, Colour::Series(i), &down, 0.0, FRAME_SECONDS)
    };
    Panel::Contacts(ContactStrip {
        title: "feet on the ground".into(),
        x_label: "s".into(),
        range: (0.0, clip.frames.len() as f64 * FRAME_SECONDS),
        rows: feet.iter().enumerate().map(row).collect(),
    })
}

fn axis(label: &str) -> Axis {
    Axis {
        label: label.into(),
        range: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_shows_speed_feet_and_joints() {
        let made = "from <a> & &lt;b.csv";
        let svg = svg(&motion::gait::walk(1.0).unwrap(), made);
        assert_eq!(origin(&svg).as_deref(), Some(made));
        assert_eq!(svg.matches("&lt;a&gt; &amp; &amp;lt;b.csv").count(), 1);
        for other in ["", "<svg/>", "<svg><desc>mine</desc></svg>", "# ampco"] {
            assert_eq!(origin(other), None, "{other}");
        }
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        for part in [
            "speed",
            "soles",
            "feet on the ground",
            "left_knee",
            "left_elbow",
        ] {
            assert!(svg.contains(part), "{part}");
        }
    }
}
