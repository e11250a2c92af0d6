//! Every term by hand, and that none lies about its reflection.

use super::*;
use crate::table::Table;
use crate::term::Kind;
use crate::{Lot, Truth};
use g1::mirror::{mirror_action, mirror_command, mirror_state};
use g1::{DEFAULT_POSE, JOINTS, RobotState};
use nalgebra::{UnitQuaternion, Vector3};

fn askew() -> RobotState {
    RobotState {
        position: Vector3::new(1.0, 0.3, 0.75),
        orientation: UnitQuaternion::from_euler_angles(0.2, -0.1, 0.5),
        linear_velocity: Vector3::new(0.9, -0.2, 0.1),
        angular_velocity: Vector3::new(0.3, 0.6, -0.4),
        joint_positions: std::array::from_fn(|i| 0.05 * i as f32 - 0.4),
        joint_velocities: std::array::from_fn(|i| (i as f32).sin()),
    }
}

const TRUTH: Truth = Truth {
    friction: 0.6,
    payload: 0.4,
    com_offset: [0.01, 0.02, 0.03],
    foot_forces: [200.0, 5.0],
    push: [0.3, 0.4, 0.0],
    lot: LOT,
};

/// Motors of the left leg 10 % to 15 % too stiff.
const LOT: Lot = {
    let mut stiffness = [1.0; JOINTS];
    let mut i = 0;
    while i < 6 {
        stiffness[i] = 1.1 + 0.01 * i as f32;
        i += 1;
    }
    Lot {
        delays: [0.02, 0.005],
        stiffness,
        down: [0.0, -0.6, -0.8],
        force: [30.0, 40.0, 0.0],
        ..Lot::NOMINAL
    }
};

fn seen(term: &Term, scene: &Scene<'_>) -> Vec<f32> {
    let mut numbers = vec![f32::NAN; term.width()];
    (term.write)(scene, &mut numbers);
    numbers
}

#[test]
fn what_a_mirrored_robot_sees_is_the_reflection_of_what_is_seen() {
    let (command, action) = ([1.0, 0.5, -0.3], std::array::from_fn(|i| i as f32));
    let here = Scene {
        state: &askew(),
        command: &command,
        previous_action: &action,
        truth: &TRUTH,
    };
    let mut mirrored_action = [0.0; JOINTS];
    mirror_action(&action, &mut mirrored_action);
    let turned = |[x, y, z]: [f32; 3]| [x, -y, z];
    let there = Scene {
        state: &mirror_state(&askew()),
        command: &mirror_command(command),
        previous_action: &mirrored_action,
        truth: &Truth {
            com_offset: turned(TRUTH.com_offset),
            foot_forces: [5.0, 200.0],
            push: turned(TRUTH.push),
            lot: Lot {
                stiffness: std::array::from_fn(|i| {
                    if (6..12).contains(&i) {
                        LOT.stiffness[i - 6]
                    } else {
                        1.0
                    }
                }),
                down: turned(LOT.down),
                force: turned(LOT.force),
                ..LOT
            },
            ..TRUTH
        },
    };
    for term in TERMS {
        let (here, there) = (seen(term, &here), seen(term, &there));
        for (i, number) in there.iter().enumerate() {
            let (from, sign) = (term.mirror)(i);
            // Unitree's shoulders differ by 10 µm between the sides, and a hand is a forearm further.
            assert!(
                (number - sign * here[from]).abs() < 1e-4,
                "{} {i}",
                term.name
            );
            let (back, again) = (term.mirror)(from);
            assert_eq!((back, again), (i, sign), "{} {i}", term.name);
        }
    }
}

#[test]
fn names_are_given_once_and_make_keys_of_a_configuration() {
    for (i, term) in TERMS.iter().enumerate() {
        assert!(TERMS[..i].iter().all(|other| other.name != term.name));
        assert!(
            term.name
                .chars()
                .all(|c| c.is_ascii_lowercase() || c == '_')
        );
        assert!(term.width() > 0 && !term.unit.is_empty() && term.name != "actor");
        assert!(std::ptr::eq(named(term.name).unwrap(), *term));
    }
    assert!(named("no_such_term").is_none());
}

