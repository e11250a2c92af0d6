//! A clip as a picture: speeds, feet and joints over time.
//!
//! Separate because drawing is many words for little meaning.

use std::path::Path;

use anyhow::Result;
use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_LEG};
use g1::kinematics::{forward_state, lowest_sole_point};
use g1::{JOINT_TABLE, LEFT_FOOT, RIGHT_FOOT};
use motion::quality::speeds;
use motion::{Clip, FRAME_SECONDS};
use plotters::prelude::*;

/// A curve: its name and a value per frame.
type Curve = (String, Vec<f64>);

const SIZE: (u32, u32) = (1000, 1200);

/// Draws a clip into an SVG file.
pub(super) fn draw(clip: &Clip, path: &Path) -> Result<()> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let root = root.titled(&clip.name, ("sans-serif", 22))?;
        let panels = root.split_evenly((4, 1));
        panel(
            &panels[0],
            "speed over half a second, m/s",
            &[("speed".into(), speeds(clip))],
        )?;
        panel(&panels[1], "lowest point of the soles, m", &soles(clip))?;
        panel(
            &panels[2],
            "legs, rad",
            &joints(
                clip,
                &[
                    LEFT_LEG,
                    LEFT_LEG + 3,
                    LEFT_LEG + 4,
                    RIGHT_LEG,
                    RIGHT_LEG + 3,
                    RIGHT_LEG + 4,
                ],
            ),
        )?;
        panel(
            &panels[3],
            "waist and left arm, rad",
            &joints(clip, &[12, LEFT_ARM, LEFT_ARM + 1, LEFT_ARM + 3]),
        )?;
        root.present()?;
    }
    run::replace_file(path, svg.as_bytes())?;
    Ok(())
}

fn soles(clip: &Clip) -> Vec<Curve> {
    [("left", LEFT_FOOT), ("right", RIGHT_FOOT)]
        .map(|(name, foot)| {
            let low = |frame| f64::from(lowest_sole_point(&forward_state(frame), foot));
            (name.to_owned(), clip.frames.iter().map(low).collect())
        })
        .into()
}

fn joints(clip: &Clip, which: &[usize]) -> Vec<Curve> {
    let curve = |&j: &usize| {
        let name = JOINT_TABLE[j].name.trim_end_matches("_joint").to_owned();
        let angles = clip.frames.iter().map(|f| f64::from(f.joint_positions[j]));
        (name, angles.collect())
    };
    which.iter().map(curve).collect()
}

fn panel<B: DrawingBackend>(
    area: &DrawingArea<B, plotters::coord::Shift>,
    caption: &str,
    curves: &[Curve],
) -> Result<()>
where
    B::ErrorType: 'static,
{
    let all = || curves.iter().flat_map(|(_, values)| values.iter().copied());
    let (low, high) = (
        all().fold(f64::INFINITY, f64::min),
        all().fold(f64::NEG_INFINITY, f64::max),
    );
    let margin = 0.05 * (high - low) + 0.01;
    let frames = curves.first().map_or(0, |(_, values)| values.len());
    let mut chart = ChartBuilder::on(area)
        .caption(caption, ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(28)
        .y_label_area_size(48)
        .build_cartesian_2d(
            0.0..frames as f64 * FRAME_SECONDS,
            low - margin..high + margin,
        )?;
    chart.configure_mesh().x_desc("s").draw()?;
    for (i, (name, values)) in curves.iter().enumerate() {
        let colour = Palette99::pick(i).to_rgba();
        let points = values
            .iter()
            .enumerate()
            .map(|(k, v)| (k as f64 * FRAME_SECONDS, *v));
        chart
            .draw_series(LineSeries::new(points, colour))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour));
    }
    if curves.len() > 1 {
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.8))
            .draw()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plot_has_four_panels_with_their_curves() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("walk.svg");
        draw(&motion::gait::walk(1.0).unwrap(), &path).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        for part in ["m/s", "soles", "left_knee", "left_elbow"] {
            assert!(svg.contains(part), "{part}");
        }
        assert!(
            svg.matches("<polyline").count() > 13,
            "{}",
            svg.matches("<polyline").count()
        );
    }
}
