//! Clips written as joblib writes those of ASAP, PBHC and PHC, and broken ones.

use super::*;
use crate::import::file::pickle::tests::Writer;
use crate::import::{Options, import};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

/// A posture with another number in every joint: 0.01 · (column + 1) rad in ASAP's order.
fn angles(frames: usize) -> Vec<f64> {
    let frame: Vec<f64> = (1..=23).map(|i| f64::from(i) / 100.0).collect();
    frame.repeat(frames)
}

/// The axis-angles that such files repeat: the root's, the joints' about their axes, three bodies
/// without joints. The axes are written down here as in ASAP's model.
fn poses(dof: &[f64]) -> Vec<f64> {
    const LEG: [usize; 6] = [1, 0, 2, 1, 1, 0];
    const REST: [usize; 11] = [2, 0, 1, 1, 0, 2, 1, 1, 0, 2, 1];
    let axes: Vec<usize> = LEG.into_iter().chain(LEG).chain(REST).collect();
    let mut out = Vec::new();
    for frame in dof.chunks_exact(23) {
        out.extend([0.0, 0.0, FRAC_PI_2]);
        for (angle, axis) in frame.iter().zip(&axes) {
            out.extend((0..3).map(|k| if k == *axis { *angle } else { 0.0 }));
        }
        out.extend([0.0; 9]);
    }
    out
}

/// What a clip is made of.
pub(in crate::import) struct Clip {
    pub(in crate::import) frames: usize,
    pub(in crate::import) dof: Vec<f64>,
    pub(in crate::import) width: usize,
    pub(in crate::import) poses: Option<Vec<f64>>,
    pub(in crate::import) names: [&'static str; 3],
}

impl Clip {
    /// ASAP's: turned to the left by 90° (z and w are √½), 1 cm a frame along y.
    pub(in crate::import) fn asap(frames: usize) -> Self {
        let dof = angles(frames);
        Self {
            frames,
            poses: Some(poses(&dof)),
            dof,
            width: 23,
            names: ["root_trans_offset", "root_rot", "dof"],
        }
    }

    fn write(&self, writer: Writer) -> Writer {
        let t = self.frames;
        let place: Vec<f64> = (0..t).flat_map(|i| [0.0, 0.01 * i as f64, 0.78]).collect();
        let half = 0.5f64.sqrt();
        let writer = writer
            .op(b"}(")
            .text(self.names[0])
            .joblib_array(&[t, 3], &place)
            .text(self.names[2])
            .joblib_array(&[t, self.width], &self.dof)
            .text(self.names[1])
            .joblib_array(&[t, 4], &[0.0, 0.0, half, half].repeat(t));
        let writer = match &self.poses {
            Some(poses) => writer
                .text("pose_aa")
                .joblib_array(&[t, poses.len() / 3 / t, 3], poses),
            None => writer,
        };
        writer.text("fps").integer(30).op(b"u")
    }

    pub(in crate::import) fn file(&self) -> Vec<u8> {
        self.write(Writer::new().op(b"}\x94").text("0-walk_level1"))
            .op(b"s")
            .done()
    }

