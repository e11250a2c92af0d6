//! Reads a table of motion: comma-separated numbers, with or without a header.
//!
//! Separate because its one subject is what can be wrong with a file that a person made.
//!
//! Columns: x y z (m), quaternion, joints (rad). With a header they are found by name in any order
//! (`x y z qw qx qy qz` and joint names with or without `_joint`; the six joints that only the
//! 29-joint robot has are passed over). Without one there are 30 columns in robot order, or 36 in
//! the order of the 29-joint robot.

use super::Row;
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::{JOINT_TABLE, JOINTS};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::path::Path;

/// Numbers of a row in our order: x y z, qw qx qy qz, 23 joints.
const FIELDS: usize = 7 + JOINTS;
const BASE: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];
/// Where the 29-joint robot has joints that the 23-joint robot lacks.
const DROPPED: [usize; 6] = [13, 14, 20, 21, 27, 28];
const DROPPED_NAMES: [&str; 6] = [
    "waist_roll",
    "waist_pitch",
    "left_wrist_pitch",
    "left_wrist_yaw",
    "right_wrist_pitch",
    "right_wrist_yaw",
];

/// Which column each field is in, and how many columns a line must have.
struct Layout {
    column: [usize; FIELDS],
    width: usize,
}

/// The rows of a table. `path` is named in errors only.
pub(super) fn parse(
    text: &str,
    path: &Path,
    quaternion: QuaternionOrder,
) -> Result<Vec<Row>, MotionError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| Line {
            path,
            number: i + 1,
            text: line,
        })
        .filter(|line| !line.text.trim().is_empty() && !line.text.trim_start().starts_with('#'))
        .peekable();
    let Some(first) = lines.peek() else {
        return Err(MotionError::File {
            path: path.into(),
            problem: "holds no frames".into(),
            remedy: "export the motion again".into(),
        });
    };
    let layout = if first.is_header() {
        let layout = first.named_layout()?;
        lines.next();
        layout
    } else {
        first.plain_layout(quaternion)?
    };
    lines.map(|line| line.row(&layout)).collect()
}

#[derive(Clone, Copy)]
struct Line<'a> {
    path: &'a Path,
    number: usize,
    text: &'a str,
}

impl<'a> Line<'a> {
    fn cells(&self) -> impl Iterator<Item = &'a str> {
        self.text.split(',').map(str::trim)
    }

    fn is_header(&self) -> bool {
        self.cells().all(|cell| cell.parse::<f64>().is_err())
    }

    fn plain_layout(&self, quaternion: QuaternionOrder) -> Result<Layout, MotionError> {
        let width = self.cells().count();
        let kept: Vec<usize> = match width {
            30 => (0..JOINTS).collect(),
            36 => (0..29).filter(|i| !DROPPED.contains(i)).collect(),
            _ => {
                return Err(self.error(
                    None,
                    format!("{width} columns"),
                    "expected 30 (x y z, quaternion, 23 joints) or 36 (29 joints), or a header \
                     that names them",
                ));
            }
        };
        let mut column = [0; FIELDS];
        column[..3].copy_from_slice(&[0, 1, 2]);
        column[3..7].copy_from_slice(match quaternion {
            QuaternionOrder::Wxyz => &[3, 4, 5, 6],
            QuaternionOrder::Xyzw => &[6, 3, 4, 5],
        });
        for (field, joint) in column[7..].iter_mut().zip(kept) {
            *field = 7 + joint;
        }
        Ok(Layout { column, width })
    }

    fn named_layout(&self) -> Result<Layout, MotionError> {
        let mut column = [None; FIELDS];
        let mut width = 0;
        for (i, cell) in self.cells().enumerate() {
            width = i + 1;
            let name = cell.trim_matches('"');
            let short = name.strip_suffix("_joint").unwrap_or(name);
            if DROPPED_NAMES.contains(&short) {
                continue;
            }
            let joint = |j: &g1::Joint| j.name.strip_suffix("_joint") == Some(short);
            let field = BASE
                .iter()
                .position(|base| *base == name)
                .or_else(|| JOINT_TABLE.iter().position(joint).map(|j| 7 + j));
            let Some(field) = field else {
                return Err(self.error(
                    Some(i + 1),
                    format!("unknown column {name:?}"),
                    "name columns x y z qw qx qy qz and joints as in the URDF, for example \
                     left_knee_joint",
                ));
            };
            if column[field].replace(i).is_some() {
                return Err(self.error(
                    Some(i + 1),
                    format!("column {name:?} appears twice"),
                    "keep one of them",
                ));
            }
        }
        let mut found = [0; FIELDS];
        for (field, place) in column.iter().enumerate() {
            found[field] = place.ok_or_else(|| {
                let name = BASE.get(field).copied();
                let name = name.unwrap_or_else(|| JOINT_TABLE[field - BASE.len()].name);
                self.error(
                    None,
                    format!("no column {name:?}"),
                    "add it to the header and the rows",
                )
            })?;
        }
        Ok(Layout {
            column: found,
            width,
        })
    }

    fn row(&self, layout: &Layout) -> Result<Row, MotionError> {
        let cells: Vec<&str> = self.cells().collect();
        if cells.len() != layout.width {
            return Err(self.error(
                None,
                format!(
                    "{} columns where the first line has {}",
                    cells.len(),
                    layout.width
                ),
                "give every line the same columns",
            ));
        }
        let mut value = [0.0; FIELDS];
        for (field, number) in value.iter_mut().enumerate() {
            *number = self.number(&cells, layout.column[field], field)?;
        }
        let [x, y, z, qw, qx, qy, qz] = std::array::from_fn(|i| value[i]);
        let quaternion = Quaternion::new(qw, qx, qy, qz);
        // Files keep about six digits; what is further off is another order, or not a quaternion.
        if (quaternion.norm() - 1.0).abs() > 0.01 {
            return Err(self.error(
                Some(layout.column[3] + 1),
                format!("the quaternion has length {:.3}", quaternion.norm()),
                "it must have length 1; check the columns",
            ));
        }
        Ok(Row {
            position: Vector3::new(x, y, z),
            orientation: UnitQuaternion::from_quaternion(quaternion),
            joints: std::array::from_fn(|j| value[7 + j]),
        })
    }

    fn number(&self, cells: &[&str], column: usize, field: usize) -> Result<f64, MotionError> {
        let cell = cells[column];
        let fail = |problem: String, remedy: &str| self.error(Some(column + 1), problem, remedy);
        let Ok(number) = cell.parse::<f64>() else {
            let shown: String = cell.chars().take(40).collect();
            return Err(fail(
                format!("{shown:?} is not a number"),
                "write a decimal number",
            ));
        };
        if !number.is_finite() {
            return Err(fail(
                format!("{cell} is not a finite number"),
                "repair or cut the frame",
            ));
        }
        if field < 3 && number.abs() > 1e4 {
            return Err(fail(
                format!("a place {number} m away"),
                "places are in metres",
            ));
        }
        if field >= 7 && number.abs() > 10.0 {
            return Err(fail(
                format!("a joint at {number} rad"),
                "joints are in radians",
            ));
        }
        Ok(number)
    }

    fn error(&self, column: Option<usize>, problem: String, remedy: &str) -> MotionError {
        MotionError::Cell {
            path: self.path.into(),
            line: self.number,
            column,
            problem,
            remedy: remedy.into(),
        }
    }
}

#[cfg(test)]
#[path = "csv_tests.rs"]
mod tests;
