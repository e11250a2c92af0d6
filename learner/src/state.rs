//! What the learner knows: how it begins, grows by an iteration, and is written to a checkpoint.

use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;

use amp::{Batch, IterationReport, Learning, LearningError, PpoConfig};
use ampco::Weighting;
use anyhow::{Context, Result, bail};
use observation::{ObservationConfig, Print, Tables};
use protocol::RewardReport;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use run::checkpoint::{CONFIG, robots_of};
use run::{Checkpoint, CheckpointError, Contents, Folder, Mode};
use serde::{Deserialize, Serialize};
use tracing::{info, warn};

use crate::config::LearnerConfig;
use crate::earned::Earned;
use crate::guidance::Guide;
use crate::robot::{self, robot};

/// This shell's own share of a checkpoint.
const SHELL: &str = "shell.json";
/// Networks, optimisers, normalisers, replay.
const LEARNING: &str = "learning.bin";
/// The flat policy alone, little-endian f32, for whoever wants no more.
const POLICY: &str = "policy.bin";
/// Of a shipped policy; a run has its critic in [`LEARNING`].
const CRITIC: &str = "critic.bin";

/// The learner between two iterations.
pub(crate) struct State {
    pub(crate) learning: Learning,
    /// Iterations done; also the version of the weights.
    pub(crate) iteration: u64,
    /// Seconds of learning before this start.
    pub(crate) seconds_before: f64,
    /// How the last iteration was paid, to be reported again after a resume.
    pub(crate) last_report: Option<RewardReport>,
    pub(crate) remembered: Option<Weighting>,
    /// Iterations in which the run's ramps stood still, as the scheduler counts.
    pub(crate) held: u64,
    generator: Pcg64Mcg,
    /// The iteration of the newest checkpoint; writing it again would lose the actors' share.
    saved: Option<u64>,
    /// What the newest policies have earned, by which checkpoints are compared.
    earned: Earned,
}

#[derive(Serialize, Deserialize)]
struct Shell {
    seconds: f64,
    last_report: Option<RewardReport>,
    remembered: Option<Weighting>,
    #[serde(default)]
    held: u64,
    generator: Pcg64Mcg,
    #[serde(default)]
    earned: Earned,
}

impl State {
    /// A new learner, or with `resume` the one of the newest checkpoint. What `metrics.jsonl` says
    /// of later iterations is dropped: they are about to happen again.
    pub(crate) fn begin(folder: &Folder, config: &LearnerConfig, resume: bool) -> Result<Self> {
        let learning = Learning::new(
            config.learning.clone(),
            robot(&config.tables),
            config.run.seed,
        )
        .context("setting up the networks")?
        .with_clock(seconds);
        let mut state = Self {
            learning,
            iteration: 0,
            seconds_before: 0.0,
            last_report: None,
            remembered: None,
            held: 0,
            // Any stream but those that the networks' own seeds begin.
            generator: Pcg64Mcg::seed_from_u64(config.run.seed ^ 0x0045_5850_4552_5453),
            saved: None,
            earned: Earned::default(),
        };
        if resume {
            let checkpoints = folder.checkpoints();
            let checkpoint = checkpoints.open_whole(Some(&shape(config)))?;
            state.take_up(&checkpoint)?;
            checkpoints.forget_after(state.iteration)?;
            let whole = checkpoints.is_whole(&checkpoint);
            info!(iteration = state.iteration, whole, "checkpoint taken up");
            if !whole {
                warn!(
                    iteration = state.iteration,
                    "no checkpoint has the robots of all actors; episodes of those that are missing \
                     begin anew"
                );
            }
        }
        if state.iteration == 0 && !config.run.from.is_empty() {
            let from = Path::new(&config.run.from);
            let critic_first = config.learning.ppo.critic_first;
            state.begin_with(&Checkpoint::open(from)?, &config.tables, critic_first)?;
            info!(from = %from.display(), "begun with the policy of another run");
        }
        run::metrics::truncate_after(&folder.metrics_path(), state.iteration)?;
        Ok(state)
    }

