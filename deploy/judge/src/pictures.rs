//! A figure per scenario: velocities over time, hips, contacts, torques.

use std::path::Path;

use anyhow::{Context, Result};
use g1::JOINT_TABLE;
use plots::{
    Axis, Band, Bar, BarChart, Colour, ContactRow, ContactStrip, Figure, Line, LineChart, Panel,
};

use super::episodes::Conditions;
use super::scenario::Scenario;
use super::tally::{CONTROL_HZ, Sample, Tally, Trace};

/// Velocities are averaged over a tenth of a second: a figure has fewer pixels than steps.
const GROUP: usize = 5;
/// Hips and contacts are shown for this long, s: a few strides that can be told apart.
const WINDOW: f64 = 4.0;
/// The share of robots outside the band, on each side.
const OUTSIDE: f64 = 0.1;

const AXES: [(&str, &str); 3] = [
    ("forward velocity", "m/s"),
    ("leftward velocity", "m/s"),
    ("yaw rate", "rad/s"),
];

/// Writes `plots/<scenario>.svg` for each scenario into a folder.
pub(super) fn write(
    folder: &Path,
    scenarios: &[Scenario],
    tallies: &[Tally],
    conditions: &Conditions,
) -> Result<()> {
    let folder = folder.join("plots");
    std::fs::create_dir_all(&folder)
        .with_context(|| format!("making the folder {}", folder.display()))?;
    for (scenario, tally) in scenarios.iter().zip(tallies) {
        let path = folder.join(format!("{}.svg", scenario.name));
        let svg = figure(scenario, tally, conditions).svg();
        run::replace_file(&path, svg.as_bytes())
            .with_context(|| format!("writing {}", path.display()))?;
    }
    Ok(())
}

fn figure(scenario: &Scenario, tally: &Tally, conditions: &Conditions) -> Figure {
    let outcome = tally.outcome();
    let mut panels: Vec<Panel> = (0..AXES.len())
        .filter(|&axis| axis == 0 || scenario.commands.iter().any(|command| command[axis] != 0.0))
        .map(|axis| Panel::Lines(tracking(scenario, &tally.traces, conditions, axis)))
        .collect();
    // The robot that stayed up longest has the most to show.
    if let Some(trace) = tally.traces.iter().max_by_key(|trace| trace.samples.len()) {
        let (window, start) = last_window(&trace.samples);
        panels.push(Panel::Lines(hips(window, start)));
        panels.push(Panel::Contacts(contacts(window, start)));
    }
    panels.push(Panel::Bars(torques(tally)));
    let turns = scenario.commands.iter().any(|command| command[2] != 0.0);
    let yaw = match turns {
        true => format!(" and {:.2} rad/s", outcome.rmse_yaw_rate),
        false => String::new(),
    };
    Figure {
        title: format!(
            "{} ({}): {:.0} % survive, RMSE {:.2} m/s{yaw}, {}",
            scenario.name,
            scenario.condition(),
            100.0 * outcome.survival,
            outcome.rmse,
            outcome.gait
        ),
        panels,
    }
}

