//! One robot on a flat floor: the tables of `g1` as a rapier multibody, its state in and out.
//!
//! Separate because this and `model` are all that knows how rapier is fed; what is done to the
//! robot (torques, tasks, resets) is said elsewhere. One robot per world: many in one world cost
//! more each.

use crate::actuator::{self, Gains};
use crate::model::{self, Variation};
use g1::{BODIES, JOINT_TABLE, JOINTS, LEFT_FOOT, RIGHT_FOOT, RobotState, links};
use nalgebra::Vector3;
use rapier3d::dynamics::{
    CCDSolver, CoefficientCombineRule, ImpulseJointSet, IntegrationParameters, IslandManager,
    Multibody, MultibodyJointHandle, MultibodyJointSet, RigidBodyBuilder, RigidBodyHandle,
    RigidBodySet, SoftBodySet,
};
use rapier3d::geometry::{
    BroadPhaseBvh, ColliderBuilder, ColliderHandle, ColliderSet, Group, InteractionGroups,
    InteractionTestMode, NarrowPhase,
};
use rapier3d::math::{Pose, Vector};
use rapier3d::pipeline::PhysicsPipeline;
use serde::{Deserialize, Serialize};

/// Length of a physics step, s: 200 Hz (III-A).
pub const PHYSICS_STEP: f32 = 0.005;
/// Physics steps in a control step: the policy runs at 50 Hz (III-A).
pub const SUBSTEPS: usize = 4;
/// Length of a control step, s.
pub const CONTROL_STEP: f32 = PHYSICS_STEP * SUBSTEPS as f32;
/// Gravitational acceleration, m/s².
pub const GRAVITY: f32 = 9.81;
/// Degrees of freedom of the free base, ahead of the joints in generalised vectors: linear velocity
/// of the pelvis' centre of mass, then angular velocity, both in the world frame.
pub(crate) const BASE_DEGREES: usize = 6;

const DEGREES: usize = BASE_DEGREES + JOINTS;
/// Index of the free angular axis of a hinge among rapier's six.
pub(crate) const HINGE_AXIS: usize = 3;
/// Beyond these speeds (m/s, rad/s) a state is taken for a blown-up one.
const SPEED_LIMIT: f32 = 1_000.0;

/// rapier's scratch space and settings: no state of any robot, shared by all worlds of a thread.
pub struct Engine {
    pipeline: PhysicsPipeline,
    ccd: CCDSolver,
    parameters: IntegrationParameters,
}

impl Engine {
    /// At the project's step of 5 ms.
    pub fn new() -> Self {
        Self::with_step(PHYSICS_STEP)
    }

    /// At another step, s, for references that tests compare with.
    pub fn with_step(dt: f32) -> Self {
        Self {
            pipeline: PhysicsPipeline::new(),
            ccd: CCDSolver::new(),
            parameters: IntegrationParameters {
                dt,
                num_solver_iterations: 1,
                num_internal_pgs_iterations: 1,
                num_internal_stabilization_iterations: 1,
                max_ccd_substeps: 0,
                // Both look at what the last steps did instead of at the feet; with one box per
                // foot on a plane there is nothing to save.
                contact_recycling: false,
                contact_clustering: false,
                ..IntegrationParameters::default()
            },
        }
    }

    /// Length of a physics step, s.
    pub fn step(&self) -> f32 {
        self.parameters.dt
    }
}

impl Default for Engine {
    fn default() -> Self {
        Self::new()
    }
}

/// What a control step took and felt.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exertion {
    /// Positive mechanical work of the motors, J.
    pub energy: f32,
    /// Vertical force on the left and the right sole, mean over the step, N.
    pub foot_forces: [f32; 2],
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
    floor: ColliderHandle,
    // rapier turns a body with numbers that are not finite into a disabled one with finite numbers.
    broken: bool,
}

