//! What the learner reads of the run's configuration.

use std::time::Duration;

use amp::{DiscriminatorConfig, IterationReport, LearningConfig};
use ampco::ScheduleConfig;
use anyhow::{Context, Result};
use motion::{Dataset, MotionConfig};
use observation::{ObservationConfig, Tables};
use protocol::{Lists, RolloutLayout};
use run::{Config, FleetConfig, Folder, Mode, RunConfig};
use toml::Value;
use tracing::warn;

use crate::intake::Terms;

/// The sections that the learner needs, read and checked.
pub(crate) struct LearnerConfig {
    pub(crate) run: RunConfig,
    pub(crate) fleet: FleetConfig,
    pub(crate) learning: LearningConfig,
    pub(crate) schedule: ScheduleConfig,
    /// What is seen of the robots.
    pub(crate) tables: Tables,
    pub(crate) experts: Dataset,
    /// Control steps of the longest possible episode.
    pub(crate) episode_steps: f64,
    /// Samples after which task and robots are what they will be, see [`settled`].
    pub(crate) settled: f64,
    /// All of it as TOML, to be kept in checkpoints.
    pub(crate) text: String,
}

impl LearnerConfig {
    pub(crate) fn read(folder: &Folder) -> Result<Self> {
        let config = folder.config()?;
        let motion: MotionConfig = config.section()?;
        let experts =
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
        let fleet: FleetConfig = config.section()?;
        let discriminator: DiscriminatorConfig = config.section()?;
        if let Some(lack) = never_whole(&discriminator, fleet.steps) {
            warn!("{lack}");
        }
        Ok(Self {
            run: config.section()?,
            fleet,
            learning: LearningConfig {
                policy: config.section()?,
                exploration: config.section()?,
                ppo: config.section()?,
                discriminator,
            },
            schedule: config.section()?,
            experts: experts.seen_as(&tables.discriminator),
            tables,
            episode_steps: config
                .given("task.termination.time_out.steps")
                .and_then(|steps| steps.as_integer())
                .context(
                    "config.toml lacks task.termination.time_out.steps; `ampco train` writes it",
                )? as f64,
            settled: settled(&config),
            text: config.to_toml(),
        })
    }

    /// Mean length of the episodes that ended in an iteration, as a share of the longest possible.
    pub(crate) fn episode_share(&self, report: &IterationReport) -> Option<f64> {
        report
            .episode_length
            .map(|steps| steps / self.episode_steps)
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
            lists: Lists::from(&self.tables),
        }
    }
}

/// What is to be said of windows that no rollout is long enough for: a window ends where its rollout began.
fn never_whole(discriminator: &DiscriminatorConfig, steps: usize) -> Option<String> {
    let (frames, spacing) = (discriminator.frames, discriminator.spacing);
    let span = (frames - 1) * spacing;
    (span > steps).then(|| {
        format!(
            "the discriminator never sees a whole window: {frames} states, {spacing} steps apart \
             (discriminator.frames, spacing), are {span} steps, and a rollout has {steps} (fleet.steps); the oldest \
             state of the rollout stands for those before it"
        )
    })
}

/// Samples at which the last ramp of `[task]`, `[randomization]` and `[event]` arrives; 0 where there is none. The learner knows
/// neither section, but the way a ramp is written: it ends with the second of its `samples`.
fn settled(config: &Config) -> f64 {
    let number = |value: &Value| {
        value
            .as_float()
            .or(value.as_integer().map(|whole| whole as f64))
    };
    let end = |(path, value): (String, Value)| {
        let (section, name) = (path.split('.').next()?, path.rsplit('.').next()?);
        match (section, name) {
            ("task" | "randomization" | "event", "samples") => number(value.as_array()?.last()?),
            _ => None,
        }
    };
    config
        .leaves()
        .into_iter()
        .filter_map(end)
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_longer_than_a_rollout_are_told() {
        let of = |frames, spacing, steps| {
            let config = DiscriminatorConfig {
                frames,
                spacing,
                ..DiscriminatorConfig::default()
            };
            never_whole(&config, steps)
        };
        assert_eq!(of(2, 1, 1), None);
        assert_eq!(of(6, 3, 15), None);
        let said = of(6, 3, 14).unwrap();
        assert!(
            said.contains("15 steps") && said.contains("has 14"),
            "{said}"
        );
    }

    #[test]
    fn a_task_has_settled_when_its_last_schedule_arrives() {
        let of = |text: &str| settled(&Config::parse(text, "a test").unwrap());
        let exploration = "[exploration.sigma]\nfrom = 0.6\nto = 0.2\nsamples = [1e6, 9e9]\n";
        assert_eq!(of(exploration), 0.0);
        let kernel = "[task.reward.track.kernel]\nfrom = 0.25\nto = 2.0\nsamples = [1e6, 4e6]\n";
        assert_eq!(of(&format!("{exploration}{kernel}")), 4e6);
        let table = "[randomization.strength]\nfrom = 0\nto = 1\nsamples = [3e6, 5000000]";
        assert_eq!(of(&format!("{kernel}{table}")), 5e6);
        let event = "[event.strength]\nfrom = 0\nto = 1\nsamples = [3e6, 6e6]";
        assert_eq!(of(&format!("{table}\n{event}")), 6e6);
    }
}
