//! Where an episode begins: a frame of reference motion, or standing.
//!
//! Separate because reference-state initialisation is a choice of its own: most samples of early
//! training lie near where episodes begin.

use crate::command::{CommandConfig, Occasion};
use crate::kind::Kind;
use g1::{JOINT_TABLE, RobotState, kinematics};
use rand::{Rng, RngExt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

mod pools;

pub(crate) use pools::Pools;

/// How starts are drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StartConfig {
    /// Share of episodes that begin in a frame of reference motion, the rest standing. Default 1,
    /// of the recipe that walked (the AMP papers use 0.85).
    pub reference_share: Ramp<f32>,
    /// Least clearance of the soles at the start, m: a lower frame is lifted to it, a frame in
    /// flight stays where it is. Default 0.005.
    pub lift: f32,
    /// Greatest joint-position noise, rad. Default 0.02.
    pub position_noise: f32,
    /// Greatest joint-velocity noise, rad/s. Default 0.1.
    pub velocity_noise: f32,
}

impl Default for StartConfig {
    fn default() -> Self {
        Self {
            reference_share: 1.0.into(),
            lift: 0.005,
            position_noise: 0.02,
            velocity_noise: 0.1,
        }
    }
}

impl StartConfig {
    /// Holds all that moves where it is after a number of samples.
    pub(crate) fn set(&mut self, samples: f64) {
        self.reference_share.set(samples);
    }

    /// Checks every field; names the first bad one.
    pub(crate) fn validate(&self) -> Checked {
        self.reference_share
            .check("reference_share", invalid::share)?;
        let metres = "metres; from higher up every episode begins with a fall";
        invalid::between("lift", self.lift, [0.0, 0.5], metres)?;
        let radians = "radians; half a turn is 3.14";
        invalid::between("position_noise", self.position_noise, [0.0, 3.2], radians)?;
        let radians = "radians per second; the fastest joints turn at 37";
        invalid::between("velocity_noise", self.velocity_noise, [0.0, 40.0], radians)
    }
}

/// Frames of reference motion to begin from, as plain data; empty means always standing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Starts {
    /// The frames.
    pub states: Vec<RobotState>,
    /// The command that fits each frame's clip: vx, vy (m/s), yaw rate (rad/s).
    pub commands: Vec<[f32; 3]>,
    /// Running sum of the frames' weights; the last is the total.
    pub cumulative_weights: Vec<f32>,
}

impl FromIterator<(RobotState, [f32; 3], f32)> for Starts {
    /// From frames with the command that fits and the weight of each.
    fn from_iter<I: IntoIterator<Item = (RobotState, [f32; 3], f32)>>(frames: I) -> Self {
        let mut starts = Self::default();
        let mut sum = 0.0;
        for (state, command, weight) in frames {
            sum += weight;
            starts.states.push(state);
            starts.commands.push(command);
            starts.cumulative_weights.push(sum);
        }
        starts
    }
}

impl Starts {
    /// Checks that the three lists belong together.
    pub fn validate(&self) -> Checked {
        let frames = self.states.len();
        invalid::require(
            self.commands.len() == frames && self.cumulative_weights.len() == frames,
            "starts",
            (frames, self.commands.len(), self.cumulative_weights.len()),
            "give as many commands and cumulative weights as states",
        )?;
        let mut before = 0.0;
        for (i, &weight) in self.cumulative_weights.iter().enumerate() {
            let sound = weight.is_finite() && weight >= before && self.states[i].is_finite();
            invalid::require(
                sound && self.commands[i].iter().all(|x| x.is_finite()),
                "starts",
                i,
                "this frame, its command or its cumulative weight is not finite or not in order",
            )?;
            before = weight;
        }
        invalid::require(
            frames == 0 || before > 0.0,
            "starts.cumulative_weights",
            before,
            "give a positive total",
        )
    }

    /// A frame by weight: its index, or none when there is no motion.
    fn draw(&self, rng: &mut impl Rng) -> Option<usize> {
        let total = *self.cumulative_weights.last()?;
        let at = rng.random::<f32>() * total;
        let frame = self.cumulative_weights.partition_point(|&sum| sum <= at);
        Some(frame.min(self.states.len() - 1))
    }
}

/// How often a frame is drawn until one is found that does not wait for its command; the last one is taken.
const TRIES: usize = 16;

/// How an episode begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Beginning {
    pub(crate) state: RobotState,
    pub(crate) command: [f32; 3],
    /// Whether the robot is in motion that fits the command.
    pub(crate) fits: bool,
}

/// Draws the state and the command of a new episode, of one kind or of any.
pub(crate) fn draw(
    starts: &Starts,
    kind: Option<(Kind, &Pools)>,
    start: &StartConfig,
    commands: &CommandConfig,
    rng: &mut impl Rng,
) -> Beginning {
    let from_motion = rng.random::<f32>() < start.reference_share.now();
    let frame = (0..TRIES).fold(None, |frame, _| match frame {
        Some(frame) if !commands.waits(starts.commands[frame]) => Some(frame),
        _ => match kind {
            Some((kind, pools)) => pools.draw(kind, rng),
            None => starts.draw(rng),
        },
    });
    let kind = kind.map(|(kind, _)| kind);
    let (mut state, command, fits) = match frame.filter(|_| from_motion) {
        Some(frame) => {
            let clip = &starts.commands[frame];
            let motion = Some(*clip);
            let command = commands.draw(Occasion { kind, motion }, rng);
            (starts.states[frame], command, command == *clip)
        }
        None => {
            let command = commands.draw(Occasion { kind, motion: None }, rng);
            (RobotState::standing(), command, false)
        }
    };
    perturb(&mut state, start, rng);
    place(&mut state, start.lift);
    Beginning {
        state,
        command,
        fits,
    }
}

/// Adds uniform noise to the joints, within their limits.
fn perturb(state: &mut RobotState, start: &StartConfig, rng: &mut impl Rng) {
    for (i, joint) in JOINT_TABLE.iter().enumerate() {
        let noisy = state.joint_positions[i] + noise(start.position_noise, rng);
        state.joint_positions[i] = noisy.clamp(joint.lower as f32, joint.upper as f32);
        state.joint_velocities[i] += noise(start.velocity_noise, rng);
    }
}

/// Moves the robot over the origin (f32 is finest there) and at least `lift` above the ground.
fn place(state: &mut RobotState, lift: f32) {
    state.position.x = 0.0;
    state.position.y = 0.0;
    let lowest = kinematics::lowest_foot_point(&kinematics::forward_state(state));
    state.position.z += (lift - lowest).max(0.0);
}

/// A number from −size to size.
pub(crate) fn noise(size: f32, rng: &mut impl Rng) -> f32 {
    size * (2.0 * rng.random::<f32>() - 1.0)
}

#[cfg(test)]
mod tests;
