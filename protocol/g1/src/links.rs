//! The 24 bodies: masses, centres of mass, inertias, and the sole of a foot.
//!
//! Separate from the joints because only the simulation weighs the robot, while everyone bends it.
//! Source: Unitree's `robots/g1_description/g1_23dof_rev_1_0.urdf` in unitreerobotics/unitree_ros
//! at commit d6f13aad, BSD-3-Clause. Fixed links (contour, logo, head) are merged into their parents.

use crate::BODIES;

/// A rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Name in the URDF.
    pub name: &'static str,
    /// Index of the parent body; the pelvis has none.
    pub parent: Option<usize>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the link frame, m.
    pub com: [f64; 3],
    /// Inertia about the centre of mass along the link's axes, kg·m²: xx, yy, zz, xy, xz, yz.
    pub inertia: [f64; 6],
}

/// Body index of the pelvis, the free base.
pub const PELVIS: usize = 0;
/// Body index of the left foot (`left_ankle_roll_link`).
pub const LEFT_FOOT: usize = 6;
/// Body index of the right foot (`right_ankle_roll_link`).
pub const RIGHT_FOOT: usize = 12;
/// Body index of the torso.
pub const TORSO: usize = 13;
/// Index of the left wrist and hand.
pub const LEFT_HAND: usize = 18;
/// Index of the right wrist and hand.
pub const RIGHT_HAND: usize = 23;

/// Half extents of the box that stands for a foot in contact, m.
///
/// Its bottom face matches the lowest points of Unitree's four contact spheres (radius 5 mm at
/// x −0.05 and 0.12, z −0.03): a flat sole from heel to toe, 35 mm below the ankle.
pub const FOOT_HALF_EXTENTS: [f64; 3] = [0.085, 0.03, 0.01];
/// Centre of the foot box in the frame of the foot body, m.
pub const FOOT_CENTRE: [f64; 3] = [0.035, 0.0, -0.025];
/// Height of the ankle joint above the sole, m.
pub const SOLE_DEPTH: f64 = 0.035;
/// The corners of the sole in the frame of the foot body, m: heel left, heel right, toe left, toe right.
pub const SOLE_CORNERS: [[f64; 3]; 4] = [
    [-0.05, 0.03, -SOLE_DEPTH],
    [-0.05, -0.03, -SOLE_DEPTH],
    [0.12, 0.03, -SOLE_DEPTH],
    [0.12, -0.03, -SOLE_DEPTH],
];

/// The robot's mass, kg.
pub fn total_mass() -> f64 {
    LINK_TABLE.iter().map(|link| link.mass).sum()
}

const ROOT: usize = usize::MAX;

const fn link(
    name: &'static str,
    parent: usize,
    mass: f64,
    com: [f64; 3],
    inertia: [f64; 6],
) -> Link {
    let parent = if parent == ROOT { None } else { Some(parent) };
    Link {
        name,
        parent,
        mass,
        com,
        inertia,
    }
}

// A macro only so that a row of the table stays a line.
macro_rules! table {
    ($($row:tt,)*) => { [$(link $row),*] };
}

