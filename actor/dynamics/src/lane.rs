//! One number of many robots at once: the arithmetic that the solver is written in.
//!
//! Separate because the solver must not know how many robots share an instruction. A lane type is a
//! plain `f64` for references, or [`Packed`]: as many `f32` as the machine's vectors hold, one of
//! them where there are no vectors. Every operation is that of IEEE 754 in each lane, so a robot's
//! numbers have the same bits at every width.

use pulp::Simd;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number that lanes are made of.
pub trait Real: Copy + Debug + Default + PartialEq + PartialOrd + Send + Sync + 'static {
    /// The nearest number of this type.
    fn of(x: f64) -> Self;
    /// Exactly this number in double precision.
    fn to_f64(self) -> f64;
}

impl Real for f32 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x as Self
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn to_f64(self) -> f64 {
        self
    }
}

/// Numbers of [`Lane::WIDTH`] robots.
pub trait Lane:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// What a lane holds.
    type Scalar: Real;
    /// Proof that the machine has the vectors.
    type Token: Copy;
    /// A truth per lane.
    type Mask: Copy;
    /// Robots per value.
    const WIDTH: usize;

    /// The same number in every lane.
    fn splat(token: Self::Token, x: Self::Scalar) -> Self;
    /// The first [`Lane::WIDTH`] numbers of a slice.
    fn load(token: Self::Token, from: &[Self::Scalar]) -> Self;
    /// Into the first [`Lane::WIDTH`] numbers of a slice.
    fn store(self, to: &mut [Self::Scalar]);
    /// The proof that this value carries.
    fn token(self) -> Self::Token;
    /// self·b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c − self·b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;
    /// √self.
    fn sqrt(self) -> Self;
    /// |self|.
    fn abs(self) -> Self;
    /// The lesser; of NaN unspecified.
    fn min(self, other: Self) -> Self;
    /// The greater; of NaN unspecified.
    fn max(self, other: Self) -> Self;
    /// Whether self < other; false for NaN.
    fn less(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select(self, mask: Self::Mask, no: Self) -> Self;
    /// Both.
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether any lane is true.
    fn any(self, mask: Self::Mask) -> bool;
    /// The nearest whole number, for |self| below 4 million.
    fn round(self) -> Self;
    /// Sine and cosine of an angle of a few turns at most, rad.
    fn sin_cos(self) -> (Self, Self);

    /// The same number in every lane, beside a value whose proof is at hand.
    #[inline(always)]
    fn lit(self, x: f64) -> Self {
        Self::splat(self.token(), Self::Scalar::of(x))
    }
}

impl Lane for f64 {
    type Scalar = Self;
    type Token = ();
    type Mask = bool;
    const WIDTH: usize = 1;

    fn splat((): (), x: Self) -> Self {
        x
    }
    fn load((): (), from: &[Self]) -> Self {
        from[0]
    }
    fn store(self, to: &mut [Self]) {
        to[0] = self;
    }
    fn token(self) {}
    fn mul_add(self, b: Self, c: Self) -> Self {
        Self::mul_add(self, b, c)
    }
    fn neg_mul_add(self, b: Self, c: Self) -> Self {
        Self::mul_add(-self, b, c)
    }
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    fn abs(self) -> Self {
        Self::abs(self)
    }
    fn min(self, other: Self) -> Self {
        Self::min(self, other)
    }
    fn max(self, other: Self) -> Self {
        Self::max(self, other)
    }
    fn less(self, other: Self) -> bool {
        self < other
    }
    fn select(self, mask: bool, no: Self) -> Self {
        if mask { self } else { no }
    }
    fn both(self, a: bool, b: bool) -> bool {
        a && b
    }
    fn any(self, mask: bool) -> bool {
        mask
    }
    fn round(self) -> Self {
        self.round_ties_even()
    }
    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

/// As many `f32` as one vector register of `S` holds.
#[derive(Clone, Copy, Debug)]
pub struct Packed<S: Simd> {
    simd: S,
    value: S::f32s,
}

impl<S: Simd> Packed<S> {
    #[inline(always)]
    fn with(self, value: S::f32s) -> Self {
        Self {
            simd: self.simd,
            value,
        }
    }
}

macro_rules! operator {
    ($name:ident, $method:ident, $call:ident) => {
        impl<S: Simd> $name for Packed<S> {
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

impl<S: Simd> Neg for Packed<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.lit(-0.0) - self
    }
}

/// Adding and taking away 1.5·2²³ rounds an `f32` to a whole number.
const ROUNDER: f32 = 12_582_912.0;

impl<S: Simd> Lane for Packed<S> {
    type Scalar = f32;
    type Token = S;
    type Mask = S::m32s;
    const WIDTH: usize = S::F32_LANES;

    #[inline(always)]
    fn splat(simd: S, x: f32) -> Self {
        Self {
            simd,
            value: simd.splat_f32s(x),
        }
    }
    #[inline(always)]
    fn load(simd: S, from: &[f32]) -> Self {
        let (vectors, _) = S::as_simd_f32s(from);
        Self {
            simd,
            value: vectors[0],
        }
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
        (-self).max(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        other.select(other.less(self), self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.select(self.less(other), self)
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
                let (sin, cos) = Packed::<S>::load(simd, angles).sin_cos();
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
