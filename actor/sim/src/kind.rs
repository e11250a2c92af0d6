//! Kinds of command, and robots dealt to them: every kind gets its share of the samples.
//!
//! Separate because drawing commands in shares does not share samples. A robot that cannot do yet
//! what it is told falls and begins anew, one that can goes on for the rest of its episode: of two
//! kinds of command, drawn as often, the one that is learnt already gets five times the samples of
//! the other, and the other is not learnt. A robot that keeps to one kind spends all its steps on it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

/// Least and greatest of the three parts of commands.
type Commands = [[f32; 2]; 3];

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
pub(crate) const KINDS: [Kind; 6] = [
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
}

/// Relative numbers of robots that keep to a kind: their episodes begin with a command of it and, from
/// reference motion, in motion of it. Commands that change inside an episode may be of any kind.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
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

    /// Checks every field, the kinds against all that commands ever ask for: forward and leftward velocity, m/s, and yaw
    /// rate, rad/s. Names the first bad one and a remedy.
    pub(crate) fn validate(&self, [[slowest, fastest], lateral, yaw_rate]: Commands) -> Checked {
        let fields = [
            "kinds.standing",
            "kinds.forward",
            "kinds.backward",
            "kinds.lateral",
            "kinds.turning",
            "kinds.mixed",
        ];
        for (field, weight) in fields.into_iter().zip(self.weights()) {
            let why = "shares of robots, relative to each other";
            invalid::between(field, weight, [0.0, 1e6], why)?;
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
        )?;
        invalid::require(
            self.lateral == 0.0 || lateral != [0.0; 2],
            "kinds.lateral",
            self.lateral,
            "give command.lateral a range, as in [-0.4, 0.4], or give 0",
        )?;
        invalid::require(
            self.turning == 0.0 || yaw_rate != [0.0; 2],
            "kinds.turning",
            self.turning,
            "give command.yaw_rate a range, as in [-1.0, 1.0], or give 0",
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

#[cfg(test)]
mod tests;
