//! Gait measures of a batch: the one place that knows how its rows follow each other in time.
//!
//! They are of the robots that are told to go forward or back, if there are any. Hips of a robot that steps aside, turns
//! or stands are no less in phase than out of it, and the mean of all robots would be a shuffle.

use crate::robot::place;
use amp::{Batch, Place, Segment};
use g1::gait::{Conduct, Feet, Verdict, speed_use};
use g1::observation::{ANGULAR_VELOCITY, LINEAR_VELOCITY, state_of};
use observation::Tables;
use tracing::{info, warn};

/// Steps per second.
const CONTROL_HZ: f64 = 50.0;

/// Where the feet are takes forward kinematics: one robot in so many is enough for a mean.
const FEET_OF_EVERY: usize = 4;

/// From this commanded speed on (m/s) a robot is told to go forward or back.
const SLOWEST: f32 = 0.2;

/// Iterations that are judged together in the log: a verdict of a single batch flickers.
const JUDGED_TOGETHER: u64 = 10;

/// Where a batch holds what measures are made of.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    command: Place,
    gravity: Place,
    features: Place,
}

impl Places {
    /// With robots that are seen as lists say.
    pub(crate) fn of(tables: &Tables) -> Self {
        let places = tables.places();
        Self {
            command: place(places.command),
            gravity: place(places.gravity),
            features: place(places.features),
        }
    }

    fn command(&self, batch: &Batch, row: usize) -> [f32; 3] {
        three(batch.at(row, &self.command))
    }

    /// Direction of gravity in the base frame after a row's step, of which the row `next` is the one after it. As it was
    /// observed where the policy sees it: with sensor noise it is off by up to 0.05, which moves feet by centimetres but
    /// not on average.
    fn gravity(&self, batch: &Batch, row: usize, next: usize) -> [f32; 3] {
        let row = match self.gravity {
            Place::Observation(_) => next,
            Place::Features(_) | Place::Measured(_) => row,
        };
        three(batch.at(row, &self.gravity))
    }
}

fn three(numbers: &[f32]) -> [f32; 3] {
    [numbers[0], numbers[1], numbers[2]]
}

/// All measures of some robots' steps together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Measures {
    pub(crate) conduct: Conduct,
    pub(crate) feet: Feet,
    steps: f64,
    speed_use: f64,
    seconds_upright: f64,
    lives: f64,
}

impl Measures {
    /// Of a batch, with the mean length (steps) of its episodes that ended, if robots fell in them.
    pub(crate) fn of(batch: &Batch, episode_length: Option<f64>, places: &Places) -> Self {
        let mut measures = Self::of_those(batch, places, is_along);
        if measures.steps == 0.0 {
            measures = Self::of_those(batch, places, |_| true);
        }
        if let Some(steps) = episode_length {
            measures.seconds_upright = steps / CONTROL_HZ;
            measures.lives = 1.0;
        }
        measures
    }

    /// Of the steps whose command is of a kind.
    fn of_those(batch: &Batch, places: &Places, counts: impl Fn([f32; 3]) -> bool) -> Self {
        let mut measures = Self::default();
        let mut first = 0;
        for segment in batch.segments() {
            measures.add(batch, first, *segment, places, &counts);
            first += segment.rows();
        }
        measures
    }

    /// Adds a rollout whose rows begin at `first`.
    fn add(
        &mut self,
        batch: &Batch,
        first: usize,
        segment: Segment,
        places: &Places,
        counts: &impl Fn([f32; 3]) -> bool,
    ) {
        let robots = segment.environments;
        for step in 0..segment.steps {
            for robot in 0..robots {
                let row = first + step * robots + robot;
                let command = places.command(batch, row);
                if !counts(command) {
                    continue;
                }
                let began = step == 0 || batch.ends[row - robots] != 0.0;
                let before = (!began).then(|| forces(batch, row - robots));
                let features = batch.at(row, &places.features);
                // Upright robots: base and heading frame differ by the small tilt.
                let velocity = [
                    features[LINEAR_VELOCITY.start],
                    features[LINEAR_VELOCITY.start + 1],
                    features[ANGULAR_VELOCITY.end - 1],
                ];
                let landed = forces(batch, row);
                self.conduct
                    .add(command, velocity, features, landed, before);
                self.steps += 1.0;
                self.speed_use += f64::from(speed_use(features));
                let goes_on = step + 1 < segment.steps && batch.ends[row] == 0.0;
                if robot % FEET_OF_EVERY == 0 && goes_on {
                    let state = state_of(features, places.gravity(batch, row, row + robots));
                    self.feet.add(&state, forces(batch, row), before);
                }
            }
        }
    }

    fn merge(&mut self, other: &Self) {
        self.conduct.merge(&other.conduct);
        self.feet.merge(&other.feet);
        self.steps += other.steps;
        self.speed_use += other.speed_use;
        self.seconds_upright += other.seconds_upright;
        self.lives += other.lives;
    }

    /// Mean of the greatest joint speed of a robot at the end of a step, as a share of its limit.
    pub(crate) fn speed_use(&self) -> f64 {
        self.speed_use / self.steps
    }

    pub(crate) fn stride_rate(&self) -> Option<f64> {
        self.conduct.gait().stride_rate(CONTROL_HZ)
    }

    pub(crate) fn slip_per_stride(&self) -> Option<f64> {
        self.feet.slip_per_stride(CONTROL_HZ)
    }

    /// What the gait is.
    pub(crate) fn verdict(&self) -> Verdict {
        let upright = (self.lives > 0.0).then(|| self.seconds_upright / self.lives);
        self.conduct.verdict(upright, CONTROL_HZ)
    }
}

/// Whether a command (m/s, m/s, rad/s) asks for a way that is more forward or back than aside.
fn is_along([forward, left, _]: [f32; 3]) -> bool {
    forward.abs() >= SLOWEST && forward.abs() >= left.abs()
}

/// Left and right foot force in a row, N.
fn forces(batch: &Batch, row: usize) -> [f32; 2] {
    [batch.foot_forces[2 * row], batch.foot_forces[2 * row + 1]]
}

/// Says in the log what the gait has become.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    measures: Measures,
    iterations: u64,
    said: Option<&'static str>,
}

impl Watch {
    /// Takes one more iteration; every ten are judged together, and a change is said.
    pub(crate) fn take(&mut self, iteration: u64, measures: &Measures) {
        self.measures.merge(measures);
        self.iterations += 1;
        if self.iterations < JUDGED_TOGETHER {
            return;
        }
        let gait = self.measures.verdict();
        if self.said != Some(gait.name()) {
            match gait {
                // Every run begins with falls: only what lasts and looks like success is a warning.
                Verdict::Fall(_) => info!(iteration, "{gait}"),
                _ if gait.is_good() => info!(iteration, "{gait}"),
                _ => warn!(iteration, "{gait}"),
            }
            self.said = Some(gait.name());
        }
        self.measures = Measures::default();
        self.iterations = 0;
    }
}

#[cfg(test)]
mod tests;
