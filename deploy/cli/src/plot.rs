//! `ampco plot`: the learning curves of runs, from their metrics alone.

use std::path::{Path, PathBuf};

use anyhow::Result;
use plots::{Axis, Band, Colour, Figure, Line, LineChart, Mark, Panel, smooth};
use run::{Folder, metrics};
use serde::Deserialize;
use terminal::failure::usage;
use terminal::{Place, console, file};

/// Name of the curves of a run in its folder.
pub(crate) const CURVES_FILE: &str = "curves.svg";

/// Points of a curve: as many as a figure can show.
const POINTS: usize = 150;

/// Draw the learning curves of runs as SVG
///
/// Episode length, style and task reward, task weight, velocity error, strides and hip correlation over millions of
/// samples, or over minutes; a line marks where Phase II began. A curve is a mean over successive iterations, its band
/// their least and greatest.
#[derive(Debug, clap::Args)]
pub(crate) struct Plot {
    /// Names or folders of the runs [default: the newest]
    #[arg(value_name = "RUN")]
    runs: Vec<String>,
    #[command(flatten)]
    place: Place,
    /// File to write [default: curves.svg in the first run's folder]
    #[arg(long, value_name = "FILE.svg")]
    out: Option<PathBuf>,
    /// Over minutes of training instead of samples: what a run costs its user
    #[arg(long)]
    minutes: bool,
}

/// What is drawn of a line of metrics; a line of a refused iteration has less.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
struct Record {
    samples: u64,
    phase: Option<u32>,
    episode_length: Option<f64>,
    style_mean: Option<f64>,
    task_mean: Option<f64>,
    task_weight: Option<f64>,
    rmse: Option<f64>,
    hip_correlation: Option<f64>,
    stride_rate_hz: Option<f64>,
    timing: Timing,
}

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
struct Timing {
    iteration_seconds: Option<f64>,
}

/// What curves are drawn over.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Over {
    Samples,
    Minutes,
}

/// A run's name, and its lines with where each lies on the horizontal axis.
type Run = (String, Vec<(f64, Record)>);

/// A curve: its title, its unit, the range it must show, its key.
struct Curve {
    title: &'static str,
    unit: &'static str,
    range: Option<(f64, f64)>,
    value: fn(&Record) -> Option<f64>,
}

const CURVES: [Curve; 7] = [
    Curve {
        title: "episode length",
        unit: "control steps",
        range: None,
        value: |record| record.episode_length,
    },
    Curve {
        title: "style reward",
        unit: "",
        range: None,
        value: |record| record.style_mean,
    },
    Curve {
        title: "task reward",
        unit: "",
        range: None,
        value: |record| record.task_mean,
    },
    Curve {
        title: "task weight, the style weight being 1 less it",
        unit: "",
        range: Some((0.0, 1.0)),
        value: |record| record.task_weight,
    },
    Curve {
        title: "velocity error (RMSE)",
        unit: "m/s",
        range: None,
        value: |record| record.rmse,
    },
    Curve {
        title: "strides",
        unit: "Hz",
        range: None,
        value: |record| record.stride_rate_hz,
    },
    Curve {
        title: "hip correlation: −1 a walk, +1 a hop",
        unit: "",
        range: Some((-1.0, 1.0)),
        value: |record| record.hip_correlation,
    },
];

impl Plot {
    pub(crate) fn run(&self) -> Result<()> {
        let folders = match self.runs.as_slice() {
            [] => vec![self.place.find(None)?],
            names => names
                .iter()
                .map(|name| self.place.find(Some(name)))
                .collect::<Result<_>>()?,
        };
        let out = match &self.out {
            Some(out) => out.clone(),
            None => folders[0].path().join(CURVES_FILE),
        };
        let over = match self.minutes {
            true => Over::Minutes,
            false => Over::Samples,
        };
        write(&folders, over, &out)?;
        console::print(&format!("{}\n", out.display()))
    }
}

/// Draws the curves of a run over its samples into a file.
pub(crate) fn draw(folder: &Folder, out: &Path) -> Result<()> {
    write(std::slice::from_ref(folder), Over::Samples, out)
}

fn write(folders: &[Folder], over: Over, out: &Path) -> Result<()> {
    let mut runs = Vec::new();
    for folder in folders {
        runs.push((folder.name(), over.place(records(folder)?)));
    }
    file::write(out, figure(&runs, over).svg().as_bytes())
}

impl Over {
    fn label(self) -> &'static str {
        match self {
            Self::Samples => "million samples",
            Self::Minutes => "minutes of training",
        }
    }

    /// Where each line lies. Time is that of the iterations, so that a pause between a stop and a resume counts nothing.
    fn place(self, records: Vec<Record>) -> Vec<(f64, Record)> {
        let mut seconds = 0.0;
        let place = |record: Record| {
            seconds += record.timing.iteration_seconds.unwrap_or(0.0);
            let x = match self {
                Self::Samples => record.samples as f64 / 1e6,
                Self::Minutes => seconds / 60.0,
            };
            (x, record)
        };
        records.into_iter().map(place).collect()
    }
}

fn records(folder: &Folder) -> Result<Vec<Record>> {
    let records = metrics::read::<Record>(&folder.metrics_path())?;
    if records.is_empty() {
        return Err(usage(format!(
            "run `{}` has no iteration yet; the first takes some seconds",
            folder.name()
        )));
    }
    Ok(records)
}

fn figure(runs: &[Run], over: Over) -> Figure {
    let names: Vec<&str> = runs.iter().map(|(name, _)| name.as_str()).collect();
    Figure {
        title: format!("Learning: {}", names.join(", ")),
        panels: CURVES
            .iter()
            .enumerate()
            .map(|(index, curve)| Panel::Lines(chart(runs, curve, over, index == 0)))
            .collect(),
    }
}

fn chart(runs: &[Run], curve: &Curve, over: Over, named: bool) -> LineChart {
    let mut chart = LineChart {
        title: curve.title.into(),
        x: Axis {
            label: over.label().into(),
            range: None,
        },
        y: Axis {
            label: curve.unit.into(),
            range: curve.range,
        },
        ..LineChart::default()
    };
    for (index, (name, records)) in runs.iter().enumerate() {
        let colour = Colour::Series(index);
        let points: Vec<(f64, f64)> = records
            .iter()
            .map(|(x, record)| (*x, (curve.value)(record).unwrap_or(f64::NAN)))
            .collect();
        let spread = smooth(&points, POINTS);
        chart.bands.push(Band {
            colour,
            points: spread.band,
        });
        chart.lines.push(Line {
            label: if named { name.clone() } else { String::new() },
            colour,
            points: spread.mean,
        });
        chart.marks.extend(switch(records).map(|x| Mark {
            x,
            label: "Phase II".into(),
            colour,
        }));
    }
    chart
}

/// Where Phase II began, if it did.
fn switch(records: &[(f64, Record)]) -> Option<f64> {
    let second = |(_, record): &&(f64, Record)| record.phase == Some(2);
    records.iter().find(second).map(|(x, _)| *x)
}

#[cfg(test)]
mod tests;
