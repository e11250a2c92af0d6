//! The robot against physics that can be worked out: falling, standing, swinging, tumbling.

use super::*;
use crate::model::Variation;
use g1::{DEFAULT_POSE, JOINT_TABLE, LEFT_FOOT, LINK_TABLE};
use nalgebra::UnitQuaternion;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const WEIGHT: f32 = 32.106_857 * GRAVITY; // 314.97 N

fn world(state: &RobotState) -> World {
    let mut world = World::new(&Variation::NOMINAL);
    world.set_state(state);
    world
}

/// Standing, lifted by `height`.
pub(super) fn lifted(height: f32) -> RobotState {
    let mut state = RobotState::standing();
    state.position.z += height;
    state
}

/// Motors that hold the robot up without a policy; no robot has them.
fn stiff() -> Gains {
    let mut gains = Gains::of_the_robot();
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        (gains.stiffness[i], gains.damping[i]) = match joint.name {
            name if name.contains("hip") => (400.0, 4.0),
            name if name.contains("knee") => (600.0, 8.0),
            name if name.contains("ankle") => (320.0, 6.0),
            name if name.contains("waist") => (800.0, 10.0),
            _ => (160.0, 2.0),
        };
        gains.effort[i] = 1e6;
    }
    gains
}

/// Motors without current.
pub(super) fn limp() -> Gains {
    Gains {
        stiffness: [0.0; JOINTS],
        damping: [0.0; JOINTS],
        effort: [0.0; JOINTS],
    }
}

fn rms(a: &[f32], b: &[f32]) -> f32 {
    let sum: f32 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (sum / a.len() as f32).sqrt()
}

#[test]
fn a_state_comes_back_as_it_was_put() {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut draw = |size: f32| size * (2.0 * random.random::<f32>() - 1.0);
    for _ in 0..20 {
        let state = RobotState {
            position: Vector3::new(draw(2.0), draw(2.0), 1.0 + draw(0.2)),
            orientation: UnitQuaternion::from_euler_angles(draw(3.0), draw(1.5), draw(3.0)),
            linear_velocity: Vector3::new(draw(2.0), draw(2.0), draw(2.0)),
            angular_velocity: Vector3::new(draw(3.0), draw(3.0), draw(3.0)),
            joint_positions: std::array::from_fn(|_| draw(1.0)),
            joint_velocities: std::array::from_fn(|_| draw(5.0)),
        };
        let back = world(&state).state();
        assert!((back.position - state.position).norm() < 1e-6);
        assert!(back.orientation.angle_to(&state.orientation) < 1e-3); // f32 acos near 1
        assert!((back.linear_velocity - state.linear_velocity).norm() < 1e-5);
        assert_eq!(back.angular_velocity, state.angular_velocity);
        assert_eq!(back.joint_positions, state.joint_positions);
        assert_eq!(back.joint_velocities, state.joint_velocities);
    }
}

#[test]
fn links_are_where_kinematics_says() {
    let mut state = lifted(0.3);
    state.orientation = UnitQuaternion::from_euler_angles(0.3, -0.2, 0.9);
    for (i, q) in state.joint_positions.iter_mut().enumerate() {
        *q += 0.1 * (i as f32).sin();
    }
    let frames = g1::kinematics::forward_state(&state);
    let world = world(&state);
    for (body, link) in world.multibody().links().enumerate() {
        let offset = model::frame_offset(body).cast::<f32>();
        let pose = link.local_to_world();
        let turn = model::quaternion(pose.rotation);
        let origin = model::vector3(pose.translation) - turn * offset;
        assert!(
            (origin - frames[body].translation.vector).norm() < 2e-6,
            "{body}"
        );
        assert!(
            (turn.inverse() * frames[body].rotation).vector().norm() < 1e-6,
            "{body}"
        );
    }
}

#[test]
fn falls_like_a_stone() {
    // Gravity accelerates every body alike, so a limp robot at rest keeps its pose and falls by
    // ½gt²: 1.22625 m in 0.5 s. Semi-implicit Euler at step h falls ½gt(t + h): 1 % more.
    let mut engine = Engine::new();
    let start = lifted(2.0);
    let mut world = world(&start);
    for step in 1..=100 {
        world.physics_step(&mut engine, &limp(), &DEFAULT_POSE);
        let t = step as f32 * PHYSICS_STEP;
        let fallen = start.position.z - world.state().position.z;
        assert!(
            (fallen - 0.5 * GRAVITY * t * (t + PHYSICS_STEP)).abs() < 1e-4,
            "{step}"
        );
    }
    let state = world.state();
    assert!((start.position.z - state.position.z) / 1.226_25 < 1.0101);
    assert!((state.linear_velocity.z + 4.905).abs() < 1e-3);
    assert!(rms(&state.joint_positions, &start.joint_positions) < 1e-5);
}

