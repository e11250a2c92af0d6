//! What is evaluated: a checkpoint with the configuration that it was trained under.

use std::path::{Path, PathBuf};

use amp::LearningConfig;
use anyhow::{Context, Result};
use motion::{Dataset, MotionConfig};
use policy::{Policy, Shape};
use run::{Checkpoint, Config};
use sim::{Starts, TaskConfig};

use super::reference::Reference;
use crate::failure::usage;
use crate::place::Place;

/// A checkpoint with its configuration.
pub(crate) struct Kept {
    pub(crate) path: PathBuf,
    pub(crate) iteration: u64,
    pub(crate) learning: LearningConfig,
    config: Config,
    checkpoint: Checkpoint,
}

/// A policy with its task.
pub(crate) struct Subject {
    pub(crate) kept: Kept,
    pub(crate) task: TaskConfig,
    pub(super) reference: Reference,
}

impl Kept {
    /// Opens what `name` means: a checkpoint's folder (of a run, or shipped with a `config.toml`
    /// beside its parts), or a run, whose newest checkpoint it is then.
    pub(crate) fn open(place: &Place, name: &str) -> Result<Self> {
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
        Ok(Self {
            iteration: checkpoint.iteration,
            learning: LearningConfig {
                policy: config.section("policy")?,
                exploration: config.section("exploration")?,
                ppo: config.section("ppo")?,
                discriminator: config.section("discriminator")?,
            },
            config,
            checkpoint,
            path,
        })
    }

    /// A part of the checkpoint.
    pub(crate) fn part(&self, name: &str) -> Result<&[u8]> {
        self.checkpoint
            .part(name)
            .with_context(|| format!("checkpoint {} has no {name}", self.path.display()))
    }

    /// The shape of the policy and its weights in that layout, unchecked.
    pub(crate) fn weights(&self) -> Result<(Shape, Vec<f32>)> {
        let bytes = self.part("policy.bin")?;
        let flat = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|number| f32::from_le_bytes(*number))
            .collect();
        Ok((Shape::new(&self.learning.policy.hidden), flat))
    }

    /// The task that it was trained for.
    pub(crate) fn task(&self) -> Result<TaskConfig> {
        Ok(self.config.checked("task", TaskConfig::validate)?)
    }

    /// The configuration that it was trained under, as a file.
    pub(crate) fn config_path(&self) -> Result<PathBuf> {
        config_of(&self.path)
    }

    /// The name of the run, or of the folder of a shipped policy.
    pub(crate) fn run_name(&self) -> Result<String> {
        let config = std::path::absolute(self.config_path()?)?;
        let folder = config.parent().and_then(Path::file_name);
        Ok(folder.map_or_else(String::new, |name| name.to_string_lossy().into_owned()))
    }

    /// Where evaluations of it are kept: `evaluation/` in the run's folder, or beside the parts of
    /// a checkpoint that lies in no run.
    pub(crate) fn evaluations(&self) -> PathBuf {
        let home = run_of(&self.path).unwrap_or_else(|| self.path.clone());
        home.join("evaluation")
    }
}

impl Subject {
    pub(crate) fn open(place: &Place, name: &str) -> Result<Self> {
        let kept = Kept::open(place, name)?;
        let motion: MotionConfig = kept.config.section("motion")?;
        let dataset = Dataset::load(&motion, &kept.path).context("loading the reference motion")?;
        Ok(Self {
            task: kept.task()?,
            reference: Reference::of(&dataset),
            kept,
        })
    }

    /// The policy of the checkpoint, ready to act.
    pub(crate) fn policy(&self) -> Result<Policy> {
        let (shape, flat) = self.kept.weights()?;
        let mut policy = Policy::new(shape);
        policy
            .load(&flat)
            .with_context(|| format!("loading policy.bin of {}", self.kept.path.display()))?;
        Ok(policy)
    }

    /// Frames to begin from that go about as `command` asks.
    pub(crate) fn starts(&self, command: [f32; 3]) -> Starts {
        self.reference.starts(command)
    }
}

/// The configuration of a checkpoint: beside its parts, or that of the run it lies in.
fn config_of(checkpoint: &Path) -> Result<PathBuf> {
    let beside = checkpoint.join("config.toml");
    let of_the_run = run_of(checkpoint).map(|run| run.join("config.toml"));
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

/// The folder of the run that a checkpoint lies in.
fn run_of(checkpoint: &Path) -> Option<PathBuf> {
    let checkpoint = checkpoint.canonicalize().ok()?;
    let run = checkpoint.ancestors().nth(2)?;
    (run.join("config.toml").is_file() && checkpoint.parent()?.ends_with("checkpoints"))
        .then(|| run.to_owned())
}
