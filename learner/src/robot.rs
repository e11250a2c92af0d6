//! The G1 in the terms of learning: reflections, kinds of features, groups of joints.
//!
//! Here because `amp` knows no robot and `g1` knows no learning.

use amp::{FeatureKind, JointGroup, Mirror, Robot};
use g1::joints::WAIST;
use g1::mirror::{self, ACTION_MIRROR, OBSERVATION_MIRROR};
use g1::observation::COMMAND;
use g1::{FEATURES, JOINTS};

/// The tables that learning asks for.
pub fn robot() -> Robot {
    Robot {
        observation_mirror: mirror_of(&OBSERVATION_MIRROR),
        command: COMMAND,
        action_mirror: mirror_of(&ACTION_MIRROR),
        features: (0..FEATURES).map(kind).collect(),
        joints: (0..JOINTS).map(group).collect(),
    }
}

fn mirror_of<const N: usize>(mirror: &mirror::Mirror<N>) -> Mirror {
    Mirror {
        index: mirror.index.to_vec(),
        sign: mirror.sign.to_vec(),
    }
}

fn kind(feature: usize) -> FeatureKind {
    match feature {
        0 => FeatureKind::Height,
        1..4 => FeatureKind::LinearVelocity,
        4..7 => FeatureKind::AngularVelocity,
        7..30 => FeatureKind::JointPosition,
        _ => FeatureKind::JointVelocity,
    }
}

/// Legs come before the waist, arms after it.
fn group(joint: usize) -> JointGroup {
    match joint {
        ..WAIST => JointGroup::Leg,
        WAIST => JointGroup::Waist,
        _ => JointGroup::Arm,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twelve_leg_joints_one_waist_ten_arm_joints() {
        let robot = robot();
        let count = |group| robot.joints.iter().filter(|other| **other == group).count();
        assert_eq!(
            [JointGroup::Leg, JointGroup::Waist, JointGroup::Arm].map(count),
            [12, 1, 10]
        );
        let velocities = robot
            .features
            .iter()
            .filter(|kind| **kind == FeatureKind::JointVelocity);
        assert_eq!(velocities.count(), 23);
    }
}
