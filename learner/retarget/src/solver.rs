//! Joints for targets: damped least squares within joint limits and joint-speed limits.
//!
//! Separate because it is the one solver here. The limbs hang on the pelvis and the torso one by one,
//! so each is a small system of its own: (Σ w JᵀJ + λI) Δq = Σ w Jᵀe, solved again with a joint held
//! at its bound whenever the step would leave it.

use crate::RATE;
use crate::targets::Target;
use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG, WAIST};
use g1::kinematics::forward;
use g1::{BODIES, DEFAULT_POSE, JOINT_TABLE, JOINTS};
use nalgebra::{Isometry3, SMatrix, SVector, Vector3};

/// Bodies between whose origins the bones run, counted from the first body of the limb: thigh and
/// shin of a leg, upper arm and forearm of an arm.
const LEG_BONES: [(usize, usize); 2] = [(1, 3), (3, 4)];
const ARM_BONES: [(usize, usize); 2] = [(1, 3), (3, 4)];
const LEGS: [usize; 2] = [LEFT_LEG, RIGHT_LEG];
const ARMS: [usize; 2] = [LEFT_ARM, RIGHT_ARM];
/// The foot is the sixth body of a leg.
const FOOT: usize = 5;

/// Weights of squared residuals: directions and turns in rad, places in m.
const BONE: f64 = 2.0;
const FOOT_TURN: f64 = 0.5;
/// A millimetre of a planned foot weighs as much as six degrees of a bone.
const PLANNED_PLACE: f64 = 2e4;
const PLANNED_TURN: f64 = 20.0;
const PLANNED_BONE: f64 = 0.05;
/// Toward the default pose: decides what directions leave open (a straight arm's twist).
const POSTURE: f64 = 2e-3;
/// Toward the frame before.
const CHANGE: f64 = 5e-3;

/// Distance that is kept from a joint's limit, rad: `f32` rounds.
const MARGIN: f64 = 1e-4;
/// Share of a motor's top speed that is used.
const SPEED_SHARE: f64 = 0.95;
/// Steps after which a frame is taken as it is, and the change (rad) below which it is done.
const STEPS: usize = 15;
const FIRST_STEPS: usize = 200;
const DONE: f64 = 1e-5;

/// Where the feet must be, if that is known yet.
pub type PlannedFeet = Option<[Isometry3<f64>; 2]>;

/// The joint positions of a frame, rad, and which of them a bound holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    /// Joint positions, rad.
    pub joints: [f64; JOINTS],
    /// Held by the joint's position limit.
    pub at_limit: [bool; JOINTS],
    /// Held by the motor's speed limit.
    pub at_speed: [bool; JOINTS],
}

/// Solves a frame whose pelvis is at `base`, from the joints of the frame before.
pub fn solve(
    target: &Target,
    base: &Isometry3<f64>,
    feet: PlannedFeet,
    before: Option<&[f64; JOINTS]>,
    guess: &[f64; JOINTS],
) -> Solved {
    let bounds = Bounds::of(before);
    let start = before.unwrap_or(guess);
    let mut q = *guess;
    q[WAIST] = target.waist;
    bounds.clamp(&mut q);
    let steps = if before.is_some() { STEPS } else { FIRST_STEPS };
    for _ in 0..steps {
        let bodies = forward(base, &q);
        let mut change: f64 = 0.0;
        for side in 0..2 {
            let mut leg = Limb::<6>::new(LEGS[side], &bodies);
            match &feet {
                Some(feet) => leg.reach(&bodies, &target.bones[side], &feet[side]),
                None => leg.swing(&bodies, &target.bones[side], &target.feet[side]),
            }
            change = change.max(leg.step(&mut q, start, &bounds));
            // What the feet must do changes nothing for the arms.
            let mut arm = Limb::<5>::new(ARMS[side], &bodies);
            for (bone, (from, to)) in target.bones[side][2..].iter().zip(ARM_BONES) {
                arm.point(&bodies, (from, to), bone, BONE);
            }
            change = change.max(arm.step(&mut q, start, &bounds));
        }
        if change < DONE {
            break;
        }
    }
    bounds.judged(q)
}

