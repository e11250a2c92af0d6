//! What the learner has to know of the robot, as data.
//!
//! The robot's own crate is not imported: learning needs a reflection and two groupings, whatever walks.

use crate::{ACTION, COMMAND, FEATURES, LearningError, OBSERVATION};
use std::ops::Range;

/// A reflection as a permutation with signs: `out[i] = sign[i] · in[index[i]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mirror {
    /// Where each number comes from.
    pub index: Vec<usize>,
    /// +1 or −1.
    pub sign: Vec<f32>,
}

/// What a number of the discriminator's observation measures; each kind has its own least deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    /// m
    Height,
    /// m/s
    LinearVelocity,
    /// rad/s
    AngularVelocity,
    /// rad
    JointPosition,
    /// rad/s
    JointVelocity,
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
    /// Where an observation holds the command.
    pub command: Range<usize>,
    /// Left–right reflection of an action.
    pub action_mirror: Mirror,
    /// Kind of each of the features.
    pub features: Vec<FeatureKind>,
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
    /// Refuses tables of other lengths, and mirrors that are no reflections.
    pub(crate) fn check(&self) -> Result<(), LearningError> {
        let refuse = |what: &str| Err(LearningError::Robot(what.to_owned()));
        if !self.observation_mirror.is_reflection(OBSERVATION) {
            return refuse("the mirror of observations is not a reflection of 82 numbers");
        }
        if !self.action_mirror.is_reflection(ACTION) {
            return refuse("the mirror of actions is not a reflection of 23 numbers");
        }
        if self.command.len() != COMMAND || self.command.end > OBSERVATION {
            return refuse("the command must be 3 numbers of an observation");
        }
        if self.features.len() != FEATURES {
            return refuse("there must be a kind for each of 53 features");
        }
        if self.joints.len() != ACTION {
            return refuse("there must be a group for each of 23 joints");
        }
        Ok(())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

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
            command: 10..13,
            action_mirror: swap(ACTION, -1.0),
            features: vec![FeatureKind::JointPosition; FEATURES],
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
        assert_eq!(simple().check(), Ok(()));
        let mut robot = simple();
        robot.observation_mirror.index[5] = 6; // 6 stays 6: not its own inverse
        assert!(robot.check().is_err());
        let mut robot = simple();
        robot.action_mirror.sign[0] = 1.0; // its partner has −1
        assert!(robot.check().is_err());
        let mut robot = simple();
        robot.command = 80..83;
        assert!(robot.check().is_err());
        let mut robot = simple();
        robot.features.pop();
        assert!(robot.check().is_err());
    }
}
