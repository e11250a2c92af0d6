//! Standard normal numbers for one row of actions at a time, written so that the compiler turns it into vector
//! instructions. A library's numbers come one by one, each by a table and a rejection: 23 took an eighth of the time of
//! the default network.

use rand::Rng;

use crate::OUTPUTS;

/// Pairs that a row needs.
const PAIRS: usize = OUTPUTS.div_ceil(2);
/// Pairs that are made: as many as fill vectors of every width.
const MADE: usize = PAIRS.next_multiple_of(16);

/// Independent standard normal numbers by Box and Muller (1958):  √(−2 ln u)·(cos θ, sin θ)  of uniform u and θ.
///
/// One 64-bit word makes a pair. u has 24 bits, so no number is beyond √(2·25·ln 2) = 5.9; θ has 22 within its quadrant,
/// which two more bits choose. Absolute error below 2·10⁻⁶.
#[inline(always)]
pub(crate) fn row<R: Rng + ?Sized>(rng: &mut R) -> [f32; OUTPUTS] {
    let (mut sizes, mut turns) = ([0_u32; MADE], [0_u32; MADE]);
    for i in 0..PAIRS {
        let word = rng.next_u64();
        (sizes[i], turns[i]) = ((word >> 32) as u32, word as u32);
    }
    let (mut cosines, mut sines) = ([0.0; MADE], [0.0; MADE]);
    for i in 0..MADE {
        (cosines[i], sines[i]) = pair(sizes[i], turns[i]);
    }
    let mut numbers = [0.0; OUTPUTS];
    numbers[..PAIRS].copy_from_slice(&cosines[..PAIRS]);
    numbers[PAIRS..].copy_from_slice(&sines[..OUTPUTS - PAIRS]);
    numbers
}

/// Two independent standard normal numbers of two random words.
#[inline(always)]
fn pair(size: u32, turn: u32) -> (f32, f32) {
    /// Of 24 bits, signed, for which alone all vectors have an instruction.
    const STEP: f32 = 1.0 / 16_777_216.0;
    let radius = (-2.0 * ln(((size >> 8) as i32 as f32 + 0.5) * STEP)).sqrt();
    let eighth = std::f32::consts::FRAC_PI_4;
    // The quadrant's middle is zero: series are short there.
    let angle = (((turn >> 10) as i32 as f32 + 0.5) * (1.0 / 4_194_304.0) - 0.5) * (2.0 * eighth);
    let square = angle * angle;
    let mut sine = 1.0 / 362_880.0;
    for coefficient in [-1.0 / 5_040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0] {
        sine = sine * square + coefficient;
    }
    let sine = sine * angle;
    let mut cosine = 1.0 / 40_320.0;
    for coefficient in [-1.0 / 720.0, 1.0 / 24.0, -1.0 / 2.0, 1.0] {
        cosine = cosine * square + coefficient;
    }
    let radius = radius * std::f32::consts::FRAC_1_SQRT_2;
    let (right, up) = (radius * (cosine - sine), radius * (cosine + sine));
    let sign = |number: f32, bit: u32| f32::from_bits(number.to_bits() ^ (bit << 31));
    (sign(right, turn), sign(up, turn >> 1))
}

/// ln x of a normal number x above zero.
///
/// x = 2ⁿ·m with m from √½ to √2, and ln m = 2·artanh s of s = (m − 1)/(m + 1), |s| < .172: four terms leave 2·10⁻⁹.
#[inline(always)]
fn ln(x: f32) -> f32 {
    const ROOT_OF_HALF: u32 = 0x3f35_04f3;
    let above = x.to_bits().wrapping_sub(ROOT_OF_HALF);
    let n = (above as i32 >> 23) as f32;
    let m = f32::from_bits((above & 0x007f_ffff).wrapping_add(ROOT_OF_HALF));
    let s = (m - 1.0) / (m + 1.0);
    let square = s * s;
    let mut series = 1.0 / 9.0;
    for coefficient in [1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0] {
        series = series * square + coefficient;
    }
    n * std::f32::consts::LN_2 + 2.0 * s * series
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn the_logarithm_is_the_logarithm() {
        for i in 1..=16_384_u32 {
            let x = ((i << 10) as f32 - 0.5) / 16_777_216.0;
            let exact = f64::from(x).ln();
            assert!(
                (f64::from(ln(x)) - exact).abs() <= 2e-7 * exact.abs().max(0.5),
                "{x}: {} for {exact}",
                ln(x)
            );
        }
    }

    #[test]
    fn pairs_by_hand() {
        // u = ½ less half a step: √(2 ln 2) = 1.177410. A turn of 2²¹ of 2²² is π/4: both are 1.177410/√2 = 0.832555.
        let middle = 1 << 31;
        let (right, up) = pair(1 << 31, middle);
        assert!((right - 0.832_555).abs() < 2e-6 && (up - 0.832_555).abs() < 2e-6);
        // The two lowest bits are the signs.
        assert_eq!(pair(1 << 31, middle | 1), (-right, up));
        assert_eq!(pair(1 << 31, middle | 2), (right, -up));
        // The least u there is: √(2·25·ln 2) = 5.887050, and an angle of next to nothing.
        let (right, up) = pair(0, 0);
        assert!((right - 5.887_05).abs() < 1e-5 && up.abs() < 1e-5);
    }

    #[test]
    fn numbers_are_normal_and_know_nothing_of_each_other() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(4);
        let rows = 40_000;
        let (mut within, mut beyond) = ([0_u32; OUTPUTS], [0_u32; OUTPUTS]);
        let mut products = [0.0_f64; 3];
        for _ in 0..rows {
            let z = row(&mut rng);
            for i in 0..OUTPUTS {
                within[i] += u32::from(z[i].abs() < 1.0);
                beyond[i] += u32::from(z[i] > 2.0);
            }
            // Neighbours, the two of a pair, and what a pair's radius would tie together.
            let pairs = [
                (z[0], z[1]),
                (z[0], z[PAIRS]),
                (z[0] * z[0] - 1.0, z[PAIRS] * z[PAIRS] - 1.0),
            ];
            for (sum, (a, b)) in products.iter_mut().zip(pairs) {
                *sum += f64::from(a) * f64::from(b);
            }
        }
        let n = f64::from(rows);
        for i in 0..OUTPUTS {
            // 68.269 and 2.275 %, with standard errors of √(p(1 − p)/n) = .0023 and .00075; five of each.
            assert!((f64::from(within[i]) / n - 0.682_69).abs() < 0.0116, "{i}");
            assert!((f64::from(beyond[i]) / n - 0.022_75).abs() < 0.0037, "{i}");
        }
        // Means of products are 0, with standard errors of 1/√n = .005, and 2/√n for squares; five of each.
        assert!(products[0].abs() / n < 0.025 && products[1].abs() / n < 0.025);
        assert!(products[2].abs() / n < 0.05);
    }
}
