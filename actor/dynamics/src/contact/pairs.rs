//! Contacts of the robot with itself: capsules of limbs and trunk that meet.
//!
//! Separate because two chains feel such a contact, and the base does not: what one part is pushed the other is pushed
//! back. Along the normal it is as soft as the ground; across it there is nothing, for the shells slide. Pairs that are
//! apart in every lane are passed over, and they are nearly all of them nearly always: this keeps the whole to a few
//! hundredths of a step. A plane across the pelvis' left–right axis tells it of legs and arms beside each other, the
//! middle of one part of a forearm and the thigh below it.

use super::Touch;
use super::normal::normal;
use crate::capsules::Pair;
use crate::factor::Factor;
use crate::kinematics::Walk;
use crate::lane::Lane;
use crate::spatial::Vec3;
use crate::tree::{BASE, DEGREES, Tree};
use g1::LINK_TABLE;
use g1::collision::{CAPSULE_TABLE, CAPSULES, PAIR_TABLE, PAIRS};

/// Share of the middle of a segment in its nearest point, where two are parallel and all points are as near: the
/// nearest point of two that nearly are must not jump from end to end.
const CENTRING: f64 = 1e-4;
/// Square of the distance of segments below which they cross, m²: the normal is the pelvis' left then.
const CROSSING: f64 = 1e-10;

/// Two capsules that meet in some lane.
#[derive(Clone, Copy)]
struct Meeting<L> {
    /// ζ of a unit impulse along the normal on the first, and against it on the second.
    y: [L; DEGREES],
    /// What is missing to the wanted velocity before any impulse, m/s.
    missing: L,
    /// Impulse per missing velocity, kg; 0 in lanes without contact.
    step: L,
    /// 1/kg.
    soft: L,
    /// N·s.
    impulse: L,
}

/// All that meet in a step.
///
/// Impulses begin at nothing: there are few, and a sweep finds that of a single one. So they are no part of the state.
pub(super) struct Pairs<L> {
    list: [Meeting<L>; PAIRS],
    count: usize,
}

/// Where two capsules are nearest to each other.
pub(super) struct Nearest<L> {
    /// Distance of the surfaces, m; negative where they overlap.
    pub(super) distance: L,
    /// From the second to the first.
    pub(super) normal: Vec3<L>,
    /// Half-way between the surfaces, from the root point, m.
    pub(super) at: Vec3<L>,
}

impl<L: Lane> Pairs<L> {
    #[inline(always)]
    pub(super) fn none(zero: L) -> Self {
        let meeting = Meeting {
            y: [zero; DEGREES],
            missing: zero,
            step: zero,
            soft: zero,
            impulse: zero,
        };
        Self {
            list: [meeting; PAIRS],
            count: 0,
        }
    }

    /// Finds the pairs that touch within the step.
    #[inline(always)]
    pub(super) fn find(&mut self, touch: &Touch<'_, L>, walk: &Walk<L>, factor: Factor<'_, L>) {
        self.count = 0;
        if !touch.tree.collides {
            return;
        }
        let reach = across(touch, walk);
        for (pair, &[a, b]) in PAIR_TABLE.iter().enumerate() {
            let near = reach[a].0.less(reach[b].1);
            if !touch.dt.any(near) {
                continue;
            }
            let near = touch.dt.both(near, beside(touch, walk, pair));
            if touch.dt.any(near) {
                self.meet(touch, walk, factor, pair, near);
            }
        }
    }

    /// Takes a pair on if it touches in a lane in which it is `near`.
    #[inline(always)]
    fn meet(
        &mut self,
        touch: &Touch<'_, L>,
        walk: &Walk<L>,
        factor: Factor<'_, L>,
        pair: usize,
        near: L::Mask,
    ) {
        let (dt, zero) = (touch.dt, touch.dt.lit(0.0));
        let Nearest {
            distance,
            normal: n,
            at,
        } = nearest(touch.token, touch.tree, walk, pair);
        let [first, second] = PAIR_TABLE[pair].map(|capsule| CAPSULE_TABLE[capsule].body);
        let velocity = |body: usize| {
            let spin = &walk.velocities[body];
            n.dot(spin.turn.cross_add(at, spin.shift))
        };
        let now = velocity(first) - velocity(second);
        // What meets within the step touches already. A lane that is not near does not, whatever its
        // neighbours do.
        let within = now.min(zero).mul_add(dt, distance).less(zero);
        let touching = dt.both(near, within);
        if !dt.any(touching) {
            return;
        }
        let meeting = &mut self.list[self.count];
        self.count += 1;
        let moment = at.cross(n);
        meeting.y = [zero; DEGREES];
        for (body, sign) in [(first, zero.lit(1.0)), (second, zero.lit(-1.0))] {
            let mut link = body;
            while let Some(parent) = LINK_TABLE[link].parent {
                let (degree, motion) = (BASE + link - 1, &walk.motions[link - 1]);
                let push = motion.turn.dot(moment) + motion.shift.dot(n);
                meeting.y[degree] = push.mul_add(sign, meeting.y[degree]);
                link = parent;
            }
        }
        factor.half(&mut meeting.y);
        let yields = dot(&meeting.y, &meeting.y);
        let (wanted, soft) = normal(dt, distance, now, yields);
        meeting.soft = soft;
        meeting.step = (zero.lit(1.0) / (yields + soft)).select(touching, zero);
        meeting.missing = now - wanted;
        meeting.impulse = zero;
    }

