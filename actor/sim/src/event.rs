//! What befalls a real robot and no simulation by itself: `[event]`, named rows with a range each. A row that is not listed
//! does not exist, and draws nothing.
//!
//! Separate from Table I, which is the paper's: late commands and late sensors, motors that are weaker, stiffer or rubbed
//! on, sensors that stand aslant, loads, slopes, pushes that last and arms that are held. All but these two are drawn once
//! for an episode ([`lot::Lot`]); reward, features and falls see the true state.

pub(crate) mod arms;
pub(crate) mod force;
pub(crate) mod lot;
pub(crate) mod senses;
mod spell;

use crate::randomization::{RandomizationConfig, Row};
use crate::time::{CONTROL_STEP, PHYSICS_STEP, SUBSTEPS};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
pub use spell::Spell;
use vocabulary::invalid::{self, Invalid, range_between, within};
use vocabulary::{Checked, Ramp, Section};

/// `[event]`: what befalls robots. Without any row, the default, nothing does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[schemars(extend("terms" = true))]
pub struct EventConfig {
    /// How much the table counts: its ranges lie so much of the way between nothing (factors and friction of the ground: 1)
    /// and themselves. Default 1, from the start.
    pub strength: Ramp<f32>,
    /// Share of robots that the table leaves alone. Default 0. Where it is that of `[randomization]`, they are the same robots.
    pub plain_share: f32,
    /// Time from an action to the motors, s, in whole physics steps of 5 ms; until then the targets before it hold.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub action_delay: Option<Row>,
    /// Age of what the policy sees of the robot, s, in steps of 5 ms: of states between two control steps a straight line
    /// between both. Its command and its previous action it knows at once.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub observation_delay: Option<Row>,
    /// Factor of each motor's stiffness kp.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<Row>,
    /// Factor of each motor's damping kd.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<Row>,
    /// Factor of each motor's greatest torque.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motor_strength: Option<Row>,
    /// Dry friction of each joint, N·m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_friction: Option<Row>,
    /// Friction of each joint that grows with its speed, N·m·s/rad, beside the motor's damping.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_damping: Option<Row>,
    /// What each joint reads too much, rad. Its motor is misled with the policy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub encoder_offset: Option<Row>,
    /// How far the IMU stands aslant, rad, about a horizontal axis in any direction: all that is seen of the pelvis is
    /// turned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub imu_tilt: Option<Row>,
    /// Mass that is added to the torso, kg, beside that of `[randomization]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub payload: Option<Row>,
    /// Friction coefficient between soles and ground; without the row, that of `[randomization]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground_friction: Option<Row>,
    /// Slope of the ground, rad, uphill in any direction: gravity leans, and the ground stays level.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slope: Option<Row>,
    /// A push that lasts, now and then: a horizontal force on the torso, N, in any direction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<Spell>,
    /// Arms that are held from outside, now and then, off the default pose, rad, whatever the policy wants of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arms: Option<Spell>,
    /// Whether motors have less torque the faster they turn, as those of the robot do ([`g1::motors`]). Default: all of it.
    #[serde(skip_serializing_if = "is_off")]
    pub torque_speed: bool,
}

/// A row of the table: its key, what no range of it may go beyond and why, and the value that changes nothing.
struct Kind {
    name: &'static str,
    limits: [f32; 2],
    why: &'static str,
    nothing: f32,
}

const fn kind(name: &'static str, limits: [f32; 2], nothing: f32, why: &'static str) -> Kind {
    Kind {
        name,
        limits,
        why,
        nothing,
    }
}

/// Greatest delay, physics steps: two control steps.
pub(crate) const GREATEST_DELAY: usize = 2 * SUBSTEPS;
const DELAYS: [f32; 2] = [0.0, GREATEST_DELAY as f32 * PHYSICS_STEP];
const DELAY: &str = "seconds, two control steps at most";
const FACTORS: [f32; 2] = [0.1, 10.0];
const FACTOR: &str = "a factor of what the robot's table says";

/// All rows in the order of [`EventConfig`].
const KINDS: [Kind; 14] = [
    kind("action_delay", DELAYS, 0.0, DELAY),
    kind("observation_delay", DELAYS, 0.0, DELAY),
    kind("stiffness", FACTORS, 1.0, FACTOR),
    kind("damping", FACTORS, 1.0, FACTOR),
    kind("motor_strength", FACTORS, 1.0, FACTOR),
    kind(
        "joint_friction",
        [0.0, 20.0],
        0.0,
        "newton metres; the motors have 0.6 to 2.4, an arm gives 25 in all",
    ),
    kind(
        "joint_damping",
        [0.0, 20.0],
        0.0,
        "newton metre seconds per radian; the motors have 0.06 to 0.24, the controller 1 to 5",
    ),
    kind(
        "encoder_offset",
        [-0.5, 0.5],
        0.0,
        "radians; an ankle rolls by 0.26 to either side",
    ),
    kind(
        "imu_tilt",
        [-0.5, 0.5],
        0.0,
        "radians; nobody mounts an IMU more than 29 degrees aslant",
    ),
    kind(
        "payload",
        [-4.0, 30.0],
        0.0,
        "kilograms; the torso weighs 7.8 kg and has to keep some, the whole robot weighs 32",
    ),
    kind(
        "ground_friction",
        [0.0, 3.0],
        1.0,
        "a coefficient of friction is never negative, ice has 0.05, rubber on concrete about 1",
    ),
    kind(
        "slope",
        [-0.35, 0.35],
        0.0,
        "radians; steeper than 20 degrees is a stair",
    ),
    kind(
        "force",
        [0.0, 2000.0],
        0.0,
        "newtons; the robot weighs 315 N",
    ),
    kind(
        "arms",
        [0.0, 1.5],
        0.0,
        "radians off the default pose; a right angle is 1.57",
    ),
];

