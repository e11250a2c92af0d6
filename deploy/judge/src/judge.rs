//! The style reward of what is seen, by a discriminator that is kept as it is.

use amp::Learning;
use anyhow::{Context, Result};
use g1::RobotState;

use super::subject::Kept;
use super::windows::Windows;

/// The whole learner, as training writes it.
const LEARNING: &str = "learning.bin";

/// The discriminator alone, as a shipped policy has it.
pub(super) const JUDGE: &str = "judge.bin";

/// Windows of motion that are scored together: a call of the network costs more than a few rows.
const TOGETHER: usize = 1_024;

/// A discriminator with memory for what it has seen and for windows that wait to be scored.
pub struct Judge {
    learning: Learning,
    windows: Windows,
    waiting: Vec<f32>,
    rewards: Vec<f32>,
    sum: f64,
}

impl Judge {
    /// The discriminator of a checkpoint.
    pub fn of(kept: &Kept) -> Result<Self> {
        let mut config = kept.learning.clone();
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
            windows: Windows::new(
                &kept.learning.discriminator,
                kept.tables.discriminator.clone(),
            ),
            waiting: Vec::new(),
            rewards: Vec::new(),
            sum: 0.0,
        })
    }

    /// What a shipped policy's folder holds of it: name and bytes.
    pub fn part(&self) -> (&'static str, Vec<u8>) {
        (JUDGE, self.learning.save_judge())
    }

    /// Takes one step of one robot, as [`Windows::take`] does.
    pub(super) fn take(
        &mut self,
        robot: usize,
        first: bool,
        states: [&RobotState; 2],
        command: &[f32; 3],
    ) {
        let waiting = &mut self.waiting;
        self.windows.take(robot, first, states, command, waiting);
        if self.waiting.len() >= TOGETHER * self.windows.width() {
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
