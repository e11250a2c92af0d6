//! rapier's side of the seam: a world per robot, one after another.

use super::Exertion;
use crate::actuator::{Gains, Law};
use crate::engine::Engine;
use crate::ground::Ground;
use crate::model::Variation;
use crate::time::SUBSTEPS;
use crate::world::World;
use dynamics::Condition;
use g1::{DEFAULT_POSE, JOINTS, RobotState};
use nalgebra::Vector3;

/// Robots in rapier.
pub(crate) struct Worlds {
    engine: Engine,
    gains: Gains,
    /// A world that was never stepped.
    template: World,
    worlds: Vec<World>,
    /// Of each physics step.
    targets: Vec<[[f32; JOINTS]; SUBSTEPS]>,
    conditions: Vec<Option<Box<Condition>>>,
    exertions: Vec<Exertion>,
}

impl Worlds {
    pub(crate) fn new(
        gains: &Gains,
        count: usize,
        ground: Option<&Ground>,
        self_collision: bool,
    ) -> Self {
        let mut template = World::with_self_collision(&Variation::NOMINAL, self_collision);
        if let Some(ground) = ground {
            template.lay(ground);
        }
        Self {
            engine: Engine::new(),
            gains: gains.clone(),
            worlds: vec![template.clone(); count],
            template,
            targets: vec![[DEFAULT_POSE; SUBSTEPS]; count],
            conditions: vec![None; count],
            exertions: vec![Exertion::default(); count],
        }
    }

    pub(crate) fn begin(&mut self, robot: usize, variation: &Variation, state: &RobotState) {
        // A used world remembers its contacts; a copy of a fresh one has the bits of a fresh one.
        let mut world = if *variation == Variation::NOMINAL {
            self.template.clone()
        } else {
            World::from_template(&self.template, variation)
        };
        world.set_state(state);
        self.worlds[robot] = world;
    }

    pub(crate) fn push(&mut self, robot: usize, change: Vector3<f32>) {
        self.worlds[robot].push(change);
    }

    pub(crate) fn set_targets(&mut self, robot: usize, targets: &[f32; JOINTS]) {
        self.targets[robot] = [*targets; SUBSTEPS];
    }

    pub(crate) fn set_targets_by_step(
        &mut self,
        robot: usize,
        targets: &[[f32; JOINTS]; SUBSTEPS],
    ) {
        self.targets[robot] = *targets;
    }

    pub(crate) fn set_condition(&mut self, robot: usize, condition: Option<Condition>) {
        self.conditions[robot] = condition.map(Box::new);
    }

    pub(crate) fn set_force(&mut self, robot: usize, force: [f32; 3]) {
        self.worlds[robot].set_force(force);
    }

    pub(crate) fn advance(&mut self) {
        let robots = self.worlds.iter_mut().zip(&self.targets);
        let conditions = self.conditions.iter().zip(&mut self.exertions);
        for ((world, targets), (condition, exertion)) in robots.zip(conditions) {
            let law = match condition {
                None => Law::Table(&self.gains),
                Some(condition) => Law::Own(condition),
            };
            *exertion = world.control_step_by(&mut self.engine, law, targets);
        }
    }

    pub(crate) fn work_and_forces(&self, robot: usize) -> (f32, [f32; 2]) {
        let exertion = &self.exertions[robot];
        (exertion.energy, exertion.foot_forces)
    }

    pub(crate) fn exertion(&self, robot: usize) -> Exertion {
        self.exertions[robot]
    }

    pub(crate) fn state(&self, robot: usize) -> RobotState {
        self.worlds[robot].state()
    }

    pub(crate) fn is_sound(&self, robot: usize) -> bool {
        self.worlds[robot].is_sound()
    }

    pub(crate) fn save(&self) -> Vec<World> {
        self.worlds.clone()
    }

    pub(crate) fn restore(&mut self, saved: Vec<World>) -> bool {
        let whole = saved.len() == self.worlds.len();
        if whole {
            self.worlds = saved;
        }
        whole
    }
}