/// The rows of the table by their keys.
pub const ROWS: [&str; KINDS.len()] = {
    let mut names = [""; KINDS.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = KINDS[i].name;
        i += 1;
    }
    names
};

/// Least mass that may be added to the torso in all, kg.
const LEAST_LOAD: f32 = -7.0;

impl Default for EventConfig {
    fn default() -> Self {
        Self {
            strength: 1.0.into(),
            plain_share: 0.0,
            action_delay: None,
            observation_delay: None,
            stiffness: None,
            damping: None,
            motor_strength: None,
            joint_friction: None,
            joint_damping: None,
            encoder_offset: None,
            imu_tilt: None,
            payload: None,
            ground_friction: None,
            slope: None,
            force: None,
            arms: None,
            torque_speed: false,
        }
    }
}

impl Section for EventConfig {
    const NAME: &'static str = "event";

    fn validate(&self) -> Checked {
        self.strength.check("strength", invalid::share)?;
        invalid::share("plain_share", self.plain_share)?;
        let mut copy = self.clone();
        for (kind, range) in KINDS.iter().zip(copy.ranges()) {
            if let Some(range) = range {
                let checked = range_between("range", *range, kind.limits, kind.why);
                within(kind.name, checked)?;
            }
        }
        if let Some(force) = self.force {
            let why = "seconds; what lasts longer is a slope";
            force.check("force", [PHYSICS_STEP, 10.0], why)?;
        }
        if let Some(arms) = self.arms {
            let why = "seconds, from one control step to an hour";
            arms.check("arms", [CONTROL_STEP, 3_600.0], why)?;
        }
        Ok(())
    }
}

impl EventConfig {
    /// The range of every row, in the order of [`KINDS`].
    fn ranges(&mut self) -> [Option<&mut [f32; 2]>; KINDS.len()] {
        fn of(row: &mut Option<Row>) -> Option<&mut [f32; 2]> {
            row.as_mut().map(|row| &mut row.range)
        }
        [
            of(&mut self.action_delay),
            of(&mut self.observation_delay),
            of(&mut self.stiffness),
            of(&mut self.damping),
            of(&mut self.motor_strength),
            of(&mut self.joint_friction),
            of(&mut self.joint_damping),
            of(&mut self.encoder_offset),
            of(&mut self.imu_tilt),
            of(&mut self.payload),
            of(&mut self.ground_friction),
            of(&mut self.slope),
            self.force.as_mut().map(|force| &mut force.range),
            self.arms.as_mut().map(|arms| &mut arms.range),
        ]
    }

    /// The table after a number of samples that the learner has used, at full strength of its own: with the ranges that
    /// count then.
    #[must_use]
    pub fn at(&self, samples: f64) -> Self {
        let part = self.strength.at(samples);
        if part == 0.0 {
            return Self::default();
        }
        let mut grown = Self {
            strength: 1.0.into(),
            ..self.clone()
        };
        for (kind, range) in KINDS.iter().zip(grown.ranges()) {
            if let Some(range) = range {
                // Exact at both ends.
                *range = range.map(|end| kind.nothing * (1.0 - part) + end * part);
            }
        }
        grown
    }

    /// Whether there is any row.
    pub fn has_rows(&self) -> bool {
        let mut copy = self.clone();
        self.torque_speed || copy.ranges().iter().any(Option::is_some)
    }

    /// Refuses what the table and Table I would both say of a robot.
    pub fn check_beside(&self, randomization: &RandomizationConfig) -> Checked {
        if let (Some(row), Some(_)) = (self.ground_friction, randomization.friction) {
            return Err(Invalid::new(
                "ground_friction.range",
                row.range,
                "[randomization] has a row `friction` already, which says the same: take one of them away",
            ));
        }
        let least = |row: Option<Row>| row.map_or(0.0, |row| row.range[0].min(0.0));
        let payload = least(self.payload);
        let load = payload + least(randomization.mass_variation);
        let remedy = format!(
            "with the row `mass_variation` of [randomization] the torso would lose {} kg, and has 7.8: {} at most",
            -load, -LEAST_LOAD
        );
        invalid::require(load >= LEAST_LOAD, "payload.range", payload, remedy)
    }
}

fn is_off(switch: &bool) -> bool {
    !switch
}

#[cfg(test)]
mod tests;
