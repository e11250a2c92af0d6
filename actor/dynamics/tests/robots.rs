//! Robots of the solver as a user sees them: they stand, weigh what they weigh, and do not know each other.

use dynamics::{Build, Ground, Motors, Robots, Solver};
use g1::{DEFAULT_POSE, JOINT_TABLE, RobotState};
use nalgebra::Vector3;
use pulp::Arch;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// 32.10685728 kg · 9.81 m/s².
const WEIGHT: f32 = 314.968;

fn solver() -> Solver {
    Solver {
        dt: 0.005,
        sweeps: 4,
        motors: Motors {
            stiffness: JOINT_TABLE.map(|joint| joint.kp as f32),
            damping: JOINT_TABLE.map(|joint| joint.kd as f32),
            effort: JOINT_TABLE.map(|joint| joint.effort as f32),
        },
        ground: Ground::Plane,
        self_collision: true,
    }
}

/// Gains that hold the robot up without a policy.
fn stiff() -> Solver {
    let mut solver = solver();
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        let gains = [
            ("hip", (400.0, 4.0)),
            ("knee", (600.0, 8.0)),
            ("ankle", (320.0, 6.0)),
            ("waist", (800.0, 10.0)),
        ];
        let of_name = |(part, _): &&(&str, _)| joint.name.contains(*part);
        let (kp, kd) = gains.iter().find(of_name).map_or((160.0, 2.0), |g| g.1);
        solver.motors.stiffness[i] = kp;
        solver.motors.damping[i] = kd;
    }
    solver
}

#[test]
fn a_stiff_robot_stands_for_ten_seconds_and_weighs_what_it_weighs() {
    let mut robots = Robots::new(stiff(), 1);
    robots.set_targets(0, &DEFAULT_POSE);
    robots.advance(2_000);
    robots.advance(200);
    let force: f32 = robots.effort(0, 200).foot_forces.iter().sum();
    assert!((force - WEIGHT).abs() < 0.005 * WEIGHT, "{force} N");
    let z = robots.state(0).position.z;
    assert!((z - 0.783).abs() < 0.002, "{z} m"); // MuJoCo .7823, rapier .7829
}

#[test]
fn nothing_but_gravity_acts_in_the_air() {
    let mut solver = solver();
    solver.motors.stiffness = [0.0; 23];
    solver.motors.damping = [0.0; 23];
    let mut robots = Robots::new(solver, 1);
    let mut state = RobotState::standing();
    state.position.z = 10.0;
    robots.set_state(0, &state);
    robots.advance(100);
    // Semi-implicit: z − g·dt²·n(n+1)/2 after n steps of dt.
    let fallen = 10.0 - robots.state(0).position.z;
    assert!(
        (fallen - 9.81 * 0.005 * 0.005 * 5_050.0).abs() < 1e-4,
        "{fallen}"
    );
    assert_eq!(robots.effort(0, 100).energy, 0.0);
}

/// Robots of different make under random targets and pushes.
fn wild(arch: Arch, count: usize) -> Robots {
    let mut robots = Robots::with_arch(solver(), count, arch);
    for robot in 0..count {
        // A robot's own numbers, whatever its place.
        let mut random = Pcg64Mcg::seed_from_u64(robot as u64);
        robots.set_build(
            robot,
            &Build {
                torso_mass: random.random_range(-1.0..3.0),
                torso_com: [random.random_range(-0.05..0.05), 0.0, 0.0],
                friction: random.random_range(0.3..1.2),
            },
        );
    }
    for step in 0..50 {
        for robot in 0..count {
            let mut random = Pcg64Mcg::seed_from_u64((1_000 * step + robot) as u64);
            let mut targets = DEFAULT_POSE;
            for target in &mut targets {
                *target += random.random_range(-0.6..0.6_f32);
            }
            robots.set_targets(robot, &targets);
            if step == 20 {
                robots.push(robot, Vector3::new(0.5, -0.5, 0.0));
            }
        }
        robots.advance(4);
    }
    robots
}

#[test]
fn vectors_of_every_width_give_the_same_bits() {
    let widest = wild(Arch::new(), 33);
    let single = wild(Arch::Scalar, 33);
    for robot in 0..33 {
        assert_eq!(widest.state(robot), single.state(robot), "robot {robot}");
        assert_eq!(widest.effort(robot, 4), single.effort(robot, 4));
    }
    #[cfg(target_arch = "x86_64")]
    if let Some(v3) = pulp::x86::V3::try_new() {
        let eight = wild(Arch::V3(v3), 33);
        for robot in 0..33 {
            assert_eq!(eight.state(robot), single.state(robot), "robot {robot}");
        }
    }
}

#[test]
fn neighbours_do_not_matter() {
    let many = wild(Arch::new(), 20);
    let few = wild(Arch::new(), 3);
    for robot in 0..3 {
        assert_eq!(many.state(robot), few.state(robot));
    }
}

