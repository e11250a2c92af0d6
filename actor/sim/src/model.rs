//! The robot's tables in rapier's terms: inertias, joint frames, and the step between two algebras.
//!
//! Separate from the world because these are constants turned once. rapier speaks glam, everything
//! else of ours nalgebra; no other file converts.

use g1::{BODIES, JOINT_TABLE, Joint, LINK_TABLE, Link, links};
use nalgebra::{Matrix3, Rotation3, SymmetricEigen, UnitQuaternion, Vector3};
use rapier3d::dynamics::{GenericJoint, GenericJointBuilder, JointAxesMask, MassProperties};
use rapier3d::math::{Pose, Rotation, Vector};
use serde::{Deserialize, Serialize};

/// Gravitational acceleration, m/s².
pub const GRAVITY: f32 = 9.81;

/// Degrees of freedom of the free base, ahead of the joints in generalised vectors: linear velocity
/// of the pelvis' centre of mass, then angular velocity, both in the world frame.
pub(crate) const BASE_DEGREES: usize = 6;
/// Index of the free angular axis of a hinge among rapier's six.
pub(crate) const HINGE_AXIS: usize = 3;

/// What is different about one robot and its floor: the rows of Table I that change the physics.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// Added to the torso's mass, kg; its inertia grows in proportion.
    pub torso_mass: f32,
    /// Added to the torso's centre of mass, torso frame, m.
    pub torso_com: [f32; 3],
    /// Friction coefficient between soles and ground.
    pub friction: f32,
}

impl Variation {
    /// The robot of the tables on a floor of friction 1.
    pub const NOMINAL: Self = Self {
        torso_mass: 0.0,
        torso_com: [0.0; 3],
        friction: 1.0,
    };
}

/// Where a body's rapier frame lies in its link frame, m.
///
/// rapier integrates the root's linear velocity, which is that of its centre of mass, at the root
/// body's origin. Both are the same point only when the origin is put at the centre of mass.
pub(crate) fn frame_offset(body: usize) -> Vector3<f64> {
    if body == links::PELVIS {
        Vector3::from(LINK_TABLE[body].com)
    } else {
        Vector3::zeros()
    }
}

/// Mass, centre of mass and principal inertia of every body, the torso varied.
pub(crate) fn mass_properties(body: usize, variation: &Variation) -> MassProperties {
    assert!(body < BODIES, "the robot has {BODIES} bodies");
    let Link {
        mass, com, inertia, ..
    } = LINK_TABLE[body];
    let [xx, yy, zz, xy, xz, yz] = inertia;
    let mut com = Vector3::from(com) - frame_offset(body);
    let mut varied_mass = mass;
    if body == links::TORSO {
        varied_mass += f64::from(variation.torso_mass);
        com += Vector3::from(variation.torso_com).cast::<f64>();
    }
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * (varied_mass / mass);
    // Diagonalised here in f64: rapier's own diagonalisation works in f32.
    let SymmetricEigen {
        mut eigenvectors,
        eigenvalues,
    } = SymmetricEigen::new(inertia);
    if eigenvectors.determinant() < 0.0 {
        eigenvectors.set_column(2, &-eigenvectors.column(2).into_owned());
    }
    let frame =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(eigenvectors));
    MassProperties::with_principal_inertia_frame(
        vector(com),
        varied_mass as f32,
        vector(eigenvalues),
        rotation(frame),
    )
}

/// A hinge whose free axis is rapier's first angular axis, between the frames of parent and child.
pub(crate) fn hinge(joint: &Joint) -> GenericJoint {
    let [roll, pitch, yaw] = joint.rpy;
    let placed = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    let axis = Vector3::from(joint.axis);
    let onto_axis = UnitQuaternion::rotation_between(&Vector3::x(), &axis)
        .expect("axes are along +x, +y or +z");
    let origin = Vector3::from(joint.origin) - frame_offset(joint.parent);
    GenericJointBuilder::new(JointAxesMask::LOCKED_REVOLUTE_AXES)
        .local_frame1(Pose::from_parts(
            vector(origin),
            rotation(placed * onto_axis),
        ))
        .local_frame2(Pose::from_parts(Vector::ZERO, rotation(onto_axis)))
        .build()
}

/// Reflected rotor inertia of every degree of freedom: none for the base, then the joints'.
pub(crate) fn armature(degree: usize) -> f32 {
    match degree.checked_sub(BASE_DEGREES) {
        Some(joint) => JOINT_TABLE[joint].armature as f32,
        None => 0.0,
    }
}

pub(crate) fn vector(v: Vector3<f64>) -> Vector {
    Vector::new(v.x as f32, v.y as f32, v.z as f32)
}

pub(crate) fn vector_f32(v: Vector3<f32>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(crate) fn rotation(q: UnitQuaternion<f64>) -> Rotation {
    Rotation::from_xyzw(q.i as f32, q.j as f32, q.k as f32, q.w as f32)
}

pub(crate) fn rotation_f32(q: &UnitQuaternion<f32>) -> Rotation {
    Rotation::from_xyzw(q.i, q.j, q.k, q.w)
}

/// Back to nalgebra, normalised: products of many small turns drift from unit length.
pub(crate) fn quaternion(r: Rotation) -> UnitQuaternion<f32> {
    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(r.w, r.x, r.y, r.z))
}

pub(crate) fn vector3(v: Vector) -> Vector3<f32> {
    Vector3::new(v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masses_sum_to_the_robots() {
        let sum: f32 = (0..BODIES)
            .map(|body| mass_properties(body, &Variation::NOMINAL).mass())
            .sum();
        assert!((sum - 32.106_857).abs() < 1e-4, "{sum}");
    }

    #[test]
    fn principal_inertia_turned_back_is_the_table() {
        for (body, link) in LINK_TABLE.iter().enumerate() {
            let properties = mass_properties(body, &Variation::NOMINAL);
            let axes = quaternion(properties.principal_inertia_local_frame).to_rotation_matrix();
            let principal = Matrix3::from_diagonal(&vector3(properties.principal_inertia()));
            let got = axes.matrix() * principal * axes.matrix().transpose();
            let [xx, yy, zz, xy, xz, yz] = link.inertia.map(|x| x as f32);
            let table = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            assert!((got - table).norm() < 1e-5 * table.norm(), "{}", link.name);
        }
    }

    #[test]
    fn variation_moves_and_loads_the_torso_only() {
        let varied = Variation {
            torso_mass: 0.5,
            torso_com: [0.1, -0.05, 0.02],
            ..Variation::NOMINAL
        };
        for body in 0..BODIES {
            let a = mass_properties(body, &Variation::NOMINAL);
            let b = mass_properties(body, &varied);
            if body != links::TORSO {
                assert_eq!(a, b);
                continue;
            }
            assert!((b.mass() - 8.317).abs() < 1e-5); // 7.817 + 0.5
            let moved = vector3(b.local_com) - vector3(a.local_com);
            assert!((moved - Vector3::new(0.1, -0.05, 0.02)).norm() < 1e-6);
            let growth = b.principal_inertia().x / a.principal_inertia().x;
            assert!((growth - 8.317 / 7.817).abs() < 1e-5);
        }
    }
}
