//! Legs in the air against each other, in double precision: nothing else acts on them there.

use super::*;
use crate::block::{Block, Row};
use crate::contact;
use crate::drive::Motors;
use crate::ground::Ground;
use crate::group::Group;
use crate::reference::Reference;
use crate::robots::Solver;
use g1::collision::gap;
use g1::{JOINTS, RobotState, kinematics};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Rolls of the hips: the left one's negative side is inward, the right one's positive.
const ROLLS: [usize; 2] = [1, 7];

/// Motors that push with a torque or not at all, robots whose parts meet or do not.
fn solver(stiffness: f32, self_collision: bool) -> Solver {
    Solver {
        dt: 0.005,
        sweeps: 20,
        motors: Motors {
            stiffness: [stiffness; JOINTS],
            damping: [stiffness / 50.0; JOINTS],
            effort: [100.0; JOINTS],
        },
        ground: Ground::Plane,
        self_collision,
    }
}

/// A robot far above the ground with its legs rolled inward by an angle and at a speed.
fn inward(angle: f32, speed: f32) -> RobotState {
    let mut state = RobotState::standing();
    state.position.z = 20.0;
    for (joint, sign) in ROLLS.into_iter().zip([-1.0, 1.0]) {
        state.joint_positions[joint] = sign * angle;
        state.joint_velocities[joint] = sign * speed;
    }
    state
}

fn limp(state: &RobotState, self_collision: bool) -> Reference {
    let solver = solver(0.0, self_collision);
    let mut robot = Reference::new(&solver, solver.sweeps);
    robot.set_state(state);
    robot
}

/// The least gap of all pairs and where in the table it is, m.
fn least(state: &RobotState) -> (usize, f32) {
    g1::collision::nearest(state)
}

/// The roll at which the legs, straight down otherwise, just touch: the gap falls steadily with it.
fn touching_roll() -> f32 {
    let (mut apart, mut within) = (0.0, 0.4);
    for _ in 0..40 {
        let middle = 0.5 * (apart + within);
        if least(&inward(middle, 0.0)).1 > 0.0 {
            apart = middle;
        } else {
            within = middle;
        }
    }
    apart
}

/// Momentum and angular momentum about the pelvis' origin, and kinetic energy, by the mass matrix.
fn momentum(robot: &Reference) -> ([f64; 6], f64) {
    let (mass, _) = robot.equations();
    let v = robot.velocity();
    // Reflected rotor inertia is on the joints' diagonal only: it is no part of the base's rows.
    let row = |i: usize| -> f64 { (0..DEGREES).map(|j| mass[i][j] * v[j]).sum() };
    let energy = (0..DEGREES).map(|i| 0.5 * v[i] * row(i)).sum();
    (std::array::from_fn(row), energy)
}

#[test]
fn nearest_points_are_those_of_geometry() {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let tree = contact::tree::<f64>(true);
    let mut group = Group::<f64>::new(());
    let mut walk = Walk::new(());
    let mut block = Block::<f64>::new();
    for _ in 0..300 {
        let mut state = RobotState::standing();
        for q in &mut state.joint_positions {
            *q += random.random_range(-0.8..0.8_f32);
        }
        block.set_state(0, &state);
        group.load((), &block, &[Row::default(); JOINTS], None, 0);
        walk.run((), &tree, &group);
        let bodies = kinematics::forward_state(&state);
        for pair in 0..PAIRS {
            let (ours, theirs) = (nearest((), &tree, &walk, pair), gap(&bodies, pair));
            let error = (ours.distance - f64::from(theirs.distance)).abs();
            assert!(error < 5e-4, "pair {pair}: {error} m");
        }
    }
}