#[test]
fn what_only_a_simulation_knows_is_told_by_hand() {
    // Facing left, the push along world x is to the robot's right.
    let state = RobotState {
        orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, std::f32::consts::FRAC_PI_2),
        ..RobotState::standing()
    };
    let scene = Scene {
        truth: &Truth {
            push: [0.5, 0.0, 0.0],
            ..TRUTH
        },
        ..Scene::of(&state)
    };
    let told = |name: &str| seen(named(name).unwrap(), &scene);
    assert_eq!(told("friction"), [0.6]);
    assert_eq!(told("payload"), [0.4]);
    assert_eq!(told("com_offset"), [0.01, 0.02, 0.03]);
    assert_eq!(told("foot_forces"), [200.0, 5.0]);
    assert_eq!(told("contacts"), [1.0, 0.0]); // 5 N is a foot in the air
    let push = told("push");
    assert!(
        push[0].abs() < 1e-6 && (push[1] + 0.5).abs() < 1e-6,
        "{push:?}"
    );
    assert_eq!(told("delays"), [0.02, 0.005]);
    assert_eq!(told("stiffness")[2..7], [1.12, 1.13, 1.14, 1.15, 1.0]);
    assert_eq!(told("damping"), [1.0; JOINTS]);
    // Uphill is at the world's left, ahead of who faces there; so down leans back.
    let near = |name: &str, numbers: [f32; 3]| {
        let told = told(name);
        let off = told.iter().zip(numbers).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f32::max) < 1e-5, "{name}: {told:?}");
    };
    near("slope", [-0.6, 0.0, -0.8]);
    near("force", [40.0, -30.0, 0.0]);
}

#[test]
fn key_bodies_are_where_the_standing_robot_has_them() {
    let points = seen(&bodies::KEY_BODIES, &Scene::of(&RobotState::standing()));
    let [left, right, left_hand, right_hand, head] = [0, 3, 6, 9, 12].map(|i| &points[i..i + 3]);
    // Standing at 0.784 m with ankles 3.5 cm above the soles' lower edge.
    assert!((left[2] + 0.784_202 - 0.035).abs() < 1e-4, "{left:?}");
    assert!(left[1] > 0.05 && right[1] < -0.05 && (left[1] + right[1]).abs() < 1e-5);
    assert!(left_hand[1] > 0.1 && right_hand[1] < -0.1);
    // Above the pelvis, and seen from there wherever the robot is.
    assert!(head[2] > 0.4 && head[1].abs() < 0.01, "{head:?}");
    let mut elsewhere = askew();
    elsewhere.joint_positions = DEFAULT_POSE;
    assert_eq!(seen(&bodies::KEY_BODIES, &Scene::of(&elsewhere)), points);
}

#[test]
fn lists_that_one_function_writes_are_what_their_terms_write() {
    let action = std::array::from_fn(|i| -(i as f32));
    let scene = Scene {
        state: &askew(),
        command: &[1.0, -0.5, 0.25],
        previous_action: &action,
        truth: &TRUTH,
    };
    for (names, write) in TOGETHER {
        let mut together = vec![f32::NAN; Table::plain(names.iter().copied()).width()];
        write(&scene, &mut together);
        let alone = names
            .iter()
            .flat_map(|name| seen(named(name).unwrap(), &scene));
        assert_eq!(together, alone.collect::<Vec<_>>());
    }
}

#[test]
fn a_new_term_is_a_constant_and_every_size_follows() {
    // Nothing but this: no width, no place and no sign of it is said anywhere else.
    static TILT: Term = Term {
        name: "tilt",
        labels: &["forward", "left"],
        write: |scene, out| {
            let down = scene.state.projected_gravity();
            out.copy_from_slice(&[down.x, down.y]);
        },
        mirror: |i| (i, [1.0, -1.0][i]),
        kind: Kind::Gravity,
        unit: "1",
        frame: "base",
        meaning: "",
    };
    let mut entries = Table::plain(["height", "command"]).entries().to_vec();
    entries.insert(
        1,
        crate::Entry {
            past: 2,
            scale: 10.0,
            ..crate::Entry::plain(&TILT)
        },
    );
    let table = Table::of(entries);
    assert_eq!(
        (table.width(), table.frame_width()),
        (1 + 3 * 2 + 3, 1 + 2 + 3)
    );
    let row = table.row(&Scene::of(&askew()));
    assert!((row[1] - 10.0 * askew().projected_gravity().x).abs() < 1e-6);
    assert_eq!(row[1..3], row[5..7]);
    let mirror = table.reflection();
    assert_eq!(mirror.index, (0..10).collect::<Vec<_>>());
    assert_eq!(
        mirror.sign,
        [1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, -1.0]
    );
}
