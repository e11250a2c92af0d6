//! Which joint of a skeleton is which landmark: by name, else by the hierarchy.
//!
//! Separate because names are a guess that the hierarchy can contradict.

use super::super::file::File;
use super::names::Names;
use super::{Joints, hierarchy};
use crate::error::MotionError;
use retarget::{LANDMARKS, Landmark, Landmarks, Side};

/// The column of each landmark but the toes, which are looked for later and stand at the ankles until
/// then; and the toes as far as the hierarchy tells.
pub(super) fn of(
    file: &File<'_>,
    joints: &Joints,
    names: &Names,
    decisions: &mut Vec<String>,
) -> Result<([usize; LANDMARKS], [Option<usize>; 2]), MotionError> {
    let lost = match by_name(names) {
        Ok(columns) if connected(&joints.parents, &columns) => return Ok((columns, [None; 2])),
        Ok(_) => (Side::Left, Landmark::Knee),
        Err(lost) => lost,
    };
    let found = hierarchy::find(&joints.parents, &joints.frames, names);
    let Some(found) = found else {
        return Err(missing(file, joints, lost.0, lost.1));
    };
    let mut columns = [0; LANDMARKS];
    for side in Side::BOTH {
        let side_found = found[side.index()];
        for landmark in Landmark::ALL {
            let place = match landmark {
                Landmark::Toe => Landmark::Ankle,
                other => other,
            };
            let Some(column) = side_found[place as usize] else {
                return Err(missing(file, joints, side, landmark));
            };
            columns[Landmarks::index(side, landmark)] = column;
        }
    }
    let told: Vec<String> = [
        Landmark::Hip,
        Landmark::Knee,
        Landmark::Ankle,
        Landmark::Shoulder,
    ]
    .into_iter()
    .map(|landmark| {
        let name = &joints.names[columns[Landmarks::index(Side::Left, landmark)]];
        format!("{} {}", landmark.name(), shown(name))
    })
    .collect();
    decisions.push(format!(
        "joints by the hierarchy, names do not tell them: left {}",
        told.join(", ")
    ));
    let toe = |side: Side| found[side.index()][Landmark::Toe as usize];
    Ok((columns, Side::BOTH.map(toe)))
}

/// A joint's name, which may be anything, as part of a line.
fn shown(name: &str) -> String {
    const LONGEST: usize = 40;
    name.chars()
        .take(LONGEST)
        .flat_map(char::escape_debug)
        .collect()
}

/// The column of each landmark by its name, toes at the ankles; or the first that is not named.
fn by_name(names: &Names) -> Result<[usize; LANDMARKS], (Side, Landmark)> {
    let mut columns = [0; LANDMARKS];
    for side in Side::BOTH {
        let mut taken: Vec<usize> = Vec::new();
        for landmark in Landmark::ALL {
            let column = match landmark {
                Landmark::Toe => columns[Landmarks::index(side, Landmark::Ankle)],
                other => names.find(side, other, &taken).ok_or((side, other))?,
            };
            taken.push(column);
            columns[Landmarks::index(side, landmark)] = column;
        }
    }
    Ok(columns)
}

/// Whether knees hang on hips, ankles on knees and so on, as far as is known.
fn connected(parents: &[Option<usize>], columns: &[usize; LANDMARKS]) -> bool {
    use Landmark::{Ankle, Elbow, Hip, Knee, Shoulder, Wrist};
    if parents.is_empty() {
        return true;
    }
    let bones = [
        (Hip, Knee),
        (Knee, Ankle),
        (Shoulder, Elbow),
        (Elbow, Wrist),
    ];
    let hangs = |(upper, lower): (usize, usize)| {
        let above = |&joint: &usize| parents.get(joint).copied().flatten();
        std::iter::successors(Some(lower), above)
            .skip(1)
            .any(|joint| joint == upper)
    };
    Side::BOTH.into_iter().all(|side| {
        let at = |landmark| columns[Landmarks::index(side, landmark)];
        // Formats of positions put every joint on the root: nothing hangs on anything there.
        let flat = bones.iter().all(|&(_, lower)| {
            let parent = parents[at(lower)];
            parent.is_none_or(|parent| parents[parent].is_none())
        });
        flat || bones
            .iter()
            .all(|&(upper, lower)| hangs((at(upper), at(lower))))
    })
}

pub(super) fn missing(
    file: &File<'_>,
    joints: &Joints,
    side: Side,
    landmark: Landmark,
) -> MotionError {
    let side = if side == Side::Left { "left" } else { "right" };
    file.unusable(
        &format!(
            "has no joint for the {side} {} (but {})",
            landmark.name(),
            shortened(&joints.names)
        ),
        "rename the joint, for example LeftUpLeg, LeftLeg, LeftFoot, LeftToeBase, LeftArm, LeftForeArm, \
         LeftHand",
    )
}

fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 12;
    let shown = names
        .iter()
        .take(SHOWN)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    match names.len().checked_sub(SHOWN) {
        Some(more @ 1..) => format!("{shown} and {more} more"),
        _ => shown,
    }
}
