//! What is evaluated: a checkpoint with the configuration that it was trained under.

use std::path::{Path, PathBuf};

use amp::{Learning, LearningConfig};
use anyhow::{Context, Result};
use motion::{Dataset, MotionConfig};
use policy::{Policy, Shape};
use run::{Checkpoint, Config};
use sim::{Starts, TaskConfig};

use super::judge::Judge;
use crate::failure::usage;
use crate::place::Place;

/// A policy ready to walk, its judge, and its task.
pub(super) struct Subject {
    pub(super) path: PathBuf,
    pub(super) iteration: u64,
    pub(super) task: TaskConfig,
    pub(super) starts: Starts,
    learning: LearningConfig,
    checkpoint: Checkpoint,
}

impl Subject {
    /// Opens what `name` means: a checkpoint's folder (of a run, or shipped with a `config.toml`
    /// beside its parts), or a run, whose newest checkpoint it is then.
    pub(super) fn open(place: &Place, name: &str) -> Result<Self> {
        let given = Path::new(name);
        let path = if given.join("manifest.json").is_file() {
            given.to_owned()
        } else {
            let folder = place.find(Some(name))?;
            let checkpoints = folder.checkpoints();
            let Some(newest) = checkpoints.list().last().copied() else {
                return Err(usage(format!(
                    "run `{}` has no checkpoint yet; the first comes after run.checkpoint_every iterations, or at Ctrl-C",
                    folder.name()
                )));
            };
            checkpoints.path(newest)
        };
        let checkpoint = Checkpoint::open(&path)?;
        let config = Config::read(&config_of(&path)?)?;
        let motion: MotionConfig = config.section("motion")?;
        let dataset = Dataset::load(&motion, &path).context("loading the reference motion")?;
        Ok(Self {
            iteration: checkpoint.iteration,
            task: config.checked("task", TaskConfig::validate)?,
            starts: dataset
                .frames()
                .map(|(state, command, weight)| (*state, command, weight))
                .collect(),
            learning: LearningConfig {
                policy: config.section("policy")?,
                exploration: config.section("exploration")?,
                ppo: config.section("ppo")?,
                discriminator: config.section("discriminator")?,
            },
            checkpoint,
            path,
        })
    }

    /// The policy of the checkpoint, ready to act.
    pub(super) fn policy(&self) -> Result<Policy> {
        let bytes = self.part("policy.bin")?;
        let flat: Vec<f32> = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|number| f32::from_le_bytes(*number))
            .collect();
        let mut policy = Policy::new(Shape::new(&self.learning.policy.hidden));
        policy
            .load(&flat)
            .with_context(|| format!("loading policy.bin of {}", self.path.display()))?;
        Ok(policy)
    }

    /// The discriminator of the checkpoint.
    pub(super) fn judge(&self) -> Result<Judge> {
        // The seed is of weights that are replaced at once.
        let mut learning = Learning::new(self.learning.clone(), learner::robot(), 0)
            .context("setting up the networks")?;
        learning
            .load(self.part("learning.bin")?)
            .with_context(|| format!("loading learning.bin of {}", self.path.display()))?;
        Ok(Judge::new(learning))
    }

    fn part(&self, name: &str) -> Result<&[u8]> {
        self.checkpoint
            .part(name)
            .with_context(|| format!("checkpoint {} has no {name}", self.path.display()))
    }
}

/// The configuration of a checkpoint: beside its parts, or that of the run it lies in.
fn config_of(checkpoint: &Path) -> Result<PathBuf> {
    let checkpoint = checkpoint
        .canonicalize()
        .with_context(|| format!("resolving {}", checkpoint.display()))?;
    let beside = checkpoint.join("config.toml");
    let of_the_run = checkpoint
        .ancestors()
        .nth(2)
        .map(|run| run.join("config.toml"));
    [Some(beside), of_the_run]
        .into_iter()
        .flatten()
        .find(|path| path.is_file())
        .ok_or_else(|| {
            usage(format!(
                "{} has no config.toml beside it or in its run",
                checkpoint.display()
            ))
        })
}
