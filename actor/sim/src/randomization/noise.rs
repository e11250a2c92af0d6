//! Sensor noise: the five rows of Table I that blur what the policy observes.
//!
//! Separate because it is drawn for every number of every observation: laid out once as the numbers of an observation
//! are, so that one loop without questions adds it.

use super::{RandomizationConfig, Row};
use g1::{OBSERVATION, observation};
use rand::{Rng, RngExt};
use std::ops::Range;

/// Random words for the noise of an observation, two numbers each: as many as fill vectors of every width.
const WORDS: usize = 32;
/// Numbers of an observation that noise is laid out for. The last five are actions and have none.
const NUMBERS: usize = 2 * WORDS;
const _: () = assert!(observation::JOINT_VELOCITY.end <= NUMBERS && NUMBERS <= OBSERVATION);
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
        let rows: [(Option<Row>, Range<usize>); 5] = [
            (table.linear_velocity_noise, observation::LINEAR_VELOCITY),
            (table.angular_velocity_noise, observation::ANGULAR_VELOCITY),
            (table.gravity_noise, observation::GRAVITY),
            (table.joint_position_noise, observation::JOINT_POSITION),
            (table.joint_velocity_noise, observation::JOINT_VELOCITY),
        ];
        let mut noise = Self {
            on: rows.iter().any(|(row, _)| row.is_some()),
            least: [0.0; NUMBERS],
            span: [0.0; NUMBERS],
        };
        for (row, numbers) in rows {
            if let Some(Row {
                range: [least, greatest],
            }) = row
            {
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
        let key: u64 = rng.random();
        // Not by a function of the index, which becomes 32 calls.
        let mut words = [0; WORDS];
        for (i, place) in words.iter_mut().enumerate() {
            *place = word(key, i as u32);
        }
        let rows = observation.as_chunks_mut::<WORDS>().0.iter_mut();
        let ranges = self.least.as_chunks().0.iter().zip(self.span.as_chunks().0);
        for (half, (numbers, (least, span))) in rows.zip(ranges).enumerate() {
            let (least, span): (&[f32; WORDS], &[f32; WORDS]) = (least, span);
            for i in 0..WORDS {
                // Each half of a random word is as random as the other. Signed, for which alone all vectors have an
                // instruction.
                let level = ((words[i] >> (16 * half)) & 0xffff) as i32;
                numbers[i] += least[i] + span[i] * ((level as f32 + 0.5) / LEVELS);
            }
        }
    }
}

/// Random word `i` of a key: MurmurHash3's mixer of a Weyl sequence. The environment's own generator gives the key; it
/// alone, word by word, took a tenth of a microsecond for an observation.
#[inline(always)]
fn word(key: u64, i: u32) -> u32 {
    let mut x = (key as u32).wrapping_add(i.wrapping_mul(0x9e37_79b9));
    x = (x ^ (x >> 16)).wrapping_mul(0x85eb_ca6b);
    x = x.wrapping_add((key >> 32) as u32);
    x = (x ^ (x >> 13)).wrapping_mul(0xc2b2_ae35);
    x ^ (x >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn noise_is_uniform_and_its_numbers_know_nothing_of_each_other() {
        let table = RandomizationConfig::table_one();
        let noise = SensorNoise::of(&table);
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let draws = 20_000;
        let (mut square, mut neighbours, mut halves, mut times) = (0.0, 0.0, 0.0, 0.0);
        let mut before = [0.0; OBSERVATION];
        for _ in 0..draws {
            let mut seen = [0.0; OBSERVATION];
            noise.blur(&mut seen, &mut rng);
            // Joint velocities, ±1.5 rad/s, as parts of their size.
            let part = |i: usize| f64::from(seen[observation::JOINT_VELOCITY.start + i]) / 1.5;
            // A joint position shares its word with the velocity 32 numbers further.
            let position =
                f64::from(seen[observation::JOINT_VELOCITY.start + 5 - WORDS + 9]) / 0.01;
            square += part(5) * part(5);
            neighbours += part(5) * part(6);
            halves += part(14) * position;
            times += part(5) * before[5];
            before[5] = part(5);
        }
        let n = f64::from(draws);
        // Variance 1/3 with a standard error of √(4/45/n) = 0.002; products of independent numbers have mean 0 and a
        // standard error of 1/3/√n = 0.0024. Five of each.
        assert!((square / n - 1.0 / 3.0).abs() < 0.011, "{}", square / n);
        for product in [neighbours, halves, times] {
            assert!((product / n).abs() < 0.012, "{}", product / n);
        }
    }
}
