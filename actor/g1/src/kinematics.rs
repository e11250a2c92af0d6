//! Forward kinematics, point Jacobian, soles and centre of mass.
//!
//! Separate because motion, gait measures and the simulation's tests all ask where the feet are.
//! Generic over the number type, so tests can check the `f32` of the runtime against `f64`.

use crate::links::{LEFT_FOOT, RIGHT_FOOT, SOLE_CORNERS, total_mass};
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
mod tests {
    use super::*;
    use crate::DEFAULT_POSE;
    use crate::state::STANDING_HEIGHT;

    /// Angles that leave no joint at zero; bodies below were computed from the URDF by another program.
    const GOLDEN: [f64; JOINTS] = [
        0.8513790220645507,
        2.608304215044497,
        1.5204617188402914,
        0.5809378215838155,
        -0.45355682136700326,
        0.1955925840094827,
        -2.5022120696479577,
        -0.10043795995127747,
        1.638397313453285,
        1.3011273567291601,
        -0.4495549134049971,
        -0.11601634950403508,
        -1.2835028390430037,
        -0.5257385086383088,
        0.3491139499208533,
        0.2801121354620424,
        2.080263690437488,
        1.1543885828786604,
        0.4943034898893206,
        1.5458102790541335,
        -1.4906436560384038,
        -0.5438778744321956,
        0.44390617899140805,
    ];

    fn standing() -> [Isometry3<f64>; BODIES] {
        let base = Isometry3::translation(0.0, 0.0, STANDING_HEIGHT);
        forward(&base, &JOINT_TABLE.map(|joint| joint.default_position))
    }

    #[test]
    fn bodies_agree_with_the_urdf() {
        type Golden = (&'static str, [f64; 3], [f64; 4]);
        let expected: [Golden; 5] = [
            (
                "left_ankle_roll_link",
                [0.180971054, 0.637913851, 0.117768302],
                [0.408352981, 0.764164355, -0.48985428, 0.096661605],
            ),
            (
                "right_knee_link",
                [0.120041991, -0.224235372, 0.197450937],
                [0.583349857, -0.621716282, -0.355103369, -0.383501507],
            ),
            (
                "right_ankle_roll_link",
                [0.103829706, -0.539390479, 0.212185171],
                [0.448609454, -0.718772052, -0.461751336, -0.262491903],
            ),
            (
                "left_elbow_link",
                [0.224389993, -0.053102713, 0.152758339],
                [0.67542355, 0.383136226, 0.555193542, -0.297942597],
            ),
            (
                "right_wrist_roll_rubber_hand",
                [-0.01378556, 0.030153535, 0.179931321],
                [0.12458738, -0.425786289, -0.008646808, 0.896163631],
            ),
        ];
        let bodies = forward(&Isometry3::identity(), &GOLDEN);
        for (name, position, [w, x, y, z]) in expected {
            let frame = bodies[LINK_TABLE.iter().position(|l| l.name == name).unwrap()];
            let gap = frame.translation.vector - Vector3::from(position);
            assert!(gap.norm() < 1e-8, "{name}: {gap:?}");
            let rotation = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(w, x, y, z));
            assert!(frame.rotation.angle_to(&rotation) < 1e-6, "{name}");
        }
        let com = centre_of_mass(&bodies).coords;
        let expected = Vector3::new(0.0523499620644414, 0.01340095206263325, 0.10873563452363182);
        assert!((com - expected).norm() < 1e-9);
    }

    #[test]
    fn single_precision_is_enough() {
        let exact = forward(&Isometry3::identity(), &GOLDEN);
        let rounded = forward(&Isometry3::identity(), &GOLDEN.map(|q| q as f32));
        for (a, b) in exact.iter().zip(&rounded) {
            let gap = a.translation.vector - b.translation.vector.cast();
            assert!(gap.norm() < 2e-6);
        }
    }