    fn bare(&self) -> Vec<u8> {
        self.write(Writer::new()).done()
    }
}

fn told(bytes: &[u8]) -> Result<(Vec<super::super::Row>, Vec<String>), String> {
    let file = File {
        path: Path::new("walk.pkl"),
        bytes,
    };
    let mut decisions = Vec::new();
    match read(&file, false, &mut decisions).map_err(|e| e.to_string())? {
        (Motion::Robot(rows, _), fps) => {
            assert_eq!(fps, Some(30.0));
            Ok((rows, decisions))
        }
        _ => Err("a human".into()),
    }
}

#[test]
fn an_asap_clip_has_its_joints_by_the_axes_of_its_axis_angles() {
    for bytes in [Clip::asap(4).file(), Clip::asap(4).bare()] {
        let (rows, decisions) = told(&bytes).unwrap();
        assert_eq!(rows.len(), 4);
        let q = rows[3].joints;
        // Columns 1 to 12 are the legs', 13 the waist's yaw, 14 and 15 its roll and pitch (not ours), 16 to
        // 19 the left arm, 20 to 23 the right; the wrists are not there.
        for (joint, expected) in [
            (0, 0.01),
            (11, 0.12),
            (12, 0.13),
            (13, 0.16),
            (16, 0.19),
            (17, 0.0),
            (18, 0.20),
            (21, 0.23),
            (22, 0.0),
        ] {
            assert!(
                (q[joint] - expected).abs() < 1e-6,
                "joint {joint}: {}",
                q[joint]
            );
        }
        assert!((rows[3].position - Vector3::new(0.0, 0.03, 0.78)).norm() < 1e-6);
        assert!((rows[0].orientation * Vector3::x() - Vector3::y()).norm() < 1e-6);
        for word in ["axes in pose_aa", "arms of 4", "wrists", "xyzw"] {
            assert!(
                decisions.iter().any(|d| d.contains(word)),
                "{word}: {decisions:?}"
            );
        }
    }
}

#[test]
fn a_human_clip_is_read_as_smpl() {
    let mut poses = vec![0.0; 3 * 72];
    (0..3).for_each(|i| poses[72 * i] = FRAC_PI_2);
    let place = |z: f64| [0.0, 0.0, z].repeat(3);
    let bytes = Writer::new()
        .op(b"}")
        .text("0-CMU_02_01")
        .op(b"}(")
        .text("trans_orig")
        .joblib_array(&[3, 3], &place(0.95))
        .text("root_trans_offset")
        .joblib_array(&[3, 3], &place(0.7))
        .text("pose_aa")
        .joblib_array(&[3, 72], &poses)
        .text("gender")
        .text("neutral")
        .text("fps")
        .integer(30)
        .op(b"us")
        .done();
    let file = File {
        path: Path::new("x.pkl"),
        bytes: &bytes,
    };
    let (Motion::Human(joints), fps) = read(&file, false, &mut Vec::new()).unwrap() else {
        panic!("it is a human");
    };
    assert_eq!(fps, Some(30.0));
    // See `amass.rs`: turned by 90° about x, the left hip is at (0.0695, 0.0068, −0.0914).
    let hip = joints.frames[2][1] - Vector3::new(0.0695, 0.0068, 0.95 - 0.0914);
    assert!(hip.norm() < 1e-6, "{hip}");
}

#[test]
fn a_renamed_clip_is_read_in_its_own_order_or_refused() {
    // GMR's names, and arms that hang: column 16 on is the left arm.
    let mut clip = Clip::asap(5);
    clip.names = ["root_pos", "root_rot", "dof_pos"];
    clip.poses = None;
    let mut frame = [0.0; 23];
    for (column, angle) in [
        (15, 0.2),
        (16, 0.3),
        (18, 1.0),
        (19, 0.2),
        (20, -0.3),
        (22, 1.0),
    ] {
        frame[column] = angle;
    }
    clip.dof = frame.repeat(5);
    let import_bytes = |bytes: &[u8], format: Option<&str>| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("walk.pkl");
        std::fs::write(&path, bytes).unwrap();
        let options = Options {
            format: format.map(|name| name.parse().unwrap()),
            ..Options::default()
        };
        import(&path, &options).map_err(|e| e.to_string())
    };
    let result = import_bytes(&clip.bare(), None).unwrap();
    let q = result.clip.frames[0].joint_positions;
    assert!(
        (q[16] - 1.0).abs() < 1e-5 && (q[21] - 1.0).abs() < 1e-5,
        "{q:?}"
    );
    assert!((q[14] - 0.3).abs() < 1e-5 && q[17].abs() < 1e-5, "{q:?}");
    assert!(
        result.decisions.iter().any(|d| d.contains("arms of 4")),
        "{:?}",
        result.decisions
    );
    // One arm up, the other bent: it could be either.
    frame = [0.0; 23];
    (frame[15], frame[21]) = (-0.6, 0.5);
    clip.dof = frame.repeat(5);
    let message = import_bytes(&clip.bare(), None).unwrap_err();
    assert!(
        message.contains("two orders") && message.contains("--format phc"),
        "{message}"
    );
    let result = import_bytes(&clip.bare(), Some("phc")).unwrap();
    assert!((result.clip.frames[0].joint_positions[13] + 0.6).abs() < 1e-5);
    let result = import_bytes(&clip.bare(), Some("gmr")).unwrap();
    assert!((result.clip.frames[0].joint_positions[15] + 0.6).abs() < 1e-5);
}

#[test]
fn several_clips_and_other_robots_are_refused() {
    let two = Clip::asap(2).write(Writer::new().op(b"}(").text("run\x1b[2J"));
    let two = Clip::asap(2).write(two.text("walk")).op(b"u").done();
    let message = told(&two).unwrap_err();
    for part in ["2 clips", "walk", "\\u{1b}", "joblib.dump"] {
        assert!(message.contains(part), "{part} is not in {message}");
    }
    let mut h1 = Clip::asap(2);
    (h1.width, h1.dof, h1.poses) = (19, vec![0.0; 38], None);
    let message = told(&h1.file()).unwrap_err();
    assert!(
        message.contains("[2, 19]") && message.contains("23 or 29"),
        "{message}"
    );
    let message = told(&Writer::new().op(b"}").text("a").op(b"}s").done()).unwrap_err();
    assert!(message.contains("no clip (but a)"), "{message}");
    let message = told(&Writer::new().op(b"}").text("dof").op(b"Ns").done()).unwrap_err();
    assert!(message.contains("root_trans_offset"), "{message}");
}

#[test]
fn broken_clips_are_refused_with_frame_and_field() {
    let mut nan = Clip::asap(2);
    nan.dof[23 + 4] = f64::NAN;
    let message = told(&nan.file()).unwrap_err();
    assert!(message.contains("frame 2, dof[4]"), "{message}");
    let mut short = Clip::asap(3);
    (short.dof, short.poses) = (angles(3)[..46].to_vec(), None);
    assert!(told(&short.file()).is_err());
    let whole = Clip::asap(2).file();
    for cut in (0..whole.len()).step_by(7) {
        assert!(told(&whole[..cut]).is_err(), "{cut}");
    }
}
