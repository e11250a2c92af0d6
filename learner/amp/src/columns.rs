//! What a row of a batch is made of.

use std::ops::Range;

/// Numbers of a row of each kind; they follow from what is seen of the robot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Widths {
    /// What the policy sees.
    pub observation: usize,
    /// All that the critic sees; 0 where it sees what the policy does.
    pub critic: usize,
    /// An action.
    pub action: usize,
    /// What the discriminator sees of one state.
    pub features: usize,
    /// What is measured beside.
    pub measured: usize,
}

/// Where a batch's rows hold something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Numbers of what the policy saw.
    Observation(Range<usize>),
    /// Numbers of what the discriminator sees of the state after the step.
    Features(Range<usize>),
    /// Numbers of what is measured beside.
    Measured(Range<usize>),
}

/// A number of what the discriminator sees of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// What it measures.
    pub kind: FeatureKind,
    /// What a quantity in its unit was multiplied by.
    pub scale: f32,
}

/// What a number of the discriminator's observation measures; each kind has its own least deviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    /// m: the pelvis' height, places of other bodies
    Height,
    /// m/s
    LinearVelocity,
    /// rad/s
    AngularVelocity,
    /// rad: joints, and where down is
    JointPosition,
    /// rad/s
    JointVelocity,
}
