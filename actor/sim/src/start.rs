//! Where an episode begins: a frame of reference motion, or standing.
//!
//! Separate because reference-state initialisation is a choice of its own: most samples of early
//! training lie near where episodes begin.

use crate::command::CommandConfig;
use crate::config::{self, Invalid};
use crate::kind::{Kind, Pools};
use g1::{JOINT_TABLE, RobotState, kinematics};
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

/// How starts are drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct StartConfig {
    /// Share of episodes that begin in a frame of reference motion, the rest standing. Default 1,
    /// of the recipe that walked (the AMP papers use 0.85).
    pub reference_share: f32,
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
            reference_share: 1.0,
            lift: 0.005,
            position_noise: 0.02,
            velocity_noise: 0.1,
        }
    }
}

impl StartConfig {
    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Result<(), Invalid> {
        config::share("start.reference_share", self.reference_share)?;
        config::at_least("start.lift", self.lift, 0.0)?;
        config::at_least("start.position_noise", self.position_noise, 0.0)?;
        config::at_least("start.velocity_noise", self.velocity_noise, 0.0)
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
    pub fn validate(&self) -> Result<(), Invalid> {
        let frames = self.states.len();
        config::require(
            self.commands.len() == frames && self.cumulative_weights.len() == frames,
            "starts",
            (frames, self.commands.len(), self.cumulative_weights.len()),
            "give as many commands and cumulative weights as states",
        )?;
        let mut before = 0.0;
        for (i, &weight) in self.cumulative_weights.iter().enumerate() {
            let sound = weight.is_finite() && weight >= before && self.states[i].is_finite();
            config::require(
                sound && self.commands[i].iter().all(|x| x.is_finite()),
                "starts",
                i,
                "this frame, its command or its cumulative weight is not finite or not in order",
            )?;
            before = weight;
        }
        config::require(
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
    let from_motion = rng.random::<f32>() < start.reference_share;
    let frame = match kind {
        Some((kind, pools)) => pools.draw(kind, rng),
        None => starts.draw(rng),
    };
    let kind = kind.map(|(kind, _)| kind);
    let (mut state, command, fits) = match frame.filter(|_| from_motion) {
        Some(frame) => {
            let clip = &starts.commands[frame];
            let command = commands.draw_for_start(kind, clip, rng);
            (starts.states[frame], command, command == *clip)
        }
        None => {
            let command = commands.draw_of(kind, rng);
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
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    fn frames() -> Starts {
        let mut crouched = RobotState::standing();
        crouched.position.z = 0.6; // soles 18 cm underground
        let mut flying = RobotState::standing();
        flying.position.z += 0.1;
        Starts {
            states: vec![crouched, flying],
            commands: vec![[0.8, 0.0, 0.0], [2.2, 0.0, 0.0]],
            cumulative_weights: vec![1.0, 4.0],
        }
    }

    fn clearance(state: &RobotState) -> f32 {
        kinematics::lowest_foot_point(&kinematics::forward_state(state))
    }

    #[test]
    fn frames_are_drawn_by_weight_and_lifted_out_of_the_ground() {
        let start = StartConfig {
            position_noise: 0.0,
            velocity_noise: 0.0,
            ..StartConfig::default()
        };
        let commands = CommandConfig {
            matched_share: 1.0,
            ..CommandConfig::default()
        };
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let mut flying = 0;
        for _ in 0..1_000 {
            let Beginning {
                state,
                command,
                fits,
            } = draw(&frames(), None, &start, &commands, &mut rng);
            assert!(fits);
            if command[0] == 2.2 {
                flying += 1;
                assert!((clearance(&state) - 0.1).abs() < 1e-5);
            } else {
                assert_eq!(command, [0.8, 0.0, 0.0]);
                assert!((clearance(&state) - 0.005).abs() < 1e-5);
            }
        }
        // Weight 3 of 4: Binomial(1000, ¾) is 750 ± 13.7.
        assert!((682..818).contains(&flying), "{flying}");
    }

    #[test]
    fn noise_keeps_its_size_and_the_joint_limits() {
        let mut frame = RobotState::standing();
        frame.joint_positions[3] = JOINT_TABLE[3].lower as f32; // left knee stretched out
        let start = StartConfig::default();
        let mut rng = Pcg64Mcg::seed_from_u64(2);
        let mut greatest = [0.0_f32; 2];
        for _ in 0..200 {
            let mut state = frame;
            perturb(&mut state, &start, &mut rng);
            for i in 0..g1::JOINTS {
                let moved = (state.joint_positions[i] - frame.joint_positions[i]).abs();
                greatest[0] = greatest[0].max(moved);
                greatest[1] = greatest[1].max(state.joint_velocities[i].abs());
            }
            assert!(state.joint_positions[3] >= frame.joint_positions[3]);
        }
        assert!((0.0195..=0.0201).contains(&greatest[0]), "{greatest:?}");
        assert!((0.0975..=0.1).contains(&greatest[1]), "{greatest:?}");
    }

    #[test]
    fn without_motion_or_share_the_robot_stands() {
        let commands = CommandConfig::default();
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let start = StartConfig {
            reference_share: 0.0,
            position_noise: 0.0,
            velocity_noise: 0.0,
            ..StartConfig::default()
        };
        for starts in [Starts::default(), frames()] {
            let Beginning {
                state,
                command,
                fits,
            } = draw(&starts, None, &start, &commands, &mut rng);
            assert_eq!(state.joint_positions, g1::DEFAULT_POSE);
            assert!(!fits);
            assert!((0.4..=1.2).contains(&command[0]));
        }
    }

    #[test]
    fn mismatched_lists_are_refused() {
        let mut starts = frames();
        starts.commands.pop();
        assert!(starts.validate().is_err());
        let mut starts = frames();
        starts.cumulative_weights = vec![2.0, 1.0];
        assert!(starts.validate().is_err());
        frames().validate().unwrap();
        Starts::default().validate().unwrap();
    }
}
