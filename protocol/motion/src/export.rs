//! Clips as tables: the form in which imported motion is kept.
//!
//! Separate from reading because it is the one format that is written. A header names the columns, a
//! comment says the rate, so the file needs no word beside it.

use crate::clip::{Clip, FRAME_SECONDS};
use g1::JOINT_TABLE;
use std::fmt::Write;

/// The first line of every table that is written here. Importing takes such a table as it is, and no
/// other table is ever written over.
pub const MARK: &str = "# ampco motion";
/// How a note begins: no note is mistaken for a statement like `fps = 30`.
const NOTE: &str = "# note: ";

/// The clip as a table: x y z (m), qw qx qy qz, 23 joints (rad) at 50 Hz; `notes` become comments, the
/// first of them the table's [`origin`].
pub fn to_csv(clip: &Clip, notes: &[String]) -> String {
    let mut text = format!("{MARK}\n");
    // Writing to a String cannot fail.
    for note in notes {
        let _ = writeln!(text, "{NOTE}{}", note.replace(['\n', '\r'], " "));
    }
    let _ = writeln!(text, "# fps = {}", (1.0 / FRAME_SECONDS).round());
    let _ = writeln!(text, "{}", header());
    for frame in &clip.frames {
        let (p, q) = (frame.position, frame.orientation);
        let _ = write!(
            text,
            "{:.6},{:.6},{:.6},{:.7},{:.7},{:.7},{:.7}",
            p.x, p.y, p.z, q.w, q.i, q.j, q.k
        );
        for joint in frame.joint_positions {
            let _ = write!(text, ",{joint:.6}");
        }
        text.push('\n');
    }
    text
}

/// The line that names the columns.
pub(crate) fn header() -> String {
    let joints = JOINT_TABLE.map(|joint| joint.name).join(",");
    format!("x,y,z,qw,qx,qy,qz,{joints}")
}

/// Whether a text begins as the tables that are written here.
pub fn is_marked(text: &str) -> bool {
    text.lines().next() == Some(MARK)
}

/// The first note of a table that was written here, empty if it has none; `None` for any other text.
pub fn origin(text: &str) -> Option<&str> {
    let mut lines = text.lines();
    let mark = lines.next()?;
    let note = lines.next().and_then(|line| line.strip_prefix(NOTE));
    (mark == MARK).then_some(note.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait;
    use crate::import::{Options, load};

    #[test]
    fn what_is_written_reads_back() {
        let walk = gait::walk(0.8).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("walk.csv");
        let text = to_csv(&walk, &["from\nthe generator".into(), "fps = 30".into()]);
        std::fs::write(&path, &text).unwrap();
        let read = load(&path, &Options::default()).unwrap();
        assert_eq!(read.frames.len(), walk.frames.len());
        for (a, b) in read.frames.iter().zip(&walk.frames) {
            // Six digits are kept.
            assert!((a.position - b.position).norm() < 1e-6);
            for (p, q) in a.joint_positions.iter().zip(&b.joint_positions) {
                assert!((p - q).abs() < 1e-6);
            }
        }
        assert_eq!(
            origin(&to_csv(&read, &["from the generator".into()])),
            Some("from the generator")
        );
    }

    #[test]
    fn what_was_written_changes_no_number_however_often_it_is_imported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("walk.csv");
        // Far from the origin `f32` has fewer digits than are written; a float and a sunken sole stay.
        for (name, place, lift) in [("a", 0.0, 0.0), ("b", 11.3, 0.02), ("c", -517.0, -0.01)] {
            let mut walk = gait::walk(1.0).unwrap().unrolled(3.0);
            for (i, frame) in walk.frames.iter_mut().enumerate() {
                frame.position += nalgebra::Vector3::new(place, -place, lift);
                let turn = nalgebra::Vector3::new(0.0, 0.0, 0.013 * i as f32);
                frame.orientation =
                    nalgebra::UnitQuaternion::from_scaled_axis(turn) * frame.orientation;
            }
            let first = to_csv(&walk, &[]);
            let mut text = first.clone();
            for again in 0..3 {
                std::fs::write(&path, &text).unwrap();
                text = to_csv(&load(&path, &Options::default()).unwrap(), &[]);
                assert_eq!(text, first, "{name}, import {again}");
            }
        }
    }

    #[test]
    fn only_what_was_written_here_has_an_origin() {
        assert_eq!(
            origin("# ampco motion\n# note: from a.bvh\n"),
            Some("from a.bvh")
        );
        assert_eq!(origin("# ampco motion\n# fps = 50\n"), Some(""));
        for other in ["", "x,y,z\n", "\n# ampco motion\n", "# ampco motions\n"] {
            assert_eq!(origin(other), None, "{other:?}");
            assert!(!is_marked(other));
        }
    }
}
