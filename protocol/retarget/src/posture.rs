//! The robot in one frame, and its feet: on the way, and as retargeting makes it.

use g1::JOINTS;
use nalgebra::{Isometry3, Vector3};

/// Where the pelvis is and how the joints stand, in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture {
    /// Frame of the pelvis in the world, m.
    pub base: Isometry3<f64>,
    /// Joint positions, rad.
    pub joints: [f64; JOINTS],
}

/// What directions alone lead to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Free {
    /// The feet in the world, by [`crate::capture::Side::index`].
    pub feet: [Isometry3<f64>; 2],
    /// The hip roll joints in the world, m.
    pub hips: [Vector3<f64>; 2],
    /// The ankle pitch joints in the world, m.
    pub ankles: [Vector3<f64>; 2],
}

/// A foot's frame on the ground; `None` where it does not stand.
pub(crate) type Soles = Vec<Option<Isometry3<f64>>>;
