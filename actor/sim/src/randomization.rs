//! Domain randomisation: Table I as named rows, each with its range. A row that is not listed does not exist.
//!
//! Separate so that the table can be read here and nowhere else. Three rows change the robot or the
//! floor for an episode ([`Variation`]), one pushes it, five blur what the policy observes; reward,
//! features and falls always see the true state.

mod noise;

use crate::command;
use crate::model::Variation;
use nalgebra::Vector3;
pub(crate) use noise::SensorNoise;
use observation::Tables;
use rand::{Rng, RngExt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::invalid::{self, range_between, within};
use vocabulary::{Checked, Ramp, Section};

/// `[randomization]`: rows of Table I. Without any, the default, every robot is that of the robot's tables, its sensors are
/// exact, and nobody pushes it; the paper's preset lists all nine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("terms" = true))]
pub struct RandomizationConfig {
    /// How much the table counts: its ranges lie so much of the way between nothing (friction: 1) and themselves. Default
    /// 1, from the start. Robots that cannot walk yet learn slower on one that is never the same: a ramp from 0 waits.
    pub strength: Ramp<f32>,
    /// Share of robots that the table leaves alone. Default 0. Where noise is all that a policy has met,
    /// it may stand still without: the noise had set it going.
    pub plain_share: f32,
    /// Mass that is added to the torso in each episode, kg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass_variation: Option<Row>,
    /// Friction coefficient between soles and ground in each episode; without the row it is 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<Row>,
    /// Shift of the torso's centre of mass along each axis in each episode, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub com_offset: Option<Row>,
    /// A push now and then: a jump of the robot's velocity along world x and along world y, m/s; each sign is drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impulse: Option<Push>,
    /// Noise of the observed linear velocity, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linear_velocity_noise: Option<Row>,
    /// Noise of the observed angular velocity, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angular_velocity_noise: Option<Row>,
    /// Noise of the observed direction of gravity; Table I says m/s², the observation is a unit vector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity_noise: Option<Row>,
    /// Noise of the observed joint positions, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_position_noise: Option<Row>,
    /// Noise of the observed joint velocities, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_velocity_noise: Option<Row>,
}

/// A row of Table I.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Least and greatest value; every one between them is as likely.
    pub range: [f32; 2],
}

/// Pushes, the row of Table I that comes at its own times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Push {
    /// Least and greatest size; every one between them is as likely.
    pub range: [f32; 2],
    /// Time between pushes, s: least and greatest. Default 5 to 10; the paper gives none.
    #[serde(default = "push_seconds")]
    pub seconds: [f32; 2],
}

fn push_seconds() -> [f32; 2] {
    [5.0, 10.0]
}

/// The rows of Table I by their keys, in the table's order.
pub const ROWS: [&str; 9] = [
    "mass_variation",
    "friction",
    "com_offset",
    "impulse",
    "linear_velocity_noise",
    "angular_velocity_noise",
    "gravity_noise",
    "joint_position_noise",
    "joint_velocity_noise",
];

/// What no range of a row may go beyond, in the table's order, and why. Beyond them the numbers of a simulation break, or
/// there is no such robot.
const LIMITS: [([f32; 2], &str); ROWS.len()] = [
    (
        [-7.0, 30.0],
        "kilograms; the torso weighs 7.8 kg and has to keep some, the whole robot weighs 32",
    ),
    (
        [0.0, 3.0],
        "a coefficient of friction is never negative, ice has 0.05, rubber on concrete about 1",
    ),
    (
        [-0.3, 0.3],
        "metres; farther off the centre of mass would lie outside the torso",
    ),
    (
        [-5.0, 5.0],
        "metres per second; the robot walks at 1, and is knocked off its feet by 2",
    ),
    ([-5.0, 5.0], "metres per second; the robot walks at 1"),
    (
        [-20.0, 20.0],
        "radians per second; three turns a second are 19",
    ),
    (
        [-1.0, 1.0],
        "a unit vector is observed, of which no more noise leaves anything",
    ),
    ([-3.2, 3.2], "radians; half a turn is 3.14"),
    (
        [-40.0, 40.0],
        "radians per second; the fastest joints turn at 37",
    ),
];

