//! A point ahead of every ankle: the skeleton's toe, or one that is put there.
//!
//! Separate because many skeletons end at the ankle, or in a point straight below it. How the foot turns
//! is known then; that it points, on the whole, to where the hips face is what is added.

use super::{Joints, names::Names};
use nalgebra::Vector3;
use retarget::{Landmark, Side};

/// A toe less far ahead of its ankle, as a share of the leg, says nothing of where the foot points.
const LEAST: f64 = 0.06;
/// How far ahead of the ankle a toe is put, as a share of the leg.
const AHEAD: f64 = 0.18;

/// Where toes come from.
pub(super) enum Toes {
    /// Joints of the skeleton, left and right.
    Joints([usize; 2]),
    /// Places that were worked out, frame by frame; and why.
    Made(Vec<[Vector3<f64>; 2]>, String),
}

/// The toes of a skeleton whose other joints (`of`: side and landmark to joint) and up axis are known;
/// `None` if it has none and nothing says how its feet turn.
pub(super) fn toes(
    joints: &Joints,
    names: &Names,
    named: [Option<usize>; 2],
    of: &dyn Fn(Side, Landmark) -> usize,
    up: Vector3<f64>,
) -> Option<Toes> {
    let level = |v: Vector3<f64>| v - up * v.dot(&up);
    let leg: f64 = joints.frames.first().map_or(0.0, |frame| {
        let [hip, knee, ankle] = [Landmark::Hip, Landmark::Knee, Landmark::Ankle]
            .map(|landmark| frame[of(Side::Left, landmark)]);
        (knee - hip).norm() + (ankle - knee).norm()
    });
    let taken: Vec<usize> = Side::BOTH
        .into_iter()
        .flat_map(|side| Landmark::ALL.map(|landmark| (side, landmark)))
        .filter(|(_, landmark)| *landmark != Landmark::Toe)
        .map(|(side, landmark)| of(side, landmark))
        .collect();
    let toe = |side: Side| {
        let ankle = of(side, Landmark::Ankle);
        let ahead = |toe: &usize| {
            let frames = joints.frames.iter();
            let ahead: f64 = frames
                .map(|frame| level(frame[*toe] - frame[ankle]).norm())
                .sum();
            ahead > LEAST * leg * joints.frames.len() as f64
        };
        let above = |&joint: &usize| joints.parents.get(joint).copied().flatten();
        let hangs = |&joint: &usize| {
            std::iter::successors(Some(joint), above)
                .skip(1)
                .any(|joint| joint == ankle)
        };
        let named = named[side.index()].or_else(|| names.find(side, Landmark::Toe, &taken));
        named
            .into_iter()
            .chain((0..joints.parents.len()).filter(hangs))
            .find(ahead)
    };
    if let [Some(left), Some(right)] = Side::BOTH.map(toe) {
        return Some(Toes::Joints([left, right]));
    }
    let mut places = vec![[Vector3::zeros(); 2]; joints.frames.len()];
    for side in Side::BOTH {
        let ankle = of(side, Landmark::Ankle);
        let turns = joints.turns.get(&ankle)?;
        let facing = |frame: &Vec<Vector3<f64>>| {
            let across =
                frame[of(Side::Left, Landmark::Hip)] - frame[of(Side::Right, Landmark::Hip)];
            across.cross(&up).try_normalize(1e-9).unwrap_or_default()
        };
        let own: Vector3<f64> = joints
            .frames
            .iter()
            .zip(turns)
            .map(|(frame, turn)| turn.cast::<f64>().inverse_transform_vector(&facing(frame)))
            .sum();
        let own = own.try_normalize(1e-9)? * (AHEAD * leg);
        for ((place, frame), turn) in places.iter_mut().zip(&joints.frames).zip(turns) {
            place[side.index()] = frame[ankle] + turn.cast::<f64>() * own;
        }
    }
    let told = "no toes ahead of the ankles: feet point to where the hips face, on the whole";
    Some(Toes::Made(places, told.into()))
}
