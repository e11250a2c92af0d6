//! Motions of the G1 in archives and pickles: BeyondMimic and its relatives, and GMR.
//!
//! Separate as every format is; these two share that they seldom name joints. BeyondMimic's files hold
//! where bodies are, so the order of the joints is told by forward kinematics; GMR's is that of the SDK,
//! unless it has 23 joints (see `order.rs`).

use super::Row;
use super::file::File;
use super::file::array::{Array, PLACES};
use super::file::npz::Archive;
use super::file::pickle::Pickle;
use super::joints::{self, ISAAC_23, ISAAC_29, SDK_29, Table};
use super::order::{self, Order, Said};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::kinematics::forward;
use nalgebra::{Isometry3, Vector3};

/// Feet that are farther from the file's (m) are in no known order.
const AGREES: f64 = 0.05;
/// Elbows may be off by the lean of a waist that the rows have not: 0.35 m above it, by its 0.52 rad, m.
const LEANS: f64 = 0.2;
/// Frames that are compared.
const LOOKS: usize = 50;

/// Reads a BeyondMimic file: rows and frames per second.
pub(super) fn beyond_mimic(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Vec<Row>, Option<f64>), MotionError> {
    let mut archive = Archive::open(file)?;
    let fps = archive.scalar(&["fps", "frame_rate"])?;
    let angles = archive.numbers("joint_pos")?;
    let places = archive.numbers("body_pos_w")?;
    let turns = archive.numbers("body_quat_w")?;
    if !matches!(angles.width(), 23 | 29) {
        let problem = format!("array joint_pos has the shape {:?}", angles.shape);
        return Err(file.unusable(&problem, "expected frames of 23 or 29 joints of the G1"));
    }
    let bodies = angles.width() + 1;
    places.check(file, "body_pos_w", &[3 * bodies], PLACES)?;
    turns.check(file, "body_quat_w", &[4 * bodies], (f64::INFINITY, ""))?;
    let first = |array: &Array, width: usize| {
        let values = (0..array.frames()).flat_map(|i| array.frame(i)[..width].to_vec());
        Array::of(vec![array.frames(), width], values.collect(), false)
            .expect("a part of each frame")
    };
    let (pelvis, turn) = (first(&places, 3), first(&turns, 4));
    let rows = |angles: &Array, names: &[String]| {
        let table = Table {
            position: (&pelvis, "body_pos_w"),
            orientation: (&turn, "body_quat_w"),
            joints: (angles, "joint_pos"),
            columns: joints::columns(names).expect("names were checked"),
        };
        table.rows(file, QuaternionOrder::Wxyz)
    };
    if let Some(names) = archive.words("joint_names")?
        && names.len() == angles.width()
    {
        let (angles, names) = order::named(file, (&angles, "joint_pos"), &names, decisions)?;
        return Ok((rows(&angles, &names)?, fps));
    }
    let (ours, waist) = (joints::ours(), Order::Waist.names());
    let orders: &[(&str, &[&str])] = if angles.width() == SDK_29.len() {
        &[
            ("the SDK's order", &SDK_29),
            ("Isaac Lab's order", &ISAAC_29),
        ]
    } else {
        &[
            ("the SDK's order", &ours),
            ("Isaac Lab's order", &ISAAC_23),
            ("ASAP's order (waist of 3, arms of 4)", &waist),
        ]
    };
    let mut best: Option<(Gaps, &str, Vec<Row>, Vec<String>)> = None;
    let mut told = Vec::new();
    for &(name, names) in orders {
        let mut added = Vec::new();
        let words = names.iter().map(|name| (*name).to_owned()).collect();
        let (whole, words) = order::whole(&angles, words, &mut added);
        let rows = rows(&whole, &words)?;
        let gaps = gaps(&rows, &places, names);
        told.push(format!(
            "{:.1} and {:.1} cm in {name}",
            100.0 * gaps.feet,
            100.0 * gaps.elbows
        ));
        if best
            .as_ref()
            .is_none_or(|(least, ..)| gaps.both() < least.both())
        {
            best = Some((gaps, name, rows, added));
        }
    }
    let (gaps, name, rows, added) = best.expect("there are orders");
    if gaps.feet > AGREES || gaps.elbows > LEANS {
        let problem = format!(
            "has its joints in no known order (feet are off by {:.2} m, elbows by {:.2} m or more)",
            gaps.feet, gaps.elbows
        );
        return Err(file.unusable(
            &problem,
            "add an array joint_names, or export the motion of a G1",
        ));
    }
    decisions.push(format!(
        "joints in {name}: feet and elbows are off by {}",
        told.join(", ")
    ));
    decisions.extend(added);
    Ok((rows, fps))
}

