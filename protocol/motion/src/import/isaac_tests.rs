//! Small humanoids in both layouts, and broken ones.

use super::*;
use crate::import::file::npz::tests::Builder;
use crate::import::file::pickle::tests::Writer;
use crate::import::human;
use std::path::Path;

/// The AMP humanoid as it stands: name, parent, place relative to the parent, m.
const BODIES: [(&str, i32, [f64; 3]); 13] = [
    ("pelvis", -1, [0.0, 0.0, 0.0]),
    ("right_upper_arm", 0, [0.0, -0.18, 0.48]),
    ("right_lower_arm", 1, [0.0, 0.0, -0.27]),
    ("right_hand", 2, [0.0, 0.0, -0.26]),
    ("left_upper_arm", 0, [0.0, 0.18, 0.48]),
    ("left_lower_arm", 4, [0.0, 0.0, -0.27]),
    ("left_hand", 5, [0.0, 0.0, -0.26]),
    ("right_thigh", 0, [0.0, -0.085, 0.0]),
    ("right_shin", 7, [0.0, 0.0, -0.42]),
    ("right_foot", 8, [0.0, 0.0, -0.41]),
    ("left_thigh", 0, [0.0, 0.085, 0.0]),
    ("left_shin", 10, [0.0, 0.0, -0.42]),
    ("left_foot", 11, [0.0, 0.0, -0.41]),
];

fn places() -> Vec<[f64; 3]> {
    let mut places: Vec<[f64; 3]> = Vec::new();
    for (_, parent, offset) in BODIES {
        let base = usize::try_from(parent).map_or([0.0, 0.0, 0.9], |p| places[p]);
        places.push(std::array::from_fn(|i| base[i] + offset[i]));
    }
    places
}

/// Isaac Lab's layout: standing, sliding 1 cm a frame.
pub(in crate::import) fn lab_file(frames: usize) -> Vec<u8> {
    let (mut positions, mut rotations) = (Vec::new(), Vec::new());
    for i in 0..frames {
        for [x, y, z] in places() {
            positions.extend([x + 0.01 * i as f64, y, z]);
            rotations.extend([1.0, 0.0, 0.0, 0.0]);
        }
    }
    let (t, n) = (frames as u64, BODIES.len() as u64);
    Builder::new()
        .numbers("fps", &[], &[60.0])
        .words("dof_names", &["abdomen_x", "neck_x"])
        .words("body_names", &BODIES.map(|(name, ..)| name))
        .numbers("body_positions", &[t, n, 3], &positions)
        .numbers("body_rotations", &[t, n, 4], &rotations)
        .done()
}

/// Isaac Gym's layout of the same.
pub(in crate::import) fn gym_file(frames: usize) -> Vec<u8> {
    let n = BODIES.len();
    let rotation: Vec<f64> = (0..frames * n).flat_map(|_| [0.0, 0.0, 0.0, 1.0]).collect();
    let root: Vec<f64> = (0..frames)
        .flat_map(|i| [0.01 * i as f64, 0.0, 0.9])
        .collect();
    let offsets: Vec<f64> = BODIES.iter().flat_map(|(.., offset)| *offset).collect();
    let parents: Vec<f64> = BODIES
        .iter()
        .map(|(_, parent, _)| f64::from(*parent))
        .collect();
    let arr = |w: Writer, key: &str, shape: &[usize], values: &[f64]| {
        w.text(key)
            .op(b"}")
            .text("arr")
            .array(shape, values)
            .op(b"s")
    };
    // numpy.save pickles an array of one object, whatever the object is.
    let w = Writer::new()
        .op(b"cnumpy.core.multiarray\n_reconstruct\ncnumpy\nndarray\n")
        .op(b"K\x00\x85C\x01b\x87R(K\x01)cnumpy\ndtype\n")
        .text("O8")
        .op(b"\x89\x88\x87R(K\x03")
        .text("|")
        .op(b"NNNtb\x89]")
        .text("collections")
        .text("OrderedDict")
        .op(&[0x93])
        .op(b")R(");
    let w = arr(w, "rotation", &[frames, n, 4], &rotation);
    let w = arr(w, "root_translation", &[frames, 3], &root);
    let mut w = w
        .text("skeleton_tree")
        .op(b"}(")
        .text("node_names")
        .op(b"](");
    for (name, ..) in BODIES {
        w = w.text(name);
    }
    let w = arr(w.op(b"e"), "parent_indices", &[n], &parents);
    let w = arr(w, "local_translation", &[n, 3], &offsets).op(b"u");
    let pickle = w
        .text("is_local")
        .op(&[0x88])
        .text("fps")
        .integer(60)
        .op(b"uatb")
        .done();
    let header = "{'descr': '|O', 'fortran_order': False, 'shape': (), }";
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    let padded = format!("{header:<117}\n");
    bytes.extend((padded.len() as u16).to_le_bytes());
    bytes.extend(padded.as_bytes());
    bytes.extend(pickle);
    bytes
}

