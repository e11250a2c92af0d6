//! What the learner has to know of the robot, as data.
//!
//! The robot's own crate is not imported: learning needs a reflection and two groupings, whatever walks.

use crate::columns::{Feature, Place, Widths};
use crate::{COMMAND, DiscriminatorConfig, LearningError};

/// A reflection as a permutation with signs: `out[i] = sign[i] · in[index[i]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mirror {
    /// Where each number comes from.
    pub index: Vec<usize>,
    /// +1 or −1.
    pub sign: Vec<f32>,
}

/// Where a joint is; each group explores with its own width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointGroup {
    /// Hips, knees, ankles.
    Leg,
    /// The waist.
    Waist,
    /// Shoulders, elbows, wrists.
    Arm,
}

/// Tables of one robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    /// Left–right reflection of a policy observation.
    pub observation_mirror: Mirror,
    /// That of what the critic sees; none where it sees what the policy does.
    pub critic_mirror: Option<Mirror>,
    /// Where rows hold the command: m/s, m/s, rad/s.
    pub command: Place,
    /// Left–right reflection of an action.
    pub action_mirror: Mirror,
    /// Each number that the discriminator sees of a state.
    pub features: Vec<Feature>,
    /// Which of them are the velocities that a command asks for, in its units; none where they are not among them.
    pub velocities: Option<[usize; COMMAND]>,
    /// Numbers that are measured beside.
    pub measured: usize,
    /// Group of each of the actions' joints.
    pub joints: Vec<JointGroup>,
}

impl Mirror {
    /// Reflects one row.
    pub fn apply(&self, row: &[f32], out: &mut [f32]) {
        for ((out, index), sign) in out.iter_mut().zip(&self.index).zip(&self.sign) {
            *out = sign * row[*index];
        }
    }

    /// Whether it maps `length` numbers and is its own inverse, as a reflection is.
    fn is_reflection(&self, length: usize) -> bool {
        self.index.len() == length
            && self.sign.len() == length
            && (0..length).all(|i| {
                self.index.get(self.index[i]) == Some(&i)
                    && self.sign[i] * self.sign[self.index[i]] == 1.0
            })
    }
}

impl Robot {
    /// Numbers of a batch's rows.
    pub fn widths(&self) -> Widths {
        Widths {
            observation: self.observation_mirror.index.len(),
            critic: self
                .critic_mirror
                .as_ref()
                .map_or(0, |mirror| mirror.index.len()),
            action: self.joints.len(),
            features: self.features.len(),
            measured: self.measured,
        }
    }

    /// Numbers that the critic sees.
    pub(crate) fn critic_width(&self) -> usize {
        let mirror = self
            .critic_mirror
            .as_ref()
            .unwrap_or(&self.observation_mirror);
        mirror.index.len()
    }

