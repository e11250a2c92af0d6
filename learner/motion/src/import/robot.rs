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
use super::lean;
use super::order::{self, Order, Said};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::kinematics::forward;
use g1::{LEFT_FOOT, RIGHT_FOOT};
use nalgebra::{Isometry3, Vector3};

/// Feet that are farther from the file's (m) are in no known order.
const AGREES: f64 = 0.05;
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
    let table = |names: &[&str]| {
        let columns = joints::columns(names).map_err(|missing| {
            file.unusable(
                &format!("names no joint {missing}"),
                "expected the joints of the G1",
            )
        })?;
        Ok(Table {
            position: (&pelvis, "body_pos_w"),
            orientation: (&turn, "body_quat_w"),
            joints: (&angles, "joint_pos"),
            columns,
        })
    };
    if let Some(names) = archive.words("joint_names")? {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        if names.len() == angles.width() {
            decisions.push("joints by the file's names".into());
            let table = table(&names)?;
            lean::say_others(&table.others(), decisions);
            return Ok((table.rows(file, QuaternionOrder::Wxyz)?, fps));
        }
    }
    let ours = joints::ours();
    let orders: [(&str, &[&str]); 2] = if angles.width() == 29 {
        [
            ("the SDK's order", &SDK_29),
            ("Isaac Lab's order", &ISAAC_29),
        ]
    } else {
        [("the SDK's order", &ours), ("Isaac Lab's order", &ISAAC_23)]
    };
    let mut best: Option<(f64, &str, Vec<Row>)> = None;
    let mut told = Vec::new();
    for (name, names) in orders {
        let rows = table(names)?.rows(file, QuaternionOrder::Wxyz)?;
        let gap = feet_gap(&rows, &places, names);
        told.push(format!("{:.1} cm in {name}", 100.0 * gap));
        if best.as_ref().is_none_or(|(least, ..)| gap < *least) {
            best = Some((gap, name, rows));
        }
    }
    let (gap, name, rows) = best.expect("there are orders");
    let told = format!("joints in {name}: feet are off by {}", told.join(", "));
    if gap > AGREES {
        return Err(file.unusable(
            &format!(
                "has its joints in no known order (feet are off by {:.2} m or more)",
                gap
            ),
            "add an array joint_names, or export the motion of a G1",
        ));
    }
    decisions.push(told);
    Ok((rows, fps))
}

/// Mean distance between the feet of rows and the file's bodies, which stand in the joints' order
/// after the pelvis, m.
fn feet_gap(rows: &[Row], places: &Array, names: &[&str]) -> f64 {
    let body = |name: &str| {
        1 + names
            .iter()
            .position(|n| *n == name)
            .expect("orders have ankles")
    };
    let feet = [
        (LEFT_FOOT, body("left_ankle_roll")),
        (RIGHT_FOOT, body("right_ankle_roll")),
    ];
    let step = (rows.len() / LOOKS).max(1);
    let (mut sum, mut count) = (0.0, 0.0);
    for i in (0..rows.len()).step_by(step) {
        let base = Isometry3::from_parts(rows[i].position.into(), rows[i].orientation);
        let bodies = forward(&base, &rows[i].joints);
        for (ours, theirs) in feet {
            let place = Vector3::from_column_slice(&places.frame(i)[3 * theirs..3 * theirs + 3]);
            sum += (bodies[ours].translation.vector - place).norm();
            count += 1.0;
        }
    }
    sum / f64::max(count, 1.0)
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
            let keys = wording::line(&pickle.keys().join(", "));
            file.unusable(
                &format!("has no array {name} (but {keys})"),
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
) -> Result<(Array, Vec<&'static str>), MotionError> {
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
