//! The batched solver's side of the seam.

use super::Exertion;
use crate::actuator::Gains;
use crate::ground::Ground;
use crate::model::Variation;
use crate::time::{PHYSICS_STEP, SUBSTEPS};
use dynamics::{Build, Condition, Motors, Robots, Saved, Solver};
use g1::{JOINT_TABLE, JOINTS, RobotState};
use nalgebra::Vector3;

/// Sweeps over the contacts of a step: 4 are enough to learn from, twice as many change little.
const SWEEPS: usize = 4;

/// Robots in the batched solver.
pub(crate) struct Batched(Robots);

impl Batched {
    pub(crate) fn new(
        gains: &Gains,
        count: usize,
        ground: Option<&Ground>,
        self_collision: bool,
    ) -> Self {
        let solver = Solver {
            dt: PHYSICS_STEP,
            sweeps: SWEEPS,
            motors: Motors {
                stiffness: gains.stiffness,
                damping: gains.damping,
                effort: gains.effort,
            },
            ground: ground.map_or(dynamics::Ground::Plane, |ground| {
                dynamics::Ground::Heights(ground.heights().clone())
            }),
            self_collision,
        };
        Self(Robots::new(solver, count))
    }

    pub(crate) fn begin(&mut self, robot: usize, variation: &Variation, state: &RobotState) {
        self.0.set_build(
            robot,
            &Build {
                torso_mass: variation.torso_mass,
                torso_com: variation.torso_com,
                friction: variation.friction,
            },
        );
        self.0.set_state(robot, state);
    }

    pub(crate) fn push(&mut self, robot: usize, change: Vector3<f32>) {
        self.0.push(robot, change);
    }

    #[inline]
    pub(crate) fn set_targets(&mut self, robot: usize, targets: &[f32; JOINTS]) {
        self.0.set_targets(robot, targets);
    }

    pub(crate) fn set_targets_by_step(
        &mut self,
        robot: usize,
        targets: &[[f32; JOINTS]; SUBSTEPS],
    ) {
        self.0.set_targets_by_step(robot, targets);
    }

    pub(crate) fn set_condition(&mut self, robot: usize, condition: Option<Condition>) {
        self.0.set_condition(robot, condition.as_ref());
    }

    pub(crate) fn set_force(&mut self, robot: usize, force: [f32; 3]) {
        self.0.set_force(robot, force);
    }

    pub(crate) fn advance(&mut self) {
        self.0.advance(SUBSTEPS);
    }

    #[inline]
    pub(crate) fn work_and_forces(&self, robot: usize) -> (f32, [f32; 2]) {
        let effort = self.0.effort(robot, SUBSTEPS);
        (effort.energy, effort.foot_forces)
    }

    pub(crate) fn exertion(&self, robot: usize) -> Exertion {
        let (energy, foot_forces) = self.work_and_forces(robot);
        let peaks = self.0.peaks(robot);
        let share = |peak: f32, limit: f64| peak / limit as f32;
        Exertion {
            energy,
            foot_forces,
            torque_use: std::array::from_fn(|i| share(peaks.torques[i], JOINT_TABLE[i].effort)),
            speed_use: std::array::from_fn(|i| {
                share(peaks.speeds[i], JOINT_TABLE[i].velocity_limit)
            }),
        }
    }

    #[inline]
    pub(crate) fn state(&self, robot: usize) -> RobotState {
        self.0.state(robot)
    }

    #[inline]
    pub(crate) fn is_sound(&self, robot: usize) -> bool {
        self.0.is_sound(robot)
    }

    pub(crate) fn save(&self) -> Saved {
        self.0.save()
    }

    pub(crate) fn restore(&mut self, saved: Saved) -> bool {
        self.0.restore(saved)
    }
}
