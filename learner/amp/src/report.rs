//! What an iteration tells the log.

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use vocabulary::{Cause, Counts};

use crate::saturation::Scores;

/// Figures of one iteration. All but [`Self::seconds`] are the same for the same inputs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct IterationReport {
    /// Iterations done, this one included.
    pub iteration: u64,
    /// Rows learnt from since the beginning, these included.
    pub samples: u64,
    /// Rows of this iteration.
    pub rows: u64,

    /// r̄ˢ, mean style reward of the batch.
    pub style_mean: f64,
    /// Its standard deviation over the batch's transitions.
    pub style_std: f64,
    /// Standard deviation of the robots' means in the batch, each beside that of the robot with the nearest command.
    pub style_std_robots: f64,
    /// Its least value.
    pub style_min: f64,
    /// Its largest value.
    pub style_max: f64,
    /// Mean task reward rᴳ.
    pub task_mean: f64,
    /// Its standard deviation over the batch's transitions.
    pub task_std: f64,
    /// Mean blended reward r, before scaling.
    pub reward_mean: f64,
    /// Mean wˢ.
    pub style_weight: f64,

    /// Mean length in steps of the episodes that ended in this batch; none if none did.
    pub episode_length: Option<f64>,
    /// Episodes that ended, by cause: `termination/fall` and so on.
    #[serde(flatten, serialize_with = "by_cause")]
    pub terminations: Counts,
    /// Root of the mean squared planar velocity error, m/s.
    pub rmse: f64,
    /// Positive mechanical work of one robot in 1,000 steps, J; with exploration noise about twice that without.
    pub energy_j: f64,

    /// Mean clipped surrogate loss over all minibatches.
    pub surrogate: f64,
    /// Mean value loss over all minibatches.
    pub value_loss: f64,
    /// Entropy of the policy after the update.
    pub entropy: f64,
    /// Mean KL(old ‖ new) in the last epoch, of rows that are not mirrored.
    pub kl: f64,
    /// Share of ratios outside the clip range, over all minibatches.
    pub clip_fraction: f64,
    /// Mean symmetry loss over all minibatches; none if no row was a lesson in it: it is off, or all such rows are mirrored.
    pub asymmetry: Option<f64>,
    /// Adam's rate for the next iteration.
    pub learning_rate: f64,
    /// Mean global norm of PPO's gradient before clipping.
    pub gradient_norm: f64,
    /// Mean σ of the actions in this batch.
    pub sigma: f64,
    /// 1 − Var(R − V)/Var(R): how much of the returns the critic foresaw.
    pub explained_variance: f64,

    /// Mean D of expert windows over the discriminator's steps.
    pub expert_score: f64,
    /// Mean D of policy transitions.
    pub policy_score: f64,
    /// Mean D of reference motion beside commands that it does not follow; none if it is not shown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mismatch_score: Option<f64>,
    /// Mean L_GP (Eq. 5), without its weight.
    pub gradient_penalty: f64,
    /// Mean L_AMP (Eq. 6).
    pub discriminator_loss: f64,

    /// Where the time went.
    pub seconds: Seconds,
}

impl IterationReport {
    /// What the discriminator made of it.
    pub fn scores(&self) -> Scores {
        Scores {
            expert: self.expert_score,
            policy: self.policy_score,
            style_std: self.style_std,
        }
    }
}

/// Seconds of wall time of an iteration's parts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Checks, scoring, blending.
    pub score: f64,
    /// Of this, weights and blend of all transitions (Eq. 1, 9, 12): what the method costs.
    pub weighting: f64,
    /// Values and advantages.
    pub advantage: f64,
    /// The policy's update.
    pub ppo: f64,
    /// The discriminator's update.
    pub discriminator: f64,
    /// All of it.
    pub total: f64,
}

/// A key for each cause, in a group of their own.
fn by_cause<S: Serializer>(counts: &Counts, serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(None)?;
    for cause in Cause::ALL {
        map.serialize_entry(&format!("termination/{}", cause.name()), &counts.by(cause))?;
    }
    map.end()
}

/// Mean, standard deviation, least and largest of numbers; zeros of none.
pub(crate) fn moments(numbers: &[f32]) -> [f64; 4] {
    if numbers.is_empty() {
        return [0.0; 4];
    }
    let n = numbers.len() as f64;
    let mean = numbers.iter().map(|x| f64::from(*x)).sum::<f64>() / n;
    let square = numbers
        .iter()
        .map(|x| (f64::from(*x) - mean).powi(2))
        .sum::<f64>()
        / n;
    let least = numbers.iter().copied().fold(f32::INFINITY, f32::min);
    let most = numbers.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    [mean, square.sqrt(), f64::from(least), f64::from(most)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_by_hand() {
        // 1 3 5 7: mean 4, squares 9+1+1+9 = 20 over 4
        assert_eq!(
            moments(&[1.0, 3.0, 5.0, 7.0]),
            [4.0, 5.0_f64.sqrt(), 1.0, 7.0]
        );
        assert_eq!(moments(&[]), [0.0; 4]);
    }
}
