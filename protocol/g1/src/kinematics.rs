//! Forward kinematics, point Jacobian, soles and centre of mass.
//!
//! Separate because motion, gait measures and the simulation's tests all ask where the feet are.
//! Generic over the number type, so tests can check the `f32` of the runtime against `f64`.

use crate::links::{LEFT_FOOT, LEFT_HAND, RIGHT_FOOT, RIGHT_HAND, SOLE_CORNERS, TORSO, total_mass};
use crate::{BODIES, JOINT_TABLE, JOINTS, LINK_TABLE, RobotState};
use nalgebra::{
    Isometry3, Point3, RealField, SMatrix, Translation3, UnitQuaternion, Vector3, convert,
};

/// Degrees of freedom: 3 of the base's position, 3 of its rotation, then the joints.
pub const DOFS: usize = 6 + JOINTS;

/// How a point of a body moves, in the world frame: rows 0–2 its velocity, rows 3–5 the body's
/// angular velocity; columns 0–2 the base's velocity, 3–5 its angular velocity, then the joints.
pub type Jacobian<T> = SMatrix<T, 6, DOFS>;

/// The frame of every body in the world, given the pelvis frame and the joint positions (rad).
pub fn forward<T: RealField + Copy>(
    base: &Isometry3<T>,
    joint_positions: &[T; JOINTS],
) -> [Isometry3<T>; BODIES] {
    let mut bodies = [*base; BODIES];
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        let frame = bodies[joint.parent] * joint_frame::<T>(i);
        let turn = UnitQuaternion::from_scaled_axis(vector(joint.axis) * joint_positions[i]);
        bodies[i + 1] = Isometry3::from_parts(frame.translation, frame.rotation * turn);
    }
    bodies
}

/// The frame of every body in the world, for a state.
pub fn forward_state(state: &RobotState) -> [Isometry3<f32>; BODIES] {
    forward(
        &Isometry3::from_parts(state.position.into(), state.orientation),
        &state.joint_positions,
    )
}

/// The Jacobian of a point fixed to a body; `point` is in the frame of `body`, `bodies` as from
/// [`forward`].
pub fn point_jacobian<T: RealField + Copy>(
    bodies: &[Isometry3<T>; BODIES],
    body: usize,
    point: &Point3<T>,
) -> Jacobian<T> {
    let mut jacobian = Jacobian::zeros();
    let p = bodies[body] * point;
    for axis in 0..3 {
        jacobian[(axis, axis)] = T::one();
        let rotation = Vector3::ith(axis, T::one());
        write_rotation(&mut jacobian, 3 + axis, rotation, p - base_origin(bodies));
    }
    let mut link = body;
    while let Some(parent) = LINK_TABLE[link].parent {
        let joint = link - 1;
        // The hinge's axis is fixed to the moved body too, since it turns about it.
        let axis = bodies[link].rotation * vector(JOINT_TABLE[joint].axis);
        let arm = p.coords - bodies[link].translation.vector;
        write_rotation(&mut jacobian, 6 + joint, axis, arm);
        link = parent;
    }
    jacobian
}

/// Velocity in the world, m/s, of a point fixed to a body; `point` is in the world, `bodies` those of
/// `state`. What [`point_jacobian`] times the velocities would give, without the matrix.
pub fn point_velocity(
    bodies: &[Isometry3<f32>; BODIES],
    state: &RobotState,
    body: usize,
    point: &Point3<f32>,
) -> Vector3<f32> {
    let arm = point - base_origin(bodies);
    let mut velocity = state.linear_velocity + state.angular_velocity.cross(&arm);
    let mut link = body;
    while let Some(parent) = LINK_TABLE[link].parent {
        let joint = link - 1;
        let axis = bodies[link].rotation * vector(JOINT_TABLE[joint].axis);
        let arm = point.coords - bodies[link].translation.vector;
        velocity += axis.cross(&arm) * state.joint_velocities[joint];
        link = parent;
    }
    velocity
}

