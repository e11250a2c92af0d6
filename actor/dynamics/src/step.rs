//! One physics step of the robots in a register: forces, solve, contacts, integration.
//!
//! Separate because the order of the parts is the method. Semi-implicit: velocities from forces at
//! the old places, places from the new velocities.

use crate::block::row;
use crate::condition::Own;
use crate::contact::{self, Contacts, Touch};
use crate::drive::{AHEAD, Motors, Torque, stop};
use crate::factor::{self, Factor};
use crate::ground::Ground;
use crate::group::Group;
use crate::kinematics::Walk;
use crate::lane::{Lane, Real};
use crate::spatial::{Spatial, Vec3};
use crate::tree::{BASE, DEGREES, LIMB_FIRST, Tree};
use g1::{JOINTS, joints};

/// Joint speed from which the joint brakes itself, rad/s: beyond it nothing is physical any more.
const SPEED_LIMIT: f64 = 50.0;

/// What a step is made with.
pub(crate) struct Setting<'a, T> {
    pub(crate) tree: &'a Tree<T>,
    pub(crate) ground: &'a Ground,
    pub(crate) motors: &'a Motors<T>,
    /// s.
    pub(crate) dt: T,
    pub(crate) sweeps: usize,
}

/// A group and room for the intermediate results of its step.
pub(crate) struct Crew<L: Lane> {
    pub(crate) group: Group<L>,
    walk: Walk<L>,
    root: [L; DEGREES],
    torques: [Torque<L>; JOINTS],
    velocity: [L; DEGREES],
}

/// Advances groups by one physics step, each with its contacts.
///
/// All of them do a part of it before any does the next: the impulses of one group wait for each other,
/// and those of the others fill the time.
#[inline(always)]
pub(crate) fn step<L: Lane>(
    token: L::Token,
    setting: &Setting<'_, L::Scalar>,
    crews: &mut [&mut Crew<L>],
    contacts: &mut [&mut Contacts<L>],
) {
    for crew in &mut *crews {
        crew.walk.run(token, setting.tree, &crew.group);
    }
    for (crew, contacts) in crews.iter_mut().zip(&mut *contacts) {
        // Twice written out, so that robots without conditions do not read one.
        if crew.group.conditioned {
            crew.drive::<true>(token, setting, contacts);
        } else {
            crew.drive::<false>(token, setting, contacts);
        }
    }
    for (crew, contacts) in crews.iter().zip(&mut *contacts) {
        crew.touch(token, setting, contacts);
    }
    contact::solve(contacts, setting.sweeps);
    for (crew, contacts) in crews.iter_mut().zip(contacts) {
        crew.finish(token, setting, contacts);
    }
}

impl<L: Lane> Crew<L> {
    #[inline(always)]
    pub(crate) fn new(token: L::Token) -> Self {
        let zero = L::splat(token, L::Scalar::default());
        let torque = Torque {
            constant: zero,
            damping: zero,
        };
        Self {
            group: Group::new(token),
            walk: Walk::new(token),
            root: [zero; DEGREES],
            torques: [torque; JOINTS],
            velocity: [zero; DEGREES],
        }
    }

