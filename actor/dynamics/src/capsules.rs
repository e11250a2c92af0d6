//! The capsules that meet ([`g1::collision`]), in the solver's own numbers.
//!
//! Separate from the tree because mechanics does not know them; and laid out once, for pairs are looked at in every step.

use crate::lane::Real;
use g1::BODIES;
use g1::collision::{CAPSULE_TABLE, CAPSULES, PAIR_TABLE, PAIRS};

/// Parts further from each other than this are not looked at, m: what 6 m/s cover in a step of 5 ms.
const MARGIN: f64 = 0.03;

/// The capsules.
#[derive(Clone, Debug)]
pub(crate) struct Capsules<T> {
    /// The capsule of every body that has one.
    pub(crate) of_body: [Option<usize>; BODIES],
    /// Ends of the segments in the link frame, m.
    pub(crate) ends: [[[T; 3]; 2]; CAPSULES],
    /// Squares of the lengths of the segments, m².
    pub(crate) squares: [T; CAPSULES],
    /// m.
    pub(crate) radii: [T; CAPSULES],
    /// The radii and the margin, m.
    pub(crate) reaches: [T; CAPSULES],
    /// Of every pair of [`PAIR_TABLE`].
    pub(crate) pairs: [Pair<T>; PAIRS],
}

/// What tells that two capsules are apart without their nearest points: how far the middle of the shorter segment is from
/// the longer one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<T> {
    /// The capsule with the longer segment.
    pub(crate) long: usize,
    /// The other one.
    pub(crate) short: usize,
    /// One over the square of the longer segment's length, 1/m².
    pub(crate) inverse: T,
    /// Square of the distance from which on they are apart, m²: half the shorter segment, both radii, the margin.
    pub(crate) apart: T,
}

impl<T: Real> Capsules<T> {
    pub(crate) fn new() -> Self {
        let of = |body| {
            let mut bodies = CAPSULE_TABLE.iter().map(|capsule| capsule.body);
            bodies.position(|of| of == body)
        };
        Self {
            of_body: std::array::from_fn(of),
            ends: CAPSULE_TABLE.map(|capsule| capsule.ends.map(|end| end.map(T::of))),
            squares: std::array::from_fn(|capsule| T::of(square(capsule))),
            radii: CAPSULE_TABLE.map(|capsule| T::of(capsule.radius)),
            reaches: CAPSULE_TABLE.map(|capsule| T::of(capsule.radius + MARGIN)),
            pairs: PAIR_TABLE.map(Pair::of),
        }
    }
}

impl<T: Real> Pair<T> {
    fn of([a, b]: [usize; 2]) -> Self {
        let (long, short) = if square(a) < square(b) {
            (b, a)
        } else {
            (a, b)
        };
        let radii = CAPSULE_TABLE[a].radius + CAPSULE_TABLE[b].radius;
        let apart = 0.5 * square(short).sqrt() + radii + MARGIN;
        Self {
            long,
            short,
            inverse: T::of(1.0 / square(long)),
            apart: T::of(apart * apart),
        }
    }
}

/// Square of the length of a capsule's segment, m².
fn square(capsule: usize) -> f64 {
    let [from, to] = CAPSULE_TABLE[capsule].ends;
    (0..3).map(|axis| (to[axis] - from[axis]).powi(2)).sum()
}
