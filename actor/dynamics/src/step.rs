//! One physics step of the robots in a register: forces, solve, contacts, integration.
//!
//! Separate because the order of the parts is the method. Semi-implicit: velocities from forces at
//! the old places, places from the new velocities.

use crate::block::{Block, Row, row};
use crate::contact::{Contacts, Touch};
use crate::drive::{AHEAD, Motors, Torque, stop};
use crate::factor::{self, Factor};
use crate::ground::Ground;
use crate::kinematics::Walk;
use crate::lane::{Lane, Real};
use crate::tree::{BASE, DEGREES, LIMB_FIRST, LIMBS, Tree};
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

/// Sums over the steps of a control step, for sixteen robots.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally<T> {
    /// Positive work of the motors, J.
    pub(crate) work: Row<T>,
    /// Normal impulses on the soles, left and right, N·s.
    pub(crate) soles: [Row<T>; 2],
    /// Greatest torque of every joint without sign, N·m.
    pub(crate) torques: [Row<T>; JOINTS],
    /// Greatest speed of every joint without sign, rad/s.
    pub(crate) speeds: [Row<T>; JOINTS],
}

/// Room for the intermediate results of a step.
pub(crate) struct Room<L: Lane> {
    walk: Walk<L>,
    root: [L; DEGREES],
    contacts: Contacts<L>,
    torques: [Torque<L>; JOINTS],
}

impl<L: Lane> Room<L> {
    #[inline(always)]
    pub(crate) fn new(token: L::Token) -> Self {
        let zero = L::splat(token, L::Scalar::default());
        let torque = Torque {
            constant: zero,
            damping: zero,
        };
        Self {
            walk: Walk::new(token),
            root: [zero; DEGREES],
            contacts: Contacts::none(token),
            torques: [torque; JOINTS],
        }
    }
}

/// Advances the robots of a block from `lane` on by one physics step. Targets are rows of 23.
#[inline(always)]
pub(crate) fn step<L: Lane>(
    token: L::Token,
    setting: &Setting<'_, L::Scalar>,
    targets: &[Row<L::Scalar>],
    lane: usize,
    block: &mut Block<L::Scalar>,
    tally: &mut Tally<L::Scalar>,
    room: &mut Room<L>,
) {
    let dt = L::splat(token, setting.dt);
    let walk = &mut room.walk;
    walk.run(token, setting.tree, block, lane);

    let state = block.rows();
    let mut velocity = [dt; DEGREES];
    for (i, velocity) in velocity.iter_mut().enumerate() {
        let at = if i < BASE {
            row::LINEAR + i
        } else {
            row::SPEED + i - BASE
        };
        *velocity = state[at].get(token, lane);
    }
    // dt·force on every degree, then half-way to a velocity.
    let mut x = [dt; DEGREES];
    for i in 0..BASE {
        x[i] = -(dt * walk.bias[i]);
    }
    let (zero, ahead) = (dt.lit(0.0), dt * dt.lit(AHEAD));
    let torques = &mut room.torques;
    for joint in 0..JOINTS {
        let q: L = state[row::JOINT + joint].get(token, lane);
        let speed = velocity[BASE + joint];
        let number = |x: L::Scalar| L::splat(token, x);
        let torque = Torque::of_motor(
            number(setting.motors.stiffness[joint]),
            number(setting.motors.damping[joint]),
            number(setting.motors.effort[joint]),
            targets[joint].get(token, lane),
            q,
            speed,
            ahead,
        );
        torques[joint] = torque;
        let diagonal = diagonal(walk, joint);
        let hinge = &setting.tree.hinges[joint];
        let (resistance, push) = stop(
            number(hinge.lower),
            number(hinge.upper),
            q,
            speed,
            *diagonal,
            dt,
        );
        // A brake within the joint, for a speed that is cut off would take momentum from the robot.
        let racing = number(Real::of(SPEED_LIMIT)).less(speed.abs());
        let brake = diagonal.select(racing, zero);
        let (resistance, push) = (resistance + brake, brake.neg_mul_add(speed, push));
        *diagonal = torque.damping.mul_add(dt, *diagonal) + resistance;
        let force = torque.at(speed) - walk.bias[BASE + joint];
        x[BASE + joint] = force.mul_add(dt, push);
    }
    factor::factor(&mut walk.trunk, &mut walk.limbs, &mut room.root);
    let walk = &room.walk;
    let factor = Factor {
        trunk: &walk.trunk,
        limbs: &walk.limbs,
        root: &room.root,
    };
    factor.half(&mut x);

    let touch = Touch {
        token,
        lane,
        tree: setting.tree,
        ground: setting.ground,
        dt,
        friction: block.friction.get(token, lane),
    };
    let contacts = &mut room.contacts;
    contacts.find(&touch, walk, factor, block, &velocity);
    contacts.solve(touch.friction, setting.sweeps, &mut x);
    let soles = contacts.keep(&touch, block);
    for (sum, impulse) in tally.soles.iter_mut().zip(soles) {
        let before: L = sum.get(token, lane);
        sum.set(lane, before + impulse);
    }

    factor.velocity(&mut x);
    let mut power = zero;
    for i in 0..DEGREES {
        velocity[i] = velocity[i] + x[i];
    }
    for joint in 0..JOINTS {
        let speed = velocity[BASE + joint];
        let torque = torques[joint].at(speed);
        power = power + (torque * speed).max(zero);
        for (peak, now) in [
            (&mut tally.torques[joint], torque),
            (&mut tally.speeds[joint], speed),
        ] {
            let before: L = peak.get(token, lane);
            peak.set(lane, before.max(now.abs()));
        }
    }
    let before: L = tally.work.get(token, lane);
    tally.work.set(lane, power.mul_add(dt, before));
    integrate(token, lane, dt, &velocity, block);
}

/// The diagonal entry of a joint in the mass matrix.
#[inline(always)]
fn diagonal<L: Lane>(walk: &mut Walk<L>, joint: usize) -> &mut L {
    if joint == joints::WAIST {
        return &mut walk.trunk[BASE][BASE];
    }
    let limb = (0..LIMBS)
        .rev()
        .find(|&limb| LIMB_FIRST[limb] <= joint)
        .unwrap_or(0);
    let (prefix, _) = factor::limb_shape(limb);
    let k = joint - LIMB_FIRST[limb];
    &mut walk.limbs[limb][k][prefix + k]
}

/// Places from new velocities; the base turns by the exponential map.
#[inline(always)]
fn integrate<L: Lane>(
    token: L::Token,
    lane: usize,
    dt: L,
    velocity: &[L; DEGREES],
    block: &mut Block<L::Scalar>,
) {
    let state = block.rows_mut();
    for (i, &velocity) in velocity.iter().enumerate() {
        let (place, rate) = match i {
            0..3 => (Some(row::POSITION + i), row::LINEAR + i),
            3..BASE => (None, row::LINEAR + i),
            _ => (Some(row::JOINT + i - BASE), row::SPEED + i - BASE),
        };
        state[rate].set(lane, velocity);
        if let Some(place) = place {
            let before: L = state[place].get(token, lane);
            state[place].set(lane, velocity.mul_add(dt, before));
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
    let get = |i: usize| -> L { state[row::QUATERNION + i].get(token, lane) };
    let (w, i, j, k) = (get(0), get(1), get(2), get(3));
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
        state[row::QUATERNION + at].set(lane, value * scale);
    }
}
