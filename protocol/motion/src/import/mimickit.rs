//! MimicKit's motions: a pickle of `frames`, each root place, root rotation vector and joints in a row.
//!
//! Separate as every format is. The file does not say which character it is of; the count of numbers does.
//! Layout: `mimickit/anim/motion.py` of xbpeng/MimicKit at f8d0d709.

use super::file::File;
use super::file::array::{ANGLES, Array, PLACES};
use super::file::pickle::Pickle;
use super::joints::{self, Table};
use super::order::{self, Said};
use super::skeleton::{self, MIMICKIT};
use super::{Motion, Sure, amass, isaac};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::JOINTS;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// Numbers of the root: a place and a rotation vector.
const ROOT: usize = 6;
/// Numbers of SMPL's joints: 23 rotation vectors.
const SMPL: usize = 69;
/// Which of SMPL's joints each of MimicKit's is, hands left out: it goes through the body limb by limb.
const SMPL_JOINTS: [usize; 23] = [
    1, 4, 7, 10, 2, 5, 8, 11, 3, 6, 9, 12, 15, 13, 16, 18, 20, 22, 14, 17, 19, 21, 23,
];

/// Whether a pickle is such a motion.
pub(super) fn is(pickle: &Pickle) -> bool {
    pickle.has("frames") && (pickle.has("fps") || pickle.has("loop_mode"))
}

/// Reads a file: motion and frames per second.
pub(super) fn read(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Motion, Option<f64>), MotionError> {
    let pickle = Pickle::read(file, file.bytes)?;
    let frames = pickle.array(&["frames"]).ok_or_else(|| {
        file.unusable(
            &format!("has no frames of equal length (but {})", pickle.holds()),
            "expected loop_mode, fps and frames, as Motion.save writes them",
        )
    })?;
    let fps = pickle
        .array(&["fps"])
        .and_then(|fps| fps.values.first().copied());
    let humanoid = ROOT + skeleton::numbers(&MIMICKIT);
    let widths = [ROOT + 29, ROOT + JOINTS, humanoid, ROOT + SMPL];
    frames.check(file, "frames", &widths, PLACES)?;
    let (place, root, pose) = (
        frames.part(0, 3),
        frames.part(3, 3),
        frames.part(ROOT, frames.width() - ROOT),
    );
    root.check(file, "frames, root rotation", &[3], ANGLES)?;
    pose.check(file, "frames, joints", &[frames.width() - ROOT], ANGLES)?;
    let root: Vec<UnitQuaternion<f64>> = (0..root.frames())
        .map(|i| UnitQuaternion::from_scaled_axis(Vector3::from_column_slice(root.frame(i))))
        .collect();
    let motion = if frames.width() == humanoid {
        decisions.push("MimicKit's humanoid of 28 joints".into());
        let posed = |(i, root): (usize, &UnitQuaternion<f64>)| {
            let at = Vector3::from_column_slice(place.frame(i));
            let root = Isometry3::from_parts(at.into(), *root);
            skeleton::posed(&MIMICKIT, root, pose.frame(i))
        };
        let bodies: Vec<_> = root.iter().enumerate().map(posed).collect();
        let names = MIMICKIT.map(|(name, ..)| name.to_owned()).into();
        Motion::Human(isaac::with_toes(names, &bodies))
    } else if frames.width() == ROOT + SMPL {
        let poses = smpl(&root, &pose);
        Motion::Human(amass::of_poses(
            file,
            (&poses, "frames"),
            (&place, "frames"),
            decisions,
        )?)
    } else {
        let (angles, names) = order::of_g1(file, (&pose, "frames"), Said::Nothing, decisions)?;
        let turn = joints::quaternions(&root);
        let table = Table {
            position: (&place, "frames"),
            orientation: (&turn, "frames"),
            joints: (&angles, "frames"),
            columns: joints::columns(&names).expect("both orders have all joints"),
        };
        Motion::Robot(table.rows(file, QuaternionOrder::Wxyz)?, Sure::Yes)
    };
    Ok((motion, fps))
}

/// SMPL's own poses. MimicKit's bodies have x ahead, y left, z up where SMPL's have x left, y up, z ahead:
/// (a, b, c) there is (b, c, a) here, and the root is turned by that once more.
fn smpl(root: &[UnitQuaternion<f64>], pose: &Array) -> Array {
    const WIDTH: usize = 72;
    // Rotates x to z, y to x, z to y.
    let axes = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(0.5, -0.5, -0.5, -0.5));
    let mut values = vec![0.0; WIDTH * root.len()];
    for (i, out) in values.chunks_exact_mut(WIDTH).enumerate() {
        let turn = (root[i] * axes.inverse()).scaled_axis();
        out[..3].copy_from_slice(turn.as_slice());
        for (joint, turn) in SMPL_JOINTS.iter().zip(pose.frame(i).chunks_exact(3)) {
            out[3 * joint..3 * joint + 3].copy_from_slice(&[turn[1], turn[2], turn[0]]);
        }
    }
    Array::of(vec![root.len(), WIDTH], values, false).expect("as many numbers as frames need")
}

#[cfg(test)]
#[path = "mimickit_tests.rs"]
pub(super) mod tests;
