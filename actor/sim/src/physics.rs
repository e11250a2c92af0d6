//! The seam between the task and what simulates it: robots by number in one of two engines.
//!
//! Separate because the task, its rewards and resets must be the same code whatever moves the
//! robots. rapier is the default and the judge; the batched solver of `dynamics` is the fast lane.

mod batched;
mod worlds;

use crate::actuator::Gains;
use crate::ground::Ground;
use crate::model::Variation;
use crate::time::SUBSTEPS;
use batched::Batched;
use dynamics::Condition;
use g1::{JOINTS, RobotState};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use worlds::Worlds;

pub use crate::world::Exertion;
pub use vocabulary::{Mechanics, Physics};

/// The robots of a fleet in their engine.
pub(crate) enum Bodies {
    Rapier(Box<Worlds>),
    Batched(Box<Batched>),
}

/// What a snapshot holds of the engine.
#[derive(Serialize, Deserialize)]
pub(crate) enum SavedBodies {
    Rapier(Vec<crate::world::World>),
    Batched(dynamics::Saved),
}

impl SavedBodies {
    /// The engine that they were in.
    pub(crate) fn physics(&self) -> Physics {
        match self {
            Self::Rapier(_) => Physics::Rapier,
            Self::Batched(_) => Physics::Batched,
        }
    }
}

// A macro only so that every call of the seam is a line.
macro_rules! both {
    ($self:ident, $bodies:ident => $call:expr) => {
        match $self {
            Self::Rapier($bodies) => $call,
            Self::Batched($bodies) => $call,
        }
    };
}

impl Bodies {
    /// Robots on a level floor, or on `ground`.
    pub(crate) fn new(
        mechanics: Mechanics,
        gains: &Gains,
        count: usize,
        ground: Option<&Ground>,
    ) -> Self {
        let meet = mechanics.self_collision;
        match mechanics.physics {
            Physics::Rapier => Self::Rapier(Box::new(Worlds::new(gains, count, ground, meet))),
            Physics::Batched => Self::Batched(Box::new(Batched::new(gains, count, ground, meet))),
        }
    }

    /// A fresh robot in a state, nothing left of the one before; the state as the engine holds it.
    pub(crate) fn begin(
        &mut self,
        robot: usize,
        variation: &Variation,
        state: &RobotState,
    ) -> RobotState {
        both!(self, bodies => bodies.begin(robot, variation, state));
        self.state(robot)
    }

    /// Adds to the velocity of a whole robot, world frame, m/s.
    pub(crate) fn push(&mut self, robot: usize, change: Vector3<f32>) {
        both!(self, bodies => bodies.push(robot, change));
    }

    /// Target positions of the coming control step, rad.
    #[inline]
    pub(crate) fn set_targets(&mut self, robot: usize, targets: &[f32; JOINTS]) {
        both!(self, bodies => bodies.set_targets(robot, targets));
    }

    /// The same of each of its physics steps.
    pub(crate) fn set_targets_by_step(
        &mut self,
        robot: usize,
        targets: &[[f32; JOINTS]; SUBSTEPS],
    ) {
        both!(self, bodies => bodies.set_targets_by_step(robot, targets));
    }

    /// Gives a robot that has begun a condition of its own, or takes it away. It is not saved: whoever restores robots
    /// gives it again.
    pub(crate) fn set_condition(&mut self, robot: usize, condition: Option<Condition>) {
        both!(self, bodies => bodies.set_condition(robot, condition));
    }

    /// A force on the torso of a robot that has a condition in the coming control step, world frame, N.
    pub(crate) fn set_force(&mut self, robot: usize, force: [f32; 3]) {
        both!(self, bodies => bodies.set_force(robot, force));
    }

    /// One control step of all robots.
    pub(crate) fn advance(&mut self) {
        both!(self, bodies => bodies.advance());
    }

    /// Positive work of the motors (J) and vertical forces on the soles (N) in the last control step:
    /// what every step asks for.
    #[inline]
    pub(crate) fn work_and_forces(&self, robot: usize) -> (f32, [f32; 2]) {
        both!(self, bodies => bodies.work_and_forces(robot))
    }

    /// All that the last control step took from a robot and felt.
    pub(crate) fn exertion(&self, robot: usize) -> Exertion {
        both!(self, bodies => bodies.exertion(robot))
    }

    #[inline]
    pub(crate) fn state(&self, robot: usize) -> RobotState {
        both!(self, bodies => bodies.state(robot))
    }

    /// Whether a robot's state can be used.
    #[inline]
    pub(crate) fn is_sound(&self, robot: usize) -> bool {
        both!(self, bodies => bodies.is_sound(robot))
    }

    pub(crate) fn save(&self) -> SavedBodies {
        match self {
            Self::Rapier(worlds) => SavedBodies::Rapier(worlds.save()),
            Self::Batched(robots) => SavedBodies::Batched(robots.save()),
        }
    }

    /// False, and nothing changed, if what was saved is of the other engine or of another number.
    pub(crate) fn restore(&mut self, saved: SavedBodies) -> bool {
        match (self, saved) {
            (Self::Rapier(worlds), SavedBodies::Rapier(saved)) => worlds.restore(saved),
            (Self::Batched(robots), SavedBodies::Batched(saved)) => robots.restore(saved),
            _ => false,
        }
    }
}