    #[test]
    fn the_default_pose_stands_on_both_soles() {
        let bodies = standing();
        for foot in [LEFT_FOOT, RIGHT_FOOT] {
            for corner in sole_points(&bodies, foot) {
                // hip −0.1 + knee 0.3 + ankle −0.2 = 0: the sole is level.
                assert!(corner.z.abs() < 1e-6, "{corner:?}");
            }
        }
        assert!(lowest_foot_point(&bodies).abs() < 1e-6);
        assert!((centre_of_mass(&bodies).z - 0.68613).abs() < 1e-5);
        let feet = [LEFT_FOOT, RIGHT_FOOT].map(|foot| bodies[foot].translation.vector.y);
        assert!((feet[0] - 0.1185).abs() < 1e-3 && (feet[1] + 0.1185).abs() < 1e-3);
        let runtime = forward_state(&RobotState::standing());
        assert_eq!(RobotState::standing().joint_positions, DEFAULT_POSE);
        assert!(lowest_foot_point(&runtime).abs() < 1e-6);
    }

    #[test]
    fn jacobian_is_the_derivative_of_forward_kinematics() {
        let base = Isometry3::from_parts(
            Translation3::new(0.3, -0.2, 0.7),
            UnitQuaternion::from_euler_angles(0.2, -0.3, 0.9),
        );
        let h = 1e-6;
        for (body, point) in [
            (RIGHT_FOOT, Point3::new(0.12, 0.03, -0.035)),
            (23, Point3::new(0.1, 0.0, 0.02)),
        ] {
            let jacobian = point_jacobian(&forward(&base, &GOLDEN), body, &point);
            for dof in 0..DOFS {
                let moved = |step: f64| {
                    let (mut base, mut q) = (base, GOLDEN);
                    match dof {
                        0..3 => base.translation.vector[dof] += step,
                        3..6 => {
                            let axis = Vector3::ith(dof - 3, step);
                            base.rotation = UnitQuaternion::from_scaled_axis(axis) * base.rotation;
                        }
                        _ => q[dof - 6] += step,
                    }
                    forward(&base, &q)[body]
                };
                let (ahead, behind) = (moved(h), moved(-h));
                let velocity = (ahead * point - behind * point) / (2.0 * h);
                let spin = (ahead.rotation * behind.rotation.inverse()).scaled_axis() / (2.0 * h);
                for row in 0..3 {
                    assert!((jacobian[(row, dof)] - velocity[row]).abs() < 1e-7);
                    assert!((jacobian[(row + 3, dof)] - spin[row]).abs() < 1e-7);
                }
            }
        }
    }

    #[test]
    fn point_velocity_is_the_jacobian_times_the_velocities() {
        let state = RobotState {
            orientation: UnitQuaternion::from_euler_angles(0.2, -0.3, 0.9),
            linear_velocity: Vector3::new(0.4, -0.2, 0.1),
            angular_velocity: Vector3::new(-0.3, 0.5, 0.7),
            joint_positions: GOLDEN.map(|q| q as f32),
            joint_velocities: std::array::from_fn(|i| 0.3 * i as f32 - 2.0),
            ..RobotState::standing()
        };
        let bodies = forward_state(&state);
        let point = Point3::new(0.12, 0.03, -0.035);
        let mut velocities = nalgebra::SVector::<f32, DOFS>::zeros();
        velocities
            .fixed_rows_mut::<3>(0)
            .copy_from(&state.linear_velocity);
        velocities
            .fixed_rows_mut::<3>(3)
            .copy_from(&state.angular_velocity);
        for (i, speed) in state.joint_velocities.iter().enumerate() {
            velocities[6 + i] = *speed;
        }
        for body in [LEFT_FOOT, RIGHT_FOOT, 23] {
            let expected = point_jacobian(&bodies, body, &point) * velocities;
            let got = point_velocity(&bodies, &state, body, &(bodies[body] * point));
            assert!((got - expected.fixed_rows::<3>(0)).norm() < 1e-4, "{body}");
        }
    }
}
