//! rapier's settings and its scratch space.
//!
//! Separate from the world because one engine serves all robots of a thread: it holds nothing that
//! the next step of any robot depends on.

use crate::time::PHYSICS_STEP;
use rapier3d::dynamics::{CCDSolver, IntegrationParameters};
use rapier3d::pipeline::PhysicsPipeline;

/// rapier's scratch space and settings: no state of any robot, shared by all worlds of a thread.
pub struct Engine {
    pub(crate) pipeline: PhysicsPipeline,
    pub(crate) ccd: CCDSolver,
    pub(crate) parameters: IntegrationParameters,
}

impl Engine {
    /// At the project's step of 5 ms.
    pub fn new() -> Self {
        Self::with_step(PHYSICS_STEP)
    }

    /// At another step, s, for references that tests compare with.
    pub fn with_step(dt: f32) -> Self {
        Self {
            pipeline: PhysicsPipeline::new(),
            ccd: CCDSolver::new(),
            parameters: IntegrationParameters {
                dt,
                num_solver_iterations: 1,
                num_internal_pgs_iterations: 1,
                num_internal_stabilization_iterations: 1,
                max_ccd_substeps: 0,
                // Both look at what the last steps did instead of at the feet; with one box per
                // foot on a plane there is nothing to save.
                contact_recycling: false,
                contact_clustering: false,
                ..IntegrationParameters::default()
            },
        }
    }

    /// Length of a physics step, s.
    pub fn step(&self) -> f32 {
        self.parameters.dt
    }
}

impl Default for Engine {
    fn default() -> Self {
        Self::new()
    }
}
