//! One number of many robots at once: the arithmetic that the solver is written in.
//!
//! Separate because the solver must not know how many robots share an instruction. A lane type is a
//! plain `f64` for references, or [`Packed`]: as many `f32` as the machine's vectors hold, one of
//! them where there are no vectors. Every operation is that of IEEE 754 in each lane, so a robot's
//! numbers have the same bits at every width.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

mod packed;
pub use packed::{Packed, boundary};

/// The same memory, to be read again. What is used in two places far from each other the compiler reads
/// once, writes to the stack and reads from there; to read it twice from where it is costs less.
#[inline(always)]
pub(crate) fn afresh<T>(memory: &T) -> &T {
    std::hint::black_box(memory)
}

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
