//! How good a policy is found, so that the best checkpoint can be told from the others.
//!
//! Separate because it is easily told too well: of a window in which few episodes have ended, the rewards of all the others
//! would be added to those few.

use amp::IterationReport;
use serde::{Deserialize, Serialize};

/// What robots have earned since a checkpoint was last scored, from the task as it is once its schedules have arrived:
/// rewards of a task that still grows harder cannot be compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Earned {
    /// Sum of task rewards (Eq. 14), which mean the same in every phase, over all rows.
    reward: f64,
    rows: u64,
    /// Episodes that ended, and the control steps that they had lasted.
    episodes: u64,
    steps: f64,
    /// Robots in the newest batch.
    robots: u64,
}

impl Earned {
    /// Takes the iteration of a batch of so many robots in.
    pub(crate) fn add(&mut self, report: &IterationReport, robots: usize) {
        let ended = report.terminations.total();
        self.reward += report.task_mean * report.rows as f64;
        self.rows += report.rows;
        self.episodes += ended;
        self.steps += report.episode_length.unwrap_or(0.0) * ended as f64;
        self.robots = robots as u64;
    }

    /// Task reward of an episode: that of a step times the steps that an ended episode had lasted.
    ///
    /// `None` before as many episodes have ended as there are robots. Of fewer, the short ones end first and the mean
    /// hangs on a handful; the window then goes on until there are enough.
    pub(crate) fn score(&self) -> Option<f64> {
        let enough = self.episodes > 0 && self.episodes >= self.robots;
        enough.then(|| self.reward / self.rows as f64 * self.steps / self.episodes as f64)
    }
}

#[cfg(test)]
mod tests {
    use vocabulary::{Cause, Counts};

    use super::*;

    /// An iteration of 4 steps of 8 robots, of which so many ended episodes of so many steps.
    fn iteration(task_mean: f64, ended: u64, length: f64) -> IterationReport {
        let mut ends = vec![Cause::TimeOut.code(); ended as usize];
        ends[..ended as usize / 2].fill(Cause::Fall.code());
        IterationReport {
            rows: 32,
            task_mean,
            terminations: Counts::of(&ends),
            episode_length: (ended > 0).then_some(length),
            ..IterationReport::default()
        }
    }

    fn of(iterations: &[IterationReport]) -> Earned {
        let mut earned = Earned::default();
        iterations.iter().for_each(|report| earned.add(report, 8));
        earned
    }

    #[test]
    fn a_short_window_is_not_scored_and_inflates_nothing() {
        // Two iterations in which one robot fell: 64 rewards of 0.5 are no episode's.
        let short = of(&[iteration(0.5, 0, 0.0), iteration(0.5, 1, 6.0)]);
        assert_eq!(short.score(), None);
        assert_eq!(Earned::default().score(), None);
    }

    #[test]
    fn a_score_is_the_reward_of_a_step_times_the_length_of_an_episode() {
        // (0.5 + 0.25)/2 a step; 4 episodes of 10 steps and 4 of 20 are 15 steps each: 5.625.
        let window = [iteration(0.5, 4, 10.0), iteration(0.25, 4, 20.0)];
        assert_eq!(of(&window).score(), Some(5.625));
        // The same policy over a window ten times as long.
        let long: Vec<_> = window.iter().cycle().take(20).cloned().collect();
        assert_eq!(of(&long).score(), Some(5.625));
    }

    #[test]
    fn a_window_goes_on_until_as_many_episodes_ended_as_there_are_robots() {
        let mut earned = of(&[iteration(0.5, 7, 10.0)]);
        assert_eq!(earned.score(), None);
        earned.add(&iteration(0.5, 1, 10.0), 8);
        assert_eq!(earned.score(), Some(5.0));
    }
}
