//! The same motion in an `.npy` and in an `.npz`, and broken ones.

use super::*;
use crate::import::file::npz::tests::Builder;
use crate::import::file::pickle::tests::Writer;
use crate::import::joints::SDK_29;
use nalgebra::Vector3;
use std::path::Path;

/// Names in no known order: the SDK's backwards.
pub(in crate::import) fn names() -> Vec<String> {
    SDK_29
        .iter()
        .rev()
        .map(|name| format!("{name}_joint"))
        .collect()
}

const HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// `numpy.save` of a dictionary whose values are lists of arrays, one a frame: 0.01 · column rad, turned
/// to the left by 90°, 2 cm a frame.
pub(in crate::import) fn npy(names: &[String], frames: usize) -> Vec<u8> {
    let angles: Vec<f64> = (0..names.len()).map(|i| i as f64 / 100.0).collect();
    let list = |writer: Writer, key: &str, frame: &dyn Fn(usize) -> Vec<f64>| {
        let mut writer = writer.text(key).op(b"](");
        for i in 0..frames {
            let numbers = frame(i);
            writer = writer.array(&[numbers.len()], &numbers);
        }
        writer.op(b"e")
    };
    let mut writer = Writer::new()
        .op(b"cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n")
        .op(b"K\x00\x85C\x01b\x87R(K\x01)cnumpy\ndtype\n")
        .text("O8")
        .op(b"\x89\x88\x87R(K\x03")
        .text("|")
        .op(b"NNNtb\x89]}(")
        .text("joints_list")
        .op(b"](");
    for name in names {
        writer = writer.text(name);
    }
    writer = list(writer.op(b"e"), "joint_positions", &|_| angles.clone());
    writer = list(writer, "root_position", &|i| {
        vec![0.0, 0.02 * i as f64, 0.78]
    });
    writer = list(writer, "root_quaternion", &|_| vec![0.0, 0.0, HALF, HALF]);
    let pickle = writer.text("fps").op(b"G\x40\x49\0\0\0\0\0\0uatb").done(); // 50.0
    let header = "{'descr': '|O', 'fortran_order': False, 'shape': (), }";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let padded = format!("{header:<117}\n");
    bytes.extend((padded.len() as u16).to_le_bytes());
    bytes.extend(padded.as_bytes());
    bytes.extend(pickle);
    bytes
}

fn told(bytes: &[u8]) -> Result<Vec<Row>, String> {
    let file = File {
        path: Path::new("walk.npy"),
        bytes,
    };
    let (rows, fps) = read(&file, &mut Vec::new()).map_err(|e| e.to_string())?;
    assert_eq!(fps, Some(50.0));
    Ok(rows)
}

#[test]
fn joints_are_found_by_their_names_in_both_containers() {
    let names = names();
    let angles: Vec<f64> = (0..29).map(|i| f64::from(i) / 100.0).collect();
    let words: Vec<&str> = names.iter().map(String::as_str).collect();
    let npz = Builder::new()
        .words("joints_list", &words)
        .numbers("joint_positions", &[3, 29], &angles.repeat(3))
        .numbers(
            "root_position",
            &[3, 3],
            &[0.0, 0.0, 0.78, 0.0, 0.02, 0.78, 0.0, 0.04, 0.78],
        )
        .numbers(
            "root_quaternion",
            &[3, 4],
            &[0.0, 0.0, HALF, HALF].repeat(3),
        )
        .numbers("fps", &[], &[50.0])
        .done();
    for bytes in [npy(&names, 3), npz] {
        let rows = told(&bytes).unwrap();
        // Backwards: the left hip's pitch is the last of 29, the waist's yaw (13th of the SDK) the 17th.
        for (joint, expected) in [(0, 0.28), (12, 0.16), (22, 0.02)] {
            assert!((rows[2].joints[joint] - expected).abs() < 1e-6, "{joint}");
        }
        assert!((rows[2].position - Vector3::new(0.0, 0.04, 0.78)).norm() < 1e-6);
        // The scalar is last in the file and is read first here: the caller turns it.
        let turned = crate::import::upright::reread(&rows)[0].orientation;
        assert!((turned * Vector3::x() - Vector3::y()).norm() < 1e-6);
    }
    // A G1 whose wrists are fixed names none.
    let fixed: Vec<String> = names
        .iter()
        .filter(|n| !n.contains("wrist"))
        .cloned()
        .collect();
    assert_eq!(told(&npy(&fixed, 2)).unwrap()[0].joints[17], 0.0);
}

#[test]
fn other_robots_and_broken_files_are_refused() {
    let other: Vec<String> = (0..23).map(|i| format!("r_leg_{i}")).collect();
    let message = told(&npy(&other, 2)).unwrap_err();
    assert!(message.contains("no joint left_hip_pitch"), "{message}");
    let whole = npy(&names(), 2);
    for cut in (0..whole.len()).step_by(31) {
        assert!(told(&whole[..cut]).is_err(), "{cut}");
    }
    let unnamed = Builder::new()
        .numbers("joint_positions", &[1, 29], &[0.0; 29])
        .numbers("root_position", &[1, 3], &[0.0; 3])
        .numbers("root_quaternion", &[1, 4], &[0.0, 0.0, 0.0, 1.0])
        .done();
    assert!(told(&unnamed).unwrap_err().contains("joints_list"));
    let short = Builder::new()
        .words("joints_list", &["left_knee_joint"])
        .numbers("joint_positions", &[1, 29], &[0.0; 29])
        .numbers("root_position", &[1, 3], &[0.0; 3])
        .numbers("root_quaternion", &[1, 4], &[0.0, 0.0, 0.0, 1.0])
        .done();
    assert!(told(&short).unwrap_err().contains("[1, 29]"));
}