impl World {
    /// A robot in its tables' zero pose at the origin; place it with [`World::set_state`].
    pub fn new(variation: &Variation) -> Self {
        let mut bodies = RigidBodySet::new();
        let mut colliders = ColliderSet::new();
        let mut multibody_joints = MultibodyJointSet::new();
        let links: [RigidBodyHandle; BODIES] = std::array::from_fn(|body| {
            let mut link = RigidBodyBuilder::dynamic()
                .additional_mass_properties(model::mass_properties(body, variation))
                .can_sleep(false)
                .build();
            // rapier caps a body's turn at about 45° a step otherwise.
            link.set_allow_fast_rotation(true);
            bodies.insert(link)
        });
        // Feet touch the floor and nothing else touches anything.
        let (floor_group, sole_group) = (Group::GROUP_1, Group::GROUP_2);
        let groups = |member, with| InteractionGroups::new(member, with, InteractionTestMode::And);
        let floor = colliders.insert(
            ColliderBuilder::halfspace(nalgebra::Unit::new_unchecked(Vector::Z))
                .friction(1.0)
                .collision_groups(groups(floor_group, sole_group)),
        );
        let half = Vector3::from(links::FOOT_HALF_EXTENTS).cast::<f32>();
        let soles = [LEFT_FOOT, RIGHT_FOOT].map(|foot| {
            let sole = ColliderBuilder::cuboid(half.x, half.y, half.z)
                .position(Pose::from_translation(model::vector(Vector3::from(
                    links::FOOT_CENTRE,
                ))))
                .density(0.0)
                .friction(variation.friction)
                .friction_combine_rule(CoefficientCombineRule::Multiply)
                .collision_groups(groups(sole_group, floor_group));
            colliders.insert_with_parent(sole, links[foot], &mut bodies)
        });
        let mut robot = MultibodyJointHandle::invalid();
        for (i, joint) in JOINT_TABLE.iter().enumerate() {
            robot = multibody_joints
                .insert(links[joint.parent], links[i + 1], model::hinge(joint), true)
                .expect("the joint table is a tree");
        }
        for &link in &links {
            bodies[link].recompute_mass_properties_from_colliders(&colliders);
        }
        let (multibody, _) = multibody_joints.get_mut(robot).expect("just inserted");
        assert_eq!(
            multibody.ndofs(),
            DEGREES,
            "a free base and one hinge a joint"
        );
        for (body, link) in multibody.links().enumerate() {
            // Everything below counts on the order of the tables.
            assert_eq!(link.rigid_body_handle(), links[body]);
            assert_eq!(link.assembly_id(), if body == 0 { 0 } else { body + 5 });
        }
        multibody.set_self_contacts_enabled(false);
        // The default of 0.1 on every angular degree of freedom brakes the free base, too.
        multibody.damping_mut().fill(0.0);
        for (degree, armature) in multibody.armature_mut().iter_mut().enumerate() {
            *armature = model::armature(degree);
        }
        multibody.forward_kinematics(&bodies, true);
        multibody.update_rigid_bodies(&mut bodies, true);
        Self {
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::default(),
            narrow_phase: NarrowPhase::new(),
            bodies,
            colliders,
            impulse_joints: ImpulseJointSet::new(),
            multibody_joints,
            soft_bodies: SoftBodySet::default(),
            links,
            robot,
            soles,
            floor,
            broken: false,
        }
    }

    /// A fresh world from a template that was never stepped: bit-equal to `World::new(variation)`
    /// and cheaper. A used world is no template: contacts and islands remember.
    pub fn from_template(template: &Self, variation: &Variation) -> Self {
        let mut world = template.clone();
        let torso = &mut world.bodies[world.links[links::TORSO]];
        torso
            .set_additional_mass_properties(model::mass_properties(links::TORSO, variation), false);
        torso.recompute_mass_properties_from_colliders(&world.colliders);
        for sole in world.soles {
            world.colliders[sole].set_friction(variation.friction);
        }
        world
    }

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

    /// One control step of 20 ms toward target positions (rad), held over its four physics steps.
    pub fn control_step(
        &mut self,
        engine: &mut Engine,
        gains: &Gains,
        targets: &[f32; JOINTS],
    ) -> Exertion {
        let mut exertion = Exertion::default();
        for _ in 0..SUBSTEPS {
            let step = self.physics_step(engine, gains, targets);
            exertion.energy += step.energy;
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
        let torques = actuator::drive(gains, targets, self.multibody_mut());
        engine.pipeline.step(
            Vector::new(0.0, 0.0, -GRAVITY),
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
        Exertion {
            energy: actuator::positive_work(&torques, self.multibody(), dt),
            foot_forces: [0, 1].map(|side| self.sole_impulse(side) / dt),
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

    /// Normal impulse of the floor on a sole during the last physics step, N·s.
    fn sole_impulse(&self, side: usize) -> f32 {
        let manifolds = self
            .narrow_phase
            .contact_pair(self.soles[side], self.floor)
            .and_then(|pair| pair.rigid())
            .map_or(&[][..], |pair| &pair.manifolds);
        manifolds
            .iter()
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

#[cfg(test)]
mod tests;
