//! Which column holds what.
//!
//! Separate from reading rows because it is decided once, by the first line.

use super::Line;
use crate::error::MotionError;
use crate::import::joints::{self, DROPPED, SDK_29};
use g1::JOINTS;

/// Numbers of a row in our order: x y z, qw qx qy qz, 23 joints.
pub(super) const FIELDS: usize = 7 + JOINTS;
const BASE: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];
/// The same in BONES-SEED tables: cm, and degrees about fixed axes, x first.
const BONES_BASE: [&str; 6] = [
    "root_translateX",
    "root_translateY",
    "root_translateZ",
    "root_rotateX",
    "root_rotateY",
    "root_rotateZ",
];

/// Which column each field is in, and how many columns a line must have.
#[derive(Debug)]
pub(super) struct Layout {
    pub(super) column: [usize; FIELDS],
    /// The columns of the joints that only the 29-joint robot has, as far as they are there.
    pub(super) dropped: [Option<usize>; DROPPED.len()],
    pub(super) width: usize,
    /// The column that counts time or frames.
    pub(super) time: Option<usize>,
    pub(super) in_seconds: bool,
    /// Whether the orientation is three angles, lengths are cm and angles degrees.
    pub(super) euler: bool,
}

impl Layout {
    /// What a field is multiplied by to be in SI units.
    pub(super) fn scale(&self, field: usize) -> f64 {
        match field {
            0..3 if self.euler => 0.01,
            3.. if self.euler => 1f64.to_radians(),
            _ => 1.0,
        }
    }
}

impl Line<'_> {
    /// The layout of a table without header, of which this is the first line.
    pub(super) fn plain_layout(&self) -> Result<Layout, MotionError> {
        let width = self.cells().count();
        let names: &[&str] = match width {
            30 => &joints::ours(),
            36 => &SDK_29,
            _ => {
                return Err(self.error(
                    None,
                    wording::count(width, "column"),
                    "expected 30 (x y z, quaternion, 23 joints) or 36 (29 joints), or a header \
                     that names them",
                ));
            }
        };
        let kept = joints::columns(names).expect("known orders have all joints");
        Ok(Layout {
            column: std::array::from_fn(|i| if i < 7 { i } else { 7 + kept.ours[i - 7] }),
            dropped: kept.dropped.map(|column| column.map(|column| 7 + column)),
            width,
            time: None,
            in_seconds: false,
            euler: false,
        })
    }

    /// The layout that a header names.
    pub(super) fn named_layout(&self) -> Result<Layout, MotionError> {
        let cells: Vec<&str> = self.cells().map(|cell| cell.trim_matches('"')).collect();
        let euler = cells.contains(&BONES_BASE[0]);
        let base: &[&str] = if euler { &BONES_BASE } else { &BASE };
        let ours = joints::ours();
        let mut column = [None; FIELDS];
        let mut dropped = [None; DROPPED.len()];
        let (mut time, mut in_seconds) = (None, false);
        for (i, &name) in cells.iter().enumerate() {
            let short = joints::short(name);
            let lower = name.to_ascii_lowercase();
            let of_time = matches!(lower.as_str(), "time" | "t" | "timestamp");
            let place = if of_time || lower == "frame" {
                in_seconds = of_time;
                &mut time
            } else if let Some(extra) = DROPPED.iter().position(|extra| *extra == short) {
                &mut dropped[extra]
            } else if let Some(field) = base
                .iter()
                .position(|base| *base == name)
                .or_else(|| ours.iter().position(|ours| *ours == short).map(|j| 7 + j))
            {
                &mut column[field]
            } else {
                return Err(self.error(
                    Some(i + 1),
                    format!("unknown column {name:?}"),
                    "name columns x y z qw qx qy qz and joints as in the URDF, for example \
                     left_knee_joint",
                ));
            };
            if place.replace(i).is_some() {
                return Err(self.error(
                    Some(i + 1),
                    format!("column {name:?} appears twice"),
                    "keep one of them",
                ));
            }
        }
        if euler {
            column[6] = column[5]; // three angles: the fourth number is not looked at
        }
        let mut found = [0; FIELDS];
        for (field, place) in column.iter().enumerate() {
            found[field] = place.ok_or_else(|| {
                let name = match base.get(field) {
                    Some(name) => (*name).to_owned(),
                    None => format!("{}_joint", ours[field - 7]),
                };
                self.error(
                    None,
                    format!("no column {name:?}"),
                    "add it to the header and the rows",
                )
            })?;
        }
        Ok(Layout {
            column: found,
            dropped,
            width: cells.len(),
            time,
            in_seconds,
            euler,
        })
    }
}
