//! Archives of a walking G1 and of a standing human, and others.

use super::*;
use crate::gait;
use crate::import::file::torch::tests::Archive;
use crate::import::human;
use crate::import::human::tests::STANDING;
use g1::kinematics::forward_state;
use std::path::Path;

/// What every such file begins with.
const LABEL: &[u8] = b"cprotomotions.simulator.base_simulator.simulator_state\nStateConversion\nX\x06\0\0\0common\x85R";

/// The built-in walk as a G1 of 33 bodies, of which pelvis and feet are where they are; the joints stand
/// behind the seven numbers of the root, as they are saved.
pub(in crate::import) fn walk(names: &[&str]) -> Vec<u8> {
    let (mut rows, mut places, mut turns) = (Vec::new(), Vec::new(), Vec::new());
    let states = gait::walk(1.0).unwrap().frames;
    let ours = joints::ours();
    for state in &states {
        let bodies = forward_state(state);
        rows.extend([9.0; 7]);
        rows.extend(names.iter().map(|name| {
            let joint = ours.iter().position(|ours| ours == name);
            joint.map_or(0.0, |j| f64::from(state.joint_positions[j]))
        }));
        for body in 0..33 {
            let ours = match body {
                7 => LEFT_FOOT,
                13 => RIGHT_FOOT,
                _ => 0,
            };
            places.extend(
                bodies[ours]
                    .translation
                    .vector
                    .iter()
                    .map(|x| f64::from(*x)),
            );
            let q = bodies[ours].rotation;
            turns.extend([q.i, q.j, q.k, q.w].map(f64::from));
        }
    }
    let t = states.len();
    Archive::new()
        .value("state_conversion", LABEL)
        .value("fps", b"K\x32")
        .slice("dof_pos", &[t, names.len()], &rows, 7, 7 + names.len())
        .tensor("rigid_body_pos", &[t, 33, 3], &places)
        .tensor("rigid_body_rot", &[t, 33, 4], &turns)
        .done()
}

fn told(bytes: &[u8]) -> Result<(Motion, Vec<String>), String> {
    let file = File {
        path: Path::new("walk.motion"),
        bytes,
    };
    let mut decisions = Vec::new();
    let (motion, fps) = read(&file, &mut decisions).map_err(|e| e.to_string())?;
    // A library keeps seconds, as float32.
    assert!((fps.unwrap() - 50.0).abs() < 1e-5);
    Ok((motion, decisions))
}

#[test]
fn a_g1_is_read_and_its_feet_are_checked() {
    for names in [&joints::SDK_29[..], &joints::ours()] {
        let (Motion::Robot(rows, Sure::Yes), _) = told(&walk(names)).unwrap() else {
            panic!("it is a G1");
        };
        for (row, state) in rows.iter().zip(gait::walk(1.0).unwrap().frames) {
            for (a, b) in row.joints.iter().zip(state.joint_positions) {
                assert!((a - f64::from(b)).abs() < 1e-6);
            }
            assert!(row.orientation.cast::<f32>().angle_to(&state.orientation) < 1e-3);
        }
    }
    // In Isaac Lab's order the feet are elsewhere.
    let message = told(&walk(&joints::ISAAC_29)).unwrap_err();
    assert!(message.contains("feet of a G1"), "{message}");
}

/// A human that stands, facing x, z up: places of the bodies that are given, the others at the hips.
fn standing(bodies: usize, at: &[usize; 14], frames: usize, library: bool) -> Vec<u8> {
    let mut frame = [0.0, 0.0, 0.95].repeat(bodies);
    for ((_, place), body) in STANDING.iter().zip(at) {
        frame[3 * body..3 * body + 3].copy_from_slice(place);
    }
    let turns = [0.0, 0.0, 0.0, 1.0].repeat(bodies * frames);
    let (places, rotations) = if library {
        ("gts", "grs")
    } else {
        (BODIES[0], TURNS[0])
    };
    let archive = Archive::new()
        .tensor(places, &[frames, bodies, 3], &frame.repeat(frames))
        .tensor(rotations, &[frames, bodies, 4], &turns);
    if library {
        archive
            .tensor("motion_num_frames", &[1], &[frames as f64])
            .tensor("motion_dt", &[1], &[0.02])
    } else {
        archive.value("fps", b"K\x32")
    }
    .done()
}

