//! Joints of the G1 in files: from the 29-joint robot, by name or in one of the known orders.
//!
//! Separate because every format of robot motion has them, and checks are the same for all.

use super::Row;
use super::file::File;
use super::file::array::{ANGLES, Array, PLACES};
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use g1::{JOINT_TABLE, JOINTS};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Order of Unitree's SDK for the robot with 29 joints, which is that of MuJoCo models too.
pub(super) const SDK_29: [&str; 29] = [
    "left_hip_pitch",
    "left_hip_roll",
    "left_hip_yaw",
    "left_knee",
    "left_ankle_pitch",
    "left_ankle_roll",
    "right_hip_pitch",
    "right_hip_roll",
    "right_hip_yaw",
    "right_knee",
    "right_ankle_pitch",
    "right_ankle_roll",
    "waist_yaw",
    "waist_roll",
    "waist_pitch",
    "left_shoulder_pitch",
    "left_shoulder_roll",
    "left_shoulder_yaw",
    "left_elbow",
    "left_wrist_roll",
    "left_wrist_pitch",
    "left_wrist_yaw",
    "right_shoulder_pitch",
    "right_shoulder_roll",
    "right_shoulder_yaw",
    "right_elbow",
    "right_wrist_roll",
    "right_wrist_pitch",
    "right_wrist_yaw",
];

/// Order of Isaac Lab for the same: breadth first from the pelvis.
pub(super) const ISAAC_29: [&str; 29] = [
    "left_hip_pitch",
    "right_hip_pitch",
    "waist_yaw",
    "left_hip_roll",
    "right_hip_roll",
    "waist_roll",
    "left_hip_yaw",
    "right_hip_yaw",
    "waist_pitch",
    "left_knee",
    "right_knee",
    "left_shoulder_pitch",
    "right_shoulder_pitch",
    "left_ankle_pitch",
    "right_ankle_pitch",
    "left_shoulder_roll",
    "right_shoulder_roll",
    "left_ankle_roll",
    "right_ankle_roll",
    "left_shoulder_yaw",
    "right_shoulder_yaw",
    "left_elbow",
    "right_elbow",
    "left_wrist_roll",
    "right_wrist_roll",
    "left_wrist_pitch",
    "right_wrist_pitch",
    "left_wrist_yaw",
    "right_wrist_yaw",
];

/// Breadth first for the robot with 23 joints.
pub(super) const ISAAC_23: [&str; 23] = [
    "left_hip_pitch",
    "right_hip_pitch",
    "waist_yaw",
    "left_hip_roll",
    "right_hip_roll",
    "left_shoulder_pitch",
    "right_shoulder_pitch",
    "left_hip_yaw",
    "right_hip_yaw",
    "left_shoulder_roll",
    "right_shoulder_roll",
    "left_knee",
    "right_knee",
    "left_shoulder_yaw",
    "right_shoulder_yaw",
    "left_ankle_pitch",
    "right_ankle_pitch",
    "left_elbow",
    "right_elbow",
    "left_ankle_roll",
    "right_ankle_roll",
    "left_wrist_roll",
    "right_wrist_roll",
];

/// The joints that the robot with 23 lacks; those of the waist first.
pub(super) const DROPPED: [&str; 6] = [
    "waist_roll",
    "waist_pitch",
    "left_wrist_pitch",
    "left_wrist_yaw",
    "right_wrist_pitch",
    "right_wrist_yaw",
];

/// A joint's name without its ending.
pub(super) fn short(name: &str) -> &str {
    let name = name.strip_suffix("_dof").unwrap_or(name);
    name.strip_suffix("_joint").unwrap_or(name)
}

/// Our 23 joints' names without their ending.
pub(super) fn ours() -> [&'static str; JOINTS] {
    JOINT_TABLE.map(|joint| short(joint.name))
}

/// Which of a file's columns of joints is which.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    /// The column of each of our joints.
    pub(super) ours: [usize; JOINTS],
    /// The column of each of [`DROPPED`], if it is there.
    pub(super) dropped: [Option<usize>; DROPPED.len()],
    /// All other columns and their names: fingers, a head, or something misspelt.
    pub(super) others: Vec<(String, usize)>,
}

/// The columns of joints among named ones; the name of the first of ours that is missing.
pub(super) fn columns<S: AsRef<str>>(names: &[S]) -> Result<Columns, &'static str> {
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    let find = |wanted: &str| names.iter().position(|name| short(name) == wanted);
    let mut columns = [0; JOINTS];
    for (column, wanted) in columns.iter_mut().zip(ours()) {
        *column = find(wanted).ok_or(wanted)?;
    }
    let dropped = DROPPED.map(find);
    let known = |column: &usize| columns.contains(column) || dropped.contains(&Some(*column));
    let others = (0..names.len()).filter(|column| !known(column));
    Ok(Columns {
        ours: columns,
        dropped,
        others: others.map(|i| (short(names[i]).to_owned(), i)).collect(),
    })
}

/// Arrays of robot motion and the names that errors give them.
pub(super) struct Table<'a> {
    pub(super) position: (&'a Array, &'a str),
    pub(super) orientation: (&'a Array, &'a str),
    pub(super) joints: (&'a Array, &'a str),
    /// Which column of `joints` is which joint.
    pub(super) columns: Columns,
}