#[test]
fn wild_targets_and_hard_pushes_break_nothing() {
    let mut robots = Robots::new(solver(), 128);
    let mut random = Pcg64Mcg::seed_from_u64(1);
    for step in 0..1_000 {
        for robot in 0..128 {
            if step % 10 == 0 {
                let mut targets = DEFAULT_POSE;
                for target in &mut targets {
                    *target += random.random_range(-2.5..2.5_f32);
                }
                robots.set_targets(robot, &targets);
            }
            if (step + robot) % 100 == 0 {
                let mut push = || random.random_range(-2.0..2.0_f32);
                let change = Vector3::new(push(), push(), 0.0);
                robots.push(robot, change);
            }
        }
        robots.advance(4);
    }
    for robot in 0..128 {
        assert!(robots.is_sound(robot), "robot {robot}");
        let z = robots.state(robot).position.z;
        assert!((0.0..3.0).contains(&z), "robot {robot} at {z} m");
    }
}

#[test]
fn numbers_that_cannot_be_used_are_told_from_those_of_the_neighbours() {
    let mut robots = Robots::new(solver(), 20);
    let broken = |change: fn(&mut RobotState)| {
        let mut state = RobotState::standing();
        change(&mut state);
        state
    };
    robots.set_state(
        3,
        &broken(|state| state.joint_velocities[2] = f32::INFINITY),
    );
    robots.set_state(9, &broken(|state| state.position.x = f32::NAN));
    robots.set_state(17, &broken(|state| state.linear_velocity.z = 2_000.0));
    for robot in 0..20 {
        robots.set_targets(robot, &DEFAULT_POSE);
    }
    robots.advance(1);
    let unsound: Vec<_> = (0..20).filter(|&robot| !robots.is_sound(robot)).collect();
    assert_eq!(unsound, [3, 9, 17]);
}

#[test]
fn a_saved_fleet_goes_on_bit_by_bit() {
    let mut robots = wild(Arch::new(), 5);
    let saved = robots.save();
    let mut other = Robots::new(solver(), 5);
    assert!(other.restore(saved.clone()));
    for robot in 0..5 {
        other.set_targets(robot, &DEFAULT_POSE);
        robots.set_targets(robot, &DEFAULT_POSE);
    }
    robots.advance(40);
    other.advance(40);
    for robot in 0..5 {
        assert_eq!(robots.state(robot), other.state(robot));
    }
    assert!(!Robots::new(solver(), 6).restore(saved));
}

/// A robot high up whose legs are held against each other.
fn pressed(solver: Solver, count: usize, arch: Arch) -> Robots {
    let mut robots = Robots::with_arch(solver, count, arch);
    for robot in 0..count {
        let mut state = RobotState::standing();
        state.position.z = 20.0;
        // Every third one stays apart.
        let turn = if robot % 3 == 2 {
            0.0
        } else {
            0.12 + 0.003 * robot as f32
        };
        (state.joint_positions[1], state.joint_positions[7]) = (-turn, turn);
        robots.set_state(robot, &state);
        let mut targets = DEFAULT_POSE;
        (targets[1], targets[7]) = (-2.0 * turn, 2.0 * turn);
        robots.set_targets(robot, &targets);
    }
    robots.advance(40);
    robots
}

#[test]
fn parts_that_meet_have_the_same_bits_at_every_width_and_beside_every_neighbour() {
    let (widest, single) = (
        pressed(solver(), 20, Arch::new()),
        pressed(solver(), 20, Arch::Scalar),
    );
    let few = pressed(solver(), 2, Arch::new());
    let mut without = solver();
    without.self_collision = false;
    let passing = pressed(without, 20, Arch::new());
    for robot in 0..20 {
        assert_eq!(widest.state(robot), single.state(robot), "robot {robot}");
        let apart = robot % 3 == 2;
        let same = widest.state(robot) == passing.state(robot);
        assert_eq!(same, apart, "robot {robot}");
        let gap = g1::collision::nearest(&widest.state(robot)).1;
        assert!(gap > -0.01, "robot {robot}: {gap} m");
    }
    for robot in 0..2 {
        assert_eq!(few.state(robot), widest.state(robot), "robot {robot}");
    }
}

#[test]
fn a_fleet_saved_while_parts_meet_goes_on_bit_by_bit() {
    let mut robots = pressed(solver(), 4, Arch::new());
    let mut other = Robots::new(solver(), 4);
    assert!(other.restore(robots.save()));
    let mut targets = DEFAULT_POSE;
    (targets[1], targets[7]) = (-0.3, 0.3);
    for fleet in [&mut robots, &mut other] {
        for robot in 0..4 {
            fleet.set_targets(robot, &targets);
        }
        fleet.advance(40);
    }
    for robot in 0..4 {
        assert!(g1::collision::nearest(&robots.state(robot)).1 < 0.005);
        assert_eq!(robots.state(robot), other.state(robot));
    }
}
