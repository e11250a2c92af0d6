//! Errors of one engine, from its traces.
//!
//! Separate because the same function judges every engine.

use crate::case::{Case, STEP};
use crate::cases::{self, SETTLING, STOPS};
use crate::engines::{Engine, reference};
use crate::trace::{Frame, Trace};
use g1::{JOINT_TABLE, JOINTS, joints, links};
use serde::{Deserialize, Serialize};

/// How much finer the step is that contact is compared with.
pub const FINER: usize = 10;

/// All traces of one engine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Traces {
    /// Name of the engine.
    pub engine: String,
    /// At the common step, in the order of [`cases::all`].
    pub coarse: Vec<Trace>,
    /// Of the cases that are refined, at a step [`FINER`] times finer.
    pub fine: Vec<Trace>,
    /// Of the stress run.
    pub stress: Vec<Trace>,
}

impl Traces {
    /// Runs everything.
    pub fn of(engine: Engine, name: &str, cases: &[Case], stress: &[Case]) -> Self {
        let refined = cases.iter().filter(|case| case.refined);
        Self {
            engine: name.into(),
            coarse: cases.iter().map(|case| engine.run(case, 1)).collect(),
            fine: refined.map(|case| engine.run(case, FINER)).collect(),
            stress: stress.iter().map(|case| engine.run(case, 1)).collect(),
        }
    }

    fn coarse(&self, case: &str) -> Option<&Trace> {
        self.coarse.iter().find(|trace| trace.case == case)
    }

    fn fine(&self, case: &str) -> Option<&Trace> {
        self.fine.iter().find(|trace| trace.case == case)
    }
}

/// One number of one engine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// What it is.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// The number; none if the engine's traces do not have it.
    pub value: Option<f64>,
    /// Whether it is an error, and so the smaller the better.
    pub judged: bool,
}