/// The four corners of a foot's sole in the world; `foot` is [`LEFT_FOOT`] or [`RIGHT_FOOT`].
pub fn sole_points<T: RealField + Copy>(
    bodies: &[Isometry3<T>; BODIES],
    foot: usize,
) -> [Point3<T>; 4] {
    SOLE_CORNERS.map(|corner| bodies[foot] * Point3::from(vector(corner)))
}

/// Bodies and points within them by which a pose is told: left and right foot, left and right hand, head. The hands and
/// the head are those of [`crate::shapes`].
const KEY_POINTS: [(usize, [f64; 3]); 5] = [
    (LEFT_FOOT, [0.0; 3]),
    (RIGHT_FOOT, [0.0; 3]),
    (LEFT_HAND, [0.17, 0.0, 0.0]),
    (RIGHT_HAND, [0.17, 0.0, 0.0]),
    (TORSO, [0.0, 0.0, 0.42]),
];

/// Where feet, hands and head are, seen from the pelvis and in its frame, m: left foot, right foot, left hand, right
/// hand, head.
pub fn key_points(joint_positions: &[f32; JOINTS]) -> [Point3<f32>; 5] {
    let bodies = forward(&Isometry3::identity(), joint_positions);
    KEY_POINTS.map(|(body, point)| bodies[body] * Point3::from(vector(point)))
}

/// Height of the lowest corner of one foot's sole, m.
pub fn lowest_sole_point<T: RealField + Copy>(bodies: &[Isometry3<T>; BODIES], foot: usize) -> T {
    sole_points(bodies, foot)
        .iter()
        .map(|corner| corner.z)
        .reduce(T::min)
        .expect("a sole has corners")
}

/// Height of the lowest corner of both soles, m.
pub fn lowest_foot_point<T: RealField + Copy>(bodies: &[Isometry3<T>; BODIES]) -> T {
    lowest_sole_point(bodies, LEFT_FOOT).min(lowest_sole_point(bodies, RIGHT_FOOT))
}

/// The robot's centre of mass in the world, m.
pub fn centre_of_mass<T: RealField + Copy>(bodies: &[Isometry3<T>; BODIES]) -> Point3<T> {
    let mut moment = Vector3::zeros();
    for (frame, link) in bodies.iter().zip(&LINK_TABLE) {
        moment += (frame * Point3::from(vector(link.com))).coords * convert::<f64, T>(link.mass);
    }
    Point3::from(moment / convert::<f64, T>(total_mass()))
}

fn joint_frame<T: RealField + Copy>(joint: usize) -> Isometry3<T> {
    let joint = &JOINT_TABLE[joint];
    let [roll, pitch, yaw] = joint.rpy.map(convert::<f64, T>);
    let rotation = if joint.rpy == [0.0; 3] {
        UnitQuaternion::identity() // most joints: spares six trigonometric functions
    } else {
        UnitQuaternion::from_euler_angles(roll, pitch, yaw)
    };
    Isometry3::from_parts(Translation3::from(vector(joint.origin)), rotation)
}

fn base_origin<T: RealField + Copy>(bodies: &[Isometry3<T>; BODIES]) -> Point3<T> {
    Point3::from(bodies[0].translation.vector)
}

fn write_rotation<T: RealField + Copy>(
    jacobian: &mut Jacobian<T>,
    column: usize,
    axis: Vector3<T>,
    arm: Vector3<T>,
) {
    jacobian
        .fixed_view_mut::<3, 1>(0, column)
        .copy_from(&axis.cross(&arm));
    jacobian.fixed_view_mut::<3, 1>(3, column).copy_from(&axis);
}

fn vector<T: RealField + Copy>(v: [f64; 3]) -> Vector3<T> {
    Vector3::from(v.map(convert::<f64, T>))
}

#[cfg(test)]
mod tests;