#[test]
fn what_is_passed_over_is_at_least_the_margin_apart() {
    let mut random = Pcg64Mcg::seed_from_u64(8);
    let tree = contact::tree::<f64>(true);
    let touch = Touch {
        token: (),
        tree: &tree,
        ground: &Ground::Plane,
        dt: 0.005,
        friction: 1.0,
    };
    let mut group = Group::<f64>::new(());
    let mut walk = Walk::new(());
    let mut block = Block::<f64>::new();
    let (mut near, mut over) = (0, [0; PAIRS]);
    for _ in 0..2_000 {
        let mut state = RobotState::standing();
        for q in &mut state.joint_positions {
            *q += random.random_range(-0.8..0.8_f32);
        }
        block.set_state(0, &state);
        group.load((), &block, &[Row::default(); JOINTS], None, 0);
        walk.run((), &tree, &group);
        let bodies = kinematics::forward_state(&state);
        let reach = across(&touch, &walk);
        for (pair, &[a, b]) in PAIR_TABLE.iter().enumerate() {
            let distance = gap(&bodies, pair).distance;
            let [plane, middle] = [reach[a].0 < reach[b].1, beside(&touch, &walk, pair)];
            // 3 cm are what 6 m/s cover in 5 ms; single precision is off by less than 1e-5 m.
            if distance < 0.03 - 1e-5 {
                near += 1;
                assert!(
                    plane && middle,
                    "pair {pair} at {distance} m: {plane} {middle}"
                );
            }
            over[pair] += usize::from(!middle);
        }
    }
    assert!(near > 500, "{near} near pairs are too few to tell");
    // A forearm is above the thigh on its side in nearly every pose: the plane cannot tell, the middle does.
    for pair in [11, 14] {
        assert!(over[pair] > 1_000, "pair {pair}: {}", over[pair]);
    }
}

