//! Building a world: links, hinges, soles, capsules and floor, once by hand and then by copy.
//!
//! Separate because this happens once per episode and has nothing to do with stepping.

use super::{BASE_DEGREES, DEGREES, World};
use crate::ground::Ground;
use crate::model::{self, Variation};
use g1::collision::{CAPSULE_TABLE, CAPSULES, PAIR_TABLE};
use g1::{BODIES, JOINT_TABLE, LEFT_FOOT, RIGHT_FOOT, links};
use nalgebra::{Unit, Vector3};
use rapier3d::dynamics::{
    CoefficientCombineRule, ImpulseJointSet, IslandManager, MultibodyJointHandle,
    MultibodyJointSet, RigidBodyBuilder, RigidBodyHandle, RigidBodySet, SoftBodySet,
};
use rapier3d::geometry::{
    BroadPhaseBvh, ColliderBuilder, ColliderSet, Group, InteractionGroups, InteractionTestMode,
    NarrowPhase,
};
use rapier3d::math::{Pose, Vector};

/// Soles touch the floor.
const FLOOR: Group = Group::GROUP_1;
const SOLES: Group = Group::GROUP_2;
/// First of the capsules' groups: each has one of its own, and touches those that it is in a pair with.
const CAPSULES_FROM: u32 = 2;
const _: () = assert!(CAPSULES_FROM as usize + CAPSULES <= 32, "a bit each");

/// The groups of a capsule and of all its partners.
fn capsule_groups(capsule: usize) -> InteractionGroups {
    let of = |capsule: usize| 1 << (CAPSULES_FROM + capsule as u32);
    let partners = PAIR_TABLE.iter().filter_map(|&[a, b]| match capsule {
        _ if capsule == a => Some(of(b)),
        _ if capsule == b => Some(of(a)),
        _ => None,
    });
    let with = partners.fold(0, |all: u32, one: u32| all | one);
    groups(
        Group::from_bits_retain(of(capsule)),
        Group::from_bits_retain(with),
    )
}

fn groups(member: Group, with: Group) -> InteractionGroups {
    InteractionGroups::new(member, with, InteractionTestMode::And)
}

impl World {
    /// A robot in its tables' zero pose at the origin; place it with [`World::set_state`]. Its parts meet each other.
    pub fn new(variation: &Variation) -> Self {
        Self::with_self_collision(variation, true)
    }

    /// Likewise; its limbs and trunk meet each other, or pass through each other.
    pub fn with_self_collision(variation: &Variation, self_collision: bool) -> Self {
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
        colliders.insert(
            ColliderBuilder::halfspace(Unit::new_unchecked(Vector::Z))
                .friction(1.0)
                .collision_groups(groups(FLOOR, SOLES)),
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
                .collision_groups(groups(SOLES, FLOOR));
            colliders.insert_with_parent(sole, links[foot], &mut bodies)
        });
        let meeting = CAPSULE_TABLE.iter().enumerate();
        for (index, capsule) in meeting.filter(|_| self_collision) {
            let offset = model::frame_offset(capsule.body);
            let [from, to] = capsule
                .ends
                .map(|end| model::vector(Vector3::from(end) - offset));
            let collider = ColliderBuilder::capsule_from_endpoints(from, to, capsule.radius as f32)
                .density(0.0)
                .friction(0.0)
                .friction_combine_rule(CoefficientCombineRule::Multiply)
                .collision_groups(capsule_groups(index));
            colliders.insert_with_parent(collider, links[capsule.body], &mut bodies);
        }
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
            assert_eq!(
                link.assembly_id(),
                if body == 0 {
                    0
                } else {
                    BASE_DEGREES + body - 1
                }
            );
        }
        multibody.set_self_contacts_enabled(self_collision);
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
            broken: false,
        }
    }

    /// Lays hills and bumps over the floor, which goes on where they end. For worlds that were never stepped.
    pub(crate) fn lay(&mut self, ground: &Ground) {
        self.colliders.insert(
            ColliderBuilder::new(ground.shape())
                .rotation(Vector::X * std::f32::consts::FRAC_PI_2)
                .friction(1.0)
                .collision_groups(groups(FLOOR, SOLES)),
        );
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
}
