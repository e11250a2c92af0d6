//! Kinematics against the URDF, and against finite differences.

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
