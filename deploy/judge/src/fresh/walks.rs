//! Windows of a policy's walks, as a judge sees them.

use anyhow::Result;
use rand::{Rng, RngExt};
use vocabulary::RUNNING;

use super::super::episodes::{Block, Conditions, TOGETHER, Walker, units};
use super::super::scenario::Scenario;
use super::super::subject::Subject;
use super::super::tally::SETTLING;

/// Control steps of an episode: ten seconds.
const STEPS: u32 = 500;

/// Windows of one policy for each command, `[window][width]`.
pub(super) struct Walks {
    width: usize,
    by_command: Vec<Vec<f32>>,
}

impl Walks {
    /// Walks in rapier from standing, without noise; a robot that fell is watched until it falls.
    pub(super) fn of(
        subject: &Subject,
        commands: &[[f32; 3]],
        episodes: usize,
        seed: u64,
    ) -> Result<Self> {
        let mut windows = super::windows()?;
        let width = windows.width();
        let conditions = Conditions {
            steps: STEPS,
            episodes,
            seed,
            traced: false,
        };
        let mut policy = subject.policy()?;
        let mut by_command = Vec::new();
        for command in commands {
            let scenario = Scenario::holding(String::new(), *command);
            let (mut seen, mut early) = (Vec::new(), Vec::new());
            for unit in units(&scenario, &conditions) {
                let mut fleet = Walker::fleet(subject, &unit, &conditions)?;
                let mut block = Block::new(&fleet);
                let mut going = [true; TOGETHER];
                for step in 0..STEPS {
                    for robot in 0..unit.episodes {
                        fleet.hold_command(robot, *command);
                        block.before[robot] = *fleet.state(robot);
                    }
                    policy.means(fleet.observations(), unit.episodes, &mut block.actions);
                    fleet.step(&block.actions, &mut block.rows.out());
                    for robot in (0..unit.episodes).filter(|robot| going[*robot]) {
                        let after = fleet.last_step(robot).state;
                        let out = if step >= SETTLING {
                            &mut seen
                        } else {
                            &mut early
                        };
                        let states = [&block.before[robot], &after];
                        windows.take(robot, step == 0, states, command, out);
                    }
                    early.clear();
                    for (robot, going) in going.iter_mut().enumerate().take(unit.episodes) {
                        *going &= block.rows.ends[robot] == RUNNING;
                    }
                }
            }
            by_command.push(seen);
        }
        Ok(Self { width, by_command })
    }

    /// Whether there is no window at all.
    pub(super) fn is_empty(&self) -> bool {
        self.by_command.iter().all(Vec::is_empty)
    }

    /// One of all windows.
    ///
    /// # Panics
    /// If there is none.
    pub(super) fn draw(&self, random: &mut impl Rng) -> &[f32] {
        let all: usize = self.by_command.iter().map(Vec::len).sum();
        let mut at = random.random_range(0..all / self.width) * self.width;
        for windows in &self.by_command {
            if at < windows.len() {
                return &windows[at..at + self.width];
            }
            at -= windows.len();
        }
        unreachable!("the index is below the sum")
    }

    /// What `look` makes of the windows of each command.
    pub(super) fn each<T>(&self, look: impl FnMut(&[f32]) -> T) -> Vec<T> {
        self.by_command
            .iter()
            .map(Vec::as_slice)
            .map(look)
            .collect()
    }
}
