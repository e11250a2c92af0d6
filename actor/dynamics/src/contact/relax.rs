//! One visit to the contacts of a limb.
//!
//! Separate because this is the inner loop of the solver: ζ of the limb's chain stays in registers
//! while its contacts push on it one after another.

use super::Contact;
use crate::factor::{limb_degree, trunk_degree};
use crate::lane::Lane;
use crate::tree::{CHAIN, DEGREES};

/// Visits every contact once; with `begin` only their present impulses are brought in.
#[inline(always)]
pub(crate) fn visit<L: Lane, const PREFIX: usize, const COUNT: usize>(
    contacts: &mut [Contact<L>],
    limb: usize,
    begin: bool,
    friction: L,
    x: &mut [L; DEGREES],
) {
    let first = limb_degree(limb);
    let mut chain = [friction; CHAIN];
    for i in 0..PREFIX {
        chain[i] = x[trunk_degree(i)];
    }
    for i in 0..COUNT {
        chain[PREFIX + i] = x[first + i];
    }
    if begin {
        for contact in contacts {
            for axis in 0..3 {
                contact.push(axis, contact.impulse[axis], &mut chain);
            }
        }
    } else {
        for contact in contacts {
            contact.relax(friction, &mut chain);
        }
    }
    for i in 0..PREFIX {
        x[trunk_degree(i)] = chain[i];
    }
    for i in 0..COUNT {
        x[first + i] = chain[PREFIX + i];
    }
}

impl<L: Lane> Contact<L> {
    /// Velocity along one axis, without what was missing from the start.
    #[inline(always)]
    fn along(&self, axis: usize, chain: &[L; CHAIN]) -> L {
        let y = &self.y[axis];
        // Three sums, for one would wait for itself.
        let mut a = y[0] * chain[0];
        let mut b = y[1] * chain[1];
        let mut c = y[2] * chain[2];
        for i in [3, 6, 9] {
            a = y[i].mul_add(chain[i], a);
            b = y[i + 1].mul_add(chain[i + 1], b);
            c = y[i + 2].mul_add(chain[i + 2], c);
        }
        (a + b) + c
    }

    #[inline(always)]
    fn push(&self, axis: usize, impulse: L, chain: &mut [L; CHAIN]) {
        for i in 0..CHAIN {
            chain[i] = self.y[axis][i].mul_add(impulse, chain[i]);
        }
    }

    /// The normal, then both tangents at once.
    #[inline(always)]
    fn relax(&mut self, friction: L, chain: &mut [L; CHAIN]) {
        // All three velocities at once: what the normal will change across it is known beforehand.
        let velocity = self.missing[0] + self.along(0, chain);
        let (u, v) = (
            self.missing[1] + self.along(1, chain),
            self.missing[2] + self.along(2, chain),
        );
        let resisted = self.soft.mul_add(self.impulse[0], velocity);
        let normal = resisted
            .neg_mul_add(self.step, self.impulse[0])
            .max(friction.lit(0.0));
        let more = normal - self.impulse[0];
        let u = self.across[0].mul_add(more, u);
        let v = self.across[1].mul_add(more, v);
        let [p, q, r] = self.grip;
        let mut a = p.neg_mul_add(u, q.neg_mul_add(v, self.impulse[1]));
        let mut b = q.neg_mul_add(u, r.neg_mul_add(v, self.impulse[2]));
        // Into the disk of radius μ·λ_n, where any lane is beyond it.
        let (radius, square) = (friction * normal, a.mul_add(a, b * b));
        let slips = (radius * radius).less(square);
        if radius.any(slips) {
            let share = (radius / square.sqrt()).select(slips, radius.lit(1.0));
            (a, b) = (a * share, b * share);
        }
        let (first, second) = (a - self.impulse[1], b - self.impulse[2]);
        let y = &self.y;
        for i in 0..CHAIN {
            let pushed = y[0][i].mul_add(more, chain[i]);
            chain[i] = y[2][i].mul_add(second, y[1][i].mul_add(first, pushed));
        }
        self.impulse = [normal, a, b];
    }
}
