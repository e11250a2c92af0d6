//! Contacts: points against the ground, soft along the normal, dry friction across it; and the robot with itself.
//!
//! Separate because contact is a model of its own, with choices that mechanics does not make. Along
//! the normal the point obeys φ̈ + b·φ̇ + k·φ = 0 softened by an impedance, as MuJoCo's `solref` and
//! `solimp` say (defaults: 20 ms, critically damped, 0.9 to 0.95 over the first millimetre), taken
//! implicitly over the step. Across it friction holds the point still as far as the cone |λ_t| ≤ μ·λ_n
//! allows: a disk, not a pyramid, and without softness, so that a standing robot does not creep.
//! Impulses come from projected Gauss–Seidel sweeps over the points, begun with those of the last step.

mod normal;
mod pairs;
mod reach;
mod relax;

use crate::block::{Block, Row, row};
use crate::factor::{self, Factor};
use crate::ground::Ground;
use crate::group::Group;
use crate::kinematics::Walk;
use crate::lane::{Lane, Real};
use crate::spatial::Vec3;
use crate::tree::{
    BASE, CHAIN, DEGREES, LIMBS, POINT_TABLE, POINTS, SOLE_POINTS, SOLES, TRUNK, Tree,
};
use g1::JOINTS;
use normal::normal;
use pairs::Pairs;
use reach::Reach;

/// A point that touches the ground in some lane.
#[derive(Clone, Copy)]
pub(crate) struct Contact<L> {
    point: usize,
    /// D^-½·L⁻ᵀ·Jᵀ along the limb's chain: normal, two tangents.
    y: [[L; CHAIN]; 3],
    /// What is missing to the wanted velocities before any impulse, m/s.
    missing: [L; 3],
    /// What a normal impulse does along the tangents, 1/kg.
    across: [L; 2],
    /// Impulse per missing velocity along the normal, kg; 0 in lanes without contact.
    step: L,
    /// Softness along the normal, 1/kg.
    soft: L,
    /// Inverse of the tangents' matrix, kg: first, mixed, second; 0 in lanes without contact.
    grip: [L; 3],
    /// Impulses, N·s.
    impulse: [L; 3],
}

/// The contacts of a step, limb by limb.
pub(crate) struct Contacts<L> {
    list: [Contact<L>; POINTS],
    /// First and one past the last of every limb.
    of_limb: [(usize, usize); LIMBS],
    reach: Reach<L>,
    friction: L,
    pairs: Pairs<L>,
    /// ζ of every degree (see [`factor`]): begins with what the other forces did and ends with the
    /// impulses in it.
    pub(crate) zeta: [L; DEGREES],
}

/// What all contacts of a step share.
pub(crate) struct Touch<'a, L: Lane> {
    pub(crate) token: L::Token,
    pub(crate) tree: &'a Tree<L::Scalar>,
    pub(crate) ground: &'a Ground,
    pub(crate) dt: L,
    pub(crate) friction: L,
}

impl<L: Lane> Contacts<L> {
    #[inline(always)]
    pub(crate) fn none(token: L::Token) -> Self {
        let zero = L::splat(token, L::Scalar::default());
        let contact = Contact {
            point: 0,
            y: [[zero; CHAIN]; 3],
            missing: [zero; 3],
            across: [zero; 2],
            step: zero,
            soft: zero,
            grip: [zero; 3],
            impulse: [zero; 3],
        };
        Self {
            list: [contact; POINTS],
            of_limb: [(0, 0); LIMBS],
            reach: Reach::new(zero),
            friction: zero,
            pairs: Pairs::none(zero),
            zeta: [zero; DEGREES],
        }
    }

    /// How many there are on a limb.
    #[inline(always)]
    fn count(&self, limb: usize) -> usize {
        let (first, end) = self.of_limb[limb];
        end - first
    }

