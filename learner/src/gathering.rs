//! What comes together for one iteration: seats in the batch, and who fills them.

use std::collections::BTreeMap;

use amp::Batch;
use protocol::{Rollout, RolloutHeader};

/// What came together for one iteration. Seconds are means over the rollouts, but for `collect`,
/// which is the slowest's.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gathered {
    pub(crate) rollouts: usize,
    pub(crate) actors: usize,
    /// Mean age of the weights that acted, in versions.
    pub(crate) policy_lag: f64,
    pub(crate) collect_seconds: f64,
    pub(crate) physics_seconds: f64,
    pub(crate) observation_seconds: f64,
    pub(crate) inference_seconds: f64,
    pub(crate) waiting_seconds: f64,
    /// Copying rollouts to their places, all together.
    pub(crate) copy_seconds: f64,
    /// Means of the task's terms, by name.
    pub(crate) terms: TermMeans,
}

/// What has come together so far.
pub(crate) struct Gathering<'a> {
    pub(crate) version: u64,
    pub(crate) batch: &'a mut Batch,
    pub(crate) seats: Vec<Seat>,
    pub(crate) gathered: Gathered,
}

/// A place in the batch.
#[derive(Clone, Debug)]
pub(crate) struct Seat {
    /// Whose it is; `None` is anybody's.
    pub(crate) actor: Option<u32>,
    pub(crate) taken: bool,
    /// What the rollout that took it tells of the task's terms.
    pub(crate) terms: TermMeans,
}

/// Means of the task's terms, by name.
pub(crate) type TermMeans = BTreeMap<String, f64>;

/// Means over rollouts of the same number of rows. In the order of the seats and not of arrival, so that the same
/// rollouts give the same bits; a term that a rollout does not tell was not looked at there.
pub(crate) fn means<'a>(seats: impl Iterator<Item = &'a TermMeans>) -> TermMeans {
    let mut sums: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    for (name, mean) in seats.flatten() {
        let (sum, rollouts) = sums.entry(name.clone()).or_default();
        *sum += mean;
        *rollouts += 1.0;
    }
    let mean = |(name, (sum, rollouts)): (String, (f64, f64))| (name, sum / rollouts);
    sums.into_iter().map(mean).collect()
}

impl Gathered {
    pub(crate) fn count(&mut self, header: &RolloutHeader, version: u64) {
        self.rollouts += 1;
        self.policy_lag += version.saturating_sub(header.policy_version) as f64;
        self.collect_seconds = self.collect_seconds.max(f64::from(header.collect_seconds));
        self.physics_seconds += f64::from(header.physics_seconds);
        self.observation_seconds += f64::from(header.observation_seconds);
        self.inference_seconds += f64::from(header.inference_seconds);
        self.waiting_seconds += f64::from(header.waiting_seconds);
    }

    pub(crate) fn average(&mut self) {
        let rollouts = self.rollouts.max(1) as f64;
        self.policy_lag /= rollouts;
        self.physics_seconds /= rollouts;
        self.observation_seconds /= rollouts;
        self.inference_seconds /= rollouts;
        self.waiting_seconds /= rollouts;
    }
}

/// The one copy: every block of the rollout to its segment's rows.
pub(crate) fn copy(rollout: &Rollout, batch: &mut Batch, segment: usize) {
    let from = rollout.view();
    let wide = Wide {
        observation: batch.widths().observation,
        own: rollout.layout().lists.widths.critic,
        whole: batch.widths().critic,
    };
    let to = batch.segment_mut(segment);
    let shared = from.observations;
    join(to.critic, shared, from.critic, wide);
    join(
        to.last_critic,
        from.last_observations,
        from.last_critic,
        wide,
    );
    join(
        to.timeout_critic,
        from.timeout_observations,
        from.timeout_critic,
        wide,
    );
    to.observations.copy_from_slice(from.observations);
    to.actions.copy_from_slice(from.actions);
    to.means.copy_from_slice(from.means);
    to.log_probs.copy_from_slice(from.log_probs);
    to.task_rewards.copy_from_slice(from.task_rewards);
    to.energies.copy_from_slice(from.energies);
    to.tracking_errors.copy_from_slice(from.tracking_errors);
    to.ends.copy_from_slice(from.ends);
    to.episode_steps.copy_from_slice(from.episode_steps);
    to.features.copy_from_slice(from.features);
    to.next_features.copy_from_slice(from.next_features);
    to.foot_forces.copy_from_slice(from.foot_forces);
    to.measured.copy_from_slice(from.measured);
    to.last_observations.copy_from_slice(from.last_observations);
    to.timeout_observations
        .copy_from_slice(from.timeout_observations);
}

/// Numbers of rows.
#[derive(Clone, Copy)]
struct Wide {
    /// What the policy sees.
    observation: usize,
    /// What the critic sees beside.
    own: usize,
    /// All that the critic sees: its own alone, or that behind what the policy sees; 0 where it sees no more.
    whole: usize,
}

/// Whole rows of the critic's, of what it shares with the policy and its own.
fn join(out: &mut [f32], observations: &[f32], own: &[f32], wide: Wide) {
    if wide.whole == 0 {
        return;
    }
    let shared = wide.whole - wide.own;
    let rows = observations
        .chunks_exact(wide.observation)
        .zip(own.chunks_exact(wide.own));
    for (out, (seen, own)) in out.chunks_exact_mut(wide.whole).zip(rows) {
        out[..shared].copy_from_slice(&seen[..shared]);
        out[shared..].copy_from_slice(own);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_critics_row_is_the_policys_and_its_own_or_its_own_alone() {
        let (seen, own) = ([1.0, 2.0, 3.0, 4.0], [5.0, 6.0]);
        let joined = |whole: usize| {
            let mut out = vec![0.0; 2 * whole];
            let wide = Wide {
                observation: 2,
                own: 1,
                whole,
            };
            join(&mut out, &seen, &own, wide);
            out
        };
        assert_eq!(joined(3), [1.0, 2.0, 5.0, 3.0, 4.0, 6.0]);
        assert_eq!(joined(1), [5.0, 6.0]);
        assert!(joined(0).is_empty());
    }

    #[test]
    fn terms_are_averaged_over_the_rollouts_that_tell_them() {
        let terms = |told: &[(&str, f64)]| -> TermMeans {
            let owned = told.iter().map(|(name, mean)| ((*name).to_owned(), *mean));
            owned.collect()
        };
        let seats = [
            terms(&[("gate/effort", 0.5), ("reward/track", 0.25)]),
            terms(&[("reward/track", 0.75)]),
            terms(&[]),
        ];
        let expected = terms(&[("gate/effort", 0.5), ("reward/track", 0.5)]);
        assert_eq!(means(seats.iter()), expected);
    }
}
