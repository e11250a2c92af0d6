//! The style reward of what is seen, by a discriminator that is kept as it is.

use amp::Learning;
use anyhow::{Context, Result};
use g1::RobotState;
use observation::{Scene, Table};

use super::subject::Kept;

/// The whole learner, as training writes it.
const LEARNING: &str = "learning.bin";

/// The discriminator alone, as a shipped policy has it.
const JUDGE: &str = "judge.bin";

/// Windows of motion that are scored together: a call of the network costs more than a few rows.
const TOGETHER: usize = 1_024;

/// A discriminator with memory for what it has seen and for windows that wait to be scored.
pub struct Judge {
    learning: Learning,
    /// States that a window has, and steps from one to the next.
    frames: usize,
    spacing: usize,
    /// Whether a window ends with the command.
    sees_command: bool,
    /// What it sees of a state; its own list, whatever the policy's says.
    table: Table,
    /// The last states of each robot but the newest, as it sees them, `[robot][(frames − 1)·spacing][numbers]`, oldest
    /// first.
    seen: Vec<f32>,
    /// The newest state as it sees it; memory that is used again.
    newest: Vec<f32>,
    /// How many of these are of the episode.
    known: Vec<usize>,
    waiting: Vec<f32>,
    rewards: Vec<f32>,
    sum: f64,
}

impl Judge {
    /// The discriminator of a checkpoint.
    pub fn of(kept: &Kept) -> Result<Self> {
        let mut config = kept.learning.clone();
        let (frames, spacing) = (config.discriminator.frames, config.discriminator.spacing);
        let sees_command = config.discriminator.command_blur.is_some();
        // Episodes are spread over threads already.
        config.ppo.threads = 1;
        // The seed is of weights that are replaced at once.
        let mut learning = Learning::new(config, learner::robot(&kept.tables), 0)
            .context("setting up the networks")?;
        // A shipped policy brings its discriminator alone.
        let (name, loaded) = match kept.part(JUDGE) {
            Ok(bytes) => (JUDGE, learning.load_judge(bytes)),
            Err(_) => (LEARNING, learning.load(kept.part(LEARNING)?)),
        };
        loaded.with_context(|| format!("loading {name} of {}", kept.path.display()))?;
        Ok(Self {
            learning,
            frames,
            spacing,
            sees_command,
            table: kept.tables.discriminator.clone(),
            seen: Vec::new(),
            newest: Vec::new(),
            known: Vec::new(),
            waiting: Vec::new(),
            rewards: Vec::new(),
            sum: 0.0,
        })
    }

    /// What a shipped policy's folder holds of it: name and bytes.
    pub fn part(&self) -> (&'static str, Vec<u8>) {
        (JUDGE, self.learning.save_judge())
    }

    /// Takes one step of one robot: the states before and after it, and the command in force. What an episode has not
    /// yet seen is as the oldest state of the window that it has, as in training.
    pub(super) fn take(
        &mut self,
        robot: usize,
        first: bool,
        [before, after]: [&RobotState; 2],
        command: &[f32; 3],
    ) {
        let features = self.table.width();
        let depth = (self.frames - 1) * self.spacing;
        let size = depth * features;
        if self.known.len() <= robot {
            self.known.resize(robot + 1, 0);
            self.seen.resize((robot + 1) * size, 0.0);
        }
        let seen = &mut self.seen[robot * size..][..size];
        seen.copy_within(features.., 0);
        look(&self.table, before, &mut seen[size - features..]);
        let newest = &mut self.newest;
        newest.resize(features, 0.0);
        look(&self.table, after, newest);
        let known = if first { 1 } else { self.known[robot] + 1 }.min(depth);
        self.known[robot] = known;
        // States of the window before the newest that there are.
        let real = known / self.spacing;
        for back in (1..self.frames).rev() {
            let state = match back.min(real) {
                0 => newest,
                there => &seen[size - there * self.spacing * features..][..features],
            };
            self.waiting.extend_from_slice(state);
        }
        self.waiting.extend_from_slice(newest);
        if self.sees_command {
            self.waiting.extend_from_slice(command);
        }
        if self.waiting.len() >= TOGETHER * self.frames * features {
            self.score();
        }
    }

    /// Sum of rˢ (Eq. 7) over all steps taken since the last call.
    pub(super) fn sum(&mut self) -> f64 {
        self.score();
        std::mem::take(&mut self.sum)
    }

    fn score(&mut self) {
        if self.waiting.is_empty() {
            return;
        }
        self.rewards.clear();
        self.learning
            .style_rewards(&self.waiting, &mut self.rewards);
        self.waiting.clear();
        self.sum += self.rewards.iter().copied().map(f64::from).sum::<f64>();
    }
}

/// Writes what is seen of a state.
fn look(table: &Table, state: &RobotState, out: &mut [f32]) {
    table.measure(&Scene::of(state), out);
    table.adjust(out);
}
