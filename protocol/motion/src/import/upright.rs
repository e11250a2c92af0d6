//! Which number of a quaternion is its scalar, told by what the robot does.
//!
//! Separate because it is a test that users are shown: files do not say, and both orders occur.
//! Under the right reading the pelvis stands upright and the lower foot moves little over the ground;
//! the sum of mean tilt (rad) and mean speed of the lower sole (m/s) decides.

use super::Row;
use super::file::File;
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::kinematics::{forward, sole_points};
use g1::{LEFT_FOOT, RIGHT_FOOT};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};

/// Readings whose scores differ by less (rad + m/s) cannot be told apart.
const CLEAR: f64 = 0.15;
/// Frames that are looked at.
const LOOKS: usize = 200;

/// Decides between the readings of a file's rows; `rows` are read with the scalar first.
///
/// # Errors
/// If the motion does not tell and `usual` is not given.
pub(super) fn decide(
    file: &File<'_>,
    rows: &[Row],
    fps: f64,
    usual: Option<QuaternionOrder>,
) -> Result<(QuaternionOrder, String), MotionError> {
    let first = score(rows, fps);
    let last = score(&reread(rows), fps);
    let scores = format!("tilt + slip {first:.2} with w first, {last:.2} with w last");
    if (first - last).abs() >= CLEAR {
        let order = if first < last {
            QuaternionOrder::Wxyz
        } else {
            QuaternionOrder::Xyzw
        };
        return Ok((order, format!("quaternions {order}: {scores}")));
    }
    match usual {
        Some(order) => Ok((
            order,
            format!("quaternions {order}, as usual in this format: {scores}"),
        )),
        None => Err(file.unusable(
            &format!("does not tell the order of its quaternions ({scores})"),
            "say it: quaternion = \"wxyz\" or \"xyzw\", on the command line --quaternion",
        )),
    }
}

/// Rows that were read with the scalar first, read with the scalar last.
pub(super) fn reread(rows: &[Row]) -> Vec<Row> {
    let again = |row: &Row| {
        let q = row.orientation;
        // Stored (a b c d) was taken for w x y z; now a b c are x y z and d is w.
        let quaternion = nalgebra::Quaternion::new(q.k, q.w, q.i, q.j);
        Row {
            orientation: UnitQuaternion::new_unchecked(quaternion),
            ..*row
        }
    };
    rows.iter().map(again).collect()
}

fn score(rows: &[Row], fps: f64) -> f64 {
    let step = (rows.len() / LOOKS).max(1);
    let (mut tilt, mut slip, mut looks) = (0.0, 0.0, 0.0);
    for i in (0..rows.len()).step_by(step) {
        let row = &rows[i];
        tilt += (row.orientation * Vector3::z()).z.clamp(-1.0, 1.0).acos();
        if let Some(next) = rows.get(i + 1) {
            let (a, b) = (soles(row), soles(next));
            let lowest = (0..a.len()).min_by(|&j, &k| a[j].z.total_cmp(&a[k].z));
            slip += lowest.map_or(0.0, |k| (b[k] - a[k]).xy().norm() * fps);
        }
        looks += 1.0;
    }
    (tilt + slip) / f64::max(looks, 1.0)
}

fn soles(row: &Row) -> Vec<Point3<f64>> {
    let base = Isometry3::from_parts(row.position.into(), row.orientation);
    let bodies = forward(&base, &row.joints);
    [LEFT_FOOT, RIGHT_FOOT]
        .iter()
        .flat_map(|&foot| sole_points(&bodies, foot))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait;
    use std::path::Path;

    /// A walk toward some heading, rad, read with the scalar first.
    fn walk(heading: f64) -> Vec<Row> {
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, heading);
        let walk = gait::walk(1.0).unwrap();
        let row = |frame: &g1::RobotState| Row {
            position: turn * frame.position.cast(),
            orientation: turn * frame.orientation.cast(),
            joints: frame.joint_positions.map(f64::from),
            dropped: [0.0; 6],
        };
        walk.frames.iter().map(row).collect()
    }

    #[test]
    fn both_orders_are_found_whatever_the_heading() {
        let file = File {
            path: Path::new("walk.csv"),
            bytes: b"",
        };
        for heading in [0.0, 0.8, 1.57, 2.5, 3.1, -2.0, -0.3] {
            let rows = walk(heading);
            let (order, told) = decide(&file, &rows, 50.0, None).unwrap();
            assert_eq!(order, QuaternionOrder::Wxyz, "{heading}: {told}");
            // The same file with the scalar last: what was read first is x, and so on.
            let turned: Vec<Row> = (0..3).fold(rows, |rows, _| reread(&rows));
            let (order, told) = decide(&file, &turned, 50.0, None).unwrap();
            assert_eq!(order, QuaternionOrder::Xyzw, "{heading}: {told}");
        }
    }

    #[test]
    fn what_cannot_be_told_is_asked() {
        let file = File {
            path: Path::new("still.csv"),
            bytes: b"",
        };
        // Four equal numbers are the same turn in any order.
        let half = nalgebra::Quaternion::new(0.5, 0.5, 0.5, 0.5);
        let half = UnitQuaternion::from_quaternion(half);
        let mut rows = walk(0.0);
        rows.truncate(1);
        rows[0].orientation = half;
        let message = decide(&file, &rows, 50.0, None).unwrap_err().to_string();
        assert!(
            message.contains("still.csv") && message.contains("--quaternion"),
            "{message}"
        );
        let usual = Some(QuaternionOrder::Xyzw);
        assert_eq!(
            decide(&file, &rows, 50.0, usual).unwrap().0,
            QuaternionOrder::Xyzw
        );
    }
}
