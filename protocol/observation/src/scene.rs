//! What terms are written from: a robot at one moment, and what only a simulation knows of it.

use g1::{COMMAND, JOINTS, RobotState};

/// A robot at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// Its true state.
    pub state: &'a RobotState,
    /// The command in force: m/s forward, m/s leftward, rad/s.
    pub command: &'a [f32; COMMAND],
    /// The action of the step before, zeros at an episode's start.
    pub previous_action: &'a [f32; JOINTS],
    /// What only a simulation knows.
    pub truth: &'a Truth,
}

/// What a simulation knows of a robot and the robot itself does not.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Truth {
    /// Friction coefficient between soles and ground.
    pub friction: f32,
    /// Added to the torso's mass, kg.
    pub payload: f32,
    /// Added to the torso's centre of mass, torso frame, m.
    pub com_offset: [f32; 3],
    /// Vertical force on the left and the right sole, mean over the last step, N; zeros before the first.
    pub foot_forces: [f32; 2],
    /// The jump of velocity by a push in the last step, world frame, m/s; zeros where there was none.
    pub push: [f32; 3],
}

impl Truth {
    /// The robot of the tables on a floor of friction 1, in the air, pushed by nobody.
    pub const NOMINAL: Self = Self {
        friction: 1.0,
        payload: 0.0,
        com_offset: [0.0; 3],
        foot_forces: [0.0; 2],
        push: [0.0; 3],
    };
}

impl<'a> Scene<'a> {
    /// Of reference motion, which has a state and nothing else.
    pub fn of(state: &'a RobotState) -> Self {
        Self {
            state,
            command: &[0.0; COMMAND],
            previous_action: &[0.0; JOINTS],
            truth: &Truth::NOMINAL,
        }
    }
}
