//! Motions of PHC and its relatives ASAP and PBHC: pickles of clips by name.
//!
//! Separate as every format is. A clip of a robot has `root_trans_offset`, `root_rot` (scalar last) and
//! `dof`, and repeats its joints as axis-angles in `pose_aa`, which tells the joints' axes and with them
//! their order. A clip of a human has SMPL's `pose_aa` and `trans_orig`. Layouts: `fit_smpl_motion.py` and
//! `convert_amass_isaac.py` in scripts/data_process of ZhengyiLuo/PHC at 846988d4.

use super::file::File;
use super::file::array::{Array, PLACES};
use super::file::pickle::Pickle;
use super::joints::{self, Table};
use super::order::{self, Order, Said};
use super::{Motion, Sure, amass};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use nalgebra::{UnitQuaternion, Vector3};

/// Names of a clip's parts, also those that other programs give them.
const JOINTS: [&str; 2] = ["dof", "dof_pos"];
const PLACE: [&str; 3] = ["root_trans_offset", "root_trans", "root_pos"];
const HUMAN_PLACE: [&str; 3] = ["trans_orig", "trans", "root_trans_offset"];
/// Angles that agree so well are the same, rad: files hold `float32`.
const AGREES: f64 = 1e-3;

/// Whether a pickle is, or holds, such clips.
pub(super) fn is(pickle: &Pickle) -> bool {
    let clip = |inner: &[&str]| {
        let has = |name: &str| pickle.at(&[inner, &[name]].concat()).is_some();
        has(PLACE[0]) && (has("dof") || has("pose_aa")) || has("pose_aa") && has("trans")
    };
    clip(&[]) || pickle.keys().iter().any(|key| clip(&[key]))
}

/// Reads the one clip of a file: motion and frames per second. `by_user` if the user named the format.
pub(super) fn read(
    file: &File<'_>,
    by_user: bool,
    decisions: &mut Vec<String>,
) -> Result<(Motion, Option<f64>), MotionError> {
    let mut pickle = Pickle::read(file, file.bytes)?;
    choose(file, &mut pickle, decisions)?;
    let fps = pickle
        .array(&["fps"])
        .and_then(|fps| fps.values.first().copied());
    let motion = if JOINTS.iter().any(|name| pickle.has(name)) {
        robot(file, &pickle, by_user, decisions)?
    } else {
        let (poses, _) = pickle.part(file, &["pose_aa"], EXPECTED)?;
        let (place, name) = pickle.part(file, &HUMAN_PLACE, EXPECTED)?;
        decisions.push("a human of SMPL".into());
        Motion::Human(amass::of_poses(
            file,
            (&poses, "pose_aa"),
            (&place, name),
            decisions,
        )?)
    };
    Ok((motion, fps))
}

/// Goes into the clip, if clips are kept by name.
fn choose(
    file: &File<'_>,
    pickle: &mut Pickle,
    decisions: &mut Vec<String>,
) -> Result<(), MotionError> {
    const SHOWN: usize = 3;
    let is_clip = |pickle: &Pickle, clip: &[&str]| {
        let mut names = JOINTS.iter().chain(&["pose_aa"]);
        names.any(|name| pickle.at(&[clip, &[name]].concat()).is_some())
    };
    if is_clip(pickle, &[]) {
        return Ok(());
    }
    let keys = pickle.keys();
    let clips: Vec<String> = keys
        .iter()
        .filter(|key| is_clip(pickle, &[key]))
        .map(|key| (*key).to_owned())
        .collect();
    match clips.as_slice() {
        [] => Err(file.unusable(
            &format!("holds no clip (but {})", keys.join(", ")),
            "expected root_trans_offset, root_rot and dof, or pose_aa and trans_orig, under a clip's name",
        )),
        [only] => {
            decisions.push(format!("clip {}", wording::line(only)));
            pickle.descend(only);
            Ok(())
        }
        several => {
            let names: Vec<String> = several.iter().take(SHOWN).map(|name| wording::line(name)).collect();
            Err(file.unusable(
                &format!("holds {} clips ({}, …)", several.len(), names.join(", ")),
                "import one a file: python -c \"import joblib, sys; [joblib.dump({k: v}, f'clip{i}.pkl') for \
                 i, (k, v) in enumerate(joblib.load(sys.argv[1]).items())]\" FILE",
            ))
        }
    }
}

