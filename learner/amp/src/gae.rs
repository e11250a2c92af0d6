//! Generalised advantage estimation over one rollout (Schulman et al. 2016).

use crate::Segment;
use vocabulary::{Cause, RUNNING};

/// What advantages follow from; slices of one rollout, `[step][environment]` or `[environment]`.
#[derive(Clone, Copy, Debug)]
pub struct Returns<'a> {
    /// Blended, scaled reward of each row.
    pub rewards: &'a [f32],
    /// V(o_t) of each row.
    pub values: &'a [f32],
    /// How each row's episode went on.
    pub ends: &'a [f32],
    /// V of the observation after the last step, per environment.
    pub last_values: &'a [f32],
    /// V of the observation at a time-out, per environment; read where there was one.
    pub timeout_values: &'a [f32],
}

/// Writes  A_t = δ_t + γλ·A_{t+1},  δ_t = r_t + γ·V(o_{t+1}) − V(o_t),  for each row.
///
/// A time-out cuts an episode that could have gone on: V of its own last observation follows. After any other end, a fall,
/// straying or a fault, nothing does: V(o_{t+1}) = 0. Across no end is an advantage carried.
///
/// # Panics
/// If a slice does not fit the rollout.
pub fn advantages(segment: Segment, from: Returns<'_>, gamma: f32, lambda: f32, out: &mut [f32]) {
    assert_eq!(out.len(), segment.rows(), "one advantage per row");
    backward(segment, from, gamma, |row, delta, next| {
        out[row] = delta + gamma * lambda * next;
        out[row]
    });
}

/// Goes through each environment's rows from the last to the first: what `carry` makes of a row, its δ_t and what it made
/// of the row after it is carried to the row before. Across no end, nor into the last row, is anything but 0 carried.
pub(crate) fn backward(
    segment: Segment,
    from: Returns<'_>,
    gamma: f32,
    mut carry: impl FnMut(usize, f32, f32) -> f32,
) {
    let robots = segment.environments;
    for robot in 0..robots {
        let mut next_value = from.last_values[robot];
        let mut carried = 0.0;
        for step in (0..segment.steps).rev() {
            let row = step * robots + robot;
            let end = from.ends[row];
            if end != RUNNING {
                let cut = end == Cause::TimeOut.code();
                next_value = if cut { from.timeout_values[robot] } else { 0.0 };
                carried = 0.0;
            }
            let delta = from.rewards[row] + gamma * next_value - from.values[row];
            carried = carry(row, delta, carried);
            next_value = from.values[row];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn running_falling_and_timed_out_episodes_by_hand() {
        // Three environments, three steps, γ = λ = ½. Rewards 1; values 2 4 6 by step; last values 8; time-out value 10.
        // Environment 0 runs:   δ₂ = 1 + 4 − 6 = −1, A₂ = −1;  δ₁ = 1 + 3 − 4 = 0, A₁ = −¼;  δ₀ = 1 + 2 − 2 = 1, A₀ = 15/16
        // Environment 1 falls at step 1:  δ₁ = 1 + 0 − 4 = −3 = A₁;  A₀ = 1 − ¾ = ¼;  A₂ = −1
        // Environment 2 is cut at step 1: δ₁ = 1 + 5 − 4 =  2 = A₁;  A₀ = 1 + ½ = 3/2; A₂ = −1
        let segment = Segment {
            steps: 3,
            environments: 3,
        };
        let mut out = [0.0; 9];
        advantages(
            segment,
            Returns {
                rewards: &[1.0; 9],
                values: &[2.0, 2.0, 2.0, 4.0, 4.0, 4.0, 6.0, 6.0, 6.0],
                ends: &[
                    0.0,
                    0.0,
                    0.0,
                    0.0,
                    Cause::Fall.code(),
                    Cause::TimeOut.code(),
                    0.0,
                    0.0,
                    0.0,
                ],
                last_values: &[8.0; 3],
                timeout_values: &[f32::NAN, f32::NAN, 10.0],
            },
            0.5,
            0.5,
            &mut out,
        );
        assert_eq!(out, [0.9375, 0.25, 1.5, -0.25, -3.0, 2.0, -1.0, -1.0, -1.0]);
    }

    #[test]
    fn nothing_follows_an_end_that_the_robot_or_the_physics_caused() {
        // One environment, two steps, γ = λ = ½, rewards 1, values 2 and 4: an end at the first step leaves
        // δ₀ = 1 + 0 − 2 = −1 = A₀, whatever the cause. A time-out with value 10 leaves 1 + 5 − 2 = 4.
        let first = |cause: Cause| {
            let segment = Segment {
                steps: 2,
                environments: 1,
            };
            let from = Returns {
                rewards: &[1.0; 2],
                values: &[2.0, 4.0],
                ends: &[cause.code(), RUNNING],
                last_values: &[8.0],
                timeout_values: &[10.0],
            };
            let mut out = [0.0; 2];
            advantages(segment, from, 0.5, 0.5, &mut out);
            out[0]
        };
        let firsts = [Cause::Fall, Cause::Stray, Cause::Fault, Cause::TimeOut].map(first);
        assert_eq!(firsts, [-1.0, -1.0, -1.0, 4.0]);
    }

    #[test]
    fn with_lambda_one_it_is_the_discounted_return() {
        // 1 + ½·2 + ¼·4 = 3, without values
        let segment = Segment {
            steps: 2,
            environments: 1,
        };
        let mut out = [0.0; 2];
        let from = Returns {
            rewards: &[1.0, 2.0],
            values: &[0.0; 2],
            ends: &[0.0; 2],
            last_values: &[4.0],
            timeout_values: &[0.0],
        };
        advantages(segment, from, 0.5, 1.0, &mut out);
        assert_eq!(out, [3.0, 4.0]);
    }
}