impl Default for RandomizationConfig {
    fn default() -> Self {
        Self {
            strength: 1.0.into(),
            plain_share: 0.0,
            mass_variation: None,
            friction: None,
            com_offset: None,
            impulse: None,
            linear_velocity_noise: None,
            angular_velocity_noise: None,
            gravity_noise: None,
            joint_position_noise: None,
            joint_velocity_noise: None,
        }
    }
}

impl Section for RandomizationConfig {
    const NAME: &'static str = "randomization";

    fn validate(&self) -> Checked {
        self.strength.check("strength", invalid::share)?;
        invalid::share("plain_share", self.plain_share)?;
        for ((name, row), (limits, why)) in ROWS.into_iter().zip(self.ranges()).zip(LIMITS) {
            if let Some(row) = row {
                within(name, range_between("range", row, limits, why))?;
            }
        }
        let seconds = self.impulse.map_or(push_seconds(), |push| push.seconds);
        let why = "seconds, from one control step to an hour";
        range_between("impulse.seconds", seconds, [0.02, 3_600.0], why)
    }
}

impl RandomizationConfig {
    /// Table I as the paper has it: all rows.
    pub fn table_one() -> Self {
        let row = |least, greatest| {
            Some(Row {
                range: [least, greatest],
            })
        };
        Self {
            mass_variation: row(-0.5, 0.5),
            friction: row(0.5, 1.0),
            com_offset: row(-0.1, 0.1),
            impulse: Some(Push {
                range: [0.0, 0.5],
                seconds: push_seconds(),
            }),
            linear_velocity_noise: row(-0.1, 0.1),
            angular_velocity_noise: row(-0.2, 0.2),
            gravity_noise: row(-0.05, 0.05),
            joint_position_noise: row(-0.01, 0.01),
            joint_velocity_noise: row(-1.5, 1.5),
            ..Self::default()
        }
    }

