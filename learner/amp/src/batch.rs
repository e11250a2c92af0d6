//! What rollouts bring: arrays over all rows of one iteration.
//!
//! Rows are ordered rollout by rollout, within a rollout `[step][environment]`. The arrays are filled in place and
//! reused, so that an iteration allocates nothing here.

use crate::columns::{Place, Widths};
use crate::{COMMAND, LearningError};
use vocabulary::{CALM, Cause, calm};

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
            widths: Widths,
            /// Share of a rollout's robots that explored calmly, see [`vocabulary::calm()`].
            pub calm_share: f32,
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
                let columns: fn(&Widths) -> usize = $columns;
                self.$name.resize(count * columns(&self.widths), 0.0);)*
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
                        let columns: fn(&Widths) -> usize = $columns;
                        let wide = columns(&self.widths);
                        &mut self.$name[part.start * wide..part.end * wide]
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
                let columns: fn(&Widths) -> usize = $columns;
                let wide = columns(&self.widths);
                self.$name.drain(part.start * wide..part.end * wide);)*
                self.segments.remove(index);
            }

            fn check_lengths(&self) -> Result<(), LearningError> {
                let (rows, robots) = (self.rows(), self.robots());
                $(let columns: fn(&Widths) -> usize = $columns;
                let expected = fields!(@count $of, rows, robots) * columns(&self.widths);
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
                $(if !stringify!($name).starts_with("timeout_") {
                    let columns: fn(&Widths) -> usize = $columns;
                    check_finite(stringify!($name), &self.$name, columns(&self.widths))?;
                })*
                Ok(())
            }
        }
    };
    (@count row, $rows:expr, $robots:expr) => { $rows.clone() };
    (@count robot, $rows:expr, $robots:expr) => { $robots.clone() };
}

fields! {
    /// o_t as the policy saw it, `[row][observation]`.
    observations: row * |widths| widths.observation;
    /// What the critic sees at t, `[row][critic]`; nothing where it sees what the policy does.
    critic: row * |widths| widths.critic;
    /// a_t, `[row][joint]`.
    actions: row * |widths| widths.action;
    /// The policy's mean action, `[row][joint]`.
    means: row * |widths| widths.action;
    /// ln π(a_t | o_t), `[row]`.
    log_probs: row * |_| 1;
    /// rᴳ, `[row]`.
    task_rewards: row * |_| 1;
    /// Positive mechanical work of the step, J, `[row]`.
    energies: row * |_| 1;
    /// Squared planar velocity error, m²/s², `[row]`.
    tracking_errors: row * |_| 1;
    /// [`vocabulary::RUNNING`], or why the episode ended ([`Cause::code`]), `[row]`.
    ends: row * |_| 1;
    /// Steps done in the episode, this one included, `[row]`.
    episode_steps: row * |_| 1;
    /// What the discriminator sees of the state at t, `[row][features]`.
    features: row * |widths| widths.features;
    /// The same at t+1; of a finished episode its own last, `[row][features]`.
    next_features: row * |widths| widths.features;
    /// Ground force under the left and right foot, N, `[row][2]`.
    foot_forces: row * |_| 2;
    /// What is measured beside, of the state at t+1 and the command at t, `[row][measured]`.
    measured: row * |widths| widths.measured;
    /// Observation after the rollout's last step, `[environment][observation]`, rollout by rollout.
    last_observations: robot * |widths| widths.observation;
    /// Observation at which an episode was cut, `[environment][observation]`; others hold anything. Of two time-outs of
    /// one environment in one rollout, the later one's.
    timeout_observations: robot * |widths| widths.observation;
    /// What the critic sees after the rollout's last step, `[environment][critic]`.
    last_critic: robot * |widths| widths.critic;
    /// What it saw when an episode was cut, `[environment][critic]`; others hold anything.
    timeout_critic: robot * |widths| widths.critic;
}

impl Batch {
    /// An empty batch of rows of these widths.
    pub fn new(widths: Widths) -> Self {
        Self {
            widths,
            ..Self::default()
        }
    }

    /// Numbers of a row of each kind.
    pub fn widths(&self) -> &Widths {
        &self.widths
    }

    /// What a row holds at a place.
    pub fn at(&self, row: usize, place: &Place) -> &[f32] {
        match place {
            Place::Observation(numbers) => {
                let width = self.widths.observation;
                &self.observations[row * width..][..width][numbers.clone()]
            }
            Place::Features(numbers) => {
                let width = self.widths.features;
                &self.next_features[row * width..][..width][numbers.clone()]
            }
            Place::Measured(numbers) => {
                let width = self.widths.measured;
                &self.measured[row * width..][..width][numbers.clone()]
            }
        }
    }

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

    /// How widely each row explored, in parts of σ; appended to `out`, nothing where all did alike.
    pub fn exploration(&self, out: &mut Vec<f32>) {
        if self.calm_share == 0.0 {
            return;
        }
        for Segment {
            steps,
            environments,
        } in &self.segments
        {
            let wide = environments - calm(*environments, self.calm_share);
            for _ in 0..*steps {
                out.extend((0..*environments).map(|robot| if robot < wide { 1.0 } else { CALM }));
            }
        }
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

    /// Each robot's mean of `numbers`, `[row]`, over its steps of a rollout; rollout by rollout.
    pub(crate) fn means_of_robots(&self, numbers: &[f32]) -> Vec<f32> {
        let rollout = |index| {
            let (rows, robots) = self.place(index);
            let (steps, numbers) = (self.segments[index].steps, &numbers[rows]);
            (0..robots.len()).map(move |robot| {
                let own = numbers.iter().skip(robot).step_by(robots.len());
                own.sum::<f32>() / steps as f32
            })
        };
        (0..self.segments.len()).flat_map(rollout).collect()
    }

    /// Each robot's mean command over its steps of a rollout (m/s, m/s, rad/s), in the order of [`Self::means_of_robots`].
    pub(crate) fn commands_of_robots(&self, place: &Place) -> Vec<[f32; COMMAND]> {
        let part = |part: usize| {
            let numbers: Vec<f32> = (0..self.rows())
                .map(|row| self.at(row, place)[part])
                .collect();
            self.means_of_robots(&numbers)
        };
        let parts: [Vec<f32>; COMMAND] = std::array::from_fn(part);
        (0..self.robots())
            .map(|robot| std::array::from_fn(|part| parts[part][robot]))
            .collect()
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
    pub(crate) fn check(&self, widths: &Widths) -> Result<(), LearningError> {
        if self.widths != *widths {
            return Err(LearningError::BatchWidths {
                expected: *widths,
                found: self.widths,
            });
        }
        if self.rows() == 0 {
            return Err(LearningError::EmptyBatch);
        }
        self.check_lengths()?;
        self.check_numbers()?;
        for (_, robot) in self.time_outs() {
            for (field, numbers, width) in [
                (
                    "timeout_observations",
                    &self.timeout_observations,
                    self.widths.observation,
                ),
                ("timeout_critic", &self.timeout_critic, self.widths.critic),
            ] {
                let seen = &numbers[robot * width..][..width];
                if let Some(i) = networks::first_not_finite(seen) {
                    return Err(LearningError::BatchNotFinite {
                        field,
                        row: robot,
                        value: seen[i],
                    });
                }
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
