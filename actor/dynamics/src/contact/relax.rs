//! One visit to the contacts of a limb, or to those of the robot with itself.
//!
//! Separate because this is the inner loop of the solver. An impulse waits for the one before it, so the
//! groups take turns contact by contact: with two in turn a whole step takes 6 % less than with one.

use super::{Contact, Contacts};
use crate::factor::{limb_degree, trunk_degree};
use crate::lane::{Lane, afresh};
use crate::tree::{BASE, CHAIN, DEGREES, LIMB_JOINTS, TRUNK};
use std::hint::black_box;

/// ζ along the chain of a limb.
struct Chain<'a, L> {
    base: &'a mut [L; BASE],
    /// The limb's joints; before an arm's the waist.
    rest: &'a mut [L; LIMB_JOINTS],
}

impl<L: Lane> Chain<'_, L> {
    #[inline(always)]
    fn at(&self, i: usize) -> L {
        match i {
            0..BASE => self.base[i],
            _ => self.rest[i - BASE],
        }
    }
    #[inline(always)]
    fn set(&mut self, i: usize, value: L) {
        match i {
            0..BASE => self.base[i] = value,
            _ => self.rest[i - BASE] = value,
        }
    }
}

/// The base's part of ζ, and all from a limb's first joint on.
#[inline(always)]
fn parts<L>(zeta: &mut [L; DEGREES], limb: usize) -> (&mut [L; BASE], &mut [L]) {
    let (before, from) = zeta.split_at_mut(limb_degree(limb));
    let base = before.first_chunk_mut().expect("limbs come after the base");
    (base, from)
}

/// Visits every contact of a limb once; with `begin` only their present impulses are brought in.
#[inline(always)]
pub(crate) fn visit<L: Lane, const PREFIX: usize, const COUNT: usize>(
    groups: &mut [&mut Contacts<L>],
    limb: usize,
    begin: bool,
) {
    let most = groups.iter().map(|group| group.count(limb)).max();
    for i in 0..most.unwrap_or(0) {
        for group in &mut *groups {
            let (from, to) = group.of_limb[limb];
            let Some(contact) = group.list[from..to].get_mut(i) else {
                continue;
            };
            if PREFIX == BASE {
                let (base, from) = parts(&mut group.zeta, limb);
                let rest = from.first_chunk_mut().expect("a leg has six joints");
                contact.turn(begin, group.friction, Chain { base, rest });
                continue;
            }
            let waist = trunk_degree(TRUNK - 1);
            let mut rest = [group.zeta[waist]; LIMB_JOINTS];
            let (base, from) = parts(&mut group.zeta, limb);
            rest[1..].copy_from_slice(&from[..COUNT]);
            let chain = Chain {
                base,
                rest: &mut rest,
            };
            contact.turn(begin, group.friction, chain);
            from[..COUNT].copy_from_slice(&rest[1..]);
            group.zeta[waist] = rest[0];
        }
    }
}

/// Visits every contact of the robots with themselves once.
#[inline(always)]
pub(crate) fn visit_pairs<L: Lane>(groups: &mut [&mut Contacts<L>]) {
    let most = groups.iter().map(|group| group.pairs.count()).max();
    for i in 0..most.unwrap_or(0) {
        for group in &mut *groups {
            group.pairs.relax(i, &mut group.zeta);
        }
    }
}

impl<L: Lane> Contact<L> {
    #[inline(always)]
    fn turn(&mut self, begin: bool, friction: L, mut chain: Chain<'_, L>) {
        if !begin {
            return self.relax(friction, chain);
        }
        for axis in 0..3 {
            for i in 0..CHAIN {
                let pushed = self.y[axis][i].mul_add(self.impulse[axis], chain.at(i));
                chain.set(i, pushed);
            }
        }
    }

    /// Velocity along one axis, without what was missing from the start.
    #[inline(always)]
    fn along(&self, axis: usize, chain: &Chain<'_, L>) -> L {
        let y = &self.y[axis];
        // Three sums, for one would wait for itself.
        let mut a = y[0] * chain.at(0);
        let mut b = y[1] * chain.at(1);
        let mut c = y[2] * chain.at(2);
        for i in [3, 6, 9] {
            a = y[i].mul_add(chain.at(i), a);
            b = y[i + 1].mul_add(chain.at(i + 1), b);
            c = y[i + 2].mul_add(chain.at(i + 2), c);
        }
        (a + b) + c
    }

    /// The normal, then both tangents at once.
    #[inline(always)]
    fn relax(&mut self, friction: L, chain: Chain<'_, L>) {
        // All three velocities at once: what the normal will change across it is known beforehand.
        let velocity = self.missing[0] + self.along(0, &chain);
        let (u, v) = (
            self.missing[1] + self.along(1, &chain),
            self.missing[2] + self.along(2, &chain),
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
        let y = afresh(&self.y);
        let mut chain = Chain {
            base: black_box(chain.base),
            rest: black_box(chain.rest),
        };
        for i in 0..CHAIN {
            let pushed = y[0][i].mul_add(more, chain.at(i));
            chain.set(i, y[2][i].mul_add(second, y[1][i].mul_add(first, pushed)));
        }
        self.impulse = [normal, a, b];
    }
}
