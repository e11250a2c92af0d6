//! Reads a table of motion: comma-separated numbers, with or without a header.
//!
//! Separate because its one subject is what can be wrong with a file that a person made.
//!
//! Columns: x y z (m), quaternion, joints (rad). With a header they are found by name in any order
//! (`x y z qw qx qy qz` and joint names with or without `_joint`, the six that only the 29-joint robot
//! has among them; `time` in s or a counting `frame` is checked to be even).
//! Without one there are 30 columns in one of two orders (see `order.rs`), or 36 in the order of the 29-joint robot. BONES-SEED
//! tables (`root_translateX` in cm, `root_rotateX` and joints in degrees) are known by their header. A
//! comment `# fps = 50` says the rate.

mod layout;
mod rate;

use super::file::File;
use super::joints::DROPPED;
use super::rate::agree;
use super::{Options, Row};
use crate::clip::FRAME_SECONDS;
use crate::error::MotionError;
use crate::export;
use layout::{FIELDS, Layout};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rate::Stated;
use std::path::Path;

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// The rows; without a header quaternions are read with the scalar first.
    pub(super) rows: Vec<Row>,
    /// Whether a header names the columns.
    pub(super) named: bool,
    /// Whether there are 23 joints without names: rows are read in our own order, which may be another.
    pub(super) unsure: bool,
    /// Whether it is a table as [`export`] writes them.
    pub(super) ours: bool,
    /// The rates that it states.
    stated: Vec<Stated>,
}

impl Table {
    /// Frames per second, if the file says them; which of two that are nearly the same is taken goes to `decisions`.
    ///
    /// # Errors
    /// If it says two that differ, and the user none above them.
    pub(super) fn fps(
        &self,
        file: &File<'_>,
        options: &Options,
        decisions: &mut Vec<String>,
    ) -> Result<Option<f64>, MotionError> {
        let above = options.fps.filter(|_| options.force_fps);
        rate::one(file, &self.stated, above, decisions)
    }
}

/// Reads a table.
pub(super) fn parse(file: &File<'_>) -> Result<Table, MotionError> {
    let text = file.text();
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| Line {
            path: file.path,
            number: i + 1,
            text: line,
        })
        .filter(|line| !line.text.trim().is_empty() && !line.text.trim_start().starts_with('#'))
        .peekable();
    let Some(&first) = lines.peek() else {
        return Err(file.unusable("holds no frames", "export the motion again"));
    };
    let named = first.is_header();
    let layout = if named {
        let layout = first.named_layout()?;
        lines.next();
        layout
    } else {
        first.plain_layout()?
    };
    let (mut rows, mut times) = (Vec::new(), Vec::new());
    for line in lines {
        let (row, time) = line.row(&layout)?;
        rows.push(row);
        times.extend(time.map(|time| (line, time)));
    }
    if rows.is_empty() {
        return Err(file.unusable("holds no frames", "export the motion again"));
    }
    let mut stated = rate::in_comments(file, text)?;
    let as_written = [1.0 / FRAME_SECONDS];
    let ours = export::is_marked(text)
        && first.text == export::header()
        && stated.iter().map(|stated| stated.fps).eq(as_written);
    let timed = rate::of_times(&times, layout.time.unwrap_or(0))?;
    if layout.in_seconds {
        stated.extend(timed);
    } else if let Some(counted) = timed.filter(|counted| !agree(counted.fps, 1.0)) {
        let step = 1.0 / counted.fps;
        return Err(file.unusable(
            &format!("counts its frames in steps of {step}: are there some left out?"),
            "number its rows 0, 1, 2, … and say how many of them are a second",
        ));
    }
    Ok(Table {
        rows,
        named,
        unsure: !named && layout.width == FIELDS,
        ours,
        stated,
    })
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

    /// The row and its time, if there is a column for it.
    fn row(&self, layout: &Layout) -> Result<(Row, Option<f64>), MotionError> {
        let cells: Vec<&str> = self.cells().collect();
        if cells.len() != layout.width {
            let problem = format!(
                "{} where the first line has {}",
                wording::count(cells.len(), "column"),
                layout.width
            );
            return Err(self.error(None, problem, "give every line the same columns"));
        }
        let mut value = [0.0; FIELDS];
        for (field, number) in value.iter_mut().enumerate() {
            *number = self.number(&cells, layout, field)?;
        }
        let time = match layout.time {
            Some(column) => Some(self.finite(cells[column], column)?),
            None => None,
        };
        let [x, y, z, a, b, c, d] = std::array::from_fn(|i| value[i]);
        let quaternion = if layout.euler {
            *UnitQuaternion::from_euler_angles(a, b, c).quaternion()
        } else {
            Quaternion::new(a, b, c, d)
        };
        // Files keep about six digits; what is further off is another order, or not a quaternion.
        if (quaternion.norm() - 1.0).abs() > 0.01 {
            return Err(self.error(
                Some(layout.column[3] + 1),
                format!("the quaternion has length {:.3}", quaternion.norm()),
                "it must have length 1; check the columns",
            ));
        }
        let mut dropped = [0.0; DROPPED.len()];
        for (angle, column) in dropped.iter_mut().zip(layout.dropped) {
            if let Some(column) = column {
                *angle = self.angle(&cells, layout, column)?;
            }
        }
        let row = Row {
            position: Vector3::new(x, y, z),
            // What seven digits leave of a unit is one: dividing it would change the seventh.
            orientation: if (quaternion.norm() - 1.0).abs() < 1e-6 {
                UnitQuaternion::new_unchecked(quaternion)
            } else {
                UnitQuaternion::from_quaternion(quaternion)
            },
            joints: std::array::from_fn(|j| value[7 + j]),
            dropped,
        };
        Ok((row, time))
    }

    fn number(&self, cells: &[&str], layout: &Layout, field: usize) -> Result<f64, MotionError> {
        let column = layout.column[field];
        if field >= 7 {
            return self.angle(cells, layout, column);
        }
        let number = self.finite(cells[column], column)? * layout.scale(field);
        if field < 3 && number.abs() > 1e4 {
            let problem = format!("a place {number} m away");
            return Err(self.error(Some(column + 1), problem, "places are in metres"));
        }
        Ok(number)
    }

    /// A joint's position, rad.
    fn angle(&self, cells: &[&str], layout: &Layout, column: usize) -> Result<f64, MotionError> {
        let number = self.finite(cells[column], column)? * layout.scale(FIELDS);
        if number.abs() > 10.0 {
            let problem = format!("a joint at {number} rad");
            return Err(self.error(Some(column + 1), problem, "joints are in radians"));
        }
        Ok(number)
    }

    fn finite(&self, cell: &str, column: usize) -> Result<f64, MotionError> {
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
