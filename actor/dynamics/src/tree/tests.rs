//! The walk through the tree against the table of bodies.

use super::*;

#[test]
fn the_walk_is_that_of_the_table() {
    for limb in 0..LIMBS {
        let first = LIMB_FIRST[limb];
        let (root, joints) = if limb < 2 {
            (links::PELVIS, 6)
        } else {
            (links::TORSO, 5)
        };
        assert_eq!(JOINT_TABLE[first].parent, root);
        for (joint, row) in JOINT_TABLE
            .iter()
            .enumerate()
            .skip(first + 1)
            .take(joints - 1)
        {
            assert_eq!(row.parent, joint, "{}", row.name);
        }
    }
    assert_eq!(JOINT_TABLE[joints::WAIST].parent, links::PELVIS);
}

#[test]
fn left_and_right_joints_have_the_same_shape() {
    for limb in [0, 2] {
        let (left, right) = (LIMB_FIRST[limb], LIMB_FIRST[limb + 1]);
        for k in 0..right.abs_diff(left).min(6 - limb / 2) {
            assert_eq!(SHAPES[left + k], SHAPES[right + k]);
        }
    }
    assert_eq!(SHAPES[3], (1, true)); // knee: pitch, in a turned frame
    assert_eq!(SHAPES[joints::WAIST], (2, false));
}

#[test]
fn points_know_what_moves_them() {
    assert_eq!(POINT_TABLE[0].chain(), (0, CHAIN));
    assert_eq!(POINT_TABLE[7].chain(), (1, CHAIN));
    assert_eq!(POINT_TABLE[8].chain(), (0, 10)); // left knee: base and four joints
    assert_eq!(POINT_TABLE[12].chain(), (2, BASE));
    assert_eq!(POINT_TABLE[16].chain(), (2, TRUNK));
    assert_eq!(POINT_TABLE[27].chain(), (3, CHAIN));
    let tree = crate::contact::tree::<f64>(true);
    let (first, end) = tree.of_body[RIGHT_FOOT];
    assert_eq!(tree.order[first..end], [4, 5, 6, 7]);
    assert_eq!(tree.of_body[1].0, tree.of_body[1].1);
}
