//! What the discriminator looks at: the paper's pair of successive states, or a longer window of motion.
//!
//! Separate because rows, memory and reference motion must be cut alike. A pair shows a pose and how fast it changes,
//! not a rhythm; other trainers show 4 to 10 states, and states some steps apart show more of it than as many side by
//! side. A row whose episode or rollout began only just now has no longer past: the oldest state that there is stands
//! for those before it. Experts are then cut as short as rows of the batch are, or the
//! cut itself would tell the two apart.

use crate::batch::Batch;
use crate::columns::Place;
use crate::config::DiscriminatorConfig;
use crate::robot::Robot;

/// What windows are cut to.
#[derive(Clone, Debug)]
pub(crate) struct Cut {
    /// States.
    pub(crate) frames: usize,
    /// Control steps from one of them to the next.
    pub(crate) spacing: usize,
    /// Numbers of a state.
    pub(crate) features: usize,
    /// Where rows hold the command, if that is seen too.
    command: Option<Place>,
}

impl Cut {
    /// As a discriminator is configured to look.
    pub(crate) fn new(config: &DiscriminatorConfig, robot: &Robot) -> Self {
        Self {
            frames: config.frames,
            spacing: config.spacing,
            features: robot.features.len(),
            command: config.command_blur.map(|_| robot.command.clone()),
        }
    }

    /// Steps back from the row of one state to that of the state before it, if `real` states are there already. The
    /// newest is the row's next one, so the row itself is a step back.
    fn hops(&self, real: usize) -> usize {
        self.spacing - usize::from(real == 1)
    }

    /// Numbers of the states alone.
    pub(crate) fn states(&self) -> usize {
        self.frames * self.features
    }
}

/// No row before.
const NONE: u32 = u32::MAX;

/// For each row of a batch the row of the same robot a step before, if that is in the same rollout and episode.
#[derive(Debug, Default)]
pub(crate) struct Past {
    before: Vec<u32>,
}

impl Past {
    /// Reads a batch.
    pub(crate) fn of(&mut self, batch: &Batch) {
        self.before.clear();
        let mut first = 0;
        for segment in batch.segments() {
            let robots = segment.environments;
            for row in first..first + segment.rows() {
                let here = row >= first + robots && batch.episode_steps[row] > 1.0;
                self.before
                    .push(if here { (row - robots) as u32 } else { NONE });
            }
            first += segment.rows();
        }
    }

    /// States of a row's window that there are, its next state included: from 1 to `frames`; of successive states there
    /// are two or more.
    pub(crate) fn real(&self, row: usize, cut: &Cut) -> usize {
        let mut row = row;
        for real in 1..cut.frames {
            match self.back(row, cut.hops(real)) {
                Some(before) => row = before,
                None => return real,
            }
        }
        cut.frames
    }

    /// The row so many steps before, if that is in the same rollout and episode.
    fn back(&self, row: usize, steps: usize) -> Option<usize> {
        (0..steps).try_fold(row, |row, _| {
            let before = self.before[row];
            (before != NONE).then_some(before as usize)
        })
    }

    /// Appends a row's window: `[frames][features]`, oldest state first, then the command if that is seen.
    pub(crate) fn write(&self, batch: &Batch, row: usize, cut: &Cut, out: &mut Vec<f32>) {
        let start = out.len();
        out.resize(start + cut.states(), 0.0);
        self.write_states(batch, row, cut, &mut out[start..]);
        if let Some(command) = &cut.command {
            out.extend_from_slice(batch.at(row, command));
        }
    }

    fn write_states(&self, batch: &Batch, row: usize, cut: &Cut, window: &mut [f32]) {
        let (newest, wide) = (cut.frames - 1, cut.features);
        window[newest * wide..].copy_from_slice(&batch.next_features[row * wide..][..wide]);
        let mut row = row;
        for real in 1..cut.frames {
            let Some(before) = self.back(row, cut.hops(real)) else {
                repeat_oldest(window, real, wide);
                break;
            };
            row = before;
            window[(newest - real) * wide..][..wide]
                .copy_from_slice(&batch.features[row * wide..][..wide]);
        }
    }
}

