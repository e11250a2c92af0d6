//! The field blocks of a rollout: one table, from which sizes and views follow.
//!
//! Separate because it is arithmetic on slices and knows no middleware. A rollout is one `[f32]`
//! of named blocks (structure of arrays); within a block the order is [step][environment][number].

use super::lists::Lists;
use g1::ACTION;
use observation::Widths;
use vocabulary::Cause;

/// Sizes of a rollout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RolloutLayout {
    /// N, environments stepped side by side.
    pub environments: usize,
    /// T, control steps of 20 ms.
    pub steps: usize,
    /// What the rows hold.
    pub lists: Lists,
}

/// Writes the views from the table of blocks, so that order and size are said once.
macro_rules! blocks {
    (
        each step: { $( $(#[$step_doc:meta])* $step:ident: $step_width:expr, )* }
        once: { $( $(#[$once_doc:meta])* $once:ident: $once_width:expr, )* }
    ) => {
        impl RolloutLayout {
            /// Numbers of one environment and step, all per-step blocks together.
            pub fn per_step(&self) -> usize {
                0 $( + self.wide($step_width) )*
            }

            /// Numbers of one environment in the blocks that do not grow with the steps.
            pub fn once(&self) -> usize {
                0 $( + self.wide($once_width) )*
            }

            /// Every block of a rollout, to be read.
            ///
            /// # Panics
            /// When `numbers` does not have [`Self::len`] items.
            pub fn view<'a>(&self, numbers: &'a [f32]) -> RolloutView<'a> {
                assert_eq!(numbers.len(), self.len(), "length of a rollout");
                let rest = numbers;
                $( let ($step, rest) = rest.split_at(self.steps * self.environments * self.wide($step_width)); )*
                $( let ($once, rest) = rest.split_at(self.environments * self.wide($once_width)); )*
                debug_assert!(rest.is_empty());
                RolloutView { layout: *self, $( $step, )* $( $once, )* }
            }

            /// Every block of a rollout, to be written.
            ///
            /// # Panics
            /// When `numbers` does not have [`Self::len`] items.
            pub fn view_mut<'a>(&self, numbers: &'a mut [f32]) -> RolloutViewMut<'a> {
                assert_eq!(numbers.len(), self.len(), "length of a rollout");
                let rest = numbers;
                $( let ($step, rest) = rest.split_at_mut(self.steps * self.environments * self.wide($step_width)); )*
                $( let ($once, rest) = rest.split_at_mut(self.environments * self.wide($once_width)); )*
                debug_assert!(rest.is_empty());
                RolloutViewMut { layout: *self, $( $step, )* $( $once, )* }
            }
        }

        /// A rollout to read: T·N·width numbers in each per-step block, N·width in the others.
        #[derive(Clone, Copy, Debug)]
        pub struct RolloutView<'a> {
            /// Sizes.
            pub layout: RolloutLayout,
            $( $(#[$step_doc])* pub $step: &'a [f32], )*
            $( $(#[$once_doc])* pub $once: &'a [f32], )*
        }

        /// A rollout to write; the blocks do not overlap.
        #[derive(Debug)]
        pub struct RolloutViewMut<'a> {
            /// Sizes.
            pub layout: RolloutLayout,
            $( $(#[$step_doc])* pub $step: &'a mut [f32], )*
            $( $(#[$once_doc])* pub $once: &'a mut [f32], )*
        }

        /// One step of a rollout to read: N·width numbers in each block.
        #[derive(Clone, Copy, Debug)]
        pub struct RolloutStep<'a> {
            $( $(#[$step_doc])* pub $step: &'a [f32], )*
        }

        /// One step of a rollout to write: N·width numbers in each block, and the blocks that
        /// belong to no step as a whole.
        #[derive(Debug)]
        pub struct RolloutStepMut<'a> {
            $( $(#[$step_doc])* pub $step: &'a mut [f32], )*
            $( $(#[$once_doc])* pub $once: &'a mut [f32], )*
        }

        impl<'a> RolloutView<'a> {
            /// The first number that is NaN or infinite, time-out observations left out.
            fn not_finite(&self) -> Option<Flaw> {
                let blocks = [
                    $( (stringify!($step), self.$step, self.layout.wide($step_width)), )*
                    $( (stringify!($once), self.$once, self.layout.wide($once_width)), )*
                ];
                blocks.into_iter().find_map(|(field, numbers, width)| {
                    let meaningful = !field.starts_with("timeout_");
                    let index = first_not_finite(numbers).filter(|_| meaningful)?;
                    Some(Flaw { field, row: index / width, value: numbers[index] })
                })
            }

            /// The blocks of step `step`, from 0.
            pub fn step(&self, step: usize) -> RolloutStep<'a> {
                let RolloutLayout { environments, .. } = self.layout;
                RolloutStep {
                    $( $step: {
                        let size = environments * self.layout.wide($step_width);
                        &self.$step[step * size..][..size]
                    }, )*
                }
            }
        }

        impl RolloutViewMut<'_> {
            /// The blocks of step `step`, from 0.
            pub fn step(&mut self, step: usize) -> RolloutStepMut<'_> {
                let environments = self.layout.environments;
                RolloutStepMut {
                    $( $step: {
                        let size = environments * self.layout.wide($step_width);
                        &mut self.$step[step * size..][..size]
                    }, )*
                    $( $once: &mut *self.$once, )*
                }
            }
        }
    };
}

blocks! {
    each step: {
        /// o_t as the policy saw it, with sensor noise.
        observations: |widths| widths.observation,
        /// a_t, sampled.
        actions: |_| ACTION,
        /// Mean of the distribution that a_t was sampled from.
        means: |_| ACTION,
        /// Log-density of a_t under that distribution.
        log_probs: |_| 1,
        /// r^G, the task reward (Eq. 14).
        task_rewards: |_| 1,
        /// Positive mechanical work of this control step in J, summed over the joints.
        energies: |_| 1,
        /// Squared planar velocity error in the heading frame, m²/s².
        tracking_errors: |_| 1,
        /// 0 the episode goes on, else why it ended: [`Cause::code`].
        ends: |_| 1,
        /// Steps done in the episode, this one included.
        episode_steps: |_| 1,
        /// What the discriminator sees of the true state before the step.
        features: |widths| widths.features,
        /// What it sees of the true state after the step; for a finished episode its own last.
        next_features: |widths| widths.features,
        /// Ground reaction of the left and the right foot in N.
        foot_forces: |_| 2,
        /// What the critic sees before the step beside the observation, or instead; nothing where it sees what the policy
        /// does.
        critic: |widths| widths.critic,
        /// What is measured beside, of the true state after the step and the command during it; see
        /// [`observation::Tables::measured`].
        measured: |widths| widths.measured,
    }
    once: {
        /// o_T, what the policy would see next.
        last_observations: |widths| widths.observation,
        /// Last observation of the episode that timed out, per environment; meaningless where none did.
        timeout_observations: |widths| widths.observation,
        /// What the critic would see of its own after the last step.
        last_critic: |widths| widths.critic,
        /// What it saw of its own with the last observation of an episode that timed out.
        timeout_critic: |widths| widths.critic,
    }
}

/// A number in a rollout that no sound actor sends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flaw {
    /// Name of its block.
    pub field: &'static str,
    /// Its row in the block: step · N + environment, or the environment.
    pub row: usize,
    /// Its value.
    pub value: f32,
}

impl RolloutView<'_> {
    /// The first number that cannot be, if there is one: NaN or infinite, an end of an unknown kind, or
    /// a count of steps below zero.
    pub fn flaw(&self) -> Option<Flaw> {
        let named = |field, numbers: &[f32], wrong: fn(f32) -> bool| {
            let row = numbers.iter().position(|&number| wrong(number))?;
            let value = numbers[row];
            Some(Flaw { field, row, value })
        };
        self.not_finite()
            .or_else(|| named("ends", self.ends, |end| Cause::of(end).is_err()))
            .or_else(|| named("episode_steps", self.episode_steps, |steps| steps < 0.0))
            .or_else(|| self.unsound_time_out())
    }

    /// Time-out observations mean something where an episode timed out.
    fn unsound_time_out(&self) -> Option<Flaw> {
        let environments = self.layout.environments;
        let time_out = Cause::TimeOut.code();
        let ends = self.ends.iter().enumerate();
        ends.filter(|(_, end)| **end == time_out)
            .map(|(row, _)| row % environments)
            .find_map(|row| {
                let blocks = [
                    ("timeout_observations", self.timeout_observations),
                    ("timeout_critic", self.timeout_critic),
                ];
                blocks.into_iter().find_map(|(field, numbers)| {
                    let width = numbers.len() / environments;
                    let seen = &numbers[row * width..][..width];
                    let value = seen[first_not_finite(seen)?];
                    Some(Flaw { field, row, value })
                })
            })
    }
}

fn first_not_finite(numbers: &[f32]) -> Option<usize> {
    // Groups first, without a branch per number, which vectors of the machine do many at a time.
    const GROUP: usize = 256;
    let sound = |group: &[f32]| group.iter().fold(true, |sound, x| sound & x.is_finite());
    let group = numbers.chunks(GROUP).position(|group| !sound(group))?;
    let rest = &numbers[group * GROUP..];
    let within = rest.iter().position(|number| !number.is_finite())?;
    Some(group * GROUP + within)
}

impl RolloutLayout {
    /// Numbers of a row of a block.
    fn wide(&self, of: fn(&Widths) -> usize) -> usize {
        of(&self.lists.widths)
    }

    /// Numbers in the whole rollout; `None` where no memory could hold so many.
    pub fn checked_len(&self) -> Option<usize> {
        let per_environment = self.steps.checked_mul(self.per_step())?;
        let per_environment = per_environment.checked_add(self.once())?;
        self.environments.checked_mul(per_environment)
    }

    /// Numbers in the whole rollout.
    #[expect(clippy::len_without_is_empty, reason = "a size, not a collection")]
    pub fn len(&self) -> usize {
        self.environments * (self.steps * self.per_step() + self.once())
    }
}

#[cfg(test)]
mod tests;
