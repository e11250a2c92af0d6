//! Motions of amp-rsl-rl: `joints_list`, `joint_positions`, `root_position`, `root_quaternion` (scalar last)
//! and `fps`, as a pickled dictionary in an `.npy` or as arrays of an `.npz`.
//!
//! Separate as every format is. Layout: the README of gbionics/amp-rsl-rl at 10f7f9cc.

use super::Row;
use super::file::File;
use super::file::array::Array;
use super::file::npz;
use super::file::pickle::Pickle;
use super::joints::{self, Table};
use super::order;
use crate::config::QuaternionOrder;
use crate::error::MotionError;

/// The arrays beside the joints' names.
const PARTS: [&str; 3] = ["root_position", "root_quaternion", "joint_positions"];

/// Whether a pickle is such a motion.
pub(super) fn is(pickle: &Pickle) -> bool {
    pickle.has("joints_list") && pickle.has("joint_positions")
}

/// Reads a file: rows with the scalar read first (the caller decides), frames per second.
pub(super) fn read(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Vec<Row>, Option<f64>), MotionError> {
    let (names, [place, turn, angles], fps) = if file.bytes.starts_with(b"PK") {
        let mut archive = npz::Archive::open(file)?;
        let names = archive.words("joints_list")?;
        let [a, b, c] = PARTS.map(|name| archive.numbers(name));
        (names, [a?, b?, c?], archive.scalar(&["fps"])?)
    } else {
        let pickle = Pickle::of_npy(file)?;
        let part = |name: &str| {
            pickle.array(&[name]).ok_or_else(|| {
                let keys = pickle.holds();
                file.unusable(
                    &format!("has no array {name} with frames of equal length (but {keys})"),
                    "expected joints_list, joint_positions, root_position, root_quaternion, fps",
                )
            })
        };
        let [a, b, c] = PARTS.map(part);
        let fps: Option<Array> = pickle.array(&["fps"]);
        let fps = fps.and_then(|fps| fps.values.first().copied());
        (pickle.words(&["joints_list"]), [a?, b?, c?], fps)
    };
    let Some(names) = names else {
        return Err(file.unusable(
            "does not name its joints",
            "add joints_list, a list of the joints' names",
        ));
    };
    let (angles, names) = order::named(file, (&angles, PARTS[2]), &names, decisions)?;
    let table = Table {
        position: (&place, PARTS[0]),
        orientation: (&turn, PARTS[1]),
        joints: (&angles, PARTS[2]),
        columns: joints::columns(&names).expect("names were checked"),
    };
    Ok((table.rows(file, QuaternionOrder::Wxyz)?, fps))
}

#[cfg(test)]
#[path = "amp_rsl_rl_tests.rs"]
pub(super) mod tests;
