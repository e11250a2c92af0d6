//! The exponential linear unit as arithmetic that the compiler turns into vector instructions.
//!
//! Not burn's: `activation::elu` has NaN gradients for large inputs (its exponential overflows and is then multiplied by
//! zero) and calls the exponential of the C library once per number.

/// x above zero, eˣ − 1 below. Relative error below 3·10⁻⁷; NaN stays NaN.
///
/// With n = round(x / ln 2) and r = x − n·ln 2, |r| ≤ ln 2 / 2:  eˣ − 1 = 2ⁿ·(eʳ − 1) + (2ⁿ − 1).
/// eʳ − 1 is r times the polynomial of degree five nearest to (eʳ − 1)/r with 1 at zero (minimax, relative error 1.3·10⁻⁸);
/// near zero n = 0 and the second part vanishes, so that nothing cancels.
#[inline(always)]
pub(crate) fn elu(x: f32) -> f32 {
    /// Adding 1.5·2²³ rounds a small number to an integer, which then stands in the lowest bits.
    const ROUNDING: f32 = 12_582_912.0;
    /// From here down eˣ is lost beside 1, and 2ⁿ is still a normal number.
    const LOWEST: f32 = -80.0;

    // Written so that NaN passes both comparisons unchanged.
    let below = if x > 0.0 { 0.0 } else { x };
    let below = if below < LOWEST { LOWEST } else { below };
    let shifted = below.mul_add(std::f32::consts::LOG2_E, ROUNDING);
    let n = shifted - ROUNDING;
    // The `f32` nearest to ln 2 is 1.9·10⁻⁹ off: 2ⁿ·n times that is lost in the sum below.
    let r = n.mul_add(-std::f32::consts::LN_2, below);
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(127 << 23));
    let mut series = 0.001_388_252_6;
    for coefficient in [0.008_366_521, 0.041_667_2, 0.166_665_43, 0.5, 1.0] {
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
