//! The equations of motion against mechanics that does not share a line with them: sums over the
//! bodies by forward kinematics and Jacobians, and what a free robot keeps.

use super::*;
use g1::kinematics::{centre_of_mass, forward, point_jacobian};
use g1::{BODIES, JOINT_TABLE, LINK_TABLE, joints, links};
use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, SMatrix, SVector, UnitQuaternion, Vector3};

const GRAVITY: f64 = 9.81;

fn limp() -> Reference {
    let motors = Motors {
        stiffness: [0.0; JOINTS],
        damping: [0.0; JOINTS],
        effort: [0.0; JOINTS],
    };
    let solver = Solver {
        dt: 0.005,
        sweeps: 4,
        motors,
        ground: Ground::Plane,
        self_collision: true,
    };
    let mut reference = Reference::new(&solver, 4);
    let mut state = RobotState::standing();
    state.position = Vector3::new(0.3, -0.2, 5.0);
    state.orientation = UnitQuaternion::from_euler_angles(0.4, -0.3, 1.1);
    state.linear_velocity = Vector3::new(0.5, 0.7, -0.2);
    state.angular_velocity = Vector3::new(-0.6, 0.9, 0.4);
    for i in 0..JOINTS {
        state.joint_positions[i] += 0.3 * (1.7 * i as f32).sin();
        state.joint_velocities[i] = 3.0 * (2.3 * i as f32).cos();
    }
    reference.set_state(&state);
    // Unit length to the last bit of double precision; it came in single.
    reference.normalize();
    reference
}

impl Reference {
    fn frames(&self) -> [Isometry3<f64>; BODIES] {
        let n = |i: usize| self.number(i);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(n(3), n(4), n(5), n(6)));
        let base = Isometry3::from_parts(Vector3::new(n(0), n(1), n(2)).into(), turn);
        forward(&base, &std::array::from_fn(|i| n(row::JOINT + i)))
    }

    /// M and the momentum about the centre of mass, body by body.
    fn by_bodies(&self) -> (SMatrix<f64, DEGREES, DEGREES>, [Vector3<f64>; 2]) {
        let frames = self.frames();
        let centre = centre_of_mass(&frames);
        let v = SVector::<f64, DEGREES>::from(self.velocity());
        let mut mass = SMatrix::zeros();
        let (mut linear, mut angular) = (Vector3::zeros(), Vector3::zeros());
        for (body, link) in LINK_TABLE.iter().enumerate() {
            let com = Point3::from(Vector3::from(link.com));
            let jacobian = point_jacobian(&frames, body, &com);
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            let turn = frames[body].rotation.to_rotation_matrix();
            let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            let inertia = turn.matrix() * own * turn.matrix().transpose();
            let (along, about) = (jacobian.fixed_rows::<3>(0), jacobian.fixed_rows::<3>(3));
            mass += along.transpose() * along * link.mass + about.transpose() * inertia * about;
            let momentum = along * v * link.mass;
            linear += momentum;
            angular += inertia * (about * v) + (frames[body] * com - centre).cross(&momentum);
        }
        for (i, joint) in JOINT_TABLE.iter().enumerate() {
            mass[(BASE + i, BASE + i)] += joint.armature;
        }
        (mass, [linear, angular])
    }

    /// Kinetic and potential energy, J.
    fn energy(&self) -> f64 {
        let (mass, _) = self.by_bodies();
        let v = SVector::<f64, DEGREES>::from(self.velocity());
        let height = centre_of_mass(&self.frames()).z;
        0.5 * v.dot(&(mass * v)) + links::total_mass() * GRAVITY * height
    }
}

#[test]
fn the_mass_matrix_is_the_sum_over_the_bodies() {
    let reference = limp();
    let (mass, _) = reference.equations();
    let (expected, _) = reference.by_bodies();
    for i in 0..DEGREES {
        for j in 0..DEGREES {
            let difference = mass[i][j] - expected[(i, j)];
            assert!(difference.abs() < 1e-12, "M[{i}][{j}] off by {difference}");
        }
    }
}

#[test]
fn the_bias_is_that_of_lagrange() {
    // d/dt(M·v) less the gradients of the energies, in coordinates where v is the rate of places: with
    // the base turning not at all, v̇ = 0 and q moving along v, C = Ṁ·v − ½·∂(vᵀMv)/∂q + ∂V/∂q.
    let mut reference = limp();
    for i in 0..3 {
        reference.block.state[row::ANGULAR + i].0[0] = 0.0;
    }
    let (_, bias) = reference.equations();
    let v = SVector::<f64, DEGREES>::from(reference.velocity());
    let h = 1e-6;
    let moved = |direction: &dyn Fn(usize) -> f64| {
        let start = reference.block.clone();
        let mut there = limp();
        there.block = start;
        for i in 0..3 {
            there.block.state[i].0[0] += h * direction(i);
        }
        for i in 0..JOINTS {
            there.block.state[row::JOINT + i].0[0] += h * direction(BASE + i);
        }
        let (mass, _) = there.by_bodies();
        let potential = links::total_mass() * GRAVITY * centre_of_mass(&there.frames()).z;
        (mass, 0.5 * v.dot(&(mass * v)) - potential)
    };
    let (ahead, _) = moved(&|i| v[i]);
    let (behind, _) = moved(&|i| -v[i]);
    let drift = (ahead - behind) / (2.0 * h) * v;
    // Rows of the base's turn have no such coordinates; momentum below covers them.
    for degree in (0..3).chain(BASE..DEGREES) {
        let one = |sign: f64| move |i: usize| if i == degree { sign } else { 0.0 };
        let slope = (moved(&one(1.0)).1 - moved(&one(-1.0)).1) / (2.0 * h);
        let expected = drift[degree] - slope;
        let error = bias[degree] - expected;
        assert!(error.abs() < 1e-5, "C[{degree}] off by {error}");
    }
}

#[test]
fn a_free_robot_keeps_its_momentum_and_its_energy() {
    let mut reference = limp();
    let energy = reference.energy();
    let (_, [linear, angular]) = reference.by_bodies();
    let (steps, dt) = (2_000, 5e-4);
    reference.advance_smoothly(steps, dt);
    let fall = links::total_mass() * GRAVITY * steps as f64 * dt;
    let (_, [linear_after, angular_after]) = reference.by_bodies();
    assert!((linear_after - linear + Vector3::z() * fall).norm() < 1e-8);
    assert!((angular_after - angular).norm() < 1e-8);
    // Gravity's potential is part of the energy, so all of it stays.
    let drift = reference.energy() - energy;
    assert!(drift.abs() < 1e-7 * energy.abs(), "{drift} J of {energy} J");
}

#[test]
fn motors_and_gravity_accelerate_what_they_should() {
    // M·v̇ = τ − C with a torque in the knee alone.
    let mut reference = limp();
    let knee = joints::LEFT_LEG + 3;
    reference.motors.stiffness[knee] = 150.0;
    reference.motors.effort[knee] = 20.0;
    let q = reference.number(row::JOINT + knee);
    reference.targets[knee].0[0] = q + 0.1; // 15 N·m
    let (mass, bias) = reference.equations();
    let acceleration = reference.acceleration();
    for i in 0..DEGREES {
        let inertia: f64 = (0..DEGREES).map(|j| mass[i][j] * acceleration[j]).sum();
        let torque = if i == BASE + knee { 15.0 } else { 0.0 };
        assert!((inertia + bias[i] - torque).abs() < 1e-9, "row {i}");
    }
    reference.targets[knee].0[0] = q + 1.0; // 150 N·m asked, 20 given
    assert_eq!(reference.torque(knee), 20.0);
}