fn tracking(
    scenario: &Scenario,
    traces: &[Trace],
    conditions: &Conditions,
    axis: usize,
) -> LineChart {
    let (name, unit) = AXES[axis];
    let seconds = |step: usize| step as f64 / CONTROL_HZ;
    let command = |step| f64::from(scenario.command(step, conditions.steps)[axis]);
    let mut asked = Vec::new();
    for step in 0..conditions.steps {
        // Only where it changes, and the two ends.
        if step == 0 || command(step) != command(step - 1) {
            asked.extend(asked.last().map(|&(_, y)| (seconds(step as usize), y)));
            asked.push((seconds(step as usize), command(step)));
        }
    }
    let end = seconds(conditions.steps as usize);
    asked.extend(asked.last().map(|&(_, y)| (end, y)));
    let (mut median, mut band) = (Vec::new(), Vec::new());
    for first in (0..conditions.steps as usize).step_by(GROUP) {
        let mut means: Vec<f64> = traces
            .iter()
            .filter_map(|trace| mean_velocity(trace, first, axis))
            .collect();
        means.sort_by(f64::total_cmp);
        let time = seconds(first + GROUP / 2);
        median.push((time, quantile(&means, 0.5)));
        band.push((
            time,
            quantile(&means, OUTSIDE),
            quantile(&means, 1.0 - OUTSIDE),
        ));
    }
    LineChart {
        title: format!("{name} of robots on their feet"),
        x: Axis {
            label: "time, s".into(),
            range: Some((0.0, end)),
        },
        y: Axis {
            label: unit.into(),
            range: None,
        },
        lines: vec![
            Line {
                label: "asked for".into(),
                colour: Colour::Grey,
                points: asked,
            },
            Line {
                label: "median, and 80 % of robots".into(),
                colour: Colour::Series(0),
                points: median,
            },
        ],
        bands: vec![Band {
            colour: Colour::Series(0),
            points: band,
        }],
        marks: Vec::new(),
    }
}

/// A robot's mean over a group of steps; `None` if it had fallen by then.
fn mean_velocity(trace: &Trace, first: usize, axis: usize) -> Option<f64> {
    let group = trace.samples.get(first..first + GROUP)?;
    let sum: f64 = group.iter().map(|s| f64::from(s.velocity[axis])).sum();
    Some(sum / GROUP as f64)
}

/// The number below which a share of sorted numbers lies; NaN of none.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    let at = (share * last).round() as usize;
    sorted.get(at).copied().unwrap_or(f64::NAN)
}

/// The last seconds of an episode, and the time of the first of its samples.
fn last_window(samples: &[Sample]) -> (&[Sample], f64) {
    let first = samples.len().saturating_sub((WINDOW * CONTROL_HZ) as usize);
    // A sample is of the end of its step.
    (&samples[first..], (first + 1) as f64 / CONTROL_HZ)
}

fn hips(samples: &[Sample], start: f64) -> LineChart {
    let line = |side: usize, label: &str| Line {
        label: label.into(),
        colour: Colour::Series(side),
        points: samples
            .iter()
            .enumerate()
            .map(|(i, sample)| (start + i as f64 / CONTROL_HZ, f64::from(sample.hips[side])))
            .collect(),
    };
    LineChart {
        title: "hip pitch of one robot".into(),
        x: Axis {
            label: "time, s".into(),
            range: Some(span(samples, start)),
        },
        y: Axis {
            label: "rad".into(),
            range: None,
        },
        lines: vec![line(0, "left"), line(1, "right")],
        ..LineChart::default()
    }
}

fn contacts(samples: &[Sample], start: f64) -> ContactStrip {
    let row = |side: usize, name: &str| {
        let down: Vec<bool> = samples.iter().map(|sample| sample.down[side]).collect();
        ContactRow::of_samples(name, Colour::Series(side), &down, start, 1.0 / CONTROL_HZ)
    };
    ContactStrip {
        title: "feet on the ground, same robot".into(),
        x_label: "time, s".into(),
        range: span(samples, start),
        rows: vec![row(0, "left"), row(1, "right")],
    }
}

fn span(samples: &[Sample], start: f64) -> (f64, f64) {
    let step = 1.0 / CONTROL_HZ;
    (start - step, start + samples.len() as f64 * step - step)
}

fn torques(tally: &Tally) -> BarChart {
    let means = tally.motors.torque_means().unwrap_or_default();
    let peaks = tally.motors.torque_peaks();
    let bar = |(joint, table): (usize, &g1::Joint)| Bar {
        name: table.name.trim_end_matches("_joint").replace('_', " "),
        usual: means[joint],
        greatest: f64::from(peaks[joint]),
    };
    BarChart {
        title: "torque".into(),
        x_label: "share of the effort limit".into(),
        usual_label: "mean of each step's greatest".into(),
        greatest_label: "greatest".into(),
        limit: Some(1.0),
        bars: JOINT_TABLE.iter().enumerate().map(bar).collect(),
    }
}

#[cfg(test)]
mod tests;