    /// How many there are.
    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// One visit to one of them.
    #[inline(always)]
    pub(super) fn relax(&mut self, i: usize, zeta: &mut [L; DEGREES]) {
        let Some(meeting) = self.list[..self.count].get_mut(i) else {
            return;
        };
        let velocity = meeting.missing + dot(&meeting.y, zeta);
        let resisted = meeting.soft.mul_add(meeting.impulse, velocity);
        let impulse = resisted.neg_mul_add(meeting.step, meeting.impulse);
        let impulse = impulse.max(velocity.lit(0.0));
        let more = impulse - meeting.impulse;
        for (zeta, y) in zeta.iter_mut().zip(&meeting.y) {
            *zeta = y.mul_add(more, *zeta);
        }
        meeting.impulse = impulse;
    }
}

/// Of every capsule along the pelvis' left: where it begins, and where the margin around it ends, m.
#[inline(always)]
fn across<L: Lane>(touch: &Touch<'_, L>, walk: &Walk<L>) -> [(L, L); CAPSULES] {
    let mut reach = [(touch.dt, touch.dt); CAPSULES];
    for capsule in 0..CAPSULES {
        let [from, to] = &walk.capsules[capsule];
        let (from, to) = (from.dot(walk.left), to.dot(walk.left));
        let capsules = &touch.tree.capsules;
        reach[capsule] = (
            from.min(to) - L::splat(touch.token, capsules.radii[capsule]),
            from.max(to) + L::splat(touch.token, capsules.reaches[capsule]),
        );
    }
    reach
}

/// Lanes in which the middle of a pair's shorter segment is so near to the longer one that they might touch.
#[inline(always)]
fn beside<L: Lane>(touch: &Touch<'_, L>, walk: &Walk<L>, pair: usize) -> L::Mask {
    let number = |x: L::Scalar| L::splat(touch.token, x);
    let Pair {
        long,
        short,
        inverse,
        apart,
    } = touch.tree.capsules.pairs[pair];
    let ([from, to], [p, q]) = (&walk.capsules[long], &walk.capsules[short]);
    let (zero, one) = (touch.dt.lit(0.0), touch.dt.lit(1.0));
    let middle = p.add(*q).scale(touch.dt.lit(0.5));
    let (along, off) = (to.sub(*from), middle.sub(*from));
    let share = (along.dot(off) * number(inverse)).max(zero).min(one);
    let off = along.scale_add(-share, off);
    off.dot(off).less(number(apart))
}

/// Nearest points of two segments (Ericson, *Real-Time Collision Detection*, 2005, section 5.1.9), of all lanes without
/// a branch: of the lines, then each within its segment for the other.
#[inline(always)]
pub(super) fn nearest<L: Lane>(
    token: L::Token,
    tree: &Tree<L::Scalar>,
    walk: &Walk<L>,
    pair: usize,
) -> Nearest<L> {
    let [a, b] = PAIR_TABLE[pair];
    let ([p, p_end], [q, q_end]) = (walk.capsules[a], walk.capsules[b]);
    let (u, v, r) = (p_end.sub(p), q_end.sub(q), p.sub(q));
    let [uu, vv] = [a, b].map(|capsule| L::splat(token, tree.capsules.squares[capsule]));
    let (uv, ur, vr) = (u.dot(v), u.dot(r), v.dot(r));
    let (zero, one) = (uu.lit(0.0), uu.lit(1.0));
    let within = |share: L| share.max(zero).min(one);
    let both = uu * vv;
    let centring = both * both.lit(CENTRING);
    let turned = uv.neg_mul_add(uv, both) + centring;
    let ahead = uv.mul_add(vr, ur.neg_mul_add(vv, centring * centring.lit(0.5)));
    let s = within(ahead / turned);
    let t = within(uv.mul_add(s, vr) / vv);
    let s = within((uv * t - ur) / uu);
    let end = v.scale_add(t, q);
    let apart = u.scale_add(s, p).sub(end);
    let square = apart.dot(apart);
    let crosses = square.less(square.lit(CROSSING));
    let away = one / square.max(square.lit(CROSSING)).sqrt();
    let left = walk.left;
    let normal = Vec3::new(
        left.x.select(crosses, apart.x * away),
        left.y.select(crosses, apart.y * away),
        left.z.select(crosses, apart.z * away),
    );
    let radii = [a, b].map(|capsule| CAPSULE_TABLE[capsule].radius);
    let distance = square.sqrt() - square.lit(radii[0] + radii[1]);
    let half = distance.mul_add(distance.lit(0.5), distance.lit(radii[1]));
    Nearest {
        distance,
        normal,
        at: normal.scale_add(half, end),
    }
}

/// Four sums, for one would wait for itself.
#[inline(always)]
fn dot<L: Lane>(a: &[L; DEGREES], b: &[L; DEGREES]) -> L {
    let mut sums = [a[0].lit(0.0); 4];
    for i in 0..DEGREES {
        sums[i % 4] = a[i].mul_add(b[i], sums[i % 4]);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

#[cfg(test)]
mod tests;