/// Lets the oldest of the last `real` states of a window, of so many `features` each, stand for all before it.
pub(crate) fn repeat_oldest(window: &mut [f32], real: usize, features: usize) {
    let first = window.len() - real * features;
    let (older, rest) = window.split_at_mut(first);
    for state in older.chunks_exact_mut(features) {
        state.copy_from_slice(&rest[..features]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::tests::{FEATURES, OBSERVATION, simple};

    /// One rollout of 4 steps by 2 robots; features of step t of robot r are 10·r + t. Robot 1 begins anew at step 2.
    fn batch() -> Batch {
        let mut batch = Batch::new(simple().widths());
        batch.resize(1, 4, 2);
        for row in 0..8 {
            let (step, robot) = (row / 2, row % 2);
            let number = (10 * robot + step) as f32;
            batch.features[row * FEATURES..][..FEATURES].fill(number);
            batch.next_features[row * FEATURES..][..FEATURES].fill(number + 1.0);
            let seen = &mut batch.observations[row * OBSERVATION..][..OBSERVATION];
            seen[10..13].copy_from_slice(&[row as f32, 0.5, 0.0]);
            batch.episode_steps[row] = if robot == 1 && step >= 2 {
                step - 1
            } else {
                step + 5
            } as f32;
        }
        batch
    }

    fn window(row: usize, frames: usize) -> Vec<f32> {
        spaced(row, frames, 1)
    }

    fn spaced(row: usize, frames: usize, spacing: usize) -> Vec<f32> {
        let batch = batch();
        let (mut past, mut out) = (Past::default(), vec![]);
        past.of(&batch);
        let cut = |command| Cut {
            frames,
            spacing,
            features: FEATURES,
            command,
        };
        past.write(&batch, row, &cut(None), &mut out);
        assert_eq!(out.len(), frames * FEATURES);
        let mut with_command = vec![];
        past.write(
            &batch,
            row,
            &cut(Some(Place::Observation(10..13))),
            &mut with_command,
        );
        assert_eq!(with_command[..out.len()], out);
        assert_eq!(with_command[out.len()..], [row as f32, 0.5, 0.0]);
        out.chunks(FEATURES).map(|state| state[7]).collect()
    }

    #[test]
    fn a_window_of_two_is_the_pair_of_the_row() {
        assert_eq!(window(4, 2), [2.0, 3.0]);
        assert_eq!(window(1, 2), [10.0, 11.0]);
    }

    #[test]
    fn longer_windows_reach_back_within_rollout_and_episode() {
        assert_eq!(window(6, 4), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(window(6, 5), [0.0, 1.0, 2.0, 3.0, 4.0]);
        // Before the rollout's first step nothing is known.
        assert_eq!(window(2, 5), [0.0, 0.0, 0.0, 1.0, 2.0]);
        // Robot 1 began anew at its third step: row 5 is its first, row 7 its second.
        assert_eq!(window(5, 4), [12.0, 12.0, 12.0, 13.0]);
        assert_eq!(window(7, 4), [12.0, 12.0, 13.0, 14.0]);
    }

    #[test]
    fn what_is_real_is_counted() {
        let mut past = Past::default();
        past.of(&batch());
        let real = |row, frames, spacing| {
            let cut = Cut {
                frames,
                spacing,
                features: FEATURES,
                command: None,
            };
            past.real(row, &cut)
        };
        assert_eq!([6, 2, 0].map(|row| real(row, 4, 1)), [4, 3, 2]);
        assert_eq!([real(5, 4, 1), real(7, 4, 1), real(6, 2, 1)], [2, 3, 2]);
        assert_eq!([6, 4, 2, 0].map(|row| real(row, 3, 2)), [3, 2, 2, 1]);
        // Robot 1 began anew at its third step.
        assert_eq!([5, 7].map(|row| real(row, 3, 2)), [1, 2]);
    }

    #[test]
    fn states_may_be_some_steps_apart() {
        assert_eq!(spaced(6, 3, 2), [0.0, 2.0, 4.0]);
        assert_eq!(spaced(6, 2, 3), [1.0, 4.0]);
        // What is not there is as the oldest that is; a state alone says nothing of motion, and none is made up.
        assert_eq!(spaced(4, 3, 2), [1.0, 1.0, 3.0]);
        assert_eq!(spaced(0, 3, 2), [1.0; 3]);
        assert_eq!(spaced(7, 3, 2), [12.0, 12.0, 14.0]);
    }
}
