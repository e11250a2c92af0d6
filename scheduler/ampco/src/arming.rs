//! When Algorithm 1 may begin to test: the `arm` knob.
//!
//! Algorithm 1 as written also finds "convergence" in a reward that falls: it then never exceeds its own history. With
//! episodes that start on the reference motion the style reward does fall at first, from what the reference earned to
//! what the policy earns. `after_rise` waits until the smoothed reward has risen from its minimum by a share of it.

use crate::ArmKind;

/// What this iteration's reward means for Algorithm 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arm {
    /// Convergence is not tested yet.
    Waiting,
    /// The rise is complete with this reward: the history of fall and climb is to be forgotten, and the test begins.
    ///
    /// Kept, the values from before the fall would still set the percentile, and a climb that has not yet passed them
    /// would at once be called a plateau.
    Begins,
    /// Convergence is tested.
    Armed,
}

/// Follows the smoothed reward and its minimum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arming {
    kind: ArmKind,
    rise_share: f64,
    smoothing: f64,
    count: u64,
    smoothed: f64,
    minimum: f64,
    armed: bool,
}

impl Arming {
    /// `rise_share` ≥ 0 of the minimum, `smoothing` ≥ 1 in iterations; the literal kind uses neither.
    pub fn new(kind: ArmKind, rise_share: f64, smoothing: f64) -> Self {
        Self {
            kind,
            rise_share,
            smoothing,
            count: 0,
            smoothed: 0.0,
            minimum: f64::INFINITY,
            armed: false,
        }
    }

    /// Takes this iteration's mean style reward (finite) into account.
    ///
    /// Smoothing is exponential, s += (r̄ˢ − s)/n, where n counts up to `smoothing`: at first it is the plain mean. A new
    /// minimum disarms, so that an early rise followed by a deeper fall waits for the rise after that fall.
    pub fn observe(&mut self, style_mean: f64) -> Arm {
        if self.kind == ArmKind::WindowFull {
            return Arm::Armed;
        }
        self.count += 1;
        self.smoothed += (style_mean - self.smoothed) / (self.count as f64).min(self.smoothing);
        if self.smoothed < self.minimum {
            self.minimum = self.smoothed;
            self.armed = false;
        }
        if self.armed {
            return Arm::Armed;
        }
        // A minimum that is still the newest value has not been risen from, whatever the share.
        self.armed =
            self.smoothed > self.minimum && self.smoothed >= (1.0 + self.rise_share) * self.minimum;
        if self.armed {
            Arm::Begins
        } else {
            Arm::Waiting
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_literal_kind_is_always_armed() {
        assert_eq!(
            Arming::new(ArmKind::WindowFull, 0.5, 1.0).observe(0.3),
            Arm::Armed
        );
    }

    #[test]
    fn a_rise_by_the_share_arms_and_a_new_minimum_disarms() {
        let mut arming = Arming::new(ArmKind::AfterRise, 0.5, 1.0); // no smoothing
        let seen = [0.5, 0.4, 0.5, 0.625, 0.5, 0.25, 0.3, 0.375].map(|r| arming.observe(r));
        // Minimum 0.4 wants 0.6: reached at 0.625, and 0.5 stays armed. Minimum 0.25 disarms and wants 0.375.
        use Arm::{Armed, Begins, Waiting};
        assert_eq!(
            seen,
            [
                Waiting, Waiting, Waiting, Begins, Armed, Waiting, Waiting, Begins
            ]
        );
    }

    #[test]
    fn smoothing_holds_back_a_single_high_value() {
        let mut arming = Arming::new(ArmKind::AfterRise, 0.5, 4.0);
        // Mean of 0.2 0.2 0.2 0.4 is 0.25 < 0.3; then 0.25 + (0.4 − 0.25)/4 = 0.2875; then + (0.4 − 0.2875)/4 = 0.3156.
        let seen = [0.2, 0.2, 0.2, 0.4, 0.4, 0.4].map(|r| arming.observe(r));
        assert_eq!(seen[4], Arm::Waiting);
        assert_eq!(seen[5], Arm::Begins);
    }

    #[test]
    fn a_falling_or_constant_reward_never_arms() {
        let mut falling = Arming::new(ArmKind::AfterRise, 0.0, 3.0);
        assert!((0..100).all(|i| falling.observe(1.0 - 0.01 * f64::from(i)) == Arm::Waiting));
        let mut constant = Arming::new(ArmKind::AfterRise, 0.0, 1.0);
        assert!((0..100).all(|_| constant.observe(0.25) == Arm::Waiting));
    }
}
