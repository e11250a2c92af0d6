//! `policy.json`: everything that has to be known to run the policy on a robot or in a simulator.
//!
//! Separate because it is a contract with programs that are not ours: whoever implements what is written there, in the
//! units and frames that are written there, has the environment that the policy was trained in.

use std::collections::BTreeMap;

use g1::{ACTION_SCALE, JOINT_TABLE, RobotState};
use observation::{Scene, Table};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::held::{self, HeldMotor};
use crate::network::Network;
use crate::onnx;
use crate::operation::{Commands, Operation};

/// What `format` says.
pub const FORMAT: &str = "ampco policy";
/// What `version` says; a reader refuses a greater one.
pub const VERSION: u32 = 3;

/// The whole file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// [`FORMAT`].
    pub format: String,
    /// [`VERSION`].
    pub version: u32,
    /// Where the policy comes from.
    pub origin: Origin,
    /// The network's file, its input and output.
    pub network: NetworkDescription,
    /// From an action to torques, and how often.
    pub control: Control,
    /// The joints, in the order of every vector of a number each.
    pub joints: Vec<JointDescription>,
    /// Motors of the larger G1 that the policy does not drive.
    #[serde(default)]
    pub held_motors: Vec<HeldMotor>,
    /// The terms of an observation, in order and without gaps.
    pub observation: Vec<Term>,
    /// What has to be known besides to run it.
    pub operation: Operation,
    /// One observation and the action that belongs to it, to check an installation with.
    pub example: Example,
    /// The `[task]` section that it was trained under: when a robot has fallen, how rewards are computed.
    pub task: Value,
    /// The rows of domain randomisation (Table I) with their ranges.
    pub randomization: Value,
}

/// Which training made the policy.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// The run's name.
    pub run: String,
    /// Iterations that it was trained for.
    pub iteration: u64,
    /// SHA-256 of the flat weights, little-endian f32; it names the policy whatever file it is in.
    pub weights_sha256: String,
    /// SHA-256 of the configuration that it was trained under, as TOML without comments.
    pub config_sha256: String,
    /// SHA-256 of each file beside this one, by name.
    pub files_sha256: BTreeMap<String, String>,
}

/// The network.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NetworkDescription {
    /// Name of the ONNX input, `[batch, inputs]`.
    pub input: String,
    /// Name of the ONNX output, `[batch, joints]`.
    pub output: String,
    /// Widths of the hidden layers, ELU after each.
    pub hidden: Vec<usize>,
    /// What is done to an observation first; it is inside the ONNX model.
    pub normalisation: String,
    /// Normalised observations are cut to ± this.
    pub clip: f32,
}

/// From an action to torques.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Actions per second.
    pub policy_hz: f64,
    /// Physics steps per second of the simulation; torques are computed anew in each.
    pub physics_hz: f64,
    /// Radians of target per unit of action.
    pub action_scale: f32,
    /// The law in words.
    pub law: String,
    /// The previous action of the first observation.
    pub first_previous_action: f32,
}

/// A joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointDescription {
    /// Name in Unitree's URDF.
    pub name: String,
    /// rad.
    pub default_position: f64,
    /// rad.
    pub lower: f64,
    /// rad.
    pub upper: f64,
    /// N·m/rad.
    pub kp: f64,
    /// N·m·s/rad.
    pub kd: f64,
    /// N·m.
    pub effort: f64,
    /// rad/s.
    pub velocity_limit: f64,
    /// kg·m².
    pub armature: f64,
    /// Index of its motor in Unitree's `LowCmd` and `LowState` (`unitree_hg`), which count 29: waist roll and pitch (13, 14)
    /// and wrists' pitch and yaw (20, 21, 27, 28) are not there, and are held at 0 on the larger robot.
    #[serde(default)]
    pub unitree_motor: u32,
}