    /// The mass matrix after [`factor::factor`].
    #[inline(always)]
    fn factor(&self) -> Factor<'_, L> {
        Factor {
            trunk: &self.walk.trunk,
            limbs: &self.walk.limbs,
            root: &self.root,
        }
    }

    /// Motors and stops, the factored matrix, and what all forces but contacts do half-way.
    #[inline(always)]
    fn drive<const CONDITIONED: bool>(
        &mut self,
        token: L::Token,
        setting: &Setting<'_, L::Scalar>,
        contacts: &mut Contacts<L>,
    ) {
        let dt = L::splat(token, setting.dt);
        // dt·force on every degree, then half-way to a velocity.
        let x = &mut contacts.zeta;
        let (state, walk) = (&self.group.state, &mut self.walk);
        for (i, velocity) in self.velocity.iter_mut().enumerate() {
            let at = if i < BASE {
                row::LINEAR + i
            } else {
                row::SPEED + i - BASE
            };
            *velocity = state[at];
        }
        for i in 0..BASE {
            x[i] = -(dt * walk.bias[i]);
        }
        let mut twist = None;
        if CONDITIONED {
            let [along_x, along_y, along_z] = self.group.own.force;
            let shift = Vec3::new(along_x, along_y, along_z);
            let turn = walk.torso_centre(&self.group).cross(shift);
            let parts = [shift.x, shift.y, shift.z, turn.x, turn.y, turn.z];
            for (x, part) in x.iter_mut().zip(parts) {
                *x = part.mul_add(dt, *x);
            }
            twist = Some(walk.motions[joints::WAIST].dot(Spatial { turn, shift }));
        }
        let mut motor = |joint: usize, diagonal: &mut L| {
            let drive = Drive {
                own: CONDITIONED.then_some(&self.group.own),
                token,
                setting,
                dt,
                joint,
            };
            let (q, speed) = (state[row::JOINT + joint], self.velocity[BASE + joint]);
            let (torque, push) = drive.act(self.group.targets[joint], q, speed, diagonal);
            self.torques[joint] = torque;
            let force = torque.at(speed) - walk.bias[BASE + joint];
            x[BASE + joint] = force.mul_add(dt, push);
        };
        motor(joints::WAIST, &mut walk.trunk[BASE][BASE]);
        for (limb, rows) in walk.limbs.iter_mut().enumerate() {
            let (prefix, count) = factor::limb_shape(limb);
            for (k, row) in rows.iter_mut().take(count).enumerate() {
                motor(LIMB_FIRST[limb] + k, &mut row[prefix + k]);
            }
        }
        if let Some(twist) = twist {
            let waist = &mut x[BASE + joints::WAIST];
            *waist = twist.mul_add(dt, *waist);
        }
        factor::factor(&mut walk.trunk, &mut walk.limbs, &mut self.root);
        self.factor().half(x);
    }

    /// The contacts.
    #[inline(always)]
    fn touch(&self, token: L::Token, setting: &Setting<'_, L::Scalar>, contacts: &mut Contacts<L>) {
        let touch = Touch {
            token,
            tree: setting.tree,
            ground: setting.ground,
            dt: L::splat(token, setting.dt),
            friction: self.group.friction,
        };
        let state = &self.group.state;
        contacts.find(&touch, &self.walk, self.factor(), state, &self.velocity);
    }

    /// Impulses, velocities and places after the step, and the sums over steps.
    #[inline(always)]
    fn finish(
        &mut self,
        token: L::Token,
        setting: &Setting<'_, L::Scalar>,
        contacts: &mut Contacts<L>,
    ) {
        let dt = L::splat(token, setting.dt);
        let zero = dt.lit(0.0);
        self.factor().velocity(&mut contacts.zeta);
        let soles = contacts.keep(zero, &mut self.group.state);
        let sums = &mut self.group.sums;
        for (sum, impulse) in sums.soles.iter_mut().zip(soles) {
            *sum = *sum + impulse;
        }
        let mut power = zero;
        let velocity = &mut self.velocity;
        for i in 0..DEGREES {
            velocity[i] = velocity[i] + contacts.zeta[i];
        }
        for joint in 0..JOINTS {
            let speed = velocity[BASE + joint];
            let torque = self.torques[joint].at(speed);
            power = power + (torque * speed).max(zero);
            sums.torques[joint] = sums.torques[joint].max(torque.abs());
            sums.speeds[joint] = sums.speeds[joint].max(speed.abs());
        }
        sums.work = power.mul_add(dt, sums.work);
        integrate(dt, velocity, &mut self.group.state);
    }
}

/// What acts in one joint.
struct Drive<'a, L: Lane> {
    /// The robots' conditions, where they have any.
    own: Option<&'a Own<L>>,
    token: L::Token,
    setting: &'a Setting<'a, L::Scalar>,
    dt: L,
    joint: usize,
}