    /// Refuses tables that contradict each other or what the discriminator is to look at, and mirrors that are no
    /// reflections.
    pub(crate) fn check(&self, discriminator: &DiscriminatorConfig) -> Result<(), LearningError> {
        let refuse = |what: &str| Err(LearningError::Robot(what.to_owned()));
        let widths = self.widths();
        if !self.observation_mirror.is_reflection(widths.observation) {
            return refuse("the mirror of observations is not a reflection");
        }
        if self
            .critic_mirror
            .as_ref()
            .is_some_and(|mirror| !mirror.is_reflection(widths.critic))
        {
            return refuse("the mirror of what the critic sees is not a reflection");
        }
        if !self.action_mirror.is_reflection(widths.action) {
            return refuse("the mirror of actions is not a reflection of a number for each joint");
        }
        let (numbers, end) = match &self.command {
            Place::Observation(numbers) => (numbers, widths.observation),
            Place::Features(numbers) => (numbers, widths.features),
            Place::Measured(numbers) => (numbers, widths.measured),
        };
        if numbers.len() != COMMAND || numbers.end > end {
            return refuse("the command must be 3 numbers of a row");
        }
        if self.features.is_empty()
            || self
                .velocities
                .is_some_and(|places| places.iter().any(|place| *place >= widths.features))
        {
            return refuse("velocities must be among the features, of which there must be some");
        }
        if discriminator.command_blur.is_some() && self.velocities.is_none() {
            return refuse(
                "discriminator.command_blur needs the velocities among the features: name linear_velocity and \
                 angular_velocity in observation.discriminator.terms, without scale or clip",
            );
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::columns::FeatureKind;
    use crate::config::floor;

    /// Numbers of the rows of tests.
    pub(crate) const OBSERVATION: usize = 82;
    pub(crate) const ACTION: usize = 23;
    pub(crate) const FEATURES: usize = 53;

    pub(crate) fn feature(kind: FeatureKind) -> Feature {
        Feature { kind, scale: 1.0 }
    }

    /// A robot without sides: the first two joints swap, all else stays.
    pub(crate) fn simple() -> Robot {
        let swap = |length: usize, sign: f32| {
            let mut mirror = Mirror {
                index: (0..length).collect(),
                sign: vec![1.0; length],
            };
            mirror.index.swap(0, 1);
            mirror.sign[0] = sign;
            mirror.sign[1] = sign;
            mirror
        };
        Robot {
            observation_mirror: swap(OBSERVATION, 1.0),
            critic_mirror: None,
            command: Place::Observation(10..13),
            action_mirror: swap(ACTION, -1.0),
            features: vec![feature(FeatureKind::JointPosition); FEATURES],
            velocities: None,
            measured: 0,
            joints: (0..ACTION)
                .map(|i| match i {
                    0..12 => JointGroup::Leg,
                    12 => JointGroup::Waist,
                    _ => JointGroup::Arm,
                })
                .collect(),
        }
    }

    #[test]
    fn a_mirror_swaps_and_signs() {
        let mirror = Mirror {
            index: vec![1, 0, 2],
            sign: vec![1.0, 1.0, -1.0],
        };
        let mut out = [0.0; 3];
        mirror.apply(&[1.0, 2.0, 3.0], &mut out);
        assert_eq!(out, [2.0, 1.0, -3.0]);
        assert!(mirror.is_reflection(3));
    }

    #[test]
    fn tables_that_are_no_reflection_are_refused() {
        let config = DiscriminatorConfig::default();
        assert_eq!(simple().check(&config), Ok(()));
        let mut robot = simple();
        robot.observation_mirror.index[5] = 6; // 6 stays 6: not its own inverse
        assert!(robot.check(&config).is_err());
        let mut robot = simple();
        robot.action_mirror.sign[0] = 1.0; // its partner has −1
        assert!(robot.check(&config).is_err());
        let mut robot = simple();
        robot.command = Place::Observation(80..83);
        assert!(robot.check(&config).is_err());
        let mut robot = simple();
        robot.features.clear();
        assert!(robot.check(&config).is_err());
    }

    #[test]
    fn the_command_can_be_seen_off_only_where_velocities_are() {
        let config = DiscriminatorConfig {
            command_blur: Some([0.1; COMMAND]),
            ..DiscriminatorConfig::default()
        };
        let said = simple().check(&config).unwrap_err().to_string();
        assert!(said.contains("observation.discriminator.terms"), "{said}");
        let mut robot = simple();
        robot.velocities = Some([1, 2, 6]);
        assert_eq!(robot.check(&config), Ok(()));
        robot.velocities = Some([1, 2, FEATURES]);
        assert!(robot.check(&config).is_err());
    }

    #[test]
    fn a_floor_is_in_what_its_feature_is_scaled_to() {
        // 0.1 rad; a hundredth of 2 rad/s.
        assert_eq!(floor(&feature(FeatureKind::JointPosition)), 0.1);
        let scaled = Feature {
            kind: FeatureKind::JointVelocity,
            scale: 0.01,
        };
        assert!((floor(&scaled) - 0.02).abs() < 1e-9);
    }
}
