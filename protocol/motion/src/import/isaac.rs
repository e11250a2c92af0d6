//! AMP motions of Isaac Lab (`.npz`) and Isaac Gym (`.npy`).
//!
//! Separate as every format is. Isaac Lab's files hold the positions of named bodies and, if the robot
//! is a G1, its joints by name; Isaac Gym's hold rotations of a skeleton. Both humanoids have no toes:
//! a foot points along its own x.

use super::Row;
use super::file::File;
use super::file::array::{Array, PLACES};
use super::file::npz::Archive;
use super::file::pickle::Pickle;
use super::human::Joints;
use super::joints::{self, Table};
use super::lean;
use crate::config::QuaternionOrder;
use crate::error::MotionError;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// What an Isaac Lab file holds.
pub(super) enum Lab {
    /// A G1.
    Robot(Vec<Row>),
    /// Any other humanoid.
    Humanoid(Joints),
}

/// Reads an Isaac Lab file: motion and frames per second.
pub(super) fn lab(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Lab, Option<f64>), MotionError> {
    let mut archive = Archive::open(file)?;
    let fps = archive.scalar(&["fps"])?;
    let bodies = archive.words("body_names")?.unwrap_or_default();
    let positions = archive.numbers("body_positions")?;
    let rotations = archive.numbers("body_rotations")?;
    positions.check(file, "body_positions", &[3 * bodies.len()], PLACES)?;
    rotations.check(
        file,
        "body_rotations",
        &[4 * bodies.len()],
        (f64::INFINITY, ""),
    )?;
    rotations.check_length(file, "body_rotations", (&positions, "body_positions"))?;
    let frames = bodies_in_frames(file, &positions, &rotations)?;
    let dofs = archive.words("dof_names")?.unwrap_or_default();
    let dofs: Vec<&str> = dofs.iter().map(String::as_str).collect();
    if let Ok(columns) = joints::columns(&dofs) {
        let angles = archive.numbers("dof_positions")?;
        let part = |array: &Array, width: usize| {
            let values = (0..array.frames()).flat_map(|i| &array.frame(i)[..width]);
            Array::of(
                vec![array.frames(), width],
                values.copied().collect(),
                false,
            )
        };
        // The first body is the pelvis.
        let (place, turn) = (part(&positions, 3), part(&rotations, 4));
        let (Some(place), Some(turn)) = (place, turn) else {
            return Err(file.unusable("has no body", "export the motion again"));
        };
        let table = Table {
            position: (&place, "body_positions"),
            orientation: (&turn, "body_rotations"),
            joints: (&angles, "dof_positions"),
            columns,
        };
        decisions.push(format!("a G1 with {} joints, by name", dofs.len()));
        lean::say_others(&table.others(), decisions);
        return Ok((Lab::Robot(table.rows(file, QuaternionOrder::Wxyz)?), fps));
    }
    decisions.push(format!("a humanoid of {} bodies, by name", bodies.len()));
    Ok((Lab::Humanoid(with_toes(bodies, &frames)), fps))
}