/// Where hip, knee, ankle, toe, shoulder, elbow and wrist stand in the models, left then right.
const SMPL_AT: [usize; 14] = [1, 2, 3, 4, 15, 16, 17, 5, 6, 7, 8, 20, 21, 22];
const SMPLX_AT: [usize; 14] = [1, 2, 3, 4, 15, 16, 17, 5, 6, 7, 8, 34, 35, 36];
const SOMA_AT: [usize; 14] = [19, 20, 21, 22, 12, 13, 14, 15, 16, 17, 18, 8, 9, 10];

#[test]
fn humans_are_known_by_the_count_of_their_bodies() {
    let file = File {
        path: Path::new("x"),
        bytes: b"",
    };
    for (bodies, at) in [(24, SMPL_AT), (52, SMPLX_AT), (23, SOMA_AT)] {
        for library in [false, true] {
            let (Motion::Human(joints), _) = told(&standing(bodies, &at, 4, library)).unwrap()
            else {
                panic!("it is a human");
            };
            let capture = human::capture(&file, &joints, 50.0, &mut Vec::new()).unwrap();
            for (point, (name, place)) in capture.frames[3].0.iter().zip(STANDING) {
                assert!(
                    (point.coords - Vector3::from(place)).norm() < 1e-6,
                    "{bodies} {name}: {point}"
                );
            }
        }
    }
    let message = told(&standing(30, &SMPL_AT, 2, false)).unwrap_err();
    assert!(
        message.contains("[2, 30, 3]") && message.contains("SOMA"),
        "{message}"
    );
}

#[test]
fn the_amp_humanoid_has_feet_but_no_toes() {
    // Arms from the 4th and the 7th body on, legs from the 10th and the 13th; feet point along x.
    let at = [12, 13, 14, 0, 6, 7, 8, 9, 10, 11, 0, 3, 4, 5];
    let (Motion::Human(joints), _) = told(&standing(15, &at, 2, false)).unwrap() else {
        panic!("it is a humanoid");
    };
    let toe = joints
        .names
        .iter()
        .position(|name| name == "left_toe")
        .unwrap();
    let ankle = Vector3::from(STANDING[2].1);
    assert!((joints.frames[1][toe] - ankle - Vector3::new(0.15, 0.0, 0.0)).norm() < 1e-6);
}

#[test]
fn libraries_of_many_and_broken_files_are_refused() {
    let many = Archive::new()
        .tensor("gts", &[2, 1, 3], &[0.0; 6])
        .tensor("motion_num_frames", &[3], &[1.0, 1.0, 0.0])
        .done();
    let message = told(&many).unwrap_err();
    assert!(
        message.contains("3 motions") && message.contains(".motion"),
        "{message}"
    );
    // 30 (K\x1e) frames a second, and 0.02 s between them.
    let two = Archive::new()
        .value("fps", b"K\x1e")
        .tensor("motion_dt", &[1], &[0.02])
        .tensor("gts", &[1, 24, 3], &[0.0; 72])
        .done();
    let message = told(&two).unwrap_err();
    assert!(
        message.contains("fps = 30, and 50 frames a second by motion_dt"),
        "{message}"
    );
    let few = Archive::new()
        .value("fps", b"K\x32")
        .tensor("gts", &[1, 24, 3], &[0.0; 72])
        .done();
    assert!(
        told(&few)
            .unwrap_err()
            .contains("rigid_body_rot or grs (but fps, gts)")
    );
    let flat = Archive::new()
        .value("fps", b"K\x32")
        .tensor("gts", &[1, 24, 3], &[0.0; 72])
        .tensor("grs", &[1, 24, 4], &[0.0; 96])
        .done();
    assert!(told(&flat).unwrap_err().contains("length 0.000"));
    let whole = standing(24, &SMPL_AT, 2, false);
    for cut in (0..whole.len()).step_by(97) {
        assert!(told(&whole[..cut]).is_err(), "{cut}");
    }
}
