//! What falls to one robot for an episode: all that the rows of `[event]` draw for it.
//!
//! Separate from the table because it has a life: it remembers the last targets and what the sensors told, and goes into
//! snapshots.

use super::arms::Held;
use super::force::Pressed;
use super::senses::Senses;
use super::{EventConfig, GREATEST_DELAY};
use crate::actuator::Gains;
use crate::model::{GRAVITY, Variation};
use crate::randomization::{Row, uniform};
use crate::time::{PHYSICS_STEP, SUBSTEPS};
use dynamics::{Condition, Motors};
use g1::motors::CURVES;
use g1::{JOINTS, RobotState};
use nalgebra::{UnitQuaternion, Vector3};
use observation::{Lot as Known, Truth};
use rand::Rng;
use serde::{Deserialize, Serialize};
use std::f32::consts::TAU;

/// One robot's lot.
#[derive(Clone, Serialize, Deserialize)]
pub(crate) struct Lot {
    /// Physics steps from an action to the motors.
    delay: usize,
    /// Factors of kp, kd and the greatest torque.
    stiffness: [f32; JOINTS],
    damping: [f32; JOINTS],
    strength: [f32; JOINTS],
    /// N·m, and N·m·s/rad.
    friction: [f32; JOINTS],
    drag: [f32; JOINTS],
    /// Direction of gravity, world frame, unit length.
    down: Vector3<f32>,
    /// Whether torque falls with speed.
    curves: bool,
    senses: Senses,
    pressed: Pressed,
    held: Held,
    /// Targets of the last two control steps as the motors take them, the newer first, rad.
    targets: [[f32; JOINTS]; 2],
}

impl Lot {
    /// Draws a robot's lot; what is of its mass and its floor goes into its variation.
    pub(crate) fn draw(table: &EventConfig, variation: &mut Variation, rng: &mut impl Rng) -> Self {
        let mut senses = Senses::exact();
        let delay = steps(table.action_delay, rng);
        senses.delay = steps(table.observation_delay, rng);
        let mut lot = Self {
            delay,
            stiffness: each(table.stiffness, 1.0, rng),
            damping: each(table.damping, 1.0, rng),
            strength: each(table.motor_strength, 1.0, rng),
            friction: each(table.joint_friction, 0.0, rng),
            drag: each(table.joint_damping, 0.0, rng),
            down: -Vector3::z(),
            curves: table.torque_speed,
            senses,
            pressed: Pressed::default(),
            held: Held::default(),
            targets: [[0.0; JOINTS]; 2],
        };
        lot.senses.encoder = each(table.encoder_offset, 0.0, rng);
        if let Some(tilt) = table.imu_tilt {
            lot.senses.mount = lean(tilt, rng);
        }
        if let Some(payload) = table.payload {
            variation.torso_mass += uniform(payload.range, rng);
        }
        if let Some(friction) = table.ground_friction {
            variation.friction = uniform(friction.range, rng);
        }
        if let Some(slope) = table.slope {
            let upright = lean(slope, rng);
            lot.senses.upright = upright;
            lot.down = upright.inverse_transform_vector(&-Vector3::z());
        }
        lot.pressed = Pressed::new(table.force.as_ref(), rng);
        lot.held = Held::new(table.arms.as_ref(), rng);
        lot
    }

    /// At the start of an episode: the motors have held the robot as it is.
    pub(crate) fn begin(&mut self, state: &RobotState) {
        self.targets = [state.joint_positions; 2];
        self.senses.begin(state);
    }

    /// The condition of its body.
    pub(crate) fn condition(&self) -> Condition {
        let Gains {
            mut stiffness,
            mut damping,
            mut effort,
        } = Gains::of_the_robot();
        for i in 0..JOINTS {
            stiffness[i] *= self.stiffness[i];
            damping[i] *= self.damping[i];
            effort[i] *= self.strength[i];
        }
        Condition {
            motors: Motors {
                stiffness,
                damping,
                effort,
            },
            curves: self.curves.then_some(CURVES),
            friction: self.friction,
            drag: self.drag,
            gravity: (self.down * GRAVITY).into(),
        }
    }

    /// The targets of each physics step of the coming control step, rad, for targets that the policy sets now. Motors
    /// measure by the same encoders, so that a joint which reads too much is held as much too low.
    pub(crate) fn targets(&mut self, targets: &[f32; JOINTS]) -> [[f32; JOINTS]; SUBSTEPS] {
        let mut now = *targets;
        for (target, offset) in now.iter_mut().zip(self.senses.encoder) {
            *target -= offset;
        }
        let known = [now, self.targets[0], self.targets[1]];
        self.targets = [now, self.targets[0]];
        std::array::from_fn(|step| known[(self.delay + SUBSTEPS - 1 - step) / SUBSTEPS])
    }

    /// The force of the coming control step (world frame, N), and whether a push begins with it.
    pub(crate) fn press(
        &mut self,
        table: Option<&EventConfig>,
        rng: &mut impl Rng,
    ) -> ([f32; 3], bool) {
        let row = table.and_then(|table| table.force.as_ref());
        self.pressed.step(row, rng)
    }

    /// Holds the arms in the coming control step, if somebody does: `targets` are the policy's, rad.
    pub(crate) fn hold(
        &mut self,
        table: Option<&EventConfig>,
        targets: &mut [f32; JOINTS],
        rng: &mut impl Rng,
    ) {
        let row = table.and_then(|table| table.arms.as_ref());
        self.held.step(row, targets, rng);
    }

    /// After a control step.
    pub(crate) fn sense(&mut self, state: &RobotState) {
        self.senses.step(state);
    }

    /// The robot as its policy sees it.
    pub(crate) fn seen(&self) -> RobotState {
        self.senses.seen()
    }

    /// Tells the truth about itself; what is of mass and floor is told elsewhere.
    pub(crate) fn tell(&self, truth: &mut Truth) {
        let seconds = |steps: usize| steps as f32 * PHYSICS_STEP;
        truth.lot = Known {
            delays: [seconds(self.delay), seconds(self.senses.delay)],
            stiffness: self.stiffness,
            damping: self.damping,
            motor_strength: self.strength,
            down: self.down.into(),
            force: truth.lot.force,
        };
    }

    /// Whether it can be lived with: what a snapshot says may be damaged.
    pub(crate) fn is_sound(&self) -> bool {
        self.delay <= GREATEST_DELAY && self.senses.delay <= GREATEST_DELAY
    }
}

/// A delay in physics steps, the nearest.
fn steps(row: Option<Row>, rng: &mut impl Rng) -> usize {
    row.map_or(0, |row| {
        (uniform(row.range, rng) / PHYSICS_STEP).round() as usize
    })
}

/// A number for each joint.
fn each(row: Option<Row>, nothing: f32, rng: &mut impl Rng) -> [f32; JOINTS] {
    row.map_or([nothing; JOINTS], |row| {
        [(); JOINTS].map(|()| uniform(row.range, rng))
    })
}

/// A turn about a horizontal axis in any direction, by an angle of a row.
fn lean(row: Row, rng: &mut impl Rng) -> UnitQuaternion<f32> {
    let (angle, way) = (uniform(row.range, rng), uniform([0.0, TAU], rng));
    UnitQuaternion::from_scaled_axis(Vector3::new(way.cos(), way.sin(), 0.0) * angle)
}

#[cfg(test)]
mod tests;
