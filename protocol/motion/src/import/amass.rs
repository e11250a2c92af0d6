//! AMASS and its relatives: SMPL, SMPL+H and SMPL-X parameters.
//!
//! Separate as every format is. The body model itself is licensed; the directions of bones need only
//! where its joints are at rest, and for the mean body that is published ([`REST`]).

use super::file::File;
use super::file::array::{ANGLES, Array, PLACES};
use super::file::npz::Archive;
use super::human::Joints;
use crate::error::MotionError;
use nalgebra::{Rotation3, Vector3};

/// A joint of the body: name, parent, place at rest relative to its parent in the body's frame (x left,
/// y up, z forward), m.
type Rest = (&'static str, usize, [f64; 3]);

/// The 22 joints that SMPL, SMPL+H and SMPL-X share, in their order, for the mean neutral body.
///
/// From `smpl_humanoid.xml` of NVlabs/ProtoMotions at commit 0c4d6654 (Apache-2.0), whose axes are x
/// forward, y left, z up.
const REST: [Rest; 22] = [
    ("Pelvis", 0, [0.0, 0.0, 0.0]),
    ("L_Hip", 0, [0.0695, -0.0914, -0.0068]),
    ("R_Hip", 0, [-0.0677, -0.0905, -0.0043]),
    ("Spine1", 0, [-0.0025, 0.109, -0.0267]),
    ("L_Knee", 1, [0.0343, -0.3752, -0.0045]),
    ("R_Knee", 2, [-0.0383, -0.3826, -0.0089]),
    ("Spine2", 3, [0.0055, 0.1352, 0.0011]),
    ("L_Ankle", 4, [-0.0136, -0.398, -0.0437]),
    ("R_Ankle", 5, [0.0158, -0.3984, -0.0423]),
    ("Spine3", 6, [0.0015, 0.0529, 0.0254]),
    ("L_Toe", 7, [0.0264, -0.0558, 0.1193]),
    ("R_Toe", 8, [-0.0254, -0.0481, 0.1233]),
    ("Neck", 9, [-0.0028, 0.2139, -0.0429]),
    ("L_Collar", 9, [0.0788, 0.1217, -0.0341]),
    ("R_Collar", 9, [-0.0818, 0.1188, -0.0386]),
    ("Head", 12, [0.0052, 0.065, 0.0513]),
    ("L_Shoulder", 13, [0.091, 0.0305, -0.0089]),
    ("R_Shoulder", 14, [-0.096, 0.0326, -0.0091]),
    ("L_Elbow", 16, [0.2596, -0.0128, -0.0275]),
    ("R_Elbow", 17, [-0.2537, -0.0133, -0.0214]),
    ("L_Wrist", 18, [0.2492, 0.009, -0.0012]),
    ("R_Wrist", 19, [-0.2553, 0.0078, -0.0056]),
];
/// Numbers of the pose that the body needs: an axis-angle per joint.
const BODY: usize = 3 * REST.len();
/// Numbers of a pose: 22 joints, SMPL's 24, SMPL+H's 52, SMPL-X's 55.
const POSES: [usize; 4] = [BODY, 72, 156, 165];

/// Joint positions and frames per second, if the file says them.
pub(super) fn read(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Joints, Option<f64>), MotionError> {
    let mut archive = Archive::open(file)?;
    let trans = archive.numbers("trans")?;
    let fps = archive.scalar(&["mocap_framerate", "mocap_frame_rate", "fps"])?;
    if archive.names().iter().any(|name| name == "poses") {
        let poses = archive.numbers("poses")?;
        let joints = of_poses(file, (&poses, "poses"), (&trans, "trans"), decisions)?;
        return Ok((joints, fps));
    }
    // Rotations of the root and of the rest in arrays of their own.
    trans.check(file, "trans", &[3], PLACES)?;
    let (root, body) = (
        archive.numbers("root_orient")?,
        archive.numbers("pose_body")?,
    );
    root.check(file, "root_orient", &[3], ANGLES)?;
    body.check(file, "pose_body", &[BODY - 3], ANGLES)?;
    root.check_length(file, "root_orient", (&trans, "trans"))?;
    body.check_length(file, "pose_body", (&trans, "trans"))?;
    let frames = (0..trans.frames())
        .map(|i| posed(trans.frame(i), root.frame(i), body.frame(i)))
        .collect();
    Ok((body_of(frames, decisions), fps))
}

/// Joint positions from whole poses and the root's places.
pub(super) fn of_poses(
    file: &File<'_>,
    (poses, name): (&Array, &str),
    (trans, trans_name): (&Array, &str),
    decisions: &mut Vec<String>,
) -> Result<Joints, MotionError> {
    trans.check(file, trans_name, &[3], PLACES)?;
    poses.check(file, name, &POSES, ANGLES)?;
    poses.check_length(file, name, (trans, trans_name))?;
    let frames = (0..trans.frames())
        .map(|i| posed(trans.frame(i), &poses.frame(i)[..3], &poses.frame(i)[3..]))
        .collect();
    Ok(body_of(frames, decisions))
}

fn body_of(frames: Vec<Vec<Vector3<f64>>>, decisions: &mut Vec<String>) -> Joints {
    decisions.push("mean SMPL body, betas not applied: directions need none".into());
    Joints {
        names: REST.map(|(name, ..)| name.to_owned()).into(),
        frames,
        ..Joints::default()
    }
}

/// Forward kinematics of a frame.
fn posed(trans: &[f64], root: &[f64], body: &[f64]) -> Vec<Vector3<f64>> {
    let mut turns = vec![Rotation3::from_scaled_axis(Vector3::from_column_slice(
        root,
    ))];
    let mut places = vec![Vector3::from_column_slice(trans)];
    for (joint, (_, parent, offset)) in REST.iter().enumerate().skip(1) {
        let local = Vector3::from_column_slice(&body[3 * (joint - 1)..3 * joint]);
        places.push(places[*parent] + turns[*parent] * Vector3::from(*offset));
        turns.push(turns[*parent] * Rotation3::from_scaled_axis(local));
    }
    places
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::import::file::npz::tests::Builder;
    use crate::import::human;
    use std::f64::consts::FRAC_PI_2;
    use std::path::Path;

    /// SMPL+H standing, turned from y up to z up, and sliding 2 cm a frame along world −y (ahead).
    pub(in crate::import) fn standing(frames: usize, width: usize) -> Vec<u8> {
        let mut poses = vec![0.0; frames * width];
        let mut trans = Vec::new();
        for i in 0..frames {
            poses[i * width] = FRAC_PI_2;
            trans.extend([0.0, -0.02 * i as f64, 0.95]);
        }
        Builder::new()
            .numbers("poses", &[frames as u64, width as u64], &poses)
            .numbers("trans", &[frames as u64, 3], &trans)
            .numbers("mocap_framerate", &[], &[100.0])
            .done()
    }

    fn read_bytes(bytes: &[u8]) -> Result<(Joints, Option<f64>), String> {
        let file = File {
            path: Path::new("walk_poses.npz"),
            bytes,
        };
        read(&file, &mut Vec::new()).map_err(|e| e.to_string())
    }

    #[test]
    fn every_width_of_poses_gives_the_same_body() {
        let (first, fps) = read_bytes(&standing(5, 156)).unwrap();
        assert_eq!(fps, Some(100.0));
        for width in [66, 72, 165] {
            assert_eq!(read_bytes(&standing(5, width)).unwrap().0, first);
        }
        // Turned by 90° about x, the body's y is the world's z and its z the world's −y.
        let hip = first.frames[0][1];
        assert!(
            (hip - Vector3::new(0.0695, 0.0068, 0.95 - 0.0914)).norm() < 1e-9,
            "{hip}"
        );
        let mut decisions = Vec::new();
        let file = File {
            path: Path::new("x"),
            bytes: b"",
        };
        let capture = human::capture(&file, &first, 100.0, &mut decisions).unwrap();
        assert!(decisions[0].starts_with("z up"), "{decisions:?}");
        assert!((capture.travel_speed() - 2.0).abs() < 1e-9);
        assert!((capture.leg_length() - 0.78).abs() < 0.01);
    }

    #[test]
    fn smplx_has_its_rotations_in_two_arrays() {
        let bytes = |body: usize| {
            Builder::new()
                .numbers(
                    "root_orient",
                    &[2, 3],
                    &[FRAC_PI_2, 0.0, 0.0, FRAC_PI_2, 0.0, 0.0],
                )
                .numbers("pose_body", &[2, body as u64], &vec![0.0; 2 * body])
                .numbers("trans", &[2, 3], &[0.0, 0.0, 0.95, 0.0, -0.02, 0.95])
                .numbers("mocap_frame_rate", &[1], &[120.0])
                .done()
        };
        let (joints, fps) = read_bytes(&bytes(63)).unwrap();
        assert_eq!(fps, Some(120.0));
        assert_eq!(joints, read_bytes(&standing(2, 156)).unwrap().0);
        let message = read_bytes(&bytes(60)).unwrap_err();
        assert!(
            message.contains("pose_body") && message.contains("63"),
            "{message}"
        );
    }

    #[test]
    fn a_bent_knee_moves_what_hangs_on_it() {
        let width = 66;
        let mut poses = vec![0.0; width];
        poses[3 * 4] = FRAC_PI_2; // left knee, about the body's x
        let bytes = Builder::new()
            .numbers("poses", &[1, width as u64], &poses)
            .numbers("trans", &[1, 3], &[0.0; 3])
            .done();
        let (joints, fps) = read_bytes(&bytes).unwrap();
        assert_eq!(fps, None);
        let shin = joints.frames[0][7] - joints.frames[0][4];
        // (x, y, z) turned by 90° about x is (x, −z, y).
        assert!(
            (shin - Vector3::new(-0.0136, 0.0437, -0.398)).norm() < 1e-9,
            "{shin}"
        );
    }

    #[test]
    fn errors_name_array_and_frame() {
        let build = |poses: &[f64], shape: &[u64], trans: u64| {
            Builder::new()
                .numbers("poses", shape, poses)
                .numbers("trans", &[trans, 3], &vec![0.0; 3 * trans as usize])
                .done()
        };
        let mut broken = vec![0.0; 2 * 156];
        broken[156 + 7] = f64::NAN;
        let mut degrees = vec![0.0; 2 * 156];
        degrees[3] = 45.0;
        for (bytes, parts) in [
            (
                build(&broken, &[2, 156], 2),
                ["frame 2, poses[7]", "NaN", "repair"],
            ),
            (
                build(&degrees, &[2, 156], 2),
                ["frame 1, poses[3]", "45", "radians"],
            ),
            (
                build(&[0.0; 300], &[2, 150], 2),
                ["poses", "[2, 150]", "156"],
            ),
            (
                build(&[0.0; 312], &[2, 156], 3),
                ["poses has 2 frames", "trans has 3", "as long"],
            ),
            (build(&[], &[0, 156], 0), ["trans", "no frames", "again"]),
        ] {
            let message = read_bytes(&bytes).unwrap_err();
            for part in parts {
                assert!(message.contains(part), "{part:?} is not in {message:?}");
            }
        }
    }
}