/// What a pickle of these projects has.
const EXPECTED: &str = "expected root_trans_offset, root_rot and dof, or pose_aa and trans_orig";

fn robot(
    file: &File<'_>,
    pickle: &Pickle,
    by_user: bool,
    decisions: &mut Vec<String>,
) -> Result<Motion, MotionError> {
    let (place, place_name) = pickle.part(file, &PLACE, EXPECTED)?;
    let (turn, turn_name) = pickle.part(file, &["root_rot"], EXPECTED)?;
    let (angles, name) = pickle.part(file, &JOINTS, EXPECTED)?;
    let poses = pickle.array(&["pose_aa"]);
    let poses = poses.filter(|poses| fits(poses, &angles));
    let by_axes = poses.as_ref().and_then(|poses| by_axes(poses, &angles));
    let (angles, names) = match by_axes {
        Some(order) => {
            decisions.push(format!("joints by their axes in pose_aa: {}", order.told()));
            order.whole(&angles, decisions)
        }
        None => {
            let said = if by_user { Said::User } else { Said::Usual };
            order::of_g1(file, (&angles, name), said(Order::Waist), decisions)?
        }
    };
    place.check(file, place_name, &[3], PLACES)?;
    turn.check(file, turn_name, &[4], (f64::INFINITY, ""))?;
    turn.check_length(file, turn_name, (&place, place_name))?;
    let last = poses.is_some_and(|poses| {
        (0..turn.frames()).all(|i| {
            let quaternion = joints::quaternion(turn.frame(i), QuaternionOrder::Xyzw);
            let pose = Vector3::from_column_slice(&poses.frame(i)[..3]);
            let (a, b) = (
                UnitQuaternion::from_quaternion(quaternion),
                UnitQuaternion::from_scaled_axis(pose),
            );
            a.angle_to(&b) < AGREES
        })
    });
    let table = Table {
        position: (&place, place_name),
        orientation: (&turn, turn_name),
        joints: (&angles, name),
        columns: joints::columns(&names).expect("both orders have all joints"),
    };
    if last {
        decisions.push("quaternions xyzw, as pose_aa says".into());
        return Ok(Motion::Robot(
            table.rows(file, QuaternionOrder::Xyzw)?,
            Sure::Yes,
        ));
    }
    let usual = Some(QuaternionOrder::Xyzw);
    Ok(Motion::Robot(
        table.rows(file, QuaternionOrder::Wxyz)?,
        Sure::No { usual },
    ))
}

/// Whether axis-angles are of these joints: the root's, one a joint, and some of bodies without joints.
fn fits(poses: &Array, angles: &Array) -> bool {
    poses.frames() == angles.frames() && poses.width() >= 3 * (angles.width() + 1)
}

/// The one order of 23 columns in which every joint turns about its own axis.
fn by_axes(poses: &Array, angles: &Array) -> Option<Order> {
    if angles.width() != g1::JOINTS {
        return None;
    }
    let fits = |order: &Order| {
        let names = order.names();
        (0..angles.frames()).all(|i| {
            let (poses, angles) = (poses.frame(i), angles.frame(i));
            (0..names.len()).all(|j| {
                (0..3).all(|k| {
                    let expected = if k == order::axis(names[j]) {
                        angles[j]
                    } else {
                        0.0
                    };
                    (poses[3 * (j + 1) + k] - expected).abs() < AGREES
                })
            })
        })
    };
    let mut fitting = [Order::Wrists, Order::Waist].into_iter().filter(fits);
    fitting.next().filter(|_| fitting.next().is_none())
}

#[cfg(test)]
#[path = "phc_tests.rs"]
pub(super) mod tests;
