//! How the numbers of a term are reflected, and how a vector is written.

use nalgebra::Vector3;

/// The reflection of what has no side.
pub(crate) fn same(i: usize) -> (usize, f32) {
    (i, 1.0)
}

/// Of vectors of space (velocity, gravity, places), one after another: y turns round.
pub(crate) fn polar(i: usize) -> (usize, f32) {
    (i, if i % 3 == 1 { -1.0 } else { 1.0 })
}

/// Of an axis of rotation: only rotation about y stays.
pub(crate) fn axial(i: usize) -> (usize, f32) {
    (i, if i % 3 == 1 { 1.0 } else { -1.0 })
}

/// Of a number for each joint.
pub(crate) fn of_joints(i: usize) -> (usize, f32) {
    let mirror = &g1::mirror::ACTION_MIRROR;
    (mirror.index[i], mirror.sign[i])
}

/// Of a number for each joint that has no direction.
pub(crate) fn pairs(i: usize) -> (usize, f32) {
    (g1::mirror::ACTION_MIRROR.index[i], 1.0)
}

/// Of a number for the left side and one for the right.
pub(crate) fn sides(i: usize) -> (usize, f32) {
    (1 - i, 1.0)
}

pub(crate) fn put(vector: &Vector3<f32>, out: &mut [f32]) {
    out.copy_from_slice(vector.as_slice());
}