/// Directions of thigh, shin, upper arm and forearm as the robot has them, by side.
pub fn bones(bodies: &[Isometry3<f64>; BODIES]) -> [[Vector3<f64>; 4]; 2] {
    std::array::from_fn(|side| {
        let bone = |first: usize, (from, to): (usize, usize)| {
            let [a, b] = [from, to].map(|k| bodies[first + 1 + k].translation.vector);
            (b - a).normalize()
        };
        [
            bone(LEGS[side], LEG_BONES[0]),
            bone(LEGS[side], LEG_BONES[1]),
            bone(ARMS[side], ARM_BONES[0]),
            bone(ARMS[side], ARM_BONES[1]),
        ]
    })
}

/// How far each joint may go in this frame.
struct Bounds {
    lower: [f64; JOINTS],
    upper: [f64; JOINTS],
}

impl Bounds {
    fn of(before: Option<&[f64; JOINTS]>) -> Self {
        let mut bounds = Self {
            lower: JOINT_TABLE.map(|joint| joint.lower + MARGIN),
            upper: JOINT_TABLE.map(|joint| joint.upper - MARGIN),
        };
        if let Some(before) = before {
            for (i, joint) in JOINT_TABLE.iter().enumerate() {
                let reach = SPEED_SHARE * joint.velocity_limit / RATE;
                bounds.lower[i] = bounds.lower[i].max(before[i] - reach);
                bounds.upper[i] = bounds.upper[i].min(before[i] + reach);
            }
        }
        bounds
    }

    fn clamp(&self, q: &mut [f64; JOINTS]) {
        for (i, q) in q.iter_mut().enumerate() {
            *q = q.clamp(self.lower[i], self.upper[i]);
        }
    }

    fn judged(&self, joints: [f64; JOINTS]) -> Solved {
        let held = |i: usize| joints[i] <= self.lower[i] || joints[i] >= self.upper[i];
        let limit = |i: usize| {
            let joint = &JOINT_TABLE[i];
            joints[i] <= joint.lower + MARGIN || joints[i] >= joint.upper - MARGIN
        };
        Solved {
            joints,
            at_limit: std::array::from_fn(limit),
            at_speed: std::array::from_fn(|i| held(i) && !limit(i)),
        }
    }
}

/// The normal equations of a limb of `N` joints in a row.
struct Limb<const N: usize> {
    first: usize,
    axes: [Vector3<f64>; N],
    origins: [Vector3<f64>; N],
    normal: SMatrix<f64, N, N>,
    right: SVector<f64, N>,
}

impl<const N: usize> Limb<N> {
    fn new(first: usize, bodies: &[Isometry3<f64>; BODIES]) -> Self {
        // Joint i moves body i + 1 and its axis is fixed to that body too.
        let body = |k: usize| &bodies[first + 1 + k];
        Self {
            first,
            axes: std::array::from_fn(|k| {
                body(k).rotation * Vector3::from(JOINT_TABLE[first + k].axis)
            }),
            origins: std::array::from_fn(|k| body(k).translation.vector),
            normal: SMatrix::zeros(),
            right: SVector::zeros(),
        }
    }

    /// How the origin of the limb's `body` moves with its joints.
    fn jacobian(&self, body: usize) -> SMatrix<f64, 3, N> {
        SMatrix::from_fn(|row, k| {
            if k <= body {
                self.axes[k].cross(&(self.origins[body] - self.origins[k]))[row]
            } else {
                0.0
            }
        })
    }

    fn add(&mut self, jacobian: &SMatrix<f64, 3, N>, error: &Vector3<f64>, weight: f64) {
        self.normal += jacobian.transpose() * jacobian * weight;
        self.right += jacobian.transpose() * error * weight;
    }

    /// A bone between the origins of two bodies shall point in a direction.
    fn point(
        &mut self,
        bodies: &[Isometry3<f64>; BODIES],
        (from, to): (usize, usize),
        direction: &Vector3<f64>,
        weight: f64,
    ) {
        let [a, b] = [from, to].map(|k| bodies[self.first + 1 + k].translation.vector);
        let length = (b - a).norm();
        let now = (b - a) / length;
        let moves = (self.jacobian(to) - self.jacobian(from)) / length;
        // Only what turns the bone: its length is not to be changed.
        let across = moves - now * (now.transpose() * moves);
        self.add(&across, &(direction - now), weight);
    }

