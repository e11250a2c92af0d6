//! What rollouts bring: arrays over all rows of one iteration.
//!
//! Rows are ordered rollout by rollout, within a rollout `[step][environment]`. The arrays are filled in place and
//! reused, so that an iteration allocates nothing here.

use crate::{ACTION, FEATURES, LearningError, OBSERVATION};
use vocabulary::Cause;

/// One rollout's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// Control steps.
    pub steps: usize,
    /// Environments.
    pub environments: usize,
}

impl Segment {
    /// Rows of the rollout.
    pub fn rows(&self) -> usize {
        self.steps * self.environments
    }
}

macro_rules! fields {
    ($($(#[$doc:meta])* $name:ident: $of:ident * $columns:expr;)*) => {
        /// Rollouts of one iteration.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Batch {
            segments: Vec<Segment>,
            $($(#[$doc])* pub $name: Vec<f32>,)*
        }

        /// One rollout's part of a [`Batch`], to be written.
        #[derive(Debug)]
        pub struct SegmentMut<'a> {
            $($(#[$doc])* pub $name: &'a mut [f32],)*
        }

        impl Batch {
            fn fit(&mut self) {
                let (rows, robots) = (self.rows(), self.robots());
                $(let count = fields!(@count $of, rows, robots);
                self.$name.resize(count * $columns, 0.0);)*
            }

            /// One rollout's rows.
            ///
            /// # Panics
            /// If there is no such rollout.
            pub fn segment_mut(&mut self, index: usize) -> SegmentMut<'_> {
                let (rows, robots) = self.place(index);
                SegmentMut {
                    $($name: {
                        let part = fields!(@count $of, rows, robots);
                        &mut self.$name[part.start * $columns..part.end * $columns]
                    },)*
                }
            }

            /// Takes a rollout out.
            ///
            /// # Panics
            /// If there is no such rollout.
            pub fn remove_segment(&mut self, index: usize) {
                let (rows, robots) = self.place(index);
                $(let part = fields!(@count $of, rows, robots);
                self.$name.drain(part.start * $columns..part.end * $columns);)*
                self.segments.remove(index);
            }

            fn check_lengths(&self) -> Result<(), LearningError> {
                let (rows, robots) = (self.rows(), self.robots());
                $(let expected = fields!(@count $of, rows, robots) * $columns;
                if self.$name.len() != expected {
                    return Err(LearningError::BatchLength {
                        field: stringify!($name),
                        expected,
                        found: self.$name.len(),
                    });
                })*
                Ok(())
            }

            fn check_numbers(&self) -> Result<(), LearningError> {
                $(if stringify!($name) != "timeout_observations" {
                    check_finite(stringify!($name), &self.$name, $columns)?;
                })*
                Ok(())
            }
        }
    };
    (@count row, $rows:expr, $robots:expr) => { $rows.clone() };
    (@count robot, $rows:expr, $robots:expr) => { $robots.clone() };
}

fields! {
    /// o_t as the policy saw it, `[row][82]`.
    observations: row * OBSERVATION;
    /// a_t, `[row][23]`.
    actions: row * ACTION;
    /// The policy's mean action, `[row][23]`.
    means: row * ACTION;
    /// ln π(a_t | o_t), `[row]`.
    log_probs: row * 1;
    /// rᴳ, `[row]`.
    task_rewards: row * 1;
    /// Positive mechanical work of the step, J, `[row]`.
    energies: row * 1;
    /// Squared planar velocity error, m²/s², `[row]`.
    tracking_errors: row * 1;
    /// [`vocabulary::RUNNING`], or why the episode ended ([`Cause::code`]), `[row]`.
    ends: row * 1;
    /// Steps done in the episode, this one included, `[row]`.
    episode_steps: row * 1;
    /// What the discriminator sees of the state at t, `[row][53]`.
    features: row * FEATURES;
    /// The same at t+1; of a finished episode its own last, `[row][53]`.
    next_features: row * FEATURES;
    /// Ground force under the left and right foot, N, `[row][2]`.
    foot_forces: row * 2;
    /// Observation after the rollout's last step, `[environment][82]`, rollout by rollout.
    last_observations: robot * OBSERVATION;
    /// Observation at which an episode was cut, `[environment][82]`; others hold anything. Of two time-outs of one
    /// environment in one rollout, the later one's.
    timeout_observations: robot * OBSERVATION;
}

impl Batch {
    /// Makes place for `count` rollouts of one size; content is not kept in order.
    pub fn resize(&mut self, count: usize, steps: usize, environments: usize) {
        self.segments.clear();
        self.segments.resize(
            count,
            Segment {
                steps,
                environments,
            },
        );
        self.fit();
    }

    /// Makes place for one more rollout, at the end.
    pub fn add_segment(&mut self, steps: usize, environments: usize) {
        self.segments.push(Segment {
            steps,
            environments,
        });
        self.fit();
    }

    /// The rollouts in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Rows of all rollouts.
    pub fn rows(&self) -> usize {
        self.segments.iter().map(Segment::rows).sum()
    }

    /// Environments of all rollouts.
    pub fn robots(&self) -> usize {
        self.segments
            .iter()
            .map(|segment| segment.environments)
            .sum()
    }

    /// Where rollout `index` lies among rows and among environments.
    fn place(&self, index: usize) -> (std::ops::Range<usize>, std::ops::Range<usize>) {
        let before = &self.segments[..index];
        let row: usize = before.iter().map(Segment::rows).sum();
        let robot: usize = before.iter().map(|segment| segment.environments).sum();
        let this = self.segments[index];
        (row..row + this.rows(), robot..robot + this.environments)
    }

    /// For each time-out its row, and its environment counted over all rollouts.
    pub(crate) fn time_outs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        (0..self.segments.len()).flat_map(|index| {
            let (rows, robots) = self.place(index);
            let start = rows.start;
            rows.filter(|row| self.ends[*row] == Cause::TimeOut.code())
                .map(move |row| (row, robots.start + (row - start) % robots.len()))
        })
    }

    /// Refuses a batch that cannot be learnt from: empty, of wrong lengths, or with a number that is not finite.
    pub(crate) fn check(&self) -> Result<(), LearningError> {
        if self.rows() == 0 {
            return Err(LearningError::EmptyBatch);
        }
        self.check_lengths()?;
        self.check_numbers()?;
        for (_, robot) in self.time_outs() {
            let observation = &self.timeout_observations[robot * OBSERVATION..][..OBSERVATION];
            if let Some(i) = networks::first_not_finite(observation) {
                return Err(LearningError::BatchNotFinite {
                    field: "timeout_observations",
                    row: robot,
                    value: observation[i],
                });
            }
        }
        Ok(())
    }
}

fn check_finite(field: &'static str, numbers: &[f32], columns: usize) -> Result<(), LearningError> {
    match networks::first_not_finite(numbers) {
        None => Ok(()),
        Some(i) => Err(LearningError::BatchNotFinite {
            field,
            row: i / columns,
            value: numbers[i],
        }),
    }
}

#[cfg(test)]
mod tests;
