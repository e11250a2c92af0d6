//! One robot on its floor: the tables of `g1` as a rapier multibody, its state in and out.
//!
//! Separate because this and `model` are all that knows how rapier is fed; what is done to the
//! robot (torques, tasks, resets) is said elsewhere. One robot per world: many in one world cost
//! more each.

mod build;
#[cfg(test)]
mod meeting;
#[cfg(test)]
mod tests;

use crate::actuator::{self, Gains, Law};
use crate::engine::Engine;
pub use crate::model::GRAVITY;
use crate::model::{self, BASE_DEGREES};
pub use crate::time::{CONTROL_STEP, PHYSICS_STEP, SUBSTEPS};
use g1::{BODIES, JOINTS, RobotState, links};
use nalgebra::Vector3;
use rapier3d::dynamics::{
    ImpulseJointSet, IslandManager, Multibody, MultibodyJointHandle, MultibodyJointSet,
    RigidBodyHandle, RigidBodySet, SoftBodySet,
};
use rapier3d::geometry::{BroadPhaseBvh, ColliderHandle, ColliderSet, NarrowPhase};
use rapier3d::math::{Pose, Vector};
use serde::{Deserialize, Serialize};

const DEGREES: usize = BASE_DEGREES + JOINTS;
/// Beyond these speeds (m/s, rad/s) a state is taken for a blown-up one.
const SPEED_LIMIT: f32 = 1_000.0;

/// What a control step took and felt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exertion {
    /// Positive mechanical work of the motors, J.
    pub energy: f32,
    /// Vertical force on the left and the right sole, mean over the step, N.
    pub foot_forces: [f32; 2],
    /// Each joint's greatest torque in the step, as a share of its effort limit.
    pub torque_use: [f32; JOINTS],
    /// Each joint's greatest speed in the step, as a share of its velocity limit; the physics does
    /// not enforce that limit, so this can exceed 1.
    pub speed_use: [f32; JOINTS],
}

impl Exertion {
    /// Raises the greatest torques and speeds to those of another step.
    pub(crate) fn take_greatest(&mut self, other: &Self) {
        for i in 0..JOINTS {
            self.torque_use[i] = self.torque_use[i].max(other.torque_use[i]);
            self.speed_use[i] = self.speed_use[i].max(other.speed_use[i]);
        }
    }
}

/// A robot and its floor. Clones and snapshots continue bit by bit like the original.
#[derive(Clone, Serialize, Deserialize)]
pub struct World {
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
    soft_bodies: SoftBodySet,
    links: [RigidBodyHandle; BODIES],
    robot: MultibodyJointHandle,
    soles: [ColliderHandle; 2],
    // rapier turns a body with numbers that are not finite into a disabled one with finite numbers.
    broken: bool,
}

impl World {
    /// The robot's state.
    pub fn state(&self) -> RobotState {
        let multibody = self.multibody();
        let velocity = multibody.generalized_velocity();
        let root = multibody.root().local_to_world();
        let orientation = model::quaternion(root.rotation);
        let offset = orientation * model::frame_offset(links::PELVIS).cast::<f32>();
        let angular_velocity = Vector3::new(velocity[3], velocity[4], velocity[5]);
        RobotState {
            position: model::vector3(root.translation) - offset,
            orientation,
            linear_velocity: Vector3::new(velocity[0], velocity[1], velocity[2])
                - angular_velocity.cross(&offset),
            angular_velocity,
            joint_positions: std::array::from_fn(|i| actuator::position(multibody, i)),
            joint_velocities: std::array::from_fn(|i| velocity[BASE_DEGREES + i]),
        }
    }

    /// Puts the robot into a state. For fresh worlds: in a used one the contacts of its earlier life
    /// act for another step, and what follows differs from a fresh world's.
    pub fn set_state(&mut self, state: &RobotState) {
        let offset = state.orientation * model::frame_offset(links::PELVIS).cast::<f32>();
        self.bodies[self.links[links::PELVIS]].set_position(
            Pose::from_parts(
                model::vector_f32(state.position + offset),
                model::rotation_f32(&state.orientation),
            ),
            true,
        );
        let (multibody, _) = self
            .multibody_joints
            .get_mut(self.robot)
            .expect("a world has its robot");
        // Displacements add to the positions; the second pass takes away what rounding left.
        for _ in 0..2 {
            let mut displacement = [0.0; DEGREES];
            for i in 0..JOINTS {
                displacement[BASE_DEGREES + i] =
                    state.joint_positions[i] - actuator::position(multibody, i);
            }
            multibody.apply_displacements(&displacement);
        }
        let of_com = state.linear_velocity + state.angular_velocity.cross(&offset);
        let mut velocity = multibody.generalized_velocity_mut();
        for axis in 0..3 {
            velocity[axis] = of_com[axis];
            velocity[3 + axis] = state.angular_velocity[axis];
        }
        for i in 0..JOINTS {
            velocity[BASE_DEGREES + i] = state.joint_velocities[i];
        }
        multibody.forward_kinematics(&self.bodies, true);
        multibody.update_rigid_bodies(&mut self.bodies, true);
    }