#[test]
fn stands_ten_seconds_and_weighs_what_it_weighs() {
    let mut engine = Engine::new();
    let mut world = world(&RobotState::standing());
    let (gains, mut force, mut sides, samples) = (stiff(), 0.0, [0.0; 2], 250);
    for step in 0..500 {
        let exertion = world.control_step(&mut engine, &gains, &DEFAULT_POSE);
        if step >= 500 - samples {
            for (sum, side) in sides.iter_mut().zip(exertion.foot_forces) {
                *sum += side / samples as f32;
                force += side / samples as f32;
            }
        }
    }
    let state = world.state();
    assert!(
        (0.775..0.79).contains(&state.position.z),
        "{}",
        state.position.z
    );
    assert!(state.projected_gravity().z < -0.999);
    assert!((force - WEIGHT).abs() < 0.005 * WEIGHT, "{force} N");
    assert!((sides[0] - sides[1]).abs() < 0.02 * WEIGHT, "{sides:?}");
}

#[test]
fn feet_in_the_air_feel_nothing() {
    let mut engine = Engine::new();
    let mut world = world(&RobotState::standing());
    // Standing first, so that there are contacts to forget.
    world.control_step(&mut engine, &stiff(), &DEFAULT_POSE);
    let stood = world.control_step(&mut engine, &stiff(), &DEFAULT_POSE);
    assert!(stood.foot_forces[0] > 100.0);
    // Jumping off at 1 m/s, 5 cm are reached after 0.1 s.
    world.push(Vector3::new(0.0, 0.0, 1.0));
    for step in 0..5 {
        let exertion = world.control_step(&mut engine, &stiff(), &DEFAULT_POSE);
        assert_eq!(exertion.foot_forces, [0.0; 2], "step {step}");
    }
    let frames = g1::kinematics::forward_state(&world.state());
    assert!(g1::kinematics::lowest_foot_point(&frames) > 0.04);
}

#[test]
fn position_control_in_the_air_agrees_with_fine_steps() {
    // The same motion at 5 ms and at 0.1 ms; MuJoCo's implicit integrator is off by 0.0006 and
    // 0.0004 rad at 0.2 and 0.5 s for the same comparison.
    let targets = std::array::from_fn(|i| DEFAULT_POSE[i] + if i % 2 == 0 { 0.2 } else { -0.2 });
    let gains = Gains::of_the_robot();
    let mut coarse = world(&lifted(3.0));
    let mut fine = coarse.clone();
    let (mut coarse_engine, mut fine_engine) = (Engine::new(), Engine::with_step(1e-4));
    for (coarse_steps, bound) in [(40, 1.5e-3), (60, 1e-3)] {
        for _ in 0..coarse_steps {
            coarse.physics_step(&mut coarse_engine, &gains, &targets);
            for _ in 0..50 {
                fine.physics_step(&mut fine_engine, &gains, &targets);
            }
        }
        let error = rms(
            &coarse.state().joint_positions,
            &fine.state().joint_positions,
        );
        assert!(error < bound, "{error} rad");
    }
}

/// Kinetic energy of the bodies and rotors plus potential energy, J.
fn mechanical_energy(world: &World) -> f64 {
    let multibody = world.multibody();
    let velocity = multibody.generalized_velocity();
    let mut energy = 0.0;
    for (body, link) in multibody.links().enumerate() {
        let moving = multibody.body_jacobian(body) * velocity;
        let of_com = moving.fixed_rows::<3>(0).into_owned().cast::<f64>();
        let turn = model::quaternion(link.local_to_world().rotation).cast::<f64>();
        let spin = turn.inverse() * moving.fixed_rows::<3>(3).into_owned().cast::<f64>();
        let [xx, yy, zz, xy, xz, yz] = LINK_TABLE[body].inertia;
        let inertia = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let com = Vector3::from(LINK_TABLE[body].com) - model::frame_offset(body);
        let height = f64::from(link.local_to_world().translation.z) + (turn * com).z;
        energy += 0.5 * LINK_TABLE[body].mass * of_com.norm_squared()
            + 0.5 * spin.dot(&(inertia * spin))
            + LINK_TABLE[body].mass * f64::from(GRAVITY) * height;
    }
    for (joint, speed) in JOINT_TABLE.iter().zip(velocity.iter().skip(BASE_DEGREES)) {
        energy += 0.5 * joint.armature * f64::from(*speed).powi(2);
    }
    energy
}

