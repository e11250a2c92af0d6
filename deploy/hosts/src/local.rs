//! What both ends read of a configuration: the sizes of rollouts, and how to make them lean.

use std::time::Duration;

use anyhow::{Context, Result};
use hosts::Lean;
use observation::{ObservationConfig, Tables};
use protocol::{Lists, RolloutLayout};
use run::journal::Journal;
use run::{Config, FleetConfig, Folder, RunConfig};

/// What both ends read.
#[derive(Debug)]
pub(crate) struct Local {
    /// Makes rollouts lean, and whole again.
    pub(crate) lean: Lean,
    /// Actors that the run was launched with.
    pub(crate) actors: usize,
    /// How long a send may wait for a busy learner.
    pub(crate) patience: Duration,
    /// How long processes have after the order to end.
    pub(crate) stop: Duration,
    /// Whether every rollout is written down.
    pub(crate) journal: bool,
}

impl Local {
    pub(crate) fn of(config: &Config) -> Result<Self> {
        let run: RunConfig = config.section()?;
        let fleet: FleetConfig = config.section()?;
        let observation: ObservationConfig = config.section()?;
        let tables: Tables = observation.tables().context("section [observation]")?;
        let layout = RolloutLayout {
            environments: fleet.environments_per_actor(),
            steps: fleet.steps,
            lists: Lists::from(&tables),
        };
        Ok(Self {
            lean: Lean::new(layout, tables.actor.in_units("previous_action")),
            actors: fleet.actors,
            patience: Duration::from_secs_f64(run.deadlines.send_seconds),
            stop: Duration::from_secs_f64(run.deadlines.stop_seconds),
            journal: run.journal,
        })
    }

    /// The journal of a process of this host, if one is kept.
    pub(crate) fn journal(&self, folder: &Folder, role: &str) -> Result<Journal> {
        let opened = Journal::open(&folder.logs(), role, self.journal);
        opened.context("opening the journal of rollouts")
    }

    pub(crate) fn layout(&self) -> RolloutLayout {
        *self.lean.layout()
    }
}
