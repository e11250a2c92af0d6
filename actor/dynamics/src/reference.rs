//! One robot in double precision: what the others are compared with.
//!
//! Separate because it answers other questions than a fleet does: the same step at any length, and the
//! equations of motion themselves, M·v̇ = τ − C, taken by a fourth-order method where no contact acts.

use crate::block::{Block, Row, row};
use crate::contact::{self, Contacts};
use crate::drive::Motors;
use crate::factor::{self, Factor};
use crate::ground::Ground;
use crate::group::{Group, Tally};
use crate::kinematics::Walk;
use crate::lane::Real;
use crate::robots::Solver;
use crate::step::{Crew, Setting, step};
use crate::tree::{BASE, DEGREES, LIMB_FIRST, LIMBS, TRUNK, Tree};
use g1::{JOINTS, RobotState};

/// A number per degree of freedom: velocity of the pelvis' origin (world, m/s), its angular velocity
/// (world, rad/s), joint speeds (rad/s); or what belongs to these.
pub type Degrees = [f64; DEGREES];

/// One robot, nominal.
pub struct Reference {
    tree: Tree<f64>,
    ground: Ground,
    motors: Motors<f64>,
    sweeps: usize,
    block: Block<f64>,
    targets: [Row<f64>; JOINTS],
}

impl Reference {
    /// With a solver's motors and ground, and parts that meet or not.
    pub fn new(solver: &Solver, sweeps: usize) -> Self {
        Self {
            tree: contact::tree(solver.self_collision),
            ground: solver.ground.clone(),
            motors: solver.motors.cast(),
            sweeps,
            block: Block::new(),
            targets: [Row::default(); JOINTS],
        }
    }

    /// Puts the robot into a state.
    pub fn set_state(&mut self, state: &RobotState) {
        self.block.set_state(0, state);
    }

    /// The robot's state.
    pub fn state(&self) -> RobotState {
        self.block.state(0)
    }

    /// Target positions of its joints, rad.
    pub fn set_targets(&mut self, targets: &[f32; JOINTS]) {
        for (row, target) in self.targets.iter_mut().zip(targets) {
            row.0[0] = f64::of(f64::from(*target));
        }
    }

    /// Adds to the velocity of the whole robot, world frame, m/s.
    pub fn push(&mut self, change: [f64; 3]) {
        for (axis, change) in change.into_iter().enumerate() {
            self.block.state[row::LINEAR + axis].0[0] += change;
        }
    }

    /// Advances by steps of `dt` seconds as a fleet does.
    pub fn advance(&mut self, steps: usize, dt: f64) {
        let setting = Setting {
            tree: &self.tree,
            ground: &self.ground,
            motors: &self.motors,
            dt,
            sweeps: self.sweeps,
        };
        let (mut crew, mut contacts) = (Crew::<f64>::new(()), Contacts::none(()));
        crew.group.load((), &self.block, &self.targets, None, 0);
        for _ in 0..steps {
            step((), &setting, &mut [&mut crew], &mut [&mut contacts]);
        }
        crew.group.store(&mut self.block, &mut Tally::default(), 0);
    }

    /// Advances by Runge–Kutta steps of `dt` seconds, without contacts and stops: the solution of the
    /// equations of motion to within dt⁴.
    pub fn advance_smoothly(&mut self, steps: usize, dt: f64) {
        for _ in 0..steps {
            let from = self.block.clone();
            let mut sum = [[0.0; PLACES]; 2];
            for (share, ahead) in [(1.0, 0.5), (2.0, 0.5), (2.0, 1.0), (1.0, 0.0)] {
                let rate = self.rate();
                self.block = from.clone();
                self.walk_on(&rate, ahead * dt);
                for (sum, rate) in sum.iter_mut().flatten().zip(rate.iter().flatten()) {
                    *sum += share / 6.0 * rate;
                }
            }
            self.block = from;
            self.walk_on(&sum, dt);
            self.normalize();
        }
    }

    /// Generalised velocity.
    pub fn velocity(&self) -> Degrees {
        std::array::from_fn(|i| self.number(speed_row(i)))
    }