/// The bodies in order: name, parent, mass, centre of mass, inertia xx yy zz xy xz yz.
pub const LINK_TABLE: [Link; BODIES] = table! {
        ("pelvis",                       ROOT, 3.814,     [0.0, 0.0, -0.07603006030414265], [0.01055488208608613, 0.00931478208608613, 0.0079185, 0.0, 2.1e-06, 0.0]),
        ("left_hip_pitch_link",          0,    1.35,      [0.002741, 0.047791, -0.02606], [0.001811, 0.0014193, 0.0012812, 3.68e-05, -3.44e-05, 0.000171]),
        ("left_hip_roll_link",           1,    1.52,      [0.029812, -0.001045, -0.087934], [0.0023773, 0.0024123, 0.0016595, -3.8e-06, -0.0003908, 1.84e-05]),
        ("left_hip_yaw_link",            2,    1.702,     [-0.057709, -0.010981, -0.15078], [0.0057774, 0.0076124, 0.003149, -0.0005411, -0.0023948, -0.0007072]),
        ("left_knee_link",               3,    1.932,     [0.005457, 0.003964, -0.12074], [0.011329, 0.011277, 0.0015168, 4.82e-05, -4.49e-05, -0.0007146]),
        ("left_ankle_pitch_link",        4,    0.074,     [-0.007269, 0.0, 0.011137], [8.4e-06, 1.89e-05, 1.26e-05, 0.0, -2.9e-06, 0.0]),
        ("left_ankle_roll_link",         5,    0.608,     [0.026505, 0.0, -0.016425], [0.0002231, 0.0016161, 0.0016667, 2e-07, 8.91e-05, -1e-07]),
        ("right_hip_pitch_link",         0,    1.35,      [0.002741, -0.047791, -0.02606], [0.001811, 0.0014193, 0.0012812, -3.68e-05, -3.44e-05, -0.000171]),
        ("right_hip_roll_link",          7,    1.52,      [0.029812, 0.001045, -0.087934], [0.0023773, 0.0024123, 0.0016595, 3.8e-06, -0.0003908, -1.84e-05]),
        ("right_hip_yaw_link",           8,    1.702,     [-0.057709, 0.010981, -0.15078], [0.0057774, 0.0076124, 0.003149, 0.0005411, -0.0023948, 0.0007072]),
        ("right_knee_link",              9,    1.932,     [0.005457, -0.003964, -0.12074], [0.011329, 0.011277, 0.0015168, -4.82e-05, 4.49e-05, 0.0007146]),
        ("right_ankle_pitch_link",       10,   0.074,     [-0.007269, 0.0, 0.011137], [8.4e-06, 1.89e-05, 1.26e-05, 0.0, -2.9e-06, 0.0]),
        ("right_ankle_roll_link",        11,   0.608,     [0.026505, 0.0, -0.016425], [0.0002231, 0.0016161, 0.0016667, -2e-07, 8.91e-05, 1e-07]),
        ("torso_link",                   0,    7.817,     [0.002031334463349111, 0.00033972674939235003, 0.1845971451963669], [0.12164651964290055, 0.10977258485702901, 0.02752191941535313, 3.111021029758628e-05, -0.0037428195854218842, -1.5429925458139438e-05]),
        ("left_shoulder_pitch_link",     13,   0.718,     [0.0, 0.035892, -0.011628], [0.0004291, 0.000453, 0.000423, -9.2e-06, 6.4e-06, 2.26e-05]),
        ("left_shoulder_roll_link",      14,   0.643,     [-0.000227, 0.00727, -0.063243], [0.0006177, 0.0006912, 0.0003894, -1e-06, 8.7e-06, -5.3e-06]),
        ("left_shoulder_yaw_link",       15,   0.734,     [0.010773, -0.002949, -0.072009], [0.0009988, 0.0010605, 0.0004354, 7.9e-06, 0.0001412, -2.86e-05]),
        ("left_elbow_link",              16,   0.6,       [0.064956, 0.004454, -0.010062], [0.0002891, 0.0004152, 0.0004197, 6.53e-05, 1.72e-05, -5.6e-06]),
        ("left_wrist_roll_rubber_hand",  17,   0.35692864, [0.1079465665, 0.00163511945, 0.00202244863], [0.00019613494735, 0.00200280358206, 0.00194181412808, -4.19816908e-06, -3.95086058e-05, 2.49774203e-06]),
        ("right_shoulder_pitch_link",    13,   0.718,     [0.0, -0.035892, -0.011628], [0.0004291, 0.000453, 0.000423, 9.2e-06, 6.4e-06, -2.26e-05]),
        ("right_shoulder_roll_link",     19,   0.643,     [-0.000227, -0.00727, -0.063243], [0.0006177, 0.0006912, 0.0003894, 1e-06, 8.7e-06, 5.3e-06]),
        ("right_shoulder_yaw_link",      20,   0.734,     [0.010773, 0.002949, -0.072009], [0.0009988, 0.0010605, 0.0004354, -7.9e-06, 0.0001412, 2.86e-05]),
        ("right_elbow_link",             21,   0.6,       [0.064956, -0.004454, -0.010062], [0.0002891, 0.0004152, 0.0004197, -6.53e-05, 1.72e-05, 5.6e-06]),
        ("right_wrist_roll_rubber_hand", 22,   0.35692864, [0.1079465665, -0.00163511945, 0.00202244863], [0.00019613494735, 0.00200280358206, 0.00194181412808, 4.19816908e-06, -3.95086058e-05, -2.49774203e-06]),
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JOINT_TABLE;

    #[test]
    fn mass_is_that_of_the_urdf() {
        assert!((total_mass() - 32.107).abs() < 5e-4); // the URDF's own sum is 32.10685728
    }

    #[test]
    fn every_joint_moves_the_next_body_and_hangs_on_its_parent() {
        assert_eq!(LINK_TABLE.len(), 24);
        for (i, joint) in JOINT_TABLE.iter().enumerate() {
            assert_eq!(
                LINK_TABLE[i + 1].parent,
                Some(joint.parent),
                "{}",
                joint.name
            );
            assert!(joint.parent <= i, "a parent comes before its child");
        }
        assert_eq!(LINK_TABLE[PELVIS].parent, None);
        assert_eq!(LINK_TABLE[LEFT_FOOT].name, "left_ankle_roll_link");
        assert_eq!(LINK_TABLE[RIGHT_FOOT].name, "right_ankle_roll_link");
        assert_eq!(LINK_TABLE[TORSO].name, "torso_link");
        assert_eq!(LINK_TABLE[LEFT_HAND].name, "left_wrist_roll_rubber_hand");
        assert_eq!(LINK_TABLE[RIGHT_HAND].name, "right_wrist_roll_rubber_hand");
    }

    #[test]
    fn inertias_are_physical() {
        // A rigid body's moments satisfy the triangle inequality: xx + yy > zz and so on.
        for link in &LINK_TABLE {
            let [xx, yy, zz, xy, xz, yz] = link.inertia;
            assert!(
                xx + yy > zz && yy + zz > xx && zz + xx > yy,
                "{}",
                link.name
            );
            assert!(
                xy * xy < xx * yy && xz * xz < xx * zz && yz * yz < yy * zz,
                "{}",
                link.name
            );
        }
    }

    #[test]
    fn foot_box_ends_at_the_sole() {
        assert_eq!(FOOT_CENTRE[2] - FOOT_HALF_EXTENTS[2], -SOLE_DEPTH);
        for [x, y, z] in SOLE_CORNERS {
            assert!(((x - FOOT_CENTRE[0]).abs() - FOOT_HALF_EXTENTS[0]).abs() < 1e-12);
            assert!(((y - FOOT_CENTRE[1]).abs() - FOOT_HALF_EXTENTS[1]).abs() < 1e-12);
            assert_eq!(z, -SOLE_DEPTH);
        }
    }
}
