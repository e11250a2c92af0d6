//! Domain randomisation: Table I, a row per pair of fields, each with its own switch.
//!
//! Separate so that the table can be read here and nowhere else. Three rows change the robot or the
//! floor for an episode ([`Variation`]), one pushes it, five blur what the policy observes; reward,
//! features and falls always see the true state.

mod noise;

use crate::command;
use crate::model::Variation;
use nalgebra::Vector3;
use noise::SensorNoise;
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};
use vocabulary::invalid::{self, range};
use vocabulary::{Checked, Ramp};

/// The `[randomization]` section. Ranges are those of Table I; all rows are on, as in the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RandomizationConfig {
    /// How much the table counts: its ranges lie so much of the way between nothing (friction: 1) and themselves. Default
    /// 1, from the start. Robots that cannot walk yet learn slower on one that is never the same: a ramp from 0 waits.
    pub strength: Ramp<f32>,
    /// Share of robots that the table leaves alone. Default 0. Where noise is all that a policy has met,
    /// it may stand still without: the noise had set it going.
    pub plain_share: f32,
    /// Vary the torso's mass each episode.
    pub mass_variation: bool,
    /// Added mass, kg.
    pub mass_range: [f32; 2],
    /// Vary the friction between soles and ground each episode; off, it is 1.
    pub friction: bool,
    /// Friction coefficient.
    pub friction_range: [f32; 2],
    /// Shift the torso's centre of mass each episode.
    pub com_offset: bool,
    /// Shift along each axis, m.
    pub com_range: [f32; 2],
    /// Push the robot now and then: a jump of its velocity.
    pub impulse: bool,
    /// Size of the jump along world x and along world y, m/s; each sign is drawn.
    pub impulse_range: [f32; 2],
    /// Seconds between pushes. Default 5 to 10; the paper gives none.
    pub impulse_seconds: [f32; 2],
    /// Blur the observed linear velocity.
    pub linear_velocity_noise: bool,
    /// Its noise, m/s.
    pub linear_velocity_range: [f32; 2],
    /// Blur the observed angular velocity.
    pub angular_velocity_noise: bool,
    /// Its noise, rad/s.
    pub angular_velocity_range: [f32; 2],
    /// Blur the observed direction of gravity.
    pub gravity_noise: bool,
    /// Its noise; Table I says m/s², the observation is a unit vector.
    pub gravity_range: [f32; 2],
    /// Blur the observed joint positions.
    pub joint_position_noise: bool,
    /// Their noise, rad.
    pub joint_position_range: [f32; 2],
    /// Blur the observed joint velocities.
    pub joint_velocity_noise: bool,
    /// Their noise, rad/s.
    pub joint_velocity_range: [f32; 2],
}

/// The rows of Table I by the keys that switch them, in the table's order.
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

impl Default for RandomizationConfig {
    fn default() -> Self {
        Self {
            strength: 1.0.into(),
            plain_share: 0.0,
            mass_variation: true,
            mass_range: [-0.5, 0.5],
            friction: true,
            friction_range: [0.5, 1.0],
            com_offset: true,
            com_range: [-0.1, 0.1],
            impulse: true,
            impulse_range: [0.0, 0.5],
            impulse_seconds: [5.0, 10.0],
            linear_velocity_noise: true,
            linear_velocity_range: [-0.1, 0.1],
            angular_velocity_noise: true,
            angular_velocity_range: [-0.2, 0.2],
            gravity_noise: true,
            gravity_range: [-0.05, 0.05],
            joint_position_noise: true,
            joint_position_range: [-0.01, 0.01],
            joint_velocity_noise: true,
            joint_velocity_range: [-1.5, 1.5],
        }
    }
}

impl RandomizationConfig {
    /// Every row off: the robot of the tables, exact sensors, no pushes.
    pub fn none() -> Self {
        Self {
            mass_variation: false,
            friction: false,
            com_offset: false,
            impulse: false,
            linear_velocity_noise: false,
            angular_velocity_noise: false,
            gravity_noise: false,
            joint_position_noise: false,
            joint_velocity_noise: false,
            ..Self::default()
        }
    }