    /// The end of the limb shall turn to an orientation.
    fn turn(
        &mut self,
        bodies: &[Isometry3<f64>; BODIES],
        to: &nalgebra::UnitQuaternion<f64>,
        weight: f64,
    ) {
        let now = bodies[self.first + N].rotation;
        let jacobian = SMatrix::from_fn(|row, k| self.axes[k][row]);
        self.add(&jacobian, &(to * now.inverse()).scaled_axis(), weight);
    }

    /// Bounded Δq, applied; returns the largest change, rad.
    fn step(&mut self, q: &mut [f64; JOINTS], start: &[f64; JOINTS], bounds: &Bounds) -> f64 {
        const LARGEST: f64 = 0.4;
        const DAMPING: f64 = 1e-6;
        for k in 0..N {
            let i = self.first + k;
            self.normal[(k, k)] += POSTURE + CHANGE + DAMPING;
            self.right[k] +=
                POSTURE * (f64::from(DEFAULT_POSE[i]) - q[i]) + CHANGE * (start[i] - q[i]);
        }
        let mut held: [Option<f64>; N] = [None; N];
        let mut step = SVector::<f64, N>::zeros();
        // Each round holds at least one more joint, so N + 1 are enough.
        for _ in 0..=N {
            step = self.solve_holding(&held);
            let mut more = false;
            for k in 0..N {
                let i = self.first + k;
                let (low, high) = (bounds.lower[i] - q[i], bounds.upper[i] - q[i]);
                if held[k].is_none() && !(low..=high).contains(&step[k]) {
                    held[k] = Some(step[k].clamp(low, high));
                    more = true;
                }
            }
            if !more {
                break;
            }
        }
        let scale = (LARGEST / step.amax()).min(1.0);
        for k in 0..N {
            let i = self.first + k;
            q[i] = (q[i] + scale * step[k]).clamp(bounds.lower[i], bounds.upper[i]);
        }
        step.amax()
    }

    /// The step in which some joints move by given amounts.
    fn solve_holding(&self, held: &[Option<f64>; N]) -> SVector<f64, N> {
        let (mut normal, mut right) = (self.normal, self.right);
        for (k, amount) in held.iter().enumerate() {
            if let Some(amount) = amount {
                right -= self.normal.column(k) * *amount;
            }
        }
        for (k, amount) in held.iter().enumerate() {
            if let Some(amount) = amount {
                normal.row_mut(k).fill(0.0);
                normal.column_mut(k).fill(0.0);
                normal[(k, k)] = 1.0;
                right[k] = *amount;
            }
        }
        // Damping makes the matrix positive definite.
        normal
            .cholesky()
            .map_or_else(SVector::zeros, |c| c.solve(&right))
    }
}

impl Limb<6> {
    /// A leg whose foot may be anywhere: directions only.
    fn swing(
        &mut self,
        bodies: &[Isometry3<f64>; BODIES],
        bones: &[Vector3<f64>; 4],
        foot: &nalgebra::UnitQuaternion<f64>,
    ) {
        for (bone, ends) in bones.iter().zip(LEG_BONES) {
            self.point(bodies, ends, bone, BONE);
        }
        self.turn(bodies, foot, FOOT_TURN);
    }

    /// A leg whose foot has its place: directions count where the foot leaves a choice.
    fn reach(
        &mut self,
        bodies: &[Isometry3<f64>; BODIES],
        bones: &[Vector3<f64>; 4],
        foot: &Isometry3<f64>,
    ) {
        for (bone, ends) in bones.iter().zip(LEG_BONES) {
            self.point(bodies, ends, bone, PLANNED_BONE);
        }
        let gap = foot.translation.vector - self.origins[FOOT];
        self.add(&self.jacobian(FOOT), &gap, PLANNED_PLACE);
        self.turn(bodies, &foot.rotation, PLANNED_TURN);
    }
}

#[cfg(test)]
mod tests;
