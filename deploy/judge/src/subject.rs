//! What is evaluated: a checkpoint with the configuration that it was trained under.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use amp::{Learning, LearningConfig};
use anyhow::{Context, Result};
use motion::{Dataset, MotionConfig};
use observation::{ObservationConfig, Tables};
use policy::{Policy, Shape};
use run::motion::Learned;
use run::{Checkpoint, Config, FleetConfig};
use sim::{Mechanics, Starts, TaskConfig};
use terminal::Place;
use terminal::console::say;
use terminal::failure::usage;

use super::reference::Reference;
use super::relearned;

/// A checkpoint with its configuration.
pub struct Kept {
    /// Its folder.
    pub path: PathBuf,
    /// Iterations that it has learnt for.
    pub iteration: u64,
    /// The networks and how they learn.
    pub learning: LearningConfig,
    /// What is seen of the robots; of a policy that does not say, the paper's lists.
    pub tables: Tables,
    config: Config,
    checkpoint: Checkpoint,
}

/// A policy with its task.
pub struct Subject {
    /// The checkpoint.
    pub kept: Kept,
    /// The task that it is tried by.
    pub task: TaskConfig,
    /// What moves the robots and whether their parts meet: what it learned in, unless whoever tries it says otherwise.
    pub mechanics: Mechanics,
    motion: MotionConfig,
    /// Made when it is first asked for: most who watch a policy never do.
    reference: OnceLock<Reference>,
}

impl Kept {
    /// Opens what `name` means: a checkpoint's folder (of a run, or shipped with a `config.toml`
    /// beside its parts), or a run, whose newest checkpoint it is then.
    pub fn open(place: &Place, name: &str) -> Result<Self> {
        let given = Path::new(name);
        // One of a run is meant as such also where its manifest is gone.
        let among_others = given
            .parent()
            .is_some_and(|folder| folder.ends_with("checkpoints"));
        let path = if given.join("manifest.json").exists() || among_others && given.is_dir() {
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
        let config = config_of(&checkpoint, &path)?;
        let observation: ObservationConfig = config.section()?;
        Ok(Self {
            tables: observation
                .tables()
                .with_context(|| format!("section [observation] of {}", path.display()))?,
            iteration: checkpoint.iteration,
            learning: LearningConfig {
                policy: config.section()?,
                exploration: config.section()?,
                ppo: config.section()?,
                discriminator: config.section()?,
            },
            config,
            checkpoint,
            path,
        })
    }

    /// A part of the checkpoint.
    pub fn part(&self, name: &str) -> Result<&[u8]> {
        self.checkpoint
            .part(name)
            .with_context(|| format!("checkpoint {} has no {name}", self.path.display()))
    }

    /// The shape of the policy and its weights in that layout, unchecked.
    pub fn weights(&self) -> Result<(Shape, Vec<f32>)> {
        let bytes = self.part("policy.bin")?;
        let flat = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|number| f32::from_le_bytes(*number))
            .collect();
        let inputs = self.tables.actor.width();
        Ok((Shape::new(inputs, &self.learning.policy.hidden), flat))
    }

    /// The task that it was trained for, as its ramps had it when this checkpoint was written.
    pub fn task(&self) -> Result<TaskConfig> {
        let task: TaskConfig = self.config.section()?;
        let (first, last) = (task.at(0.0), task.at(f64::MAX));
        // Where nothing moves nobody has to count.
        if first == last {
            return Ok(last);
        }
        Ok(task.at(self.samples()?))
    }

    /// Samples that it has learnt from. A shipped policy does not say; iterations of full batches have made it.
    fn samples(&self) -> Result<f64> {
        if let Ok(bytes) = self.part("learning.bin") {
            // The seed is of weights that are replaced at once.
            let mut learning =
                Learning::new(self.learning.clone(), learner::robot(&self.tables), 0)
                    .context("setting up the networks")?;
            learning
                .load(bytes)
                .with_context(|| format!("loading learning.bin of {}", self.path.display()))?;
            return Ok(learning.samples() as f64);
        }
        let fleet: FleetConfig = self.config.section()?;
        Ok(self.iteration as f64 * fleet.environments as f64 * fleet.steps as f64)
    }

    /// The configuration that it was trained under.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// The name of the run, or of the folder of a shipped policy.
    pub fn run_name(&self) -> Result<String> {
        let home = self.home().canonicalize()?;
        let name = home.file_name();
        Ok(name.map_or_else(String::new, |name| name.to_string_lossy().into_owned()))
    }

    /// The folder of its run, or its own if it lies in none.
    pub fn home(&self) -> PathBuf {
        run_of(&self.path).unwrap_or_else(|| self.path.clone())
    }

    /// The motion files that it was learned from, with their hashes; `None` where nothing was written down.
    pub fn learned_from(&self) -> Result<Option<Learned>> {
        let learned = run::motion::read(&self.home())?;
        let by_then = |learned: &Learned| learned.since <= self.iteration;
        Ok(learned.into_iter().rfind(by_then))
    }

    /// Where evaluations of it are kept: `evaluation/` in the run's folder, or beside the parts of
    /// a checkpoint that lies in no run.
    pub fn evaluations(&self) -> PathBuf {
        self.home().join("evaluation")
    }
}

impl Subject {
    /// Opens what `name` means, as [`Kept::open`] does.
    pub fn open(place: &Place, name: &str) -> Result<Self> {
        let kept = Kept::open(place, name)?;
        let motion: MotionConfig = kept.config.section()?;
        let fleet: FleetConfig = kept.config.section()?;
        Ok(Self {
            task: kept.task()?,
            mechanics: fleet.mechanics(),
            motion,
            reference: OnceLock::new(),
            kept,
        })
    }

    /// The policy of the checkpoint, ready to act.
    pub fn policy(&self) -> Result<Policy> {
        let (shape, flat) = self.kept.weights()?;
        let mut policy = Policy::new(shape, self.kept.learning.policy.observation_clip);
        policy
            .load(&flat)
            .with_context(|| format!("loading policy.bin of {}", self.kept.path.display()))?;
        Ok(policy)
    }

    /// Frames to begin from that go about as `command` asks.
    pub fn starts(&self, command: [f32; 3]) -> Starts {
        self.reference().starts(command)
    }

    /// The motion that it was taught by as a measure; where that is not to be had, the built-in gaits, and it is said.
    pub(super) fn reference(&self) -> &Reference {
        self.reference
            .get_or_init(|| Reference::of(&self.dataset()))
    }

    /// That motion itself.
    pub(super) fn dataset(&self) -> Dataset {
        let (dataset, lack) = relearned::dataset(&self.kept, &self.motion);
        if let Some(lack) = lack {
            say(&format!(
                "{lack}: where reference motion is asked for, built-in gaits stand in for it"
            ));
        }
        dataset
    }
}

/// The configuration of a checkpoint: its own, or that of the run it lies in.
fn config_of(checkpoint: &Checkpoint, path: &Path) -> Result<Config> {
    if let Some(own) = checkpoint.config()? {
        return Ok(own);
    }
    let Some(run) = run_of(path) else {
        return Err(usage(format!(
            "{} has no config.toml beside it or in its run",
            path.display()
        )));
    };
    Ok(Config::read(&run.join("config.toml"))?)
}

/// The folder of the run that a checkpoint lies in.
fn run_of(checkpoint: &Path) -> Option<PathBuf> {
    let checkpoint = checkpoint.canonicalize().ok()?;
    let run = checkpoint.ancestors().nth(2)?;
    (run.join("config.toml").is_file() && checkpoint.parent()?.ends_with("checkpoints"))
        .then(|| run.to_owned())
}
