//! What the learner reads of the run's configuration.

use std::time::Duration;

use amp::LearningConfig;
use ampco::ScheduleConfig;
use anyhow::{Context, Result};
use motion::{Dataset, MotionConfig};
use protocol::RolloutLayout;
use run::{FleetConfig, Folder, Mode, RunConfig};

use crate::intake::Terms;

/// The sections that the learner needs, read and checked.
pub(crate) struct LearnerConfig {
    pub(crate) run: RunConfig,
    pub(crate) fleet: FleetConfig,
    pub(crate) learning: LearningConfig,
    pub(crate) schedule: ScheduleConfig,
    pub(crate) experts: Dataset,
}

impl LearnerConfig {
    pub(crate) fn read(folder: &Folder) -> Result<Self> {
        let config = folder.config()?;
        let motion: MotionConfig = config.section("motion")?;
        let experts =
            Dataset::load(&motion, folder.path()).context("loading the reference motion")?;
        Ok(Self {
            run: config.checked("run", RunConfig::validate)?,
            fleet: config.checked("fleet", FleetConfig::validate)?,
            learning: LearningConfig {
                policy: config.section("policy")?,
                exploration: config.section("exploration")?,
                ppo: config.section("ppo")?,
                discriminator: config.section("discriminator")?,
            },
            schedule: config.section("scheduler")?,
            experts,
        })
    }

    pub(crate) fn terms(&self) -> Terms {
        Terms {
            lockstep: self.run.mode == Mode::Lockstep,
            max_lag: self.run.max_lag,
            patience: Duration::from_secs_f64(self.run.deadlines.rollout_seconds),
            layout: self.layout(),
        }
    }

    pub(crate) fn layout(&self) -> RolloutLayout {
        RolloutLayout {
            environments: self.fleet.environments_per_actor(),
            steps: self.fleet.steps,
        }
    }
}
