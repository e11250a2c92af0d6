//! Sensor noise: the five rows of Table I that blur what the policy observes, and what a list says of its terms.
//!
//! Separate because it is drawn for every number of every observation: laid out once as the numbers of a frame are, so
//! that one loop without questions adds it.

use super::RandomizationConfig;
use observation::{Kind, Table};
use rand::{Rng, RngExt};

/// Random words for the noise of a block, two numbers each: as many as fill vectors of every width.
const WORDS: usize = 32;
/// Numbers of a frame that noise is laid out for together.
const NUMBERS: usize = 2 * WORDS;
/// Levels that a number's noise has: enough for a sensor.
const LEVELS: f32 = 65_536.0;

/// Noise of the numbers of a frame, in blocks; those without noise are not among them.
pub(crate) struct SensorNoise {
    blocks: Vec<Block>,
}

/// Uniform from `least`, over a `span`; both 0 where there is none.
struct Block {
    /// Which of the frame's blocks it is.
    index: usize,
    least: [f32; NUMBERS],
    span: [f32; NUMBERS],
}

impl SensorNoise {
    /// None at all.
    pub(crate) fn none() -> Self {
        Self { blocks: Vec::new() }
    }

    /// As Table I says of what terms measure, widened by what a list says of each.
    pub(crate) fn of(rows: &RandomizationConfig, seen: &Table) -> Self {
        let count = seen.frame_width().div_ceil(NUMBERS);
        let block = |index| Block {
            index,
            least: [0.0; NUMBERS],
            span: [0.0; NUMBERS],
        };
        let mut blocks: Vec<Block> = (0..count).map(block).collect();
        let mut on = vec![false; count];
        for (entry, numbers) in seen.in_frame() {
            let row = match entry.term.kind {
                Kind::LinearVelocity => rows.linear_velocity_noise,
                Kind::AngularVelocity => rows.angular_velocity_noise,
                Kind::Gravity => rows.gravity_noise,
                Kind::JointPosition => rows.joint_position_noise,
                Kind::JointVelocity => rows.joint_velocity_noise,
                Kind::Length | Kind::Beside => None,
            };
            if row.is_none() && entry.noise == 0.0 {
                continue;
            }
            let [least, greatest] = row.map_or([0.0; 2], |row| row.range);
            for number in numbers {
                let (block, place) = (number / NUMBERS, number % NUMBERS);
                on[block] = true;
                blocks[block].least[place] = least - entry.noise;
                blocks[block].span[place] = greatest - least + 2.0 * entry.noise;
            }
        }
        blocks.retain(|block| on[block.index]);
        Self { blocks }
    }

    /// Adds a fresh draw to a frame; draws nothing where there is none.
    pub(crate) fn blur(&self, frame: &mut [f32], rng: &mut impl Rng) {
        if self.blocks.is_empty() {
            return;
        }
        let key: u64 = rng.random();
        for block in &self.blocks {
            let rest = &mut frame[block.index * NUMBERS..];
            if let Some(whole) = rest.first_chunk_mut() {
                block.blur(key, whole);
            } else {
                let mut whole = [0.0; NUMBERS];
                whole[..rest.len()].copy_from_slice(rest);
                block.blur(key, &mut whole);
                rest.copy_from_slice(&whole[..rest.len()]);
            }
        }
    }
}

impl Block {
    #[inline]
    fn blur(&self, key: u64, numbers: &mut [f32; NUMBERS]) {
        // Not by a function of the index, which becomes 32 calls.
        let mut words = [0; WORDS];
        let first = (self.index * WORDS) as u32;
        for (i, place) in words.iter_mut().enumerate() {
            *place = word(key, first + i as u32);
        }
        for half in 0..NUMBERS / WORDS {
            let place = half * WORDS;
            for i in 0..WORDS {
                // Each half of a random word is as random as the other. Signed, for which alone all vectors have an
                // instruction.
                let level = ((words[i] >> (16 * half)) & 0xffff) as i32;
                let share = (level as f32 + 0.5) / LEVELS;
                numbers[place + i] += self.least[place + i] + self.span[place + i] * share;
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
    use g1::{OBSERVATION, observation::JOINT_VELOCITY};
    use observation::Tables;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn noise_is_uniform_and_its_numbers_know_nothing_of_each_other() {
        let table = RandomizationConfig::table_one();
        let noise = SensorNoise::of(&table, &Tables::default().actor);
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let draws = 20_000;
        let (mut square, mut neighbours, mut halves, mut times) = (0.0, 0.0, 0.0, 0.0);
        let mut before = [0.0; OBSERVATION];
        for _ in 0..draws {
            let mut seen = [0.0; OBSERVATION];
            noise.blur(&mut seen, &mut rng);
            // Joint velocities, ±1.5 rad/s, as parts of their size.
            let part = |i: usize| f64::from(seen[JOINT_VELOCITY.start + i]) / 1.5;
            // A joint position shares its word with the velocity 32 numbers further.
            let position = f64::from(seen[JOINT_VELOCITY.start + 5 - WORDS + 9]) / 0.01;
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

    fn list(text: &str) -> Table {
        let config: observation::ObservationConfig = toml::from_str(text).unwrap();
        config.tables().unwrap().actor
    }

    #[test]
    fn a_lists_noise_widens_that_of_the_table_and_stays_within() {
        let seen = list(
            "[actor]\nterms = ['height', 'gravity', 'previous_action', 'joint_velocity', 'command']\n\
             [actor.term.height]\nnoise = 0.5\n[actor.term.gravity]\nnoise = 0.95\n\
             [actor.term.command]\nnoise = 2.0",
        );
        let rows = RandomizationConfig::only(["gravity_noise"]).unwrap();
        let noise = SensorNoise::of(&rows, &seen);
        let mut rng = Pcg64Mcg::seed_from_u64(4);
        // Height ±0.5, gravity ±(0.05 + 0.95), actions and joints none, the command (from number 50 on) ±2.
        let sizes = |i: usize| match i {
            0 => 0.5,
            1..4 => 1.0,
            50..53 => 2.0,
            _ => 0.0,
        };
        let mut widest = [0.0_f32; 53];
        for _ in 0..400 {
            let mut frame = [0.0; 53];
            noise.blur(&mut frame, &mut rng);
            for (i, (widest, number)) in widest.iter_mut().zip(frame).enumerate() {
                assert!(number.abs() <= sizes(i), "number {i}: {number}");
                *widest = widest.max(number.abs());
            }
        }
        // The greatest of 400 is beyond 95 % with a chance of 1 − 0.95⁴⁰⁰.
        for (i, widest) in widest.into_iter().enumerate() {
            assert!(widest >= 0.95 * sizes(i), "number {i}: {widest}");
        }
    }

    #[test]
    fn numbers_of_further_blocks_have_noise_of_their_own() {
        let seen = list("[actor]\nterms = ['joint_velocity', 'joint_angle', 'joint_position']");
        let noise = SensorNoise::of(&RandomizationConfig::table_one(), &seen);
        let mut rng = Pcg64Mcg::seed_from_u64(5);
        let mut frame = [0.0; 69];
        noise.blur(&mut frame, &mut rng);
        assert!(frame.iter().all(|number| *number != 0.0));
        // Of one size are 23 and 46 numbers; none of a block comes again in the next.
        assert!(
            frame[46..64]
                .iter()
                .all(|number| !frame[64..].contains(number))
        );
        assert!(frame[23..].iter().all(|number| number.abs() <= 0.01));
    }
}