    /// Adds to the velocity of the whole robot, world frame, m/s.
    pub fn push(&mut self, change: Vector3<f32>) {
        let mut velocity = self.multibody_mut().generalized_velocity_mut();
        for axis in 0..3 {
            velocity[axis] += change[axis];
        }
    }

    /// A force on the torso's centre of mass, world frame, N, until another is given.
    pub(crate) fn set_force(&mut self, [x, y, z]: [f32; 3]) {
        let torso = &mut self.bodies[self.links[links::TORSO]];
        torso.reset_forces(true);
        torso.add_force(Vector::new(x, y, z), true);
    }

    /// One control step of 20 ms toward target positions (rad), held over its four physics steps.
    pub fn control_step(
        &mut self,
        engine: &mut Engine,
        gains: &Gains,
        targets: &[f32; JOINTS],
    ) -> Exertion {
        self.control_step_by(engine, Law::Table(gains), &[*targets; SUBSTEPS])
    }

    /// One control step by a law, toward targets of each of its physics steps.
    pub(crate) fn control_step_by(
        &mut self,
        engine: &mut Engine,
        law: Law<'_>,
        targets: &[[f32; JOINTS]; SUBSTEPS],
    ) -> Exertion {
        let mut exertion = Exertion::default();
        for targets in targets {
            let step = self.physics_step_by(engine, law, targets);
            exertion.energy += step.energy;
            exertion.take_greatest(&step);
            for (sum, force) in exertion.foot_forces.iter_mut().zip(step.foot_forces) {
                *sum += force / SUBSTEPS as f32;
            }
        }
        exertion
    }

    /// One physics step of the engine's length.
    pub fn physics_step(
        &mut self,
        engine: &mut Engine,
        gains: &Gains,
        targets: &[f32; JOINTS],
    ) -> Exertion {
        self.physics_step_by(engine, Law::Table(gains), targets)
    }

    /// The same by a law.
    fn physics_step_by(
        &mut self,
        engine: &mut Engine,
        law: Law<'_>,
        targets: &[f32; JOINTS],
    ) -> Exertion {
        let torques = actuator::drive(law, targets, self.multibody_mut());
        let [x, y, z] = law.gravity();
        engine.pipeline.step(
            Vector::new(x, y, z),
            &engine.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut self.impulse_joints,
            &mut self.multibody_joints,
            &mut self.soft_bodies,
            &mut engine.ccd,
            &(),
            &(),
        );
        self.broken |= !engine.pipeline.quarantine().is_empty();
        let dt = engine.parameters.dt;
        let (torque_use, speed_use) = actuator::use_of_limits(&torques, self.multibody());
        Exertion {
            energy: actuator::positive_work(&torques, self.multibody(), dt),
            foot_forces: [0, 1].map(|side| self.sole_impulse(side) / dt),
            torque_use,
            speed_use,
        }
    }

    /// Whether the state is usable: finite, and slower than anything a robot does.
    pub fn is_sound(&self) -> bool {
        // Written so that NaN fails.
        let speeds_sound = self
            .multibody()
            .generalized_velocity()
            .iter()
            .all(|speed| speed.abs() < SPEED_LIMIT);
        !self.broken && speeds_sound && self.state().is_finite()
    }

    /// Normal impulse of floor and ground on a sole during the last physics step, N·s.
    fn sole_impulse(&self, side: usize) -> f32 {
        // Soles touch nothing else.
        self.narrow_phase
            .contact_pairs_with(self.soles[side])
            .filter_map(|pair| pair.rigid())
            .flat_map(|pair| &pair.manifolds)
            .flat_map(|manifold| &manifold.points)
            .fold(0.0, |sum, point| sum + point.data.impulse)
    }

    pub(crate) fn multibody(&self) -> &Multibody {
        let (multibody, _) = self
            .multibody_joints
            .get(self.robot)
            .expect("a world has its robot");
        multibody
    }

    pub(crate) fn multibody_mut(&mut self) -> &mut Multibody {
        let (multibody, _) = self
            .multibody_joints
            .get_mut(self.robot)
            .expect("a world has its robot");
        multibody
    }
}
