//! What an actor reads of the run's configuration: the task and the clips that robots start from.

use std::time::Duration;

use anyhow::{Context, Result};
use motion::{Dataset, MotionConfig};
use observation::{ObservationConfig, Tables};
use protocol::{Lists, RolloutLayout};
use run::{FleetConfig, Folder, RunConfig};
use sim::{EventConfig, Mechanics, RandomizationConfig, Starts, TaskConfig};
use tracing::warn;

/// The sections that an actor needs, read and checked.
pub struct ActorConfig {
    /// Seed of the whole run.
    pub seed: u64,
    /// Size of this actor's rollouts.
    pub layout: RolloutLayout,
    /// Robots of a rollout that explore calmly.
    pub calm: usize,
    /// Which engine moves the robots, and what may touch.
    pub mechanics: Mechanics,
    /// What is seen of the robots.
    pub tables: Tables,
    /// Commands, rewards, ends of episodes.
    pub task: TaskConfig,
    /// Table I.
    pub randomization: RandomizationConfig,
    /// What befalls robots.
    pub event: EventConfig,
    /// Frames for reference-state initialisation.
    pub starts: Starts,
    /// How long a send may wait for a busy learner.
    pub send_patience: Duration,
    /// Whether every rollout is written down.
    pub journal: bool,
}

impl ActorConfig {
    /// Reads the run's configuration and generates or loads its clips.
    pub fn read(folder: &Folder) -> Result<Self> {
        let config = folder.config()?;
        let run: RunConfig = config.section()?;
        let fleet: FleetConfig = config.section()?;
        let motion: MotionConfig = config.section()?;
        let dataset =
            Dataset::load(&motion, folder.path()).context("loading the reference motion")?;
        // Files may come and go while the group runs; a process that restarts then must not learn from others in silence.
        for change in folder.motion_differences(&Dataset::files(&motion, folder.path())?)? {
            warn!(
                change,
                "the reference motion is not what the run began with"
            );
        }
        let observation: ObservationConfig = config.section()?;
        let tables = observation.tables().context("section [observation]")?;
        Ok(Self {
            seed: run.seed,
            layout: RolloutLayout {
                environments: fleet.environments_per_actor(),
                steps: fleet.steps,
                lists: Lists::from(&tables),
            },
            calm: fleet.calm_robots(),
            mechanics: fleet.mechanics(),
            tables,
            task: config.section()?,
            randomization: config.section()?,
            event: config.section()?,
            starts: dataset
                .frames()
                .map(|(state, command, weight)| (*state, command, weight))
                .collect(),
            send_patience: Duration::from_secs_f64(run.deadlines.send_seconds),
            journal: run.journal,
        })
    }
}
