//! The G1 in the terms of learning: reflections, kinds of features, groups of joints.
//!
//! Here because `amp` knows no robot, and `g1` and `observation` know no learning.

use amp::{Feature, FeatureKind, JointGroup, Mirror, Place, Robot};
use g1::JOINTS;
use g1::joints::WAIST;
use g1::mirror::ACTION_MIRROR;
use observation::{Kind, Reflection, Tables};

/// The tables that learning asks for, of a robot that is seen as lists say.
pub fn robot(tables: &Tables) -> Robot {
    let own = tables.critic.as_ref();
    Robot {
        observation_mirror: mirror(tables.actor.reflection()),
        critic_mirror: own.map(|_| mirror(tables.critic_reflection())),
        command: place(tables.places().command),
        action_mirror: Mirror {
            index: ACTION_MIRROR.index.to_vec(),
            sign: ACTION_MIRROR.sign.to_vec(),
        },
        features: features(tables),
        velocities: tables.velocities(),
        measured: tables.measured.width(),
        joints: (0..JOINTS).map(group).collect(),
    }
}

fn mirror(Reflection { index, sign }: Reflection) -> Mirror {
    Mirror { index, sign }
}

/// Where a batch holds what a place says.
pub(crate) fn place(place: observation::Place) -> Place {
    match place {
        observation::Place::Observation(numbers) => Place::Observation(numbers),
        observation::Place::Features(numbers) => Place::Features(numbers),
        observation::Place::Measured(numbers) => Place::Measured(numbers),
    }
}

fn features(tables: &Tables) -> Vec<Feature> {
    let entries = tables.discriminator.in_row();
    let of_entry = |(entry, numbers): (&observation::Entry, std::ops::Range<usize>)| {
        let kind = match entry.term.kind {
            Kind::Length | Kind::Beside => FeatureKind::Height,
            Kind::LinearVelocity => FeatureKind::LinearVelocity,
            Kind::AngularVelocity => FeatureKind::AngularVelocity,
            Kind::Gravity | Kind::JointPosition => FeatureKind::JointPosition,
            Kind::JointVelocity => FeatureKind::JointVelocity,
        };
        let scale = entry.scale;
        numbers.map(move |_| Feature { kind, scale })
    };
    entries.flat_map(of_entry).collect()
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
        let robot = robot(&Tables::default());
        let count = |group| robot.joints.iter().filter(|other| **other == group).count();
        assert_eq!(
            [JointGroup::Leg, JointGroup::Waist, JointGroup::Arm].map(count),
            [12, 1, 10]
        );
        let of = |kind| {
            robot
                .features
                .iter()
                .filter(|other| other.kind == kind)
                .count()
        };
        // Height, velocities, positions and velocities of the joints: the paper's list.
        assert_eq!(
            [of(FeatureKind::Height), of(FeatureKind::JointPosition)],
            [1, JOINTS]
        );
        assert_eq!(of(FeatureKind::JointVelocity), JOINTS);
        assert_eq!(robot.velocities, Some([1, 2, 6]));
        assert!(robot.critic_mirror.is_none() && robot.measured == 0);
    }

    #[test]
    fn what_other_lists_say_is_known_to_learning() {
        let config: observation::ObservationConfig = toml::from_str(
            "[critic]\nterms = ['actor', 'foot_forces']\n\
             [discriminator]\nterms = ['gravity', 'key_bodies']\n\
             [discriminator.term.gravity]\nscale = 3.0",
        )
        .unwrap();
        let robot = robot(&config.tables().unwrap());
        let critic = robot.critic_mirror.as_ref().unwrap();
        // The feet change places behind all that the actor sees.
        let seen = robot.observation_mirror.index.len();
        assert_eq!(critic.index[seen..], [seen + 1, seen]);
        assert_eq!(robot.features[0].kind, FeatureKind::JointPosition);
        assert_eq!(
            (robot.features[0].scale, robot.features[3].scale),
            (3.0, 1.0)
        );
        assert_eq!((robot.features.len(), robot.velocities), (3 + 15, None));
        assert_eq!(robot.widths().critic, seen + 2);
    }
}
