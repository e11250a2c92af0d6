//! Sensor noise: the five rows of Table I that blur what the policy observes.
//!
//! Separate because it is drawn for every number of every observation: laid out once as the numbers of an observation
//! are, so that one loop without questions adds it.

use super::RandomizationConfig;
use g1::{OBSERVATION, observation};
use rand::{Rng, RngExt};
use std::ops::Range;

/// Random words for the noise of an observation, four numbers each.
const WORDS: usize = observation::JOINT_VELOCITY.end.div_ceil(4);
/// Numbers of an observation that may be blurred, and one.
const NUMBERS: usize = 4 * WORDS;
/// Levels that a number's noise has: enough for a sensor.
const LEVELS: f32 = 65_536.0;

/// Noise of the numbers of an observation: uniform from `least`, over a `span`; both 0 where there is none.
pub(crate) struct SensorNoise {
    on: bool,
    least: [f32; NUMBERS],
    span: [f32; NUMBERS],
}

impl SensorNoise {
    /// As a table says.
    pub(crate) fn of(table: &RandomizationConfig) -> Self {
        let rows: [(bool, [f32; 2], Range<usize>); 5] = [
            (
                table.linear_velocity_noise,
                table.linear_velocity_range,
                observation::LINEAR_VELOCITY,
            ),
            (
                table.angular_velocity_noise,
                table.angular_velocity_range,
                observation::ANGULAR_VELOCITY,
            ),
            (
                table.gravity_noise,
                table.gravity_range,
                observation::GRAVITY,
            ),
            (
                table.joint_position_noise,
                table.joint_position_range,
                observation::JOINT_POSITION,
            ),
            (
                table.joint_velocity_noise,
                table.joint_velocity_range,
                observation::JOINT_VELOCITY,
            ),
        ];
        let mut noise = Self {
            on: rows.iter().any(|(on, ..)| *on),
            least: [0.0; NUMBERS],
            span: [0.0; NUMBERS],
        };
        for (on, [least, greatest], numbers) in rows {
            if on {
                noise.least[numbers.clone()].fill(least);
                noise.span[numbers].fill(greatest - least);
            }
        }
        noise
    }

    /// Adds a fresh draw to an observation; draws nothing where there is none.
    pub(crate) fn blur(&self, observation: &mut [f32; OBSERVATION], rng: &mut impl Rng) {
        if !self.on {
            return;
        }
        let mut words = [0_u64; WORDS];
        for word in &mut words {
            *word = rng.random();
        }
        for quarter in 0..4 {
            for (i, word) in words.iter().enumerate() {
                // Each quarter of a random word is as random as the others.
                let level = (word >> (16 * quarter)) as u16;
                let share = (f32::from(level) + 0.5) / LEVELS;
                let number = WORDS * quarter + i;
                observation[number] += self.least[number] + self.span[number] * share;
            }
        }
    }
}