/// Mean distances between bodies of rows and those of the file, m.
#[derive(Clone, Copy)]
struct Gaps {
    feet: f64,
    elbows: f64,
}

impl Gaps {
    fn both(self) -> f64 {
        self.feet + self.elbows
    }
}

/// The gaps between rows and a file whose bodies stand in the joints' order after the pelvis.
fn gaps(rows: &[Row], places: &Array, names: &[&str]) -> Gaps {
    let ours = joints::ours();
    let bodies = |joint: &str| {
        ["left", "right"].map(|side| {
            let joint = format!("{side}_{joint}");
            let body = |names: &[&str]| {
                1 + names
                    .iter()
                    .position(|n| *n == joint)
                    .expect("a joint of the G1")
            };
            (body(&ours), body(names))
        })
    };
    let (feet, elbows) = (bodies("ankle_roll"), bodies("elbow"));
    let step = (rows.len() / LOOKS).max(1);
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for i in (0..rows.len()).step_by(step) {
        let base = Isometry3::from_parts(rows[i].position.into(), rows[i].orientation);
        let bodies = forward(&base, &rows[i].joints);
        for (sum, pairs) in sums.iter_mut().zip([feet, elbows]) {
            for (ours, theirs) in pairs {
                let place = &places.frame(i)[3 * theirs..3 * theirs + 3];
                *sum +=
                    (bodies[ours].translation.vector - Vector3::from_column_slice(place)).norm();
            }
        }
        count += 2.0;
    }
    let [feet, elbows] = sums.map(|sum| sum / f64::max(count, 1.0));
    Gaps {
        feet,
        // With 29 joints feet tell all, and arms hang on joints that the rows have not.
        elbows: if names.len() == g1::JOINTS {
            elbows
        } else {
            0.0
        },
    }
}

/// Reads a GMR file: rows with the scalar read first (the caller decides), frames per second. `by_user` if
/// the user named the format.
pub(super) fn gmr(
    file: &File<'_>,
    by_user: bool,
    decisions: &mut Vec<String>,
) -> Result<(Vec<Row>, Option<f64>), MotionError> {
    let pickle = Pickle::read(file, file.bytes)?;
    let part = |name: &str| {
        pickle.array(&[name]).ok_or_else(|| {
            file.unusable(
                &format!("has no array {name} (but {})", pickle.holds()),
                "expected fps, root_pos, root_rot, dof_pos",
            )
        })
    };
    let (place, turn, angles) = (part("root_pos")?, part("root_rot")?, part("dof_pos")?);
    let fps = pickle
        .array(&["fps"])
        .and_then(|fps| fps.values.first().copied());
    let (angles, names) = columns(file, &pickle, angles, by_user, decisions)?;
    let table = Table {
        position: (&place, "root_pos"),
        orientation: (&turn, "root_rot"),
        joints: (&angles, "dof_pos"),
        columns: joints::columns(&names).expect("known orders have all joints"),
    };
    Ok((table.rows(file, QuaternionOrder::Wxyz)?, fps))
}

/// The joints of a GMR file and their names.
fn columns(
    file: &File<'_>,
    pickle: &Pickle,
    angles: Array,
    by_user: bool,
    decisions: &mut Vec<String>,
) -> Result<(Array, Vec<String>), MotionError> {
    let named = ["joint_names", "dof_names"];
    if let Some(names) = named.iter().find_map(|key| pickle.words(&[key])) {
        return order::named(file, (&angles, "dof_pos"), &names, decisions);
    }
    // legged_lab's files have the same keys, Isaac Lab's order, and one key more.
    if pickle.has("loop_mode") {
        let names = match angles.width() {
            29 => ISAAC_29.to_vec(),
            23 => ISAAC_23.to_vec(),
            _ => {
                let problem = format!("array dof_pos has the shape {:?}", angles.shape);
                return Err(file.unusable(&problem, "expected frames of 23 or 29 joints of the G1"));
            }
        };
        decisions.push("joints in Isaac Lab's order (it has a loop_mode)".into());
        let names = names.into_iter().map(String::from).collect();
        return Ok((angles, names));
    }
    let said = if by_user {
        Said::User(Order::Wrists)
    } else {
        Said::Nothing
    };
    order::of_g1(file, (&angles, "dof_pos"), said, decisions)
}

#[cfg(test)]
#[path = "robot_tests.rs"]
pub(super) mod tests;
