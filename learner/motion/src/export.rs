//! Clips as tables: the form in which imported motion is kept.
//!
//! Separate from reading because it is the one format that is written. A header names the columns, a
//! comment says the rate, so the file needs no word beside it.

use crate::clip::{Clip, FRAME_SECONDS};
use g1::JOINT_TABLE;
use std::fmt::Write;

/// The clip as a table: x y z (m), qw qx qy qz, 23 joints (rad) at 50 Hz; `notes` become comments.
pub fn to_csv(clip: &Clip, notes: &[String]) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    for note in notes {
        let _ = writeln!(text, "# {}", note.replace(['\n', '\r'], " "));
    }
    let _ = writeln!(text, "# fps = {}", (1.0 / FRAME_SECONDS).round());
    let _ = writeln!(
        text,
        "x,y,z,qw,qx,qy,qz,{}",
        JOINT_TABLE.map(|joint| joint.name).join(",")
    );
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
        std::fs::write(&path, to_csv(&walk, &["from\nthe generator".into()])).unwrap();
        let read = load(&path, &Options::default()).unwrap();
        assert_eq!(read.frames.len(), walk.frames.len());
        for (a, b) in read.frames.iter().zip(&walk.frames) {
            // Feet are put on the ground anew, and six digits are kept.
            assert!((a.position - b.position).norm() < 2e-3);
            for (p, q) in a.joint_positions.iter().zip(&b.joint_positions) {
                assert!((p - q).abs() < 1e-6);
            }
        }
    }
}