impl<L: Lane> Drive<'_, L> {
    /// Torque of the motor at a joint's place and speed, and the stop's part of dt·force; what both add to
    /// the diagonal of the mass matrix is added there.
    #[inline(always)]
    fn act(&self, target: L, q: L, speed: L, diagonal: &mut L) -> (Torque<L>, L) {
        let number = |x: L::Scalar| L::splat(self.token, x);
        let (motors, hinge) = (self.setting.motors, &self.setting.tree.hinges[self.joint]);
        let (dt, zero) = (self.dt, self.dt.lit(0.0));
        let (stiffness, damping, effort, frictions) = match self.own {
            None => (
                number(motors.stiffness[self.joint]),
                number(motors.damping[self.joint]),
                number(motors.effort[self.joint]),
                None,
            ),
            Some(own) => {
                let (stiffness, damping) = (own.stiffness[self.joint], own.damping[self.joint]);
                let asked = damping.neg_mul_add(speed, stiffness * (target - q));
                (
                    stiffness,
                    damping,
                    own.limit(self.joint, asked, speed),
                    Some(own.resistance(self.joint, speed)),
                )
            }
        };
        let torque = Torque::of_motor(
            stiffness,
            damping,
            effort,
            target,
            q,
            speed,
            dt * dt.lit(AHEAD),
        );
        let (lower, upper) = (number(hinge.lower), number(hinge.upper));
        let (resistance, push) = stop(lower, upper, q, speed, *diagonal, dt);
        // A brake within the joint, for a speed that is cut off would take momentum from the robot.
        let racing = number(Real::of(SPEED_LIMIT)).less(speed.abs());
        let brake = diagonal.select(racing, zero);
        let push = brake.neg_mul_add(speed, push);
        // The joint's own frictions: what they take is no work of the motor.
        let (damping, push) = match frictions {
            None => (torque.damping, push),
            Some(frictions) => (
                torque.damping + frictions,
                (frictions * dt).neg_mul_add(speed, push),
            ),
        };
        *diagonal = damping.mul_add(dt, *diagonal) + (resistance + brake);
        (torque, push)
    }
}

/// Places from new velocities; the base turns by the exponential map.
#[inline(always)]
fn integrate<L: Lane>(dt: L, velocity: &[L; DEGREES], state: &mut [L; row::STATE]) {
    for (i, &velocity) in velocity.iter().enumerate() {
        let (place, rate) = match i {
            0..3 => (Some(row::POSITION + i), row::LINEAR + i),
            3..BASE => (None, row::LINEAR + i),
            _ => (Some(row::JOINT + i - BASE), row::SPEED + i - BASE),
        };
        state[rate] = velocity;
        if let Some(place) = place {
            state[place] = velocity.mul_add(dt, state[place]);
        }
    }
    let half = dt * dt.lit(0.5);
    let [a, b, c] = [velocity[3] * half, velocity[4] * half, velocity[5] * half];
    // sin(θ)/θ and cos θ of half the angle by their series: at 50 rad/s θ is 0.125.
    let square = a.mul_add(a, b.mul_add(b, c * c));
    let one = dt.lit(1.0);
    let sinc = square
        .mul_add(dt.lit(-1.0 / 5040.0), dt.lit(1.0 / 120.0))
        .mul_add(square, dt.lit(-1.0 / 6.0))
        .mul_add(square, one);
    let cos = square
        .mul_add(dt.lit(-1.0 / 720.0), dt.lit(1.0 / 24.0))
        .mul_add(square, dt.lit(-0.5))
        .mul_add(square, one);
    let (a, b, c) = (a * sinc, b * sinc, c * sinc);
    let q = row::QUATERNION;
    let (w, i, j, k) = (state[q], state[q + 1], state[q + 2], state[q + 3]);
    let turned = [
        k.neg_mul_add(c, j.neg_mul_add(b, i.neg_mul_add(a, w * cos))),
        j.neg_mul_add(c, k.mul_add(b, w.mul_add(a, i * cos))),
        k.neg_mul_add(a, i.mul_add(c, w.mul_add(b, j * cos))),
        i.neg_mul_add(b, j.mul_add(a, w.mul_add(c, k * cos))),
    ];
    let [w, i, j, k] = turned;
    let norm = w.mul_add(w, i.mul_add(i, j.mul_add(j, k * k)));
    let scale = one / norm.sqrt();
    for (at, value) in turned.into_iter().enumerate() {
        state[q + at] = value * scale;
    }
}
