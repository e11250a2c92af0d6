//! Kinds of command, and robots dealt to them: every kind gets its share of the samples.
//!
//! Separate because drawing commands in shares does not share samples. A robot that cannot do yet
//! what it is told falls and begins anew, one that can goes on for the rest of its episode: of two
//! kinds of command, drawn as often, the one that is learnt already gets five times the samples of
//! the other, and the other is not learnt. A robot that keeps to one kind spends all its steps on it.

use crate::command::CommandConfig;
use crate::start::Starts;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

/// What a command asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing: stand still.
    Standing,
    /// Straight on.
    Forward,
    /// Straight back.
    Backward,
    /// Aside alone.
    Lateral,
    /// Turning on the spot.
    Turning,
    /// More than one of them.
    Mixed,
}

/// All kinds, in the order of [`KindsConfig`].
const KINDS: [Kind; 6] = [
    Kind::Standing,
    Kind::Forward,
    Kind::Backward,
    Kind::Lateral,
    Kind::Turning,
    Kind::Mixed,
];

impl Kind {
    /// The kind of a command.
    pub fn of([forward, lateral, yaw_rate]: [f32; 3]) -> Self {
        match [forward, lateral, yaw_rate].map(|x| x != 0.0) {
            [false, false, false] => Self::Standing,
            [true, false, false] if forward > 0.0 => Self::Forward,
            [true, false, false] => Self::Backward,
            [false, true, false] => Self::Lateral,
            [false, false, true] => Self::Turning,
            _ => Self::Mixed,
        }
    }

    /// A command of this kind from the ranges.
    pub(crate) fn draw(self, ranges: &CommandConfig, rng: &mut impl Rng) -> [f32; 3] {
        let ([slowest, fastest], lateral) = (ranges.forward.now(), ranges.lateral.now());
        let yaw_rates = ranges.yaw_rate.now();
        let forward = match self {
            Self::Forward => [slowest.max(0.0), fastest],
            Self::Backward => [slowest, fastest.min(0.0)],
            _ => [slowest, fastest],
        };
        // A range that moves may be one that leaves nothing of this kind yet: then its near end.
        let forward = [forward[0].min(fastest), forward[1].max(slowest)];
        let [vx, vy, yaw_rate] = [forward, lateral, yaw_rates]
            .map(|[least, greatest]| rng.random_range(least..=greatest));
        let ahead = ranges
            .kinds
            .as_ref()
            .map_or(0.0, |kinds| kinds.approach.now());
        match self {
            Self::Standing => [0.0; 3],
            Self::Forward => [vx, 0.0, 0.0],
            Self::Backward => [ranges.away(vx, forward), 0.0, 0.0],
            Self::Lateral => [ahead, ranges.away(vy, lateral), 0.0],
            Self::Turning => [ahead, 0.0, ranges.away(yaw_rate, yaw_rates)],
            Self::Mixed => [vx, vy, yaw_rate],
        }
    }
}

/// Relative numbers of robots that keep to a kind: their episodes begin with a command of it and, from
/// reference motion, in motion of it. Commands that change inside an episode may be of any kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct KindsConfig {
    /// Stand still.
    pub standing: f32,
    /// Straight on.
    pub forward: f32,
    /// Straight back.
    pub backward: f32,
    /// Aside alone.
    pub lateral: f32,
    /// Turning on the spot.
    pub turning: f32,
    /// All three parts at once.
    pub mixed: f32,
    /// Forward velocity that lateral and turning commands have besides, m/s; a ramp takes it away, or beyond 0 to
    /// slants backward. Between walking on, stepping aside and walking back lie walks on a slant, between them and
    /// standing only falls. Default 0.
    pub approach: Ramp<f32>,
}

impl KindsConfig {
    /// Holds all that moves where it is after a number of samples.
    pub(crate) fn set(&mut self, samples: f64) {
        self.approach.set(samples);
    }

    /// Checks every field against the ranges of commands; names the first bad one and a remedy.
    pub(crate) fn validate(&self, ranges: &CommandConfig) -> Checked {
        let fields = [
            "kinds.standing",
            "kinds.forward",
            "kinds.backward",
            "kinds.lateral",
            "kinds.turning",
            "kinds.mixed",
        ];
        for (field, weight) in fields.into_iter().zip(self.weights()) {
            invalid::at_least(field, weight, 0.0)?;
        }
        self.approach.check("kinds.approach", |path, approach| {
            invalid::require(
                (-3.0..=3.0).contains(&approach),
                path,
                approach,
                "give a velocity from -3 to 3 m/s",
            )
        })?;
        invalid::require(
            self.weights().iter().sum::<f32>() > 0.0,
            "kinds",
            self.weights(),
            "give at least one kind a share, or leave the table out",
        )?;
        let [slowest, fastest] = ranges.forward.now();
        invalid::require(
            self.forward == 0.0 || fastest > 0.0,
            "kinds.forward",
            self.forward,
            "let command.forward reach above 0, or give 0",
        )?;
        invalid::require(
            self.backward == 0.0 || slowest < 0.0,
            "kinds.backward",
            self.backward,
            "let command.forward begin below 0, or give 0",
        )
    }

    fn weights(&self) -> [f32; 6] {
        [
            self.standing,
            self.forward,
            self.backward,
            self.lateral,
            self.turning,
            self.mixed,
        ]
    }

    /// The kind that robot `index` of `robots` keeps to.
    pub(crate) fn of_robot(&self, index: usize, robots: usize) -> Kind {
        let weights = self.weights();
        let at = (index as f32 + 0.5) / robots as f32 * weights.iter().sum::<f32>();
        let mut sum = 0.0;
        let found = KINDS.into_iter().zip(weights).find(|(_, weight)| {
            sum += weight;
            at < sum
        });
        found.map_or(Kind::Mixed, |(kind, _)| kind)
    }
}

/// Frames of reference motion by the kind of their command.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pools {
    /// Of each kind: the frame, and the running sum of the kind's weights.
    frames: [Vec<(usize, f32)>; KINDS.len()],
}

impl Pools {
    /// Sorted once, for draws without a search through all frames.
    pub(crate) fn of(starts: &Starts) -> Self {
        let mut pools = Self::default();
        let mut before = 0.0;
        for (frame, &sum) in starts.cumulative_weights.iter().enumerate() {
            let pool = &mut pools.frames[Kind::of(starts.commands[frame]) as usize];
            let within = pool.last().map_or(0.0, |&(_, sum)| sum);
            pool.push((frame, within + sum - before));
            before = sum;
        }
        pools
    }

    /// A frame of a kind by weight; none if no motion is of that kind.
    pub(crate) fn draw(&self, kind: Kind, rng: &mut impl Rng) -> Option<usize> {
        let pool = &self.frames[kind as usize];
        let &(_, total) = pool.last()?;
        let at = rng.random::<f32>() * total;
        let place = pool.partition_point(|&(_, sum)| sum <= at);
        Some(pool[place.min(pool.len() - 1)].0)
    }
}

#[cfg(test)]
mod tests;
