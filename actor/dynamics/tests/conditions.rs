//! Conditions of single robots: what each does, and that nobody else notices.

use dynamics::{Build, Condition, Ground, Motors, Robots, Solver};
use g1::joints::{RIGHT_ARM, index_of};
use g1::links::total_mass;
use g1::motors::CURVES;
use g1::{DEFAULT_POSE, JOINT_TABLE, JOINTS, RobotState, kinematics};
use pulp::Arch;

const DT: f32 = 0.005;

fn motors() -> Motors<f32> {
    Motors {
        stiffness: JOINT_TABLE.map(|joint| joint.kp as f32),
        damping: JOINT_TABLE.map(|joint| joint.kd as f32),
        effort: JOINT_TABLE.map(|joint| joint.effort as f32),
    }
}

fn solver() -> Solver {
    Solver {
        dt: DT,
        sweeps: 4,
        motors: motors(),
        ground: Ground::Plane,
        self_collision: true,
    }
}

fn limp() -> Condition {
    Condition::nominal(Motors {
        stiffness: [0.0; JOINTS],
        damping: [0.0; JOINTS],
        effort: [0.0; JOINTS],
    })
}

fn high() -> RobotState {
    let mut state = RobotState::standing();
    state.position.z = 10.0;
    state
}

/// One robot high up, under a condition.
fn one(condition: &Condition, state: &RobotState) -> Robots {
    let mut robots = Robots::new(solver(), 1);
    robots.set_state(0, state);
    robots.set_condition(0, Some(condition));
    robots.set_targets(0, &DEFAULT_POSE);
    robots
}

#[test]
fn who_has_none_has_the_same_bits_beside_those_who_have() {
    let run = |conditioned: bool, arch: Arch| {
        let mut robots = Robots::with_arch(solver(), 20, arch);
        for robot in 0..20 {
            robots.set_build(
                robot,
                &Build {
                    torso_mass: 0.1 * robot as f32,
                    ..Build::NOMINAL
                },
            );
            if conditioned && robot % 2 == 1 {
                let own = Condition {
                    curves: Some(CURVES),
                    friction: [0.5; JOINTS],
                    drag: [0.1; JOINTS],
                    gravity: [0.5, 0.2, -9.8],
                    ..Condition::nominal(motors())
                };
                robots.set_condition(robot, Some(&own));
                robots.set_force(robot, [20.0, -30.0, 0.0]);
                robots.set_targets_by_step(robot, &[[0.1; JOINTS], DEFAULT_POSE]);
            } else {
                robots.set_targets(robot, &DEFAULT_POSE);
            }
        }
        for _ in 0..50 {
            robots.advance(4);
        }
        robots
    };
    let (with, without) = (run(true, Arch::new()), run(false, Arch::new()));
    let scalar = run(true, Arch::Scalar);
    for robot in 0..20 {
        let same = with.state(robot) == without.state(robot);
        assert_eq!(same, robot % 2 == 0, "robot {robot}");
        assert_eq!(with.state(robot), scalar.state(robot), "robot {robot}");
        if robot % 2 == 0 {
            assert_eq!(with.effort(robot, 4), without.effort(robot, 4));
        }
    }
}

#[test]
fn targets_of_later_steps_act_in_those() {
    let bent = [0.2; JOINTS];
    let mut together = Robots::new(solver(), 2);
    together.set_targets_by_step(0, &[DEFAULT_POSE, DEFAULT_POSE, bent, bent]);
    together.set_targets(1, &DEFAULT_POSE);
    together.advance(4);
    let mut apart = Robots::new(solver(), 2);
    for robot in 0..2 {
        apart.set_targets(robot, &DEFAULT_POSE);
    }
    apart.advance(2);
    apart.set_targets(0, &bent);
    apart.advance(2);
    for robot in 0..2 {
        assert_eq!(together.state(robot), apart.state(robot));
    }
}

