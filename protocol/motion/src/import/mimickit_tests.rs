//! Frames of the characters that are known, and of others.

use super::*;
use crate::import::file::pickle::tests::Writer;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// `Motion.save` of MimicKit: frames as lists of floats.
pub(in crate::import) fn file_of(frames: &[Vec<f64>]) -> Vec<u8> {
    let mut writer = Writer::new()
        .op(b"}\x94(")
        .text("loop_mode")
        .op(b"K\x01")
        .text("fps")
        .op(b"K\x1e")
        .text("frames")
        .op(b"]\x94(");
    for frame in frames {
        writer = writer.op(b"](");
        for number in frame {
            writer = writer.op(b"G").op(&number.to_be_bytes());
        }
        writer = writer.op(b"e");
    }
    writer.op(b"eu").done()
}

/// The humanoid of 28 joints, arms hanging: turned by 80° about x.
pub(in crate::import) fn standing() -> Vec<f64> {
    let arm = 80f64.to_radians();
    frame([0.0, 0.0, 0.9, 0.0, 0.0, 0.0], 28, &[(6, arm), (10, -arm)])
}

fn told(bytes: &[u8]) -> Result<(Motion, Vec<String>), String> {
    let file = File {
        path: Path::new("walk.pkl"),
        bytes,
    };
    let mut decisions = Vec::new();
    let (motion, fps) = read(&file, &mut decisions).map_err(|e| e.to_string())?;
    assert_eq!(fps, Some(30.0));
    Ok((motion, decisions))
}

/// A frame at a place, turned by a rotation vector, with some joints of many.
fn frame(root: [f64; 6], joints: usize, angles: &[(usize, f64)]) -> Vec<f64> {
    let mut frame = root.to_vec();
    frame.resize(6 + joints, 0.0);
    for (joint, angle) in angles {
        frame[6 + joint] = *angle;
    }
    frame
}

#[test]
fn a_g1_has_29_joints_in_the_sdks_order() {
    let angles: Vec<(usize, f64)> = (0..29).map(|i| (i, (i + 1) as f64 / 100.0)).collect();
    let frames = vec![frame([1.0, 2.0, 0.78, 0.0, 0.0, FRAC_PI_2], 29, &angles); 3];
    let (Motion::Robot(rows, Sure::Yes), _) = told(&file_of(&frames)).unwrap() else {
        panic!("it is a G1");
    };
    // Waist yaw is the 13th; the left arm begins at the 16th, its wrist's roll is the 20th; the right arm
    // begins at the 23rd.
    for (joint, expected) in [
        (0, 0.01),
        (11, 0.12),
        (12, 0.13),
        (13, 0.16),
        (17, 0.20),
        (18, 0.23),
        (22, 0.27),
    ] {
        assert!((rows[2].joints[joint] - expected).abs() < 1e-12, "{joint}");
    }
    assert_eq!(rows[0].position, Vector3::new(1.0, 2.0, 0.78));
    assert!((rows[0].orientation * Vector3::x() - Vector3::y()).norm() < 1e-9);
}

#[test]
fn the_humanoid_has_28() {
    // The left hip's ball is the last but two (21 to 23): forward by 90° about y; the knee (24) bends back.
    let bent = [(22, -FRAC_PI_2), (24, FRAC_PI_2)];
    let frames = vec![frame([0.0, 0.0, 0.9, 0.0, 0.0, 0.0], 28, &bent); 2];
    let (Motion::Human(joints), _) = told(&file_of(&frames)).unwrap() else {
        panic!("it is a humanoid");
    };
    let at = |name: &str| joints.frames[1][joints.names.iter().position(|n| n == name).unwrap()];
    for (name, expected) in [
        ("left_shin", [0.421546, 0.084887, 0.9]),
        ("left_foot", [0.421546, 0.084887, 0.9 - 0.40987]),
        // 15 cm ahead of the ankle.
        ("left_toe", [0.571546, 0.084887, 0.9 - 0.40987]),
        ("right_foot", [0.0, -0.084887, 0.9 - 0.831416]),
        // Arms aside: 0.18311 + 0.274788 + 0.258947 from the middle.
        ("right_hand", [-0.02405, -0.716845, 0.9 + 0.479651]),
    ] {
        assert!(
            (at(name) - Vector3::from(expected)).norm() < 1e-6,
            "{name}: {}",
            at(name)
        );
    }
}

#[test]
fn smpl_has_69_numbers_in_axes_of_its_own() {
    // Facing −y in the world, which is SMPL's body turned up by 90° about x (see `amass.rs`); the left
    // knee, second of the joints, bends about the axis to the left.
    let frames = vec![
        frame(
            [0.0, 0.0, 0.95, 0.0, 0.0, -FRAC_PI_2],
            69,
            &[(4, FRAC_PI_2)]
        );
        2
    ];
    let (Motion::Human(joints), _) = told(&file_of(&frames)).unwrap() else {
        panic!("it is a human");
    };
    let at = |joint: usize| joints.frames[0][joint];
    let hip = Vector3::new(0.0695, 0.0068, 0.95 - 0.0914);
    assert!((at(1) - hip).norm() < 1e-9, "{}", at(1));
    // A shin of (−0.0136, −0.398, −0.0437) bends to (−0.0136, 0.0437, −0.398) in the body, and the
    // body's (x, y, z) is (x, −z, y) in the world.
    let shin = at(7) - at(4);
    assert!(
        (shin - Vector3::new(-0.0136, 0.398, 0.0437)).norm() < 1e-9,
        "{shin}"
    );
}

#[test]
fn other_characters_and_broken_frames_are_refused() {
    let still = |joints: usize| vec![frame([0.0; 6], joints, &[]); 2];
    let message = told(&file_of(&still(12))).unwrap_err();
    assert!(
        message.contains("[2, 18]") && message.contains("35 or 29 or 34 or 75"),
        "{message}"
    );
    let mut ragged = still(29);
    ragged[1].pop();
    assert!(
        told(&file_of(&ragged))
            .unwrap_err()
            .contains("frames of equal length")
    );
    let mut nan = still(28);
    nan[1][7] = f64::NAN;
    let message = told(&file_of(&nan)).unwrap_err();
    assert!(message.contains("frame 2, frames[7]"), "{message}");
    let mut degrees = still(29);
    degrees[0][9] = 45.0;
    let message = told(&file_of(&degrees)).unwrap_err();
    assert!(
        message.contains("frame 1") && message.contains("radians"),
        "{message}"
    );
    // 23 joints whose arms could be either robot's.
    let one_sided = vec![frame([0.0; 6], 23, &[(15, -0.6), (21, 0.5)]); 2];
    let message = told(&file_of(&one_sided)).unwrap_err();
    assert!(message.contains("two orders"), "{message}");
    assert!(told(&file_of(&[])).is_err());
    let whole = file_of(&still(29));
    for cut in (0..whole.len()).step_by(11) {
        assert!(told(&whole[..cut]).is_err(), "{cut}");
    }
}