#[test]
fn what_is_apart_is_as_if_it_could_not_meet() {
    let run = |self_collision| {
        let mut robot = limp(&inward(0.02, 0.0), self_collision);
        robot.advance(1, 0.005);
        robot.velocity()
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn legs_within_each_other_part_and_nothing_else_of_the_robot_is_pushed() {
    let state = inward(touching_roll() + 0.02, 0.0);
    assert!(least(&state).1 < -0.005);
    let after = |self_collision| {
        let mut robot = limp(&state, self_collision);
        robot.advance(1, 0.005);
        robot
    };
    let (meeting, passing) = (after(true), after(false));
    let (with, without) = (meeting.velocity(), passing.velocity());
    let [left, right] = ROLLS.map(|joint| with[BASE + joint] - without[BASE + joint]);
    assert!(left > 0.05, "{left} rad/s outward");
    // A mirrored pose: what one leg gets the other gets mirrored, and the pelvis neither turns nor goes aside.
    assert!((left + right).abs() < 1e-3 * left, "{left} {right}");
    // Equal and opposite impulses at one point: the robot as a whole moves as before. The places differ by
    // dt times the velocities, which is what the mass matrices differ by.
    let of = |robot: &Reference| momentum(robot).0;
    for (a, b) in of(&meeting).into_iter().zip(of(&passing)) {
        assert!((a - b).abs() < 2e-3, "{a} {b}");
    }
}

#[test]
fn an_impulse_of_one_pair_leaves_no_momentum_of_its_own() {
    // Jᵀ on the base is n − n and p×n − p×n: not a rounding of it is left.
    let state = inward(touching_roll() + 0.02, 0.0);
    let tree = contact::tree::<f64>(true);
    let (mut block, mut group) = (Block::<f64>::new(), Group::<f64>::new(()));
    block.set_state(0, &state);
    group.load((), &block, &[Row::default(); JOINTS], None, 0);
    let mut walk = Walk::new(());
    walk.run((), &tree, &group);
    // With a mass matrix of one, ζ is the generalised force itself.
    let (mut trunk, mut limbs) = (walk.trunk, walk.limbs);
    trunk.iter_mut().flatten().for_each(|x| *x = 0.0);
    limbs.iter_mut().flatten().flatten().for_each(|x| *x = 0.0);
    let factor = Factor {
        trunk: &trunk,
        limbs: &limbs,
        root: &[1.0; DEGREES],
    };
    let touch = Touch {
        token: (),
        tree: &tree,
        ground: &Ground::Plane,
        dt: 0.005,
        friction: 1.0,
    };
    let mut pairs = Pairs::none(0.0);
    pairs.find(&touch, &walk, factor);
    assert!(pairs.count() > 0);
    let bodies = kinematics::forward_state(&state);
    for meeting in &pairs.list[..pairs.count()] {
        assert_eq!(meeting.y[..BASE], [0.0; BASE]);
    }
    // The push of the nearest pair turns the left hip outward by the lever of its axis: n·(axis × arm).
    let (pair, distance) = least(&state);
    let found = pairs.list[..pairs.count()]
        .iter()
        .map(|meeting| meeting.y[BASE + ROLLS[0]])
        .fold(0.0, f64::max);
    let normal = gap(&bodies, pair).normal;
    let axis = bodies[ROLLS[0] + 1].rotation * nalgebra::Vector3::x();
    let at = nearest((), &tree, &walk, pair).at;
    let arm = nalgebra::Vector3::new(at.x as f32, at.y as f32, at.z as f32) + state.position
        - bodies[ROLLS[0] + 1].translation.vector;
    let lever = f64::from(normal.dot(&axis.cross(&arm)));
    assert!(distance < 0.0 && lever > 0.3, "{distance} m, {lever} m");
    assert!((found - lever).abs() < 0.02 * lever, "{found} {lever}");
}

#[test]
fn a_blow_takes_energy_and_gives_none() {
    // Legs swing inward at 3 rad/s; gravity does nothing between them, for the whole robot falls.
    let roll = touching_roll() - 0.05;
    let mut robot = limp(&inward(roll, 3.0), true);
    let speed = |robot: &Reference| robot.velocity()[BASE + ROLLS[0]];
    let mut blown = false;
    // The energy of motion within the robot: that of its fall is v·p − m·v²/2 less.
    let own = |robot: &Reference| {
        let (momentum, energy) = momentum(robot);
        let mass = g1::links::total_mass();
        let fall: f64 = momentum[..3].iter().map(|p| p * p).sum();
        energy - fall / (2.0 * mass)
    };
    let mut before = own(&robot);
    let first = before;
    for _ in 0..200 {
        robot.advance(1, 0.0005);
        let after = own(&robot);
        // Motion on curved paths at a fixed step keeps energy to a few thousandths.
        assert!(after < before + 2e-3 * first, "{before} J to {after} J");
        before = after;
        blown |= speed(&robot) > -0.5;
        // 6 rad/s between them at the 0.7 m of a leg's length are 4.2 m/s, and the critically damped return with
        // its 19 ms lets v·τ/e of that through.
        let (_, gap) = least(&robot.state());
        assert!(gap > -0.03, "{gap} m");
    }
    assert!(blown, "the legs met");
    assert!(before < 0.9 * first, "{first} J to {before} J");
}

#[test]
fn legs_that_are_driven_into_each_other_stop_at_each_other() {
    let solver = solver(100.0, true);
    let mut targets = RobotState::standing().joint_positions;
    for (joint, sign) in ROLLS.into_iter().zip([-1.0, 1.0]) {
        targets[joint] = sign * 0.5;
    }
    let least_after = |self_collision: bool| {
        let mut robot = Reference::new(
            &Solver {
                self_collision,
                ..solver.clone()
            },
            solver.sweeps,
        );
        robot.set_state(&inward(0.0, 0.0));
        robot.set_targets(&targets);
        robot.advance(200, 0.005);
        least(&robot.state()).1
    };
    // Some 50 N·m at 0.5 m is 100 N; that and no more than the last millimetres of the skin give way.
    assert!(least_after(true) > -0.004, "{} m", least_after(true));
    assert!(least_after(false) < -0.05, "{} m", least_after(false));
}
