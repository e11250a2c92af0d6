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
    /// What has befallen it. Not written down: whoever knows it says it again.
    #[serde(skip)]
    pub lot: Lot,
}

/// What has befallen a robot for an episode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lot {
    /// From an action to the motors, and age of what the policy sees, s.
    pub delays: [f32; 2],
    /// Factor of every motor's stiffness.
    pub stiffness: [f32; JOINTS],
    /// Factor of every motor's damping.
    pub damping: [f32; JOINTS],
    /// Factor of every motor's greatest torque.
    pub motor_strength: [f32; JOINTS],
    /// Direction of gravity, world frame, unit length.
    pub down: [f32; 3],
    /// Force on the torso in the last step, world frame, N.
    pub force: [f32; 3],
}

impl Lot {
    /// Nothing has.
    pub const NOMINAL: Self = Self {
        delays: [0.0; 2],
        stiffness: [1.0; JOINTS],
        damping: [1.0; JOINTS],
        motor_strength: [1.0; JOINTS],
        down: [0.0, 0.0, -1.0],
        force: [0.0; 3],
    };
}

impl Default for Lot {
    fn default() -> Self {
        Self::NOMINAL
    }
}

impl Truth {
    /// The robot of the tables on a floor of friction 1, in the air, pushed by nobody.
    pub const NOMINAL: Self = Self {
        friction: 1.0,
        payload: 0.0,
        com_offset: [0.0; 3],
        foot_forces: [0.0; 2],
        push: [0.0; 3],
        lot: Lot::NOMINAL,
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