    /// These rows of Table I alone, by their keys in [`ROWS`]; none where there is no such row.
    pub fn only<'a>(rows: impl IntoIterator<Item = &'a str>) -> Option<Self> {
        let (mut only, all) = (Self::default(), Self::table_one());
        for row in rows {
            match row {
                "mass_variation" => only.mass_variation = all.mass_variation,
                "friction" => only.friction = all.friction,
                "com_offset" => only.com_offset = all.com_offset,
                "impulse" => only.impulse = all.impulse,
                "linear_velocity_noise" => only.linear_velocity_noise = all.linear_velocity_noise,
                "angular_velocity_noise" => {
                    only.angular_velocity_noise = all.angular_velocity_noise;
                }
                "gravity_noise" => only.gravity_noise = all.gravity_noise,
                "joint_position_noise" => only.joint_position_noise = all.joint_position_noise,
                "joint_velocity_noise" => only.joint_velocity_noise = all.joint_velocity_noise,
                _ => return None,
            }
        }
        Some(only)
    }

    /// The range of every row that is listed, in the order of [`ROWS`].
    fn ranges(&self) -> [Option<[f32; 2]>; ROWS.len()] {
        let of = |row: Option<Row>| row.map(|row| row.range);
        [
            of(self.mass_variation),
            of(self.friction),
            of(self.com_offset),
            self.impulse.map(|push| push.range),
            of(self.linear_velocity_noise),
            of(self.angular_velocity_noise),
            of(self.gravity_noise),
            of(self.joint_position_noise),
            of(self.joint_velocity_noise),
        ]
    }

    /// The table after a number of samples that the learner has used, at full strength of its own: with the ranges that
    /// count then.
    #[must_use]
    pub fn at(&self, samples: f64) -> Self {
        let part = self.strength.at(samples);
        if part == 0.0 {
            return Self::default();
        }
        let grown = |range: [f32; 2], nothing: f32| {
            // Exact at both ends.
            range.map(|end| nothing * (1.0 - part) + end * part)
        };
        let row = |row: Option<Row>, nothing| {
            row.map(|row| Row {
                range: grown(row.range, nothing),
            })
        };
        Self {
            strength: 1.0.into(),
            plain_share: self.plain_share,
            mass_variation: row(self.mass_variation, 0.0),
            friction: row(self.friction, Variation::NOMINAL.friction),
            com_offset: row(self.com_offset, 0.0),
            impulse: self.impulse.map(|push| Push {
                range: grown(push.range, 0.0),
                ..push
            }),
            linear_velocity_noise: row(self.linear_velocity_noise, 0.0),
            angular_velocity_noise: row(self.angular_velocity_noise, 0.0),
            gravity_noise: row(self.gravity_noise, 0.0),
            joint_position_noise: row(self.joint_position_noise, 0.0),
            joint_velocity_noise: row(self.joint_velocity_noise, 0.0),
        }
    }

    /// Whether the table leaves a robot alone.
    pub fn spares(&self, robot: usize) -> bool {
        spares(self.plain_share, robot)
    }

    /// The robot and the floor of a new episode.
    pub fn draw_variation(&self, rng: &mut impl Rng) -> Variation {
        let mut variation = Variation::NOMINAL;
        if let Some(mass) = self.mass_variation {
            variation.torso_mass = uniform(mass.range, rng);
        }
        if let Some(offset) = self.com_offset {
            variation.torso_com = [(); 3].map(|()| uniform(offset.range, rng));
        }
        if let Some(friction) = self.friction {
            variation.friction = uniform(friction.range, rng);
        }
        variation
    }

    /// A push: the change of the robot's velocity, world frame, m/s; none when there are no pushes.
    pub fn draw_push(&self, rng: &mut impl Rng) -> Option<Vector3<f32>> {
        let push = self.impulse?;
        let mut component = || {
            let size = uniform(push.range, rng);
            if rng.random::<bool>() { size } else { -size }
        };
        Some(Vector3::new(component(), component(), 0.0))
    }

    /// Control steps until the next push; none when there are no pushes.
    pub fn draw_push_interval(&self, rng: &mut impl Rng) -> Option<u32> {
        self.impulse.map(|push| command::steps(push.seconds, rng))
    }
}

/// Table I with what is laid out once for every step.
pub(crate) struct Table {
    pub(crate) rows: RandomizationConfig,
    /// Of what the policy sees: the five rows that blur it, and what its list says.
    pub(crate) noise: SensorNoise,
    /// Of what the critic sees beside: what its list says.
    pub(crate) critic_noise: SensorNoise,
}

impl Table {
    /// As the rows and the lists say.
    pub(crate) fn of(rows: RandomizationConfig, tables: &Tables) -> Self {
        let critic = tables.critic.as_ref().map(|critic| &critic.own);
        let exact = RandomizationConfig::default();
        Self {
            noise: SensorNoise::of(&rows, &tables.actor),
            critic_noise: critic.map_or_else(SensorNoise::none, |own| SensorNoise::of(&exact, own)),
            rows,
        }
    }
}

/// Whether a share of the robots has this one. Spread evenly over the robots' numbers (by the golden ratio), so that it
/// falls on all kinds of command alike.
pub(crate) fn spares(share: f32, robot: usize) -> bool {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (robot as f64 * GOLDEN).fract() < f64::from(share)
}

pub(crate) fn uniform([least, greatest]: [f32; 2], rng: &mut impl Rng) -> f32 {
    least + (greatest - least) * rng.random::<f32>()
}

#[cfg(test)]
mod tests;