#[test]
fn a_passive_tumble_keeps_its_energy() {
    let mut start = lifted(5.0);
    start.linear_velocity = Vector3::new(1.0, 0.5, 2.0);
    start.angular_velocity = Vector3::new(2.0, -1.5, 1.0);
    for (i, speed) in start.joint_velocities.iter_mut().enumerate() {
        *speed = match i {
            3 | 9 => 2.0,           // knees, away from their stops
            4 | 5 | 10 | 11 => 0.0, // ankles, close to theirs
            _ => 2.0 * (i as f32).cos(),
        };
    }
    let drift = |step: f32| {
        let mut engine = Engine::with_step(step);
        let mut world = world(&start);
        let before = mechanical_energy(&world);
        for _ in 0..(0.2 / step).round() as usize {
            world.physics_step(&mut engine, &limp(), &DEFAULT_POSE);
            for (q, joint) in world.state().joint_positions.iter().zip(&JOINT_TABLE) {
                // A stop takes energy; this is a test without.
                assert!(
                    *q > joint.lower as f32 && *q < joint.upper as f32,
                    "{}",
                    joint.name
                );
            }
        }
        (mechanical_energy(&world) - before).abs() as f32
    };
    // A first-order integrator's drift goes with its step (semi-implicit Euler alone loses
    // ½·m·g²·t·h = 1.5 J to gravity at 5 ms). A rest that does not go would be damping or a wrong
    // force: rapier's default damping of 0.1 takes 0.1·Σq̇²·t, about 0.8 J, at any step.
    let (coarse, fine) = (drift(5e-3), drift(5e-4));
    assert!(coarse < 2.5, "{coarse} J at 5 ms");
    assert!(
        (10.0 * fine - coarse).abs() < 0.02 * coarse,
        "{coarse} J and {fine} J"
    );
}

#[test]
fn joints_stop_at_their_limits() {
    let mut engine = Engine::new();
    let mut world = world(&lifted(3.0));
    let mut targets = DEFAULT_POSE;
    targets[3] = -1.5; // left knee, stretched beyond its stop at −0.087 rad
    targets[16] = 3.5; // left elbow, bent beyond its stop at 2.094 rad
    let (mut knee, mut elbow) = (f32::MAX, f32::MIN);
    for _ in 0..40 {
        world.control_step(&mut engine, &Gains::of_the_robot(), &targets);
        let q = world.state().joint_positions;
        (knee, elbow) = (knee.min(q[3]), elbow.max(q[16]));
    }
    let beyond = (-0.087_267 - knee).max(elbow - 2.0944);
    assert!(beyond < 0.25, "{beyond} rad beyond a stop"); // MuJoCo: 0.2 to 0.56 in like tests
    // They bounce off, so where they are at the end is chance; that they got there is not.
    assert!(
        knee < -0.08 && elbow > 2.08,
        "the motors did push: {knee} {elbow}"
    );
}

#[test]
fn a_template_gives_the_bits_of_a_fresh_world() {
    let variation = Variation {
        torso_mass: 0.3,
        torso_com: [0.05, -0.02, 0.01],
        friction: 0.7,
    };
    let template = World::new(&Variation::NOMINAL);
    // One engine for both and for a third robot between their steps: engines carry no state.
    let mut engine = Engine::new();
    let mut fresh = World::new(&variation);
    let mut cloned = World::from_template(&template, &variation);
    let mut other = World::from_template(&template, &Variation::NOMINAL);
    let mut start = lifted(0.01);
    start.linear_velocity.x = 0.5;
    fresh.set_state(&start);
    cloned.set_state(&start);
    other.set_state(&lifted(0.02));
    let gains = Gains::of_the_robot();
    for step in 0..100 {
        let a = fresh.control_step(&mut Engine::new(), &gains, &DEFAULT_POSE);
        let b = cloned.control_step(&mut engine, &gains, &DEFAULT_POSE);
        other.control_step(&mut engine, &gains, &DEFAULT_POSE);
        assert_eq!(a, b, "step {step}");
        assert_eq!(fresh.state(), cloned.state(), "step {step}");
    }
    assert_ne!(cloned.state(), other.state());
}

#[test]
fn a_push_changes_the_velocity_by_itself() {
    let mut world = world(&lifted(1.0));
    world.push(Vector3::new(0.4, -0.3, 0.0));
    let state = world.state();
    assert!((state.linear_velocity - Vector3::new(0.4, -0.3, 0.0)).norm() < 1e-6);
    assert_eq!(state.angular_velocity, Vector3::zeros());
}

#[test]
fn friction_decides_whether_the_robot_slides() {
    // Stiff and standing, sliding at 1 m/s: Coulomb friction brakes at μ·g, so after 0.1 s the feet
    // have lost about 0.1·μ·9.81 m/s.
    let slide = |friction: f32| {
        let mut world = World::new(&Variation {
            friction,
            ..Variation::NOMINAL
        });
        let mut start = RobotState::standing();
        start.linear_velocity.y = 1.0;
        world.set_state(&start);
        let mut engine = Engine::new();
        for _ in 0..5 {
            world.control_step(&mut engine, &stiff(), &DEFAULT_POSE);
        }
        let state = world.state();
        let frames = g1::kinematics::forward_state(&state);
        frames[LEFT_FOOT].translation.y
    };
    assert!(slide(0.0) > slide(0.5) + 0.01);
    assert!(slide(0.5) > slide(1.0) + 0.003);
}

#[test]
fn broken_numbers_are_noticed() {
    let mut engine = Engine::new();
    let mut world = world(&lifted(0.5));
    assert!(world.is_sound());
    let mut state = lifted(0.5);
    state.joint_velocities[4] = f32::NAN;
    world.set_state(&state);
    world.control_step(&mut engine, &Gains::of_the_robot(), &DEFAULT_POSE);
    assert!(!world.is_sound());
}