/// A stretch of the observation: a quantity, cut to its clip and then multiplied by its scale, of the present first and
/// then of `past` control steps before it, the newest of them first. At the start the first one stands for those before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Term {
    /// What it is.
    pub name: String,
    /// Index of its first number.
    pub start: usize,
    /// How many numbers.
    pub length: usize,
    /// Their unit.
    pub unit: String,
    /// The frame that they are in.
    pub frame: String,
    /// What each of its numbers is called; those of the past follow in the same order.
    pub labels: Vec<String>,
    /// What a quantity in its unit is multiplied by before it is put into the observation.
    pub scale: f32,
    /// Uniform noise, ± this, in its unit, that the policy was trained with besides Table I.
    pub noise: f32,
    /// It is cut to ± this, in its unit; it is not where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clip: Option<f32>,
    /// Control steps before the present one that are seen too.
    pub past: usize,
    /// In words.
    pub meaning: String,
}

/// An observation and its action.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Example {
    /// Standing in the default pose, asked to walk forward at 0.5 m/s.
    pub observation: Vec<f32>,
    /// The policy's action.
    pub action: Vec<f32>,
}

impl Description {
    /// Of a network that sees what `seen` lists and was told `commands`; `rates` are those of the policy and of physics, Hz.
    ///
    /// # Panics
    /// If the network sees another number of numbers.
    pub fn new(
        network: &Network,
        seen: &Table,
        origin: Origin,
        rates: [f64; 2],
        commands: Commands,
        task: Value,
        randomization: Value,
    ) -> Self {
        let [policy_hz, physics_hz] = rates;
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            origin,
            network: NetworkDescription {
                input: onnx::INPUT.to_owned(),
                output: onnx::OUTPUT.to_owned(),
                hidden: network.hidden().to_vec(),
                normalisation: "clip((observation − mean)·inverse_deviation, ±clip)".to_owned(),
                clip: network.clip(),
            },
            control: Control {
                policy_hz,
                physics_hz,
                action_scale: ACTION_SCALE,
                law: "target = default_position + action_scale·action, held between actions; \
                      torque = kp·(target − q) − kd·q̇ in every physics step, at most ±effort"
                    .to_owned(),
                first_previous_action: 0.0,
            },
            joints: joints(),
            held_motors: held::motors(),
            observation: terms(seen),
            operation: Operation::of(commands),
            example: example(network, seen),
            task,
            randomization,
        }
    }
}

/// `G1JointIndex` of unitree_sdk2: left leg, right leg, waist yaw, left arm to the wrist's roll, right arm.
const UNITREE_MOTORS: [u32; g1::JOINTS] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 15, 16, 17, 18, 19, 22, 23, 24, 25, 26,
];

fn joints() -> Vec<JointDescription> {
    JOINT_TABLE
        .iter()
        .zip(UNITREE_MOTORS)
        .map(|(joint, unitree_motor)| JointDescription {
            name: joint.name.to_owned(),
            default_position: joint.default_position,
            lower: joint.lower,
            upper: joint.upper,
            kp: joint.kp,
            kd: joint.kd,
            effort: joint.effort,
            velocity_limit: joint.velocity_limit,
            armature: joint.armature,
            unitree_motor,
        })
        .collect()
}

fn terms(seen: &Table) -> Vec<Term> {
    let term = |(entry, numbers): (&observation::Entry, std::ops::Range<usize>)| Term {
        name: entry.term.name.to_owned(),
        start: numbers.start,
        length: numbers.len(),
        unit: entry.term.unit.to_owned(),
        frame: entry.term.frame.to_owned(),
        labels: entry
            .term
            .labels
            .iter()
            .map(|label| (*label).to_owned())
            .collect(),
        scale: entry.scale,
        noise: entry.noise,
        clip: entry.clip,
        past: entry.past,
        meaning: entry.term.meaning.to_owned(),
    };
    seen.in_row().map(term).collect()
}

fn example(network: &Network, seen: &Table) -> Example {
    let standing = RobotState::standing();
    let observation = seen.row(&Scene {
        command: &[0.5, 0.0, 0.0],
        ..Scene::of(&standing)
    });
    Example {
        action: network.action(&observation).to_vec(),
        observation,
    }
}

#[cfg(test)]
mod tests;