    /// Takes another run's policy over, and nothing else; of a shipped one what it has: the actor, and the critic unless
    /// it was shipped by an older program.
    fn begin_with(
        &mut self,
        checkpoint: &Checkpoint,
        tables: &Tables,
        critic_first: f64,
    ) -> Result<()> {
        let theirs = lists(checkpoint)?;
        let ours = Print::of_actor(tables);
        if let Some(difference) = ours.difference(&Print::of_actor(&theirs)) {
            bail!(
                "run.from: that policy does not see what this run's is to see: {difference}; set observation.actor as it was"
            );
        }
        let same_critic = Print::of_critic(tables) == Print::of_critic(&theirs);
        let new_critic = if !same_critic {
            Some("is to see something else than that one did")
        } else if checkpoint.part(LEARNING).is_none() && checkpoint.part(CRITIC).is_none() {
            Some("does not come with that policy")
        } else {
            None
        };
        if let Some(why) = new_critic {
            let samples = critic_first;
            info!(
                "the critic {why}: it begins anew, and learns alone for {samples} samples (ppo.critic_first)"
            );
        }
        if let Some(part) = checkpoint.part(LEARNING).filter(|_| same_critic) {
            self.learning.load_policy(part).with_context(|| {
                format!("run.from: reading its `{LEARNING}`; set policy.hidden as it was")
            })?;
            return self.retune(checkpoint);
        }
        let policy = checkpoint.part(POLICY).with_context(|| {
            format!("run.from: the checkpoint has neither `{LEARNING}` nor `{POLICY}`")
        })?;
        let critic = checkpoint.part(CRITIC).filter(|_| same_critic).map(numbers);
        self.learning
            .load_snapshot(&numbers(policy), critic.as_deref())
            .with_context(|| format!("run.from: reading its `{POLICY}` and `{CRITIC}`"))
    }

    fn take_up(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        let part = |name: &str| {
            checkpoint
                .part(name)
                .with_context(|| format!("the checkpoint has no part `{name}`"))
        };
        let shell: Shell =
            serde_json::from_slice(part(SHELL)?).with_context(|| format!("reading `{SHELL}`"))?;
        self.learning
            .load(part(LEARNING)?)
            .with_context(|| format!("reading `{LEARNING}`"))?;
        self.retune(checkpoint)?;
        self.iteration = checkpoint.iteration;
        self.saved = Some(checkpoint.iteration);
        self.seconds_before = shell.seconds;
        self.last_report = shell.last_report;
        self.remembered = shell.remembered;
        self.held = shell.held;
        self.generator = shell.generator;
        self.earned = shell.earned;
        Ok(())
    }

    /// The optimizer's rate came with a checkpoint; where this configuration asks for another than that one's did, it gets it.
    fn retune(&mut self, checkpoint: &Checkpoint) -> Result<()> {
        if let Some(config) = checkpoint.config()? {
            let before: PpoConfig = config.section()?;
            self.learning.retune(&before);
        }
        Ok(())
    }

    /// One iteration. It counts whether or not its update was good: the actors need a new version
    /// to act again. After a refusal that version is the last good policy.
    pub(crate) fn learn(
        &mut self,
        batch: &Batch,
        config: &LearnerConfig,
        guide: &Guide,
    ) -> Result<IterationReport, LearningError> {
        self.iteration += 1;
        let generator = &mut self.generator;
        let judge = &config.learning.discriminator;
        let features = config.experts.width();
        let place = robot::place(config.tables.places().command);
        let told = |generator: &mut Pcg64Mcg| {
            let row = generator.random_range(0..batch.rows());
            [0, 1, 2].map(|i| batch.at(row, &place)[i])
        };
        let mut experts = |rows: &mut [f32]| {
            for row in rows.chunks_exact_mut(judge.width(features)) {
                let (states, seen) = row.split_at_mut(judge.frames * features);
                let (data, spacing) = (&config.experts, judge.spacing);
                let command = if data.is_drawn_by_commands() {
                    data.sample_window_near(told(generator), generator, spacing, states)
                } else {
                    data.sample_window(generator, spacing, states)
                };
                for (i, blur) in judge.command_blur.iter().flatten().enumerate() {
                    seen[i] = command[i] + generator.random_range(-blur..=*blur);
                }
            }
        };
        let Weighting { rule, granularity } = guide.weighting;
        let report = self
            .learning
            .iterate(batch, &mut experts, rule, granularity);
        if let Ok(report) = &report {
            // What an easier task paid before would pass for skill.
            if self.ramped() as f64 > config.settled {
                self.earned.add(report, batch.robots());
            }
            self.last_report = Some(RewardReport {
                iteration: self.iteration,
                samples: batch.rows() as u64,
                style_mean: report.style_mean,
                style_std: report.style_std,
                style_std_robots: report.style_std_robots,
                style_min: report.style_min,
                style_max: report.style_max,
                task_mean: report.task_mean,
                task_std: report.task_std,
                episode_share: config.episode_share(report).unwrap_or(f64::NAN),
                // Filled when it is sent.
                ..RewardReport::default()
            });
        }
        report
    }