    /// Only these rows on, by their keys in [`ROWS`]; none where there is no such row.
    pub fn only<'a>(rows: impl IntoIterator<Item = &'a str>) -> Option<Self> {
        let mut only = Self::none();
        for row in rows {
            let switch = match row {
                "mass_variation" => &mut only.mass_variation,
                "friction" => &mut only.friction,
                "com_offset" => &mut only.com_offset,
                "impulse" => &mut only.impulse,
                "linear_velocity_noise" => &mut only.linear_velocity_noise,
                "angular_velocity_noise" => &mut only.angular_velocity_noise,
                "gravity_noise" => &mut only.gravity_noise,
                "joint_position_noise" => &mut only.joint_position_noise,
                "joint_velocity_noise" => &mut only.joint_velocity_noise,
                _ => return None,
            };
            *switch = true;
        }
        Some(only)
    }

    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Checked {
        self.strength.check("strength", invalid::share)?;
        invalid::share("plain_share", self.plain_share)?;
        range("mass_range", self.mass_range)?;
        // The torso weighs 7.8 kg and has to keep a positive mass.
        invalid::at_least("mass_range[0]", self.mass_range[0], -7.0)?;
        range("friction_range", self.friction_range)?;
        invalid::at_least("friction_range[0]", self.friction_range[0], 0.0)?;
        range("com_range", self.com_range)?;
        range("impulse_range", self.impulse_range)?;
        range("impulse_seconds", self.impulse_seconds)?;
        invalid::at_least("impulse_seconds[0]", self.impulse_seconds[0], 0.02)?;
        range("linear_velocity_range", self.linear_velocity_range)?;
        range("angular_velocity_range", self.angular_velocity_range)?;
        range("gravity_range", self.gravity_range)?;
        range("joint_position_range", self.joint_position_range)?;
        range("joint_velocity_range", self.joint_velocity_range)
    }

    /// The table after a number of samples that the learner has used, at full strength of its own: with the ranges that
    /// count then.
    #[must_use]
    pub fn at(&self, samples: f64) -> Self {
        let part = self.strength.at(samples);
        if part == 0.0 {
            return Self::none();
        }
        let grown = |range: [f32; 2], nothing: f32| {
            // Exact at both ends.
            range.map(|end| nothing * (1.0 - part) + end * part)
        };
        Self {
            strength: 1.0.into(),
            mass_range: grown(self.mass_range, 0.0),
            friction_range: grown(self.friction_range, Variation::NOMINAL.friction),
            com_range: grown(self.com_range, 0.0),
            impulse_range: grown(self.impulse_range, 0.0),
            linear_velocity_range: grown(self.linear_velocity_range, 0.0),
            angular_velocity_range: grown(self.angular_velocity_range, 0.0),
            gravity_range: grown(self.gravity_range, 0.0),
            joint_position_range: grown(self.joint_position_range, 0.0),
            joint_velocity_range: grown(self.joint_velocity_range, 0.0),
            ..self.clone()
        }
    }

    /// Whether the table leaves a robot alone. Spread evenly over the robots' numbers (by the golden
    /// ratio), so that it falls on all kinds of command alike.
    pub fn spares(&self, robot: usize) -> bool {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        (robot as f64 * GOLDEN).fract() < f64::from(self.plain_share)
    }

    /// The robot and the floor of a new episode.
    pub fn draw_variation(&self, rng: &mut impl Rng) -> Variation {
        let mut variation = Variation::NOMINAL;
        if self.mass_variation {
            variation.torso_mass = uniform(self.mass_range, rng);
        }
        if self.com_offset {
            variation.torso_com = [(); 3].map(|()| uniform(self.com_range, rng));
        }
        if self.friction {
            variation.friction = uniform(self.friction_range, rng);
        }
        variation
    }

    /// Whether any row changes the robot or the floor.
    pub fn varies(&self) -> bool {
        self.mass_variation || self.com_offset || self.friction
    }

    /// A push: the change of the robot's velocity, world frame, m/s.
    pub fn draw_push(&self, rng: &mut impl Rng) -> Vector3<f32> {
        let mut component = || {
            let size = uniform(self.impulse_range, rng);
            if rng.random::<bool>() { size } else { -size }
        };
        Vector3::new(component(), component(), 0.0)
    }

    /// Control steps until the next push; none when pushes are off.
    pub fn draw_push_interval(&self, rng: &mut impl Rng) -> Option<u32> {
        self.impulse
            .then(|| command::steps(self.impulse_seconds, rng))
    }
}

/// Table I with what is laid out once for every step.
pub(crate) struct Table {
    pub(crate) rows: RandomizationConfig,
    /// Of the five rows that blur what the policy observes.
    pub(crate) noise: SensorNoise,
}

impl Table {
    /// As the rows say.
    pub(crate) fn of(rows: RandomizationConfig) -> Self {
        Self {
            noise: SensorNoise::of(&rows),
            rows,
        }
    }
}

fn uniform([least, greatest]: [f32; 2], rng: &mut impl Rng) -> f32 {
    least + (greatest - least) * rng.random::<f32>()
}

#[cfg(test)]
mod tests;