/// Reads an Isaac Gym file: joint positions and frames per second.
pub(super) fn gym(
    file: &File<'_>,
    decisions: &mut Vec<String>,
) -> Result<(Joints, Option<f64>), MotionError> {
    let pickle = Pickle::of_npy(file)?;
    let part = |path: &[&str]| {
        pickle.array(path).ok_or_else(|| {
            let keys = pickle.holds();
            file.unusable(
                &format!("has no array {} (but {keys})", path.join(".")),
                "save it from a SkeletonMotion",
            )
        })
    };
    let tree = |name| ["skeleton_tree", name, "arr"];
    let names = pickle
        .words(&["skeleton_tree", "node_names"])
        .unwrap_or_default();
    let (parents, offsets) = (
        part(&tree("parent_indices"))?,
        part(&tree("local_translation"))?,
    );
    let (rotation, root) = (
        part(&["rotation", "arr"])?,
        part(&["root_translation", "arr"])?,
    );
    offsets.check(file, "local_translation", &[3], PLACES)?;
    root.check(file, "root_translation", &[3], PLACES)?;
    rotation.check(file, "rotation", &[4 * names.len()], (f64::INFINITY, ""))?;
    rotation.check_length(file, "rotation", (&root, "root_translation"))?;
    if offsets.frames() != names.len() || parents.values.len() != names.len() {
        return Err(file.unusable("has a skeleton of unequal parts", "save it again"));
    }
    let fps = pickle
        .array(&["fps"])
        .and_then(|fps| fps.values.first().copied());
    decisions.push(format!(
        "a skeleton of {} nodes, quaternions w last",
        names.len()
    ));
    let local = pickle
        .array(&["is_local"])
        .is_none_or(|flag| flag.values == [1.0]);
    let frames: Vec<Vec<Isometry3<f64>>> = (0..root.frames())
        .map(|i| {
            let mut frames: Vec<Isometry3<f64>> = Vec::with_capacity(names.len());
            for (node, name) in names.iter().enumerate() {
                let numbers = &rotation.frame(i)[4 * node..4 * node + 4];
                let quaternion = joints::quaternion(numbers, QuaternionOrder::Xyzw);
                joints::check_unit(file, i, name, &quaternion)?;
                let turn = UnitQuaternion::from_quaternion(quaternion);
                // A parent stands before its children; the root's is −1.
                let parent = (parents.values[node] as isize)
                    .try_into()
                    .ok()
                    .and_then(|p: usize| frames.get(p));
                let frame = match parent {
                    Some(parent) => {
                        let place = parent * nalgebra::Point3::from_slice(offsets.frame(node));
                        let turn = if local { parent.rotation * turn } else { turn };
                        Isometry3::from_parts(place.coords.into(), turn)
                    }
                    None => Isometry3::from_parts(
                        Vector3::from_column_slice(root.frame(i)).into(),
                        turn,
                    ),
                };
                frames.push(frame);
            }
            Ok(frames)
        })
        .collect::<Result<_, MotionError>>()?;
    Ok((with_toes(names, &frames), fps))
}

fn bodies_in_frames(
    file: &File<'_>,
    positions: &Array,
    rotations: &Array,
) -> Result<Vec<Vec<Isometry3<f64>>>, MotionError> {
    (0..positions.frames())
        .map(|i| {
            let places = positions
                .frame(i)
                .chunks_exact(3)
                .map(Vector3::from_column_slice);
            places
                .zip(rotations.frame(i).chunks_exact(4))
                .map(|(place, numbers)| {
                    let quaternion = joints::quaternion(numbers, QuaternionOrder::Wxyz);
                    joints::check_unit(file, i, "body_rotations", &quaternion)?;
                    Ok(Isometry3::from_parts(
                        place.into(),
                        UnitQuaternion::from_quaternion(quaternion),
                    ))
                })
                .collect()
        })
        .collect()
}

/// Positions of bodies, and a toe 15 cm ahead of each foot.
pub(super) fn with_toes(names: Vec<String>, frames: &[Vec<Isometry3<f64>>]) -> Joints {
    let feet: Vec<usize> = (0..names.len())
        .filter(|&i| names[i].ends_with("foot"))
        .collect();
    let toes = feet.iter().map(|&i| names[i].replace("foot", "toe"));
    let with_toes: Vec<String> = names.iter().cloned().chain(toes).collect();
    let place = |frame: &Vec<Isometry3<f64>>| {
        let bodies = frame.iter().map(|body| body.translation.vector);
        let toes = feet
            .iter()
            .map(|&i| (frame[i] * nalgebra::Point3::new(0.15, 0.0, 0.0)).coords);
        bodies.chain(toes).collect()
    };
    Joints {
        names: with_toes,
        frames: frames.iter().map(place).collect(),
        ..Joints::default()
    }
}

#[cfg(test)]
#[path = "isaac_tests.rs"]
pub(super) mod tests;