/// Everything that the traces of an engine say, in a fixed order.
pub fn rows(traces: &Traces) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut error = |name: String, unit, value| {
        rows.push(Row {
            name,
            unit,
            value,
            judged: true,
        });
    };
    for (case, moments) in [
        (cases::tumble(), &[0.2, 0.5, 1.0][..]),
        (cases::posing(), &[0.2, 0.5]),
    ] {
        let truth = reference(&case);
        for &moment in moments {
            let at = (moment / STEP).round() as usize - 1;
            let value = traces
                .coarse(&case.name)
                .map(|trace| rms_of_joints(&trace.frames[at], &truth.frames[at]));
            let name = format!("{}: joints after {moment} s", case.name);
            error(name, "rad", value);
        }
    }
    for name in ["drop", "squat"] {
        let pair = traces.coarse(name).zip(traces.fine(name));
        let height = pair.map(|(a, b)| 1e3 * rms(a, b, |frame| frame.position[2]));
        error(format!("{name}: height"), "mm", height);
        for (joint, part) in [
            (joints::LEFT_LEG + 3, "knee"),
            (joints::LEFT_LEG + 4, "ankle"),
        ] {
            let value = pair.map(|(a, b)| rms(a, b, |frame| frame.joints[joint]));
            error(format!("{name}: {part}"), "rad", value);
        }
    }
    let stand = traces.coarse("stand");
    let pair = stand.zip(traces.fine("stand"));
    let sunk = pair.and_then(|(a, b)| Some(height(a)? - height(b)?));
    error(
        "stand: height after 10 s".into(),
        "mm",
        sunk.map(|x| 1e3 * x.abs()),
    );
    let weight = links::total_mass() * f64::from(sim::world::GRAVITY);
    let force = stand.map(mean_force);
    let excess = force.map(|force| (force - weight).abs());
    error("stand: force on the soles less weight".into(), "N", excess);
    let drift = stand.and_then(|trace| moved(trace, SETTLING));
    error("stand: feet moved from 1 to 10 s".into(), "mm", drift);
    let creep = traces
        .coarse("creep")
        .and_then(|trace| moved(trace, SETTLING));
    error("creep: feet moved in 3 s".into(), "mm", creep);
    for ((joint, upper), case) in STOPS.into_iter().zip(cases::all().into_iter().skip(6)) {
        let beyond = traces.coarse(&case.name).map(|trace| {
            let limits = &JOINT_TABLE[joint];
            let gap = |frame: &Frame| {
                let q = f64::from(frame.joints[joint]);
                if upper {
                    q - limits.upper
                } else {
                    limits.lower - q
                }
            };
            trace.frames.iter().map(gap).fold(0.0, f64::max)
        });
        error(format!("{}: beyond it", case.name), "rad", beyond);
    }
    for name in ["legs", "arm"] {
        let pair = traces.coarse(name).zip(traces.fine(name));
        let joints = pair.map(|(a, b)| {
            let squares = a.frames.iter().zip(&b.frames);
            let sum: f64 = squares.map(|(a, b)| rms_of_joints(a, b).powi(2)).sum();
            (sum / a.frames.len() as f64).sqrt()
        });
        error(format!("{name} meeting: joints"), "rad", joints);
        let depth = traces.coarse(name).map(|trace| {
            let gaps = trace.frames.iter().map(|frame| frame.nearest());
            -1e3 * f64::from(gaps.fold(0.0, f32::min))
        });
        error(format!("{name} meeting: within each other"), "mm", depth);
    }
    let robots = traces.stress.len() as f64;
    let unsound = traces.stress.iter().filter(|trace| !trace.sound).count() as f64;
    let share = (robots > 0.0).then_some(100.0 * unsound / robots);
    error("stress: robots with broken numbers".into(), "%", share);
    let peak = |trace: &Trace| {
        let peaks = trace.frames.iter().map(|frame| f64::from(frame.peak));
        peaks.fold(0.0, f64::max)
    };
    for (name, value) in [
        (
            "drop: peak force on the soles",
            traces.coarse("drop").map(peak),
        ),
        ("the same at 0.5 ms", traces.fine("drop").map(peak)),
        ("stand: force on the soles", force),
    ] {
        rows.push(Row {
            name: name.into(),
            unit: "N",
            value,
            judged: false,
        });
    }
    for (name, value) in [
        ("stand: height after 10 s", stand.and_then(height)),
        ("the same at 0.5 ms", traces.fine("stand").and_then(height)),
    ] {
        rows.push(Row {
            name: name.into(),
            unit: "m",
            value,
            judged: false,
        });
    }
    rows
}

fn rms_of_joints(a: &Frame, b: &Frame) -> f64 {
    let squares = a.joints.iter().zip(&b.joints);
    let sum: f64 = squares.map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (sum / JOINTS as f64).sqrt()
}

/// Over the length of two traces.
fn rms(a: &Trace, b: &Trace, number: impl Fn(&Frame) -> f32) -> f64 {
    let squares = a.frames.iter().zip(&b.frames);
    let sum: f64 = squares
        .map(|(a, b)| (f64::from(number(a)) - f64::from(number(b))).powi(2))
        .sum();
    (sum / a.frames.len() as f64).sqrt()
}

fn height(trace: &Trace) -> Option<f64> {
    trace
        .frames
        .last()
        .map(|frame| f64::from(frame.position[2]))
}

/// Over the second half, N.
fn mean_force(trace: &Trace) -> f64 {
    let half = &trace.frames[trace.frames.len() / 2..];
    half.iter().map(|frame| f64::from(frame.force)).sum::<f64>() / half.len() as f64
}

/// How far the feet moved after a time, mm.
fn moved(trace: &Trace, after: f64) -> Option<f64> {
    let from = trace
        .frames
        .get((after / STEP).round() as usize - 1)?
        .feet();
    let to = trace.frames.last()?.feet();
    Some(1e3 * f64::from((to[0] - from[0]).hypot(to[1] - from[1])))
}
