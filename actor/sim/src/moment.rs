//! What a step came to, as rewards see it: one robot, after one control step, under the command that it had.

use g1::RobotState;
use nalgebra::Vector2;

/// A step that is paid for.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// The command that held during the step: m/s forward, m/s leftward, rad/s.
    pub command: &'a [f32; 3],
    /// The state that the step led to.
    pub state: &'a RobotState,
    /// Positive mechanical work of the motors in the step, J.
    pub work: f32,
    /// ‖v* − v‖², planar, heading frame, m²/s².
    pub velocity_error: f32,
}

impl<'a> Moment<'a> {
    /// With the error of the velocity, which most terms look at.
    pub fn new(command: &'a [f32; 3], state: &'a RobotState, work: f32) -> Self {
        Self {
            command,
            state,
            work,
            velocity_error: velocity_error(command, state),
        }
    }
}

/// Squared velocity error ‖v* − v‖² in the heading frame, m²/s².
pub fn velocity_error(command: &[f32; 3], state: &RobotState) -> f32 {
    (Vector2::new(command[0], command[1]) - state.velocity_in_heading()).norm_squared()
}

/// −g_z, g the unit gravity in the base frame, and no less than 0: 1 upright, 0 lying or upside down.
pub fn uprightness(state: &RobotState) -> f32 {
    (-state.projected_gravity().z).max(0.0)
}