    /// Samples learnt from since the run's first start: the run's one clock. A batch that was refused does not
    /// count.
    pub(crate) fn samples(&self) -> u64 {
        self.learning.samples()
    }

    /// Samples that ramps of task and robots have gone on for: without those of iterations in which they stood still.
    pub(crate) fn ramped(&self) -> u64 {
        let batch = self.last_report.map_or(0, |report| report.samples);
        self.samples().saturating_sub(self.held * batch)
    }

    /// The newest iteration that the scheduler was told of; 0 before the first.
    pub(crate) fn reported(&self) -> u64 {
        self.last_report.map_or(0, |report| report.iteration)
    }

    /// Writes a checkpoint, unless this iteration has one, and drops those that are too many. In
    /// lock-step it is whole once `actors` have added their robots; overlapped, robots are in
    /// mid-rollout, and nothing exact depends on them.
    pub(crate) fn save(
        &mut self,
        folder: &Folder,
        config: &LearnerConfig,
        actors: &[u32],
        seconds: f64,
    ) -> Result<(), CheckpointError> {
        if self.saved == Some(self.iteration) {
            return Ok(());
        }
        let score = self.earned.score();
        let earned = match score {
            Some(_) => Earned::default(),
            None => self.earned,
        };
        let shell = Shell {
            seconds,
            last_report: self.last_report,
            remembered: self.remembered,
            held: self.held,
            generator: self.generator.clone(),
            earned,
        };
        let shell = serde_json::to_vec_pretty(&shell).expect("the shell's share is plain data");
        let policy: Vec<u8> = self
            .learning
            .policy_flat()
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        let awaited: Vec<String> = match config.run.mode {
            Mode::Lockstep => actors.iter().map(|actor| robots_of(*actor)).collect(),
            Mode::Overlapped => Vec::new(),
        };
        let checkpoints = folder.checkpoints();
        let contents = Contents {
            shape: &shape(config),
            parts: &[
                (CONFIG, config.text.as_bytes()),
                (SHELL, &shell),
                (LEARNING, &self.learning.save()),
                (POLICY, &policy),
            ],
            awaited: &awaited,
            score,
        };
        checkpoints.write_contents(self.iteration, &contents)?;
        self.earned = earned;
        self.saved = Some(self.iteration);
        checkpoints.prune(config.run.keep_checkpoints)
    }
}

/// The numbers of a part that holds nothing else.
fn numbers(part: &[u8]) -> Vec<f32> {
    let numbers = part.as_chunks().0.iter().copied();
    numbers.map(f32::from_le_bytes).collect()
}

/// Seconds since the first call: the pure crates own no clock.
fn seconds() -> f64 {
    static ORIGIN: OnceLock<Instant> = OnceLock::new();
    ORIGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// What a checkpoint must fit: the widths of all networks.
fn shape(config: &LearnerConfig) -> String {
    let learning = &config.learning;
    let mut shape = format!(
        "policy {:?} critic {:?} discriminator {:?}",
        learning.policy.hidden, learning.policy.critic_hidden, learning.discriminator.hidden
    );
    // Checkpoints of before there were lists are of the paper's.
    if Print::of(&config.tables) != Print::of(&Tables::default()) {
        shape.push_str(&format!(" seen by {}", config.tables.words()));
    }
    shape
}

/// The lists that a checkpoint was learned with: the paper's where it does not say.
fn lists(checkpoint: &Checkpoint) -> Result<Tables> {
    let Some(config) = checkpoint.config()? else {
        return Ok(Tables::default());
    };
    let observation: ObservationConfig = config.section()?;
    observation.tables().context("section [observation]")
}

#[cfg(test)]
mod obeyed;
