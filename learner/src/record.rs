//! A line of `metrics.jsonl`: what one iteration was like.
//!
//! Everything outside `timing` depends on the seed and the actors alone, so two runs can be
//! compared line by line.

use amp::{IterationReport, Seconds};
use protocol::Totals;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::gait::Measures;
use crate::gathering::{Gathered, TermMeans};
use crate::guidance::Guide;
use crate::intake::Unused;

/// One iteration.
#[derive(Serialize)]
pub(crate) struct Record {
    pub(crate) iteration: u64,
    pub(crate) samples: u64,
    pub(crate) phase: u32,
    pub(crate) task_weight: f64,
    /// Mean length of the episodes that ended, as a share of the longest possible.
    pub(crate) episode_share: Option<f64>,
    #[serde(flatten)]
    pub(crate) learning: Map<String, Value>,
    /// `reward/<name>`, `gate/<name>`: means of the task's terms.
    #[serde(flatten)]
    pub(crate) terms: TermMeans,
    #[serde(flatten)]
    pub(crate) decision: DecisionFigures,
    #[serde(flatten)]
    pub(crate) gait: GaitFigures,
    #[serde(flatten)]
    pub(crate) traffic: Traffic,
    pub(crate) timing: Timing,
}

/// The figures of learning that depend on nothing but the batches.
pub(crate) fn figures(report: &IterationReport) -> Map<String, Value> {
    let Ok(Value::Object(mut figures)) = serde_json::to_value(report) else {
        unreachable!("a report is a record of numbers");
    };
    // Counted by this shell, which also counts refused iterations; seconds are told under `timing`.
    for other in ["iteration", "samples", "seconds"] {
        figures.remove(other);
    }
    figures
}

/// An iteration whose update was refused.
#[derive(Serialize)]
pub(crate) struct Refused {
    pub(crate) iteration: u64,
    pub(crate) samples: u64,
    /// What was not finite.
    pub(crate) fault: String,
}

/// The scheduler's numbers that were in force.
#[derive(Default, Serialize)]
pub(crate) struct DecisionFigures {
    breakout_rate: Option<f64>,
    breakout_threshold: Option<f64>,
    style_trend: Option<f64>,
    /// Iterations in which the run's ramps stood still so far.
    held: Option<u64>,
    switched_at: Option<u64>,
    lower_bound: Option<f64>,
    upper_bound: Option<f64>,
    scheduler_away: bool,
}

impl DecisionFigures {
    pub(crate) fn of(guide: &Guide, scheduler_away: bool) -> Self {
        let Some(directive) = &guide.directive else {
            return Self {
                scheduler_away,
                ..Self::default()
            };
        };
        let (lower_bound, upper_bound) = directive.bounds().unzip();
        Self {
            breakout_rate: directive.breakout_rate(),
            breakout_threshold: Some(directive.threshold),
            style_trend: directive.trend(),
            held: Some(directive.held),
            switched_at: directive.switched_at(),
            lower_bound,
            upper_bound,
            scheduler_away,
        }
    }
}

/// Is it a walk, a hop, a stand?
#[derive(Serialize)]
pub(crate) struct GaitFigures {
    /// In words, as in "hop: hips in phase (+0.94)".
    gait: String,
    hip_correlation: Option<f64>,
    contact_correlation: Option<f64>,
    stride_rate_hz: Option<f64>,
    duty_factor: Option<f64>,
    flight_share: Option<f64>,
    pelvis_height: Option<f64>,
    foot_clearance: Option<f64>,
    foot_slip: Option<f64>,
    slip_per_stride: Option<f64>,
    step_symmetry: Option<f64>,
    joint_speed_use: f64,
    commanded_speed: Option<f64>,
    speed: Option<f64>,
    commanded_yaw_rate: Option<f64>,
    yaw_rate: Option<f64>,
}

impl From<&Measures> for GaitFigures {
    fn from(measures: &Measures) -> Self {
        let (gait, feet) = (measures.conduct.gait(), &measures.feet);
        let pace = measures.conduct.pace();
        let (commanded_speed, speed) = pace.speeds().unzip();
        let (commanded_yaw_rate, yaw_rate) = pace.turns().unzip();
        Self {
            gait: measures.verdict().to_string(),
            hip_correlation: gait.hip_correlation(),
            contact_correlation: gait.contact_correlation(),
            stride_rate_hz: measures.stride_rate(),
            duty_factor: gait.duty_factor(),
            flight_share: gait.flight_share(),
            pelvis_height: gait.pelvis_height(),
            foot_clearance: feet.clearance(),
            foot_slip: feet.slip_speed(),
            slip_per_stride: measures.slip_per_stride(),
            step_symmetry: feet.step_symmetry(),
            joint_speed_use: measures.speed_use(),
            commanded_speed,
            speed,
            commanded_yaw_rate,
            yaw_rate,
        }
    }
}

/// What became of the rollouts. Counts are sums since the learner started.
#[derive(Serialize)]
pub(crate) struct Traffic {
    actors: usize,
    rollouts: usize,
    policy_lag: f64,
    dropped: u64,
    duplicated: u64,
    stale: u64,
    surplus: u64,
    unusable: u64,
}

impl Traffic {
    pub(crate) fn of(gathered: &Gathered, totals: Totals, unused: Unused) -> Self {
        Self {
            actors: gathered.actors,
            rollouts: gathered.rollouts,
            policy_lag: gathered.policy_lag,
            dropped: totals.dropped,
            duplicated: totals.duplicated,
            stale: totals.stale,
            surplus: unused.surplus,
            unusable: unused.unusable,
        }
    }
}

/// Where the time went, seconds of wall clock.
#[derive(Serialize)]
pub(crate) struct Timing {
    /// Since the run's first start, pauses between launches left out.
    pub(crate) seconds: f64,
    /// This iteration, from broadcast to broadcast.
    pub(crate) iteration_seconds: f64,
    pub(crate) samples_per_second: f64,
    /// What the scheduler took to decide on the rule of this iteration; `null` before its first word.
    pub(crate) decision_seconds: Option<f64>,
    /// Giving the weights to the actors, before the iteration.
    pub(crate) broadcast_seconds: f64,
    /// Waiting for and copying rollouts.
    pub(crate) gather_seconds: f64,
    /// Copying them alone.
    pub(crate) copy_seconds: f64,
    /// From the batch to the new weights.
    pub(crate) learn_seconds: f64,
    /// The parts of learning.
    pub(crate) learning: Seconds,
    /// Of the actors: the slowest rollout, and means of its parts.
    pub(crate) collect_seconds: f64,
    pub(crate) physics_seconds: f64,
    pub(crate) observation_seconds: f64,
    pub(crate) inference_seconds: f64,
    pub(crate) waiting_seconds: f64,
    /// Share of the machine's cores that did nothing at all; `null` where the kernel does not say.
    pub(crate) idle_share: Option<f64>,
}
