//! A vector register of `f32`.
//!
//! Separate because it is where a machine's instructions come in; the rest of the crate knows [`Lane`].

use super::Lane;
use pulp::Simd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// As many `f32` as one vector register of `S` holds, in memory on the boundary that `A` keeps.
#[derive(Clone, Copy, Debug)]
pub struct Packed<S: Simd, A> {
    simd: S,
    value: S::f32s,
    #[expect(dead_code, reason = "it is there for its alignment")]
    aligned: [A; 0],
}

/// Boundaries in memory. A vector that lies across two cache lines takes two of everything: with vectors
/// of 32 bytes anywhere a step took a tenth longer.
pub mod boundary {
    macro_rules! boundaries {
        ($($name:ident $bytes:literal)*) => {
            $(
                #[doc = concat!("Every ", $bytes, " bytes.")]
                #[derive(Clone, Copy, Debug)]
                #[repr(align($bytes))]
                pub struct $name;
            )*
        };
    }
    boundaries!(By4 4 By16 16 By32 32 By64 64);
}

impl<S: Simd, A: Copy> Packed<S, A> {
    #[inline(always)]
    fn of(simd: S, value: S::f32s) -> Self {
        Self {
            simd,
            value,
            aligned: [],
        }
    }
    #[inline(always)]
    fn with(self, value: S::f32s) -> Self {
        Self::of(self.simd, value)
    }
}

macro_rules! operator {
    ($name:ident, $method:ident, $call:ident) => {
        impl<S: Simd, A: Copy> $name for Packed<S, A> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.with(self.simd.$call(self.value, other.value))
            }
        }
    };
}
operator!(Add, add, add_f32s);
operator!(Sub, sub, sub_f32s);
operator!(Mul, mul, mul_f32s);
operator!(Div, div, div_f32s);

impl<S: Simd, A: Copy> Neg for Packed<S, A> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.lit(-0.0) - self
    }
}

/// Adding and taking away 1.5·2²³ rounds an `f32` to a whole number.
const ROUNDER: f32 = 12_582_912.0;

impl<S: Simd, A: Copy> Lane for Packed<S, A> {
    type Scalar = f32;
    type Token = S;
    type Mask = S::m32s;
    const WIDTH: usize = S::F32_LANES;

    #[inline(always)]
    fn splat(simd: S, x: f32) -> Self {
        Self::of(simd, simd.splat_f32s(x))
    }
    #[inline(always)]
    fn load(simd: S, from: &[f32]) -> Self {
        let (vectors, _) = S::as_simd_f32s(from);
        Self::of(simd, vectors[0])
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let (vectors, _) = S::as_mut_simd_f32s(to);
        vectors[0] = self.value;
    }
    #[inline(always)]
    fn token(self) -> S {
        self.simd
    }
    #[inline(always)]
    fn mul_add(self, b: Self, c: Self) -> Self {
        self.with(self.simd.mul_add_f32s(self.value, b.value, c.value))
    }
    #[inline(always)]
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        self.with(self.simd.negate_mul_add_f32s(self.value, b.value, c.value))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.with(self.simd.sqrt_f32s(self.value))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // `pulp`'s own is a call.
        (-self).max(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.with(self.simd.min_f32s(other.value, self.value))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.with(self.simd.max_f32s(other.value, self.value))
    }
    #[inline(always)]
    fn less(self, other: Self) -> S::m32s {
        self.simd.less_than_f32s(self.value, other.value)
    }
    #[inline(always)]
    fn select(self, mask: S::m32s, no: Self) -> Self {
        self.with(self.simd.select_f32s(mask, self.value, no.value))
    }
    #[inline(always)]
    fn both(self, a: S::m32s, b: S::m32s) -> S::m32s {
        self.simd.and_m32s(a, b)
    }
    #[inline(always)]
    fn any(self, mask: S::m32s) -> bool {
        self.simd.first_true_m32s(mask) < S::F32_LANES
    }
    #[inline(always)]
    fn round(self) -> Self {
        let rounder = self.lit(f64::from(ROUNDER));
        (self + rounder) - rounder
    }

    /// To 1e-7, with the angle reduced to an eighth of a turn in three parts and Taylor's polynomials
    /// refitted on it (the coefficients of Cephes' `sinf` and `cosf`, public domain).
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let quarter = (self * self.lit(std::f64::consts::FRAC_2_PI)).round();
        let mut r = quarter.neg_mul_add(self.lit(1.570_312_5), self);
        r = quarter.neg_mul_add(self.lit(4.837_512_969_970_703e-4), r);
        r = quarter.neg_mul_add(self.lit(7.549_789_948_768_648e-8), r);
        let x = r * r;
        let sin = self.lit(-1.951_529_6e-4).mul_add(x, self.lit(8.332_161e-3));
        let sin = sin.mul_add(x, self.lit(-1.666_665_5e-1));
        let sin = (sin * x).mul_add(r, r);
        let cos = self
            .lit(2.443_315_7e-5)
            .mul_add(x, self.lit(-1.388_731_6e-3));
        let cos = cos.mul_add(x, self.lit(4.166_664_6e-2));
        let cos = (cos * x).mul_add(x, x.neg_mul_add(self.lit(0.5), self.lit(1.0)));
        // Quarters 1 and 3 swap the two, 2 and 3 turn both around.
        let half = (quarter * self.lit(0.5) - self.lit(0.25)).round();
        let odd = half.neg_mul_add(self.lit(2.0), quarter);
        let whole = (half * self.lit(0.5) - self.lit(0.25)).round();
        let turned = whole.neg_mul_add(self.lit(2.0), half);
        let sign = turned.neg_mul_add(self.lit(2.0), self.lit(1.0));
        let swap = self.lit(0.5).less(odd);
        (
            cos.select(swap, sin) * sign,
            (-sin).select(swap, cos) * sign,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, WithSimd};

    struct Angles<'a> {
        angles: &'a [f32],
        out: &'a mut Vec<(f32, f32)>,
    }

    impl WithSimd for Angles<'_> {
        type Output = ();
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) {
            for angles in self.angles.chunks_exact(S::F32_LANES) {
                let (sin, cos) = Packed::<S, boundary::By4>::load(simd, angles).sin_cos();
                let (mut sins, mut coss) = ([0.0; 16], [0.0; 16]);
                sin.store(&mut sins);
                cos.store(&mut coss);
                self.out
                    .extend(sins.into_iter().zip(coss).take(S::F32_LANES));
            }
        }
    }

    #[test]
    fn sine_and_cosine_at_every_width() {
        let angles: Vec<f32> = (-1600..1600).map(|i| i as f32 * 0.01).collect();
        let (mut wide, mut single) = (Vec::new(), Vec::new());
        Arch::new().dispatch(Angles {
            angles: &angles,
            out: &mut wide,
        });
        Arch::Scalar.dispatch(Angles {
            angles: &angles,
            out: &mut single,
        });
        assert_eq!(wide, single);
        for (angle, (sin, cos)) in angles.iter().zip(&wide) {
            let (s, c) = f64::from(*angle).sin_cos();
            assert!((f64::from(*sin) - s).abs() < 2e-7, "sin {angle}");
            assert!((f64::from(*cos) - c).abs() < 2e-7, "cos {angle}");
        }
    }
}
