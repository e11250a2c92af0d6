//! Which feet stand, and since when: a measure with a memory, which pays for nothing itself.

use crate::time::CONTROL_STEP;
use g1::gait::CONTACT_FORCE;
use g1::links::{LEFT_FOOT, RIGHT_FOOT};
use g1::{RobotState, kinematics};
use serde::{Deserialize, Serialize};

/// A foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Foot {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Foot {
    /// Height of the lowest corner of its sole, m.
    pub(crate) fn height(self, state: &RobotState) -> f32 {
        let link = match self {
            Self::Left => LEFT_FOOT,
            Self::Right => RIGHT_FOOT,
        };
        kinematics::lowest_sole_point(&kinematics::forward_state(state), link)
    }
}

/// Which feet stand, and for how long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Footing {
    /// Of the left and the right foot.
    pub(crate) down: [bool; 2],
    /// Control steps since each came down or was lifted, or since the episode began.
    steps: [u32; 2],
}

impl Footing {
    /// Takes one more control step in: the vertical forces on the left and the right sole, N.
    pub(crate) fn step(&mut self, forces: [f32; 2]) {
        for (foot, force) in forces.into_iter().enumerate() {
            let down = force > CONTACT_FORCE;
            if down != self.down[foot] {
                self.steps[foot] = 0;
            }
            self.down[foot] = down;
            self.steps[foot] += 1;
        }
    }

    /// The foot in the air while the other stands; none with both or none on the ground.
    pub(crate) fn swinging(&self) -> Option<Foot> {
        match self.down {
            [false, true] => Some(Foot::Left),
            [true, false] => Some(Foot::Right),
            _ => None,
        }
    }

    /// How long one foot has stood and the other has not, the shorter of the two, s; 0 with both or none
    /// on the ground.
    pub(crate) fn single_stance(&self) -> f32 {
        if self.down[0] == self.down[1] {
            return 0.0;
        }
        self.steps[0].min(self.steps[1]) as f32 * CONTROL_STEP
    }

    /// How long the foot that was lifted first is in the air, s; 0 with both on the ground.
    pub(crate) fn swing(&self) -> f32 {
        let aloft = |foot: usize| if self.down[foot] { 0 } else { self.steps[foot] };
        aloft(0).max(aloft(1)) as f32 * CONTROL_STEP
    }

    /// How long both feet have been in the air, or were before the one that stands came down, s; 0 with
    /// both on the ground, or if the other was lifted only after that.
    pub(crate) fn flight(&self) -> f32 {
        let [left, right] = self.steps;
        let steps = match self.down {
            [false, false] => left.min(right),
            [true, false] => right.saturating_sub(left),
            [false, true] => left.saturating_sub(right),
            [true, true] => 0,
        };
        steps as f32 * CONTROL_STEP
    }
}