    /// Generalised acceleration by gravity and the motors: M⁻¹·(τ − C). No contacts, no stops.
    pub fn acceleration(&self) -> Degrees {
        let mut walk = self.walk();
        let mut x = walk.bias.map(|bias| -bias);
        for joint in 0..JOINTS {
            x[BASE + joint] += self.torque(joint);
        }
        let mut root = [0.0; DEGREES];
        factor::factor(&mut walk.trunk, &mut walk.limbs, &mut root);
        let factor = Factor {
            trunk: &walk.trunk,
            limbs: &walk.limbs,
            root: &root,
        };
        factor.half(&mut x);
        factor.velocity(&mut x);
        x
    }

    /// Mass matrix M, armature included, and bias forces C of gravity and motion.
    pub fn equations(&self) -> ([Degrees; DEGREES], Degrees) {
        let walk = self.walk();
        let mut mass = [[0.0; DEGREES]; DEGREES];
        let mut put = |i: usize, j: usize, value: f64| {
            mass[i][j] = value;
            mass[j][i] = value;
        };
        for k in 0..TRUNK {
            for j in 0..=k {
                put(
                    factor::trunk_degree(k),
                    factor::trunk_degree(j),
                    walk.trunk[k][j],
                );
            }
        }
        for limb in 0..LIMBS {
            let (prefix, count) = factor::limb_shape(limb);
            let first = BASE + LIMB_FIRST[limb];
            for k in 0..count {
                for j in 0..prefix {
                    put(first + k, factor::trunk_degree(j), walk.limbs[limb][k][j]);
                }
                for j in 0..=k {
                    put(first + k, first + j, walk.limbs[limb][k][prefix + j]);
                }
            }
        }
        (mass, walk.bias)
    }

    /// The motor's torque at this moment, N·m.
    fn torque(&self, joint: usize) -> f64 {
        let motors = &self.motors;
        let (q, speed) = (
            self.number(row::JOINT + joint),
            self.number(row::SPEED + joint),
        );
        let pull = motors.stiffness[joint] * (self.targets[joint].0[0] - q);
        let asked = pull - motors.damping[joint] * speed;
        asked.clamp(-motors.effort[joint], motors.effort[joint])
    }

    fn walk(&self) -> Walk<f64> {
        let mut group = Group::new(());
        group.load((), &self.block, &self.targets, None, 0);
        let mut walk = Walk::new(());
        walk.run((), &self.tree, &group);
        walk
    }

    fn number(&self, row: usize) -> f64 {
        self.block.state[row].0[0]
    }

    /// Rates of the places and of the velocities.
    fn rate(&self) -> [[f64; PLACES]; 2] {
        let v = self.velocity();
        let q: [f64; 4] = std::array::from_fn(|i| self.number(row::QUATERNION + i));
        let (w, i, j, k) = (q[0], q[1], q[2], q[3]);
        let [a, b, c] = [v[3] / 2.0, v[4] / 2.0, v[5] / 2.0];
        let mut places = [0.0; PLACES];
        places[..3].copy_from_slice(&v[..3]);
        // Half of ω·q, with ω in world axes.
        places[3] = -a * i - b * j - c * k;
        places[4] = a * w + b * k - c * j;
        places[5] = b * w + c * i - a * k;
        places[6] = c * w + a * j - b * i;
        places[7..].copy_from_slice(&v[BASE..]);
        let mut speeds = [0.0; PLACES];
        speeds[..DEGREES].copy_from_slice(&self.acceleration());
        [places, speeds]
    }

    fn normalize(&mut self) {
        let q = row::QUATERNION;
        let square: f64 = (q..q + 4).map(|i| self.number(i).powi(2)).sum();
        for i in q..q + 4 {
            self.block.state[i].0[0] /= square.sqrt();
        }
    }

    fn walk_on(&mut self, [places, speeds]: &[[f64; PLACES]; 2], time: f64) {
        for (i, rate) in places.iter().enumerate() {
            let at = if i < 7 { i } else { row::JOINT + i - 7 };
            self.block.state[at].0[0] += time * rate;
        }
        for (i, rate) in speeds[..DEGREES].iter().enumerate() {
            self.block.state[speed_row(i)].0[0] += time * rate;
        }
    }
}

/// Position, quaternion and joints: one number more than there are degrees of freedom.
const PLACES: usize = DEGREES + 1;

/// The row of a generalised velocity.
fn speed_row(degree: usize) -> usize {
    if degree < BASE {
        row::LINEAR + degree
    } else {
        row::SPEED + degree - BASE
    }
}

#[cfg(test)]
mod tests;
