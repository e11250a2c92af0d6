//! The robots of one register, taken out of their block for a control step.
//!
//! Separate because a block's rows are sixteen wide on every machine. Here every number fills a register
//! and lies at a place that the compiler knows: nothing is looked up by lane within a step, and a
//! machine of eight lanes does not drag the other eight through its caches.

use crate::block::{Block, Row, row};
use crate::condition::{GRAVITY, Own};
use crate::lane::Lane;
use crate::tree::SOLES;
use g1::JOINTS;

/// State, make, targets and sums of the robots in a register.
pub(crate) struct Group<L> {
    pub(crate) state: [L; row::STATE],
    /// Mass, centre of mass and inertia of the torso, the one body that varies.
    pub(crate) torso: [L; row::PER_BODY],
    pub(crate) friction: L,
    /// Target positions of the joints, rad.
    pub(crate) targets: [L; JOINTS],
    /// Whether the robots have conditions; without, only gravity of these is read.
    pub(crate) conditioned: bool,
    pub(crate) own: Own<L>,
    pub(crate) sums: Sums<L>,
}

/// Sums over the steps of a control step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sums<L> {
    /// Positive work of the motors, J.
    pub(crate) work: L,
    /// Normal impulses on the soles, left and right, N·s.
    pub(crate) soles: [L; SOLES],
    /// Greatest torque of every joint without sign, N·m.
    pub(crate) torques: [L; JOINTS],
    /// Greatest speed of every joint without sign, rad/s.
    pub(crate) speeds: [L; JOINTS],
}

/// [`Sums`] of the robots of a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally<T> {
    /// Of the state after the last step: 0, or NaN if any of its numbers is not finite.
    pub(crate) odd: Row<T>,
    /// Likewise: the greatest part of the pelvis' velocity and angular velocity without sign, m/s or rad/s.
    pub(crate) fastest: Row<T>,
    pub(crate) work: Row<T>,
    pub(crate) soles: [Row<T>; SOLES],
    pub(crate) torques: [Row<T>; JOINTS],
    pub(crate) speeds: [Row<T>; JOINTS],
}

impl<L: Lane> Group<L> {
    #[inline(always)]
    pub(crate) fn new(token: L::Token) -> Self {
        let zero = L::splat(token, L::Scalar::default());
        Self {
            state: [zero; row::STATE],
            torso: [zero; row::PER_BODY],
            friction: zero,
            targets: [zero; JOINTS],
            conditioned: false,
            own: Own::all(zero),
            sums: Sums {
                work: zero,
                soles: [zero; SOLES],
                torques: [zero; JOINTS],
                speeds: [zero; JOINTS],
            },
        }
    }

    /// Takes the robots of a block from `lane` on, with sums of nothing.
    #[inline(always)]
    pub(crate) fn load(
        &mut self,
        token: L::Token,
        block: &Block<L::Scalar>,
        targets: &[Row<L::Scalar>; JOINTS],
        own: Option<&Own<Row<L::Scalar>>>,
        lane: usize,
    ) {
        fill(token, &mut self.state, block.rows(), lane);
        fill(token, &mut self.torso, block.torso(), lane);
        fill(token, &mut self.targets, targets, lane);
        self.friction = block.friction.get(token, lane);
        let zero = L::splat(token, L::Scalar::default());
        self.conditioned = own.is_some();
        match own {
            None => self.own.lift = [zero, zero, zero.lit(GRAVITY)],
            Some(own) => self.take(token, own, lane),
        }
        self.sums.work = zero;
        self.sums.soles = [zero; SOLES];
        self.sums.torques = [zero; JOINTS];
        self.sums.speeds = [zero; JOINTS];
    }

    /// Other target positions, for the next step.
    #[inline(always)]
    pub(crate) fn aim(&mut self, token: L::Token, targets: &[Row<L::Scalar>; JOINTS], lane: usize) {
        fill(token, &mut self.targets, targets, lane);
    }

    /// The robots' conditions.
    #[inline(always)]
    fn take(&mut self, token: L::Token, from: &Own<Row<L::Scalar>>, lane: usize) {
        let own = &mut self.own;
        fill(token, &mut own.stiffness, &from.stiffness, lane);
        fill(token, &mut own.damping, &from.damping, lane);
        fill(token, &mut own.driving, &from.driving, lane);
        fill(token, &mut own.braking, &from.braking, lane);
        fill(token, &mut own.level, &from.level, lane);
        fill(token, &mut own.fade, &from.fade, lane);
        fill(token, &mut own.friction, &from.friction, lane);
        fill(token, &mut own.drag, &from.drag, lane);
        fill(token, &mut own.lift, &from.lift, lane);
        fill(token, &mut own.force, &from.force, lane);
    }

    /// Puts the robots back.
    #[inline(always)]
    pub(crate) fn store(
        &self,
        block: &mut Block<L::Scalar>,
        tally: &mut Tally<L::Scalar>,
        lane: usize,
    ) {
        spill(&self.state, block.rows_mut(), lane);
        let (odd, fastest) = self.soundness();
        tally.odd.set(lane, odd);
        tally.fastest.set(lane, fastest);
        tally.work.set(lane, self.sums.work);
        spill(&self.sums.soles, &mut tally.soles, lane);
        spill(&self.sums.torques, &mut tally.torques, lane);
        spill(&self.sums.speeds, &mut tally.speeds, lane);
    }

    /// What [`Tally::odd`] and [`Tally::fastest`] hold.
    #[inline(always)]
    fn soundness(&self) -> (L, L) {
        let zero = self.sums.work.lit(0.0);
        // Nothing of infinity is NaN as well. Several sums, for each addition waits for the one before.
        let mut odd = [zero; 4];
        for (i, &number) in self.state[..row::IMPULSE].iter().enumerate() {
            odd[i % 4] = number.mul_add(zero, odd[i % 4]);
        }
        let mut fastest = zero;
        for &speed in &self.state[row::LINEAR..row::JOINT] {
            fastest = fastest.max(speed.abs());
        }
        ((odd[0] + odd[1]) + (odd[2] + odd[3]), fastest)
    }
}

#[inline(always)]
fn fill<L: Lane, const N: usize>(
    token: L::Token,
    to: &mut [L; N],
    from: &[Row<L::Scalar>; N],
    lane: usize,
) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = from.get(token, lane);
    }
}

#[inline(always)]
fn spill<L: Lane, const N: usize>(from: &[L; N], to: &mut [Row<L::Scalar>; N], lane: usize) {
    for (from, to) in from.iter().zip(to) {
        to.set(lane, *from);
    }
}