impl Table<'_> {
    /// The rows, checked: finite, as long as each other, unit quaternions.
    pub(super) fn rows(
        &self,
        file: &File<'_>,
        order: QuaternionOrder,
    ) -> Result<Vec<Row>, MotionError> {
        let ((p, p_name), (o, o_name), (j, j_name)) =
            (self.position, self.orientation, self.joints);
        p.check(file, p_name, &[3], PLACES)?;
        o.check(file, o_name, &[4], (f64::INFINITY, ""))?;
        j.check(file, j_name, &[j.width()], ANGLES)?;
        o.check_length(file, o_name, self.position)?;
        j.check_length(file, j_name, self.position)?;
        (0..p.frames())
            .map(|i| {
                let quaternion = quaternion(o.frame(i), order);
                check_unit(file, i, o_name, &quaternion)?;
                Ok(Row {
                    position: Vector3::from_column_slice(p.frame(i)),
                    orientation: UnitQuaternion::from_quaternion(quaternion),
                    joints: self.columns.ours.map(|column| j.frame(i)[column]),
                    dropped: (self.columns.dropped)
                        .map(|column| column.map_or(0.0, |column| j.frame(i)[column])),
                })
            })
            .collect()
    }

    /// Names of the file's joints that no G1 has, and how far they get from 0, rad.
    pub(super) fn others(&self) -> Vec<(String, f64)> {
        self.columns.others_of(self.joints.0)
    }
}

impl Columns {
    /// Names of the joints that no G1 has, and how far they get from 0, rad.
    pub(super) fn others_of(&self, angles: &Array) -> Vec<(String, f64)> {
        let reach = |column: usize| {
            let angles = (0..angles.frames()).map(|i| angles.frame(i)[column].abs());
            angles.fold(0.0, f64::max)
        };
        let others = self.others.iter();
        others
            .map(|(name, column)| (name.clone(), reach(*column)))
            .collect()
    }
}

/// Four numbers as a quaternion.
pub(super) fn quaternion(numbers: &[f64], order: QuaternionOrder) -> Quaternion<f64> {
    match order {
        QuaternionOrder::Wxyz => Quaternion::new(numbers[0], numbers[1], numbers[2], numbers[3]),
        QuaternionOrder::Xyzw => Quaternion::new(numbers[3], numbers[0], numbers[1], numbers[2]),
    }
}

/// Orientations as an array, scalar first.
pub(super) fn quaternions(turns: &[UnitQuaternion<f64>]) -> Array {
    let values = turns.iter().flat_map(|q| [q.w, q.i, q.j, q.k]).collect();
    Array::of(vec![turns.len(), 4], values, false).expect("four numbers each")
}

/// A quaternion of another length than 1 is another order, or none. Files keep about six digits.
pub(super) fn check_unit(
    file: &File<'_>,
    frame: usize,
    field: &str,
    quaternion: &Quaternion<f64>,
) -> Result<(), MotionError> {
    if (quaternion.norm() - 1.0).abs() <= 0.01 {
        return Ok(());
    }
    let problem = format!("the quaternion has length {:.3}", quaternion.norm());
    Err(file.frame(
        frame,
        field,
        problem,
        "it must have length 1; normalise or export it again",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_holds_every_joint_once() {
        for names in [&SDK_29[..], &ISAAC_29, &ISAAC_23, &ours()] {
            let columns = columns(names).unwrap();
            for (column, ours) in columns.ours.iter().zip(ours()) {
                assert_eq!(names[*column], ours);
            }
            for (column, dropped) in columns.dropped.iter().zip(DROPPED) {
                let name = column.map(|column| names[column]);
                assert_eq!(name, Some(dropped).filter(|_| names.len() == 29));
            }
            assert!(columns.others.is_empty());
            let mut sorted = names.to_vec();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), names.len());
        }
        // The 29-joint robot without six joints is ours, in our order.
        let kept: Vec<_> = SDK_29
            .iter()
            .filter(|n| !DROPPED.contains(n))
            .copied()
            .collect();
        assert_eq!(kept, ours());
    }

    #[test]
    fn endings_do_not_matter_but_joints_must_be_there() {
        assert_eq!(short("left_knee_joint_dof"), "left_knee");
        let names: Vec<String> = SDK_29.iter().map(|n| format!("{n}_joint")).collect();
        let mut names: Vec<&str> = names.iter().map(String::as_str).collect();
        assert_eq!(columns(&names).unwrap().ours[12], 12);
        names.push("left_thumb_joint");
        let others = columns(&names).unwrap().others;
        assert_eq!(others, [("left_thumb".to_owned(), 29)]);
        names.retain(|name| *name != "left_knee_joint");
        assert_eq!(columns(&names), Err("left_knee"));
    }

    #[test]
    fn joints_that_are_not_ours_are_kept_apart() {
        // Two frames of 30 joints: 0.00, 0.01, … and the same negative, the thumb last.
        let first: Vec<f64> = (0..30).map(|i| f64::from(i) / 100.0).collect();
        let values = first.iter().copied().chain(first.iter().map(|q| -q));
        let array =
            |shape: [usize; 2], values: Vec<f64>| Array::of(shape.to_vec(), values, false).unwrap();
        let joints = array([2, 30], values.collect());
        let place = array([2, 3], vec![0.0; 6]);
        let turn = array([2, 4], [1.0, 0.0, 0.0, 0.0].repeat(2));
        let names: Vec<&str> = SDK_29.iter().copied().chain(["left_thumb_joint"]).collect();
        let table = Table {
            position: (&place, "p"),
            orientation: (&turn, "q"),
            joints: (&joints, "j"),
            columns: columns(&names).unwrap(),
        };
        let file = File {
            path: std::path::Path::new("x"),
            bytes: b"",
        };
        let rows = table.rows(&file, QuaternionOrder::Wxyz).unwrap();
        // Waist roll and pitch are 13 and 14, pitch and yaw of the wrists 20, 21, 27, 28.
        assert_eq!(rows[0].dropped, [0.13, 0.14, 0.20, 0.21, 0.27, 0.28]);
        assert_eq!(rows[1].joints[12..14], [-0.12, -0.15]);
        assert_eq!(table.others(), [("left_thumb".to_owned(), 0.29)]);
    }
}