    /// Finds what touches, and how it moves and yields.
    #[inline(always)]
    pub(crate) fn find(
        &mut self,
        touch: &Touch<'_, L>,
        walk: &Walk<L>,
        factor: Factor<'_, L>,
        state: &[L; row::STATE],
        velocity: &[L; DEGREES],
    ) {
        self.friction = touch.friction;
        let mut count = 0;
        for limb in 0..LIMBS {
            let first = count;
            count = if limb < 2 {
                self.find_limb::<BASE, 6>(limb, first, touch, walk, factor, state, velocity)
            } else {
                self.find_limb::<TRUNK, 5>(limb, first, touch, walk, factor, state, velocity)
            };
            self.of_limb[limb] = (first, count);
        }
        self.pairs.find(touch, walk, factor);
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "a part of `find`, split off only for its constants"
    )]
    #[inline(always)]
    fn find_limb<const PREFIX: usize, const COUNT: usize>(
        &mut self,
        limb: usize,
        first: usize,
        touch: &Touch<'_, L>,
        walk: &Walk<L>,
        factor: Factor<'_, L>,
        state: &[L; row::STATE],
        velocity: &[L; DEGREES],
    ) -> usize {
        let place = |axis: usize| state[row::POSITION + axis];
        let root = Vec3::new(place(0), place(1), place(2));
        let base = Vec3::new(velocity[0], velocity[1], velocity[2]);
        let zero = touch.dt.lit(0.0);
        let mut count = first;
        let mut reached = usize::MAX;
        let (begin, end) = touch.tree.of_limb[limb];
        for &point in &touch.tree.order[begin..end] {
            let at = walk.points[point];
            let below = match touch.ground {
                Ground::Plane => None,
                Ground::Heights(heights) => Some(heights.below(root.add(at))),
            };
            let distance = match &below {
                None => root.z + at.z,
                Some(below) => below.distance,
            };
            let body = POINT_TABLE[point].body;
            let spin = walk.velocities[body];
            let falling = match &below {
                None => {
                    let turning = spin.turn.x.mul_add(at.y, spin.shift.z + velocity[2]);
                    spin.turn.y.neg_mul_add(at.x, turning)
                }
                Some(below) => below.frame[0].dot(spin.turn.cross_add(at, spin.shift.add(base))),
            };
            // What reaches the ground within the step touches it already.
            let nearest = falling.min(zero).mul_add(touch.dt, distance);
            let touching = nearest.less(zero);
            if !zero.any(touching) {
                continue;
            }
            if reached != body {
                reached = body;
                let moved = POINT_TABLE[point].chain().1;
                self.reach
                    .fill::<PREFIX, COUNT>(limb, moved, walk, factor, zero);
            }
            let contact = &mut self.list[count];
            count += 1;
            contact.point = point;
            let mut now = spin.turn.cross_add(at, spin.shift.add(base));
            let mut frame = None;
            if let Some(below) = below {
                let [n, s, t] = below.frame;
                now = Vec3::new(s.dot(now), t.dot(now), n.dot(now));
                frame = Some(below.frame);
            }
            let products = self.reach.at(at, frame, &mut contact.y);
            let now = [now.z, now.x, now.y];
            contact.meet(touch, state, touching, distance, now, products);
        }
        count
    }

    /// Keeps the impulses for the next step, and tells the normal ones of each sole.
    #[inline(always)]
    pub(crate) fn keep(&self, zero: L, state: &mut [L; row::STATE]) -> [L; SOLES] {
        // No `fill`: it would be a call, and of code for a machine without wide vectors.
        for impulse in &mut state[row::IMPULSE..] {
            *impulse = zero;
        }
        let mut soles = [zero; SOLES];
        for contact in &self.list[..self.of_limb[LIMBS - 1].1] {
            // As an array: a copy of a slice would be a call.
            let first = row::IMPULSE + 3 * contact.point;
            let rows = state[first..first + 3].as_mut_array();
            *rows.expect("a normal and two tangents") = contact.impulse;
            if contact.point < SOLE_POINTS {
                let foot = contact.point / 4;
                soles[foot] = soles[foot] + contact.impulse[0];
            }
        }
        soles
    }
}

/// Finds the impulses of several groups.
#[inline(always)]
pub(crate) fn solve<L: Lane>(groups: &mut [&mut Contacts<L>], sweeps: usize) {
    for sweep in 0..=sweeps {
        // The first time round only brings in the impulses of the last step.
        let begin = sweep == 0;
        for limb in 0..LIMBS {
            if limb < 2 {
                relax::visit::<L, BASE, 6>(groups, limb, begin);
            } else {
                relax::visit::<L, TRUNK, 5>(groups, limb, begin);
            }
        }
        if !begin {
            relax::visit_pairs(groups);
        }
    }
}

/// The robot's tree, its points weighed; its parts meet each other or pass through each other.
pub(crate) fn tree<T: Real>(self_collision: bool) -> Tree<T> {
    Tree::weighed(weights(&Tree::weightless()), self_collision)
}

/// Velocity per impulse at every point of the robot that stands, mean of the three directions, 1/kg:
/// what softness is a share of, so that it does not depend on the step or on the pose.
fn weights(tree: &Tree<f64>) -> [f64; POINTS] {
    let mut standing = Group::new(());
    standing.load((), &Block::new(), &[Row::default(); JOINTS], None, 0);
    let mut walk = Walk::new(());
    walk.run((), tree, &standing);
    let mut root = [0.0; DEGREES];
    factor::factor(&mut walk.trunk, &mut walk.limbs, &mut root);
    let factor = Factor {
        trunk: &walk.trunk,
        limbs: &walk.limbs,
        root: &root,
    };
    let mut reach = Reach::new(0.0);
    std::array::from_fn(|point| {
        let (limb, moved) = POINT_TABLE[point].chain();
        if limb < 2 {
            reach.fill::<BASE, 6>(limb, moved, &walk, factor, 0.0);
        } else {
            reach.fill::<TRUNK, 5>(limb, moved, &walk, factor, 0.0);
        }
        let mut y = [[0.0; CHAIN]; 3];
        let [normal, _, _, first, _, second] = reach.at(walk.points[point], None, &mut y);
        (normal + first + second) / 3.0
    })
}

impl<L: Lane> Contact<L> {
    /// What the contact wants and how it yields; `now` is the point's velocity along its axes.
    #[inline(always)]
    fn meet(
        &mut self,
        touch: &Touch<'_, L>,
        state: &[L; row::STATE],
        touching: L::Mask,
        distance: L,
        now: [L; 3],
        products: [L; 6],
    ) {
        let (zero, one) = (touch.dt.lit(0.0), touch.dt.lit(1.0));
        let [product, one_way, other_way, first, mixed, second] = products;
        self.across = [one_way, other_way];
        let weight = L::splat(touch.token, touch.tree.weights[self.point]);
        let (wanted, soft) = normal(touch.dt, distance, now[0], weight);
        self.soft = soft;
        self.step = (one / (product + self.soft)).select(touching, zero);
        self.missing = [now[0] - wanted, now[1], now[2]];
        let inverse = one / mixed.neg_mul_add(mixed, first * second);
        let inverse = inverse.select(touching, zero);
        self.grip = [second * inverse, -(mixed * inverse), first * inverse];
        for axis in 0..3 {
            let before = state[row::IMPULSE + 3 * self.point + axis];
            self.impulse[axis] = before.select(touching, zero);
        }
    }
}
