//! Humanoids whose files hold angles only: where their bodies are, so that positions can be worked out.
//!
//! Separate because three formats share it. Tables are figures of the models that the formats belong to.

use nalgebra::{Isometry3, UnitQuaternion, Vector3};

/// How a body turns against its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Joint {
    Fixed,
    /// About an axis, by an angle.
    Hinge(usize),
    /// By a rotation vector.
    Ball,
}
use Joint::{Ball, Fixed, Hinge};

/// A body: name, parent (of the first: itself), place in the parent's frame, m, joint. Angles stand in
/// the order of the bodies.
pub(super) type Body = (&'static str, usize, [f64; 3], Joint);

/// Numbers that a pose of a skeleton has, without the root.
pub(super) fn numbers(bodies: &[Body]) -> usize {
    let count = |(.., joint): &Body| match joint {
        Fixed => 0,
        Hinge(_) => 1,
        Ball => 3,
    };
    bodies.iter().map(count).sum()
}

/// Where all bodies are. The first is the root.
pub(super) fn posed(
    bodies: &[Body],
    root: Isometry3<f64>,
    mut pose: &[f64],
) -> Vec<Isometry3<f64>> {
    let mut frames: Vec<Isometry3<f64>> = Vec::with_capacity(bodies.len());
    let mut take = |count: usize| {
        let (taken, rest) = pose.split_at(count);
        pose = rest;
        taken
    };
    for (body, (_, parent, place, joint)) in bodies.iter().enumerate() {
        if body == 0 {
            frames.push(root);
            continue;
        }
        let turn = match joint {
            Fixed => UnitQuaternion::identity(),
            Hinge(axis) => UnitQuaternion::from_scaled_axis(Vector3::ith(*axis, take(1)[0])),
            Ball => UnitQuaternion::from_scaled_axis(Vector3::from_column_slice(take(3))),
        };
        let local = Isometry3::from_parts(Vector3::from(*place).into(), turn);
        frames.push(frames[*parent] * local);
    }
    frames
}

/// The humanoid of MimicKit, x ahead, y left, z up, arms aside: `data/assets/humanoid/humanoid.xml` of
/// xbpeng/MimicKit at f8d0d709 (Apache-2.0).
pub(super) const MIMICKIT: [Body; 15] = [
    ("pelvis", 0, [0.0, 0.0, 0.0], Fixed),
    ("torso", 0, [0.0, 0.0, 0.236151], Ball),
    ("head", 1, [0.0, 0.0, 0.223894], Ball),
    ("right_upper_arm", 1, [-0.02405, -0.18311, 0.2435], Ball),
    ("right_lower_arm", 3, [0.0, -0.274788, 0.0], Hinge(2)),
    ("right_hand", 4, [0.0, -0.258947, 0.0], Fixed),
    ("left_upper_arm", 1, [-0.02405, 0.18311, 0.2435], Ball),
    ("left_lower_arm", 6, [0.0, 0.274788, 0.0], Hinge(2)),
    ("left_hand", 7, [0.0, 0.258947, 0.0], Fixed),
    ("right_thigh", 0, [0.0, -0.084887, 0.0], Ball),
    ("right_shin", 9, [0.0, 0.0, -0.421546], Hinge(1)),
    ("right_foot", 10, [0.0, 0.0, -0.40987], Ball),
    ("left_thigh", 0, [0.0, 0.084887, 0.0], Ball),
    ("left_shin", 12, [0.0, 0.0, -0.421546], Hinge(1)),
    ("left_foot", 13, [0.0, 0.0, -0.40987], Ball),
];

/// The humanoid of DeepMimic, x ahead, y up, z to the right, arms down: `data/characters/humanoid3d.txt`
/// of xbpeng/DeepMimic (MIT).
pub(super) const DEEPMIMIC: [Body; 15] = [
    ("root", 0, [0.0, 0.0, 0.0], Fixed),
    ("chest", 0, [0.0, 0.236151, 0.0], Ball),
    ("neck", 1, [0.0, 0.223894, 0.0], Ball),
    ("right_thigh", 0, [0.0, 0.0, 0.084887], Ball),
    ("right_shin", 3, [0.0, -0.421546, 0.0], Hinge(2)),
    ("right_foot", 4, [0.0, -0.40987, 0.0], Ball),
    ("right_upper_arm", 1, [-0.02405, 0.2435, 0.18311], Ball),
    ("right_lower_arm", 6, [0.0, -0.274788, 0.0], Hinge(2)),
    ("right_hand", 7, [0.0, -0.258947, 0.0], Fixed),
    ("left_thigh", 0, [0.0, 0.0, -0.084887], Ball),
    ("left_shin", 9, [0.0, -0.421546, 0.0], Hinge(2)),
    ("left_foot", 10, [0.0, -0.40987, 0.0], Ball),
    ("left_upper_arm", 1, [-0.02405, 0.2435, -0.18311], Ball),
    ("left_lower_arm", 12, [0.0, -0.274788, 0.0], Hinge(2)),
    ("left_hand", 13, [0.0, -0.258947, 0.0], Fixed),
];

/// TienKung 2 lite, x ahead, y left, z up, arms down: `tienkung2_lite.urdf` of
/// Open-X-Humanoid/TienKung-Lab at 7ce828b2 (BSD-3-Clause). Its shoulders are tilted by 5° (0.087266 rad
/// about x), which the directions of upper arms have here at rest; the hand is put 20 cm down the forearm.
pub(super) const TIENKUNG: [Body; 23] = [
    ("pelvis", 0, [0.0, 0.0, 0.0], Fixed),
    ("left_hip_roll", 0, [0.0, 0.028, -0.0857], Hinge(0)),
    ("left_thigh", 1, [0.0, 0.122, -0.046], Hinge(1)),
    ("left_hip_yaw", 2, [0.0, 0.0, -0.0987], Hinge(2)),
    ("left_shin", 3, [0.0, 0.0, -0.3013], Hinge(1)),
    ("left_ankle_pitch", 4, [0.0, 0.0, -0.4], Hinge(1)),
    ("left_foot", 5, [0.0, 0.0, 0.0], Hinge(0)),
    ("right_hip_roll", 0, [0.0, -0.028, -0.0857], Hinge(0)),
    ("right_thigh", 7, [0.0, -0.122, -0.046], Hinge(1)),
    ("right_hip_yaw", 8, [0.0, 0.0, -0.0987], Hinge(2)),
    ("right_shin", 9, [0.0, 0.0, -0.3013], Hinge(1)),
    ("right_ankle_pitch", 10, [0.0, 0.0, -0.4], Hinge(1)),
    ("right_foot", 11, [0.0, 0.0, 0.0], Hinge(0)),
    ("left_shoulder_pitch", 0, [0.0, 0.14034, 0.37677], Hinge(1)),
    ("left_upper_arm", 13, [0.0, 0.073, 0.0], Hinge(0)),
    (
        "left_shoulder_yaw",
        14,
        [0.0, 0.011331, -0.129505],
        Hinge(2),
    ),
    (
        "left_lower_arm",
        15,
        [0.019998, 0.013074, -0.149429],
        Hinge(1),
    ),
    ("left_hand", 16, [0.0, 0.0, -0.2], Fixed),
    (
        "right_shoulder_pitch",
        0,
        [0.0, -0.14034, 0.37677],
        Hinge(1),
    ),
    ("right_upper_arm", 18, [0.0, -0.073, 0.0], Hinge(0)),
    (
        "right_shoulder_yaw",
        19,
        [0.0, -0.011331, -0.129505],
        Hinge(2),
    ),
    (
        "right_lower_arm",
        20,
        [0.020003, -0.013074, -0.149429],
        Hinge(1),
    ),
    ("right_hand", 21, [0.0, 0.0, -0.2], Fixed),
];
