//! The exponential linear unit as arithmetic that the compiler turns into vector instructions.
//!
//! Not burn's: `activation::elu` has NaN gradients for large inputs (its exponential overflows and is then multiplied by
//! zero) and calls the exponential of the C library once per number.

/// x above zero, eˣ − 1 below. Relative error below 3·10⁻⁷; NaN stays NaN.
///
/// With n = round(x / ln 2) and r = x − n·ln 2, |r| ≤ ln 2 / 2:  eˣ − 1 = 2ⁿ·(eʳ − 1) + (2ⁿ − 1).
/// eʳ − 1 is its Taylor series up to r⁷; near zero n = 0 and the second part vanishes, so that nothing cancels.
#[inline(always)]
pub(crate) fn elu(x: f32) -> f32 {
    /// Adding 1.5·2²³ rounds a small number to an integer, which then stands in the lowest bits.
    const ROUNDING: f32 = 12_582_912.0;
    /// ln 2 in two parts; the first has few bits, so that n times it is exact.
    const LN_2_HIGH: f32 = 355.0 / 512.0;
    const LN_2_LOW: f32 = -2.121_944_4e-4;
    /// From here down eˣ is lost beside 1, and 2ⁿ is still a normal number.
    const LOWEST: f32 = -80.0;

    // Written so that NaN passes both comparisons unchanged.
    let below = if x > 0.0 { 0.0 } else { x };
    let below = if below < LOWEST { LOWEST } else { below };
    let shifted = below.mul_add(std::f32::consts::LOG2_E, ROUNDING);
    let n = shifted - ROUNDING;
    let r = n.mul_add(-LN_2_LOW, n.mul_add(-LN_2_HIGH, below));
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23));
    let mut series = 1.0 / 5040.0;
    for coefficient in [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0] {
        series = r.mul_add(series, coefficient);
    }
    let negative = power.mul_add(r * series, power - 1.0);
    if x > 0.0 { x } else { negative }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_exponential_below_zero() {
        for i in 0..20_000 {
            let x = -20.0 * (i as f32 / 20_000.0).powi(4); // dense near zero
            let exact = f64::from(x).exp_m1();
            assert!(
                (f64::from(elu(x)) - exact).abs() <= 3e-7 * exact.abs(),
                "{x}"
            );
        }
    }

    #[test]
    fn extremes_are_safe() {
        assert_eq!(
            [elu(0.0), elu(1e30), elu(f32::INFINITY)],
            [0.0, 1e30, f32::INFINITY]
        );
        assert_eq!(
            [elu(-90.0), elu(f32::MIN), elu(f32::NEG_INFINITY)],
            [-1.0; 3]
        );
        assert!(elu(f32::NAN).is_nan());
    }
}