#[test]
fn a_force_gives_its_momentum_to_the_whole_robot() {
    let floating = Condition {
        gravity: [0.0; 3],
        ..limp()
    };
    let mut robots = one(&floating, &high());
    let centre = |robots: &Robots| {
        kinematics::centre_of_mass(&kinematics::forward_state(&robots.state(0))).coords
    };
    robots.set_force(0, [100.0, 50.0, 0.0]);
    robots.advance(4);
    robots.set_force(0, [0.0; 3]);
    let before = centre(&robots);
    robots.advance(20);
    let velocity = (centre(&robots) - before) / (20.0 * DT);
    // 100 N for 20 ms on 32.1 kg: 2 N·s / 32.1 kg = 0.0623 m/s.
    let expected = 100.0 * 0.02 / total_mass() as f32;
    assert!(
        (velocity.x - expected).abs() < 0.02 * expected,
        "{velocity}"
    );
    assert!(
        (velocity.y - 0.5 * expected).abs() < 0.02 * expected,
        "{velocity}"
    );
    assert!(velocity.z.abs() < 0.02 * expected, "{velocity}");
    // Above the pelvis: it pitches the robot forward, and rolls it to the right.
    let turn = robots.state(0).angular_velocity;
    assert!(turn.y > 0.01 && turn.x < -0.01, "{turn}");
}

#[test]
fn gravity_that_leans_pulls_along_the_ground() {
    let (sin, cos) = 0.087_f32.sin_cos();
    let leaning = Condition {
        gravity: [-9.81 * sin, 0.0, -9.81 * cos],
        ..limp()
    };
    let mut robots = one(&leaning, &high());
    robots.advance(40);
    let velocity = robots.state(0).linear_velocity;
    // 0.2 s of 9.81 m/s².
    assert!((velocity.x + 1.962 * sin).abs() < 1e-3, "{velocity}");
    assert!((velocity.z + 1.962 * cos).abs() < 1e-3, "{velocity}");
}

#[test]
fn dry_friction_stops_a_slow_joint_and_turns_none_round() {
    let wrist = RIGHT_ARM + 4;
    let mut state = high();
    state.joint_velocities[wrist] = 1.0;
    let rubbing = |friction: f32, drag: f32| {
        let mut condition = Condition {
            gravity: [0.0; 3],
            ..limp()
        };
        (condition.friction[wrist], condition.drag[wrist]) = (friction, drag);
        let mut robots = one(&condition, &state);
        let mut speeds = Vec::new();
        for _ in 0..40 {
            robots.advance(1);
            speeds.push(robots.state(0).joint_velocities[wrist]);
        }
        assert_eq!(robots.effort(0, 1).energy, 0.0, "no work of a motor");
        speeds
    };
    assert!(rubbing(0.0, 0.0)[39] > 0.95);
    let dry = rubbing(0.2, 0.0);
    assert!(
        dry.windows(2).all(|pair| pair[1] <= pair[0] + 1e-4),
        "{dry:?}"
    );
    // 0.2 N·m against an inertia of some 0.01 kg·m² that goes at 1 rad/s: 50 ms.
    assert!(dry[4] > 0.2 && dry[20].abs() < 0.02, "{dry:?}");
    let drag = rubbing(0.0, 0.1);
    assert!(drag[39] > 0.05 && drag[39] < 0.5, "{drag:?}");
}

#[test]
fn motors_of_its_own_give_what_they_have() {
    let (elbow, knee) = (
        index_of("left_elbow_joint").unwrap(),
        index_of("left_knee_joint").unwrap(),
    );
    let peak = |condition: &Condition, state: &RobotState, joint: usize, ahead: f32| {
        let mut robots = one(condition, state);
        let mut targets = state.joint_positions;
        targets[joint] += ahead;
        robots.set_targets(0, &targets);
        robots.advance(1);
        robots.peaks(0).torques[joint]
    };
    let nominal = Condition::nominal(motors());
    let mut weak = nominal.clone();
    weak.motors.effort = weak.motors.effort.map(|effort| 0.8 * effort);
    // 40 N·m/rad · 2 rad are more than 25 N·m, and than 20.
    assert_eq!(peak(&nominal, &high(), elbow, 2.0), 25.0);
    assert_eq!(peak(&weak, &high(), elbow, 2.0), 20.0);
    let mut soft = nominal.clone();
    soft.motors.stiffness[elbow] *= 0.5;
    let (whole, half) = (
        peak(&nominal, &high(), elbow, 0.1),
        peak(&soft, &high(), elbow, 0.1),
    );
    assert!((half / whole - 0.5).abs() < 0.03, "{half} of {whole}");
    // At 18.6 rad/s the knee has half of its 111 N·m.
    let fading = Condition {
        curves: Some(CURVES),
        ..nominal.clone()
    };
    let mut fast = high();
    fast.joint_velocities[knee] = 18.6;
    assert_eq!(peak(&nominal, &fast, knee, 2.0), 139.0);
    let torque = peak(&fading, &fast, knee, 2.0);
    assert!((torque - 55.5).abs() < 1e-3, "{torque}");
}