fn file(bytes: &[u8]) -> File<'_> {
    File {
        path: Path::new("humanoid_walk"),
        bytes,
    }
}

#[test]
fn both_layouts_hold_the_same_humanoid() {
    let (lab_bytes, gym_bytes) = (lab_file(20), gym_file(20));
    let mut told = Vec::new();
    let (Lab::Humanoid(from_lab), fps) = lab(&file(&lab_bytes), &mut told).unwrap() else {
        panic!("it is no G1");
    };
    let (from_gym, gym_fps) = gym(&file(&gym_bytes), &mut told).unwrap();
    assert_eq!((fps, gym_fps), (Some(60.0), Some(60.0)));
    assert_eq!(from_lab.names, from_gym.names);
    for (a, b) in from_lab
        .frames
        .iter()
        .flatten()
        .zip(from_gym.frames.iter().flatten())
    {
        assert!((a - b).norm() < 1e-6); // the pickle holds f4
    }
    let capture = human::capture(&file(b""), &from_lab, 60.0, &mut told).unwrap();
    assert!((capture.travel_speed() - 0.6).abs() < 1e-9);
    assert!((capture.leg_length() - 0.83).abs() < 1e-9);
}

#[test]
fn a_g1_is_known_by_the_names_of_its_joints() {
    let names: Vec<String> = joints::ISAAC_29
        .iter()
        .map(|n| format!("{n}_joint"))
        .collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let build = |quaternion: [f64; 4]| {
        Builder::new()
            .numbers("fps", &[], &[50.0])
            .words("dof_names", &names)
            .words("body_names", &["pelvis"])
            .numbers("body_positions", &[1, 1, 3], &[1.0, 2.0, 0.78])
            .numbers("body_rotations", &[1, 1, 4], &quaternion)
            .numbers(
                "dof_positions",
                &[1, 29],
                &std::array::from_fn::<f64, 29, _>(|i| i as f64 / 100.0),
            )
            .done()
    };
    let bytes = build([1.0, 0.0, 0.0, 0.0]);
    let (Lab::Robot(rows), _) = lab(&file(&bytes), &mut Vec::new()).unwrap() else {
        panic!("it is a G1");
    };
    // Isaac's ninth joint is the left knee, our fourth.
    assert_eq!((rows[0].joints[3], rows[0].joints[12]), (0.09, 0.02));
    let bytes = build([0.5, 0.0, 0.0, 0.0]);
    let message = lab(&file(&bytes), &mut Vec::new())
        .err()
        .unwrap()
        .to_string();
    assert!(
        message.contains("frame 1, body_rotations") && message.contains("0.500"),
        "{message}"
    );
}

#[test]
fn errors_name_what_is_missing_or_broken() {
    let plain = {
        let mut bytes = Vec::new();
        let options = npyz::WriteOptions::new().default_dtype().shape(&[1]);
        use npyz::WriterBuilder;
        let mut writer = options.writer(&mut bytes).begin_nd().unwrap();
        writer.push(&1.0f64).unwrap();
        writer.finish().unwrap();
        bytes
    };
    let message = gym(&file(&plain), &mut Vec::new()).unwrap_err().to_string();
    assert!(message.contains("plain array"), "{message}");
    let whole = gym_file(2);
    for cut in (0..whole.len()).step_by(13) {
        assert!(gym(&file(&whole[..cut]), &mut Vec::new()).is_err(), "{cut}");
    }
    let few = Builder::new()
        .words("body_names", &["pelvis", "left_foot"])
        .numbers("body_positions", &[1, 1, 3], &[0.0; 3])
        .numbers("body_rotations", &[1, 1, 4], &[1.0, 0.0, 0.0, 0.0])
        .done();
    let message = lab(&file(&few), &mut Vec::new()).err().unwrap().to_string();
    assert!(
        message.contains("body_positions") && message.contains('6'),
        "{message}"
    );
}
