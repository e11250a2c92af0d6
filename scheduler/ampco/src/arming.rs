//! When Algorithm 1 may begin to test: the `arm` knob.
//!
//! Algorithm 1 as written also finds "convergence" in a reward that falls: it then never exceeds its own history. With
//! episodes that start on the reference motion the style reward does fall at first, from what the reference earned to
//! what the policy earns. `after_rise` waits until the smoothed reward has risen from its minimum by a share of it.
//!
//! It also finds convergence in a reward that pauses. A run whose robots fall after two seconds may earn the same style
//! for millions of samples before they stay up, and more after that. `episodes_last` waits for what imitation is for:
//! robots that stay up. Style is then judged to converge on episodes that last. And on a task that stands still: while
//! commands widen, a style reward that no longer rises has been handed something new to imitate.

use crate::{ArmKind, Report, ScheduleConfig};

/// By which share of its minimum the smoothed reward has to rise: a third of the rise seen in a trial whose style reward
/// fell to 0.29 and then rose to 0.39.
const RISE_SHARE: f64 = 0.1;

/// The share of the longest possible length that episodes have to last on average: a robot that still falls in the first
/// half of its episodes is not yet past imitation.
const LAST_SHARE: f64 = 0.8;

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

/// Follows what arms: the smoothed reward and its minimum, or the smoothed length of episodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arming {
    kind: ArmKind,
    rise_share: f64,
    last_share: f64,
    smoothing: f64,
    /// The iteration from which on nothing of the run moves, if ramps never stand still.
    settled: u64,
    count: u64,
    smoothed: f64,
    minimum: f64,
    armed: bool,
}

impl Arming {
    /// As a checked configuration says.
    pub fn new(config: &ScheduleConfig) -> Self {
        Self {
            kind: config.arm,
            rise_share: RISE_SHARE,
            last_share: LAST_SHARE,
            smoothing: config.smoothing,
            settled: 0,
            count: 0,
            smoothed: 0.0,
            minimum: f64::INFINITY,
            armed: false,
        }
    }

    /// The same, in a run whose task moves until an iteration.
    pub fn settling(self, iteration: u64) -> Self {
        Self {
            settled: iteration,
            ..self
        }
    }

    /// Takes an iteration's report into account, every number of it finite; ramps stood still in `held` iterations so far.
    pub fn observe(&mut self, report: &Report, held: u64) -> Arm {
        let ready = match self.kind {
            ArmKind::WindowFull => return Arm::Armed,
            ArmKind::AfterRise => self.has_risen(report.style_mean),
            ArmKind::EpisodesLast => {
                self.lasts(report.episode_share)
                    && report.iteration.saturating_sub(held) >= self.settled
            }
        };
        match (std::mem::replace(&mut self.armed, ready), ready) {
            (_, false) => Arm::Waiting,
            (false, true) => Arm::Begins,
            (true, true) => Arm::Armed,
        }
    }

    /// Whether the smoothed reward has risen from its minimum by the share. A new minimum disarms, so that an early rise
    /// followed by a deeper fall waits for the rise after that fall; a fall that stays above it does not.
    fn has_risen(&mut self, style_mean: f64) -> bool {
        self.smooth(style_mean);
        if self.smoothed < self.minimum {
            self.minimum = self.smoothed;
            // A minimum that is still the newest value has not been risen from, whatever the share.
            return false;
        }
        let risen =
            self.smoothed > self.minimum && self.smoothed >= (1.0 + self.rise_share) * self.minimum;
        self.armed || risen
    }

    /// Whether episodes last. An iteration in which none ended says nothing.
    fn lasts(&mut self, episode_share: Option<f64>) -> bool {
        if let Some(share) = episode_share {
            self.smooth(share);
        }
        self.count > 0 && self.smoothed >= self.last_share
    }

    /// s += (x − s)/n, where n counts up to `smoothing`: at first it is the plain mean.
    fn smooth(&mut self, value: f64) {
        self.count += 1;
        self.smoothed += (value - self.smoothed) / (self.count as f64).min(self.smoothing);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of one kind, with the share that it asks for.
    fn arming(kind: ArmKind, share: f64, smoothing: f64) -> Arming {
        Arming {
            rise_share: share,
            last_share: share,
            ..Arming::new(&ScheduleConfig {
                arm: kind,
                smoothing,
                ..ScheduleConfig::default()
            })
        }
    }

    fn report(style_mean: f64, episode_share: Option<f64>) -> Report {
        Report {
            iteration: 1,
            style_mean,
            style_std: 0.0,
            style_std_robots: None,
            task_mean: 0.0,
            episode_share,
        }
    }

    /// Answers to rewards.
    fn style(arming: &mut Arming, means: &[f64]) -> Vec<Arm> {
        let answer = |mean: &f64| arming.observe(&report(*mean, None), 0);
        means.iter().map(answer).collect()
    }

    use Arm::{Armed, Begins, Waiting};

    #[test]
    fn the_literal_kind_is_always_armed() {
        let mut literal = arming(ArmKind::WindowFull, 0.5, 1.0);
        assert_eq!(style(&mut literal, &[0.3]), [Armed]);
    }

    #[test]
    fn a_rise_by_the_share_arms_and_a_new_minimum_disarms() {
        let mut arming = arming(ArmKind::AfterRise, 0.5, 1.0); // no smoothing
        let seen = style(&mut arming, &[0.5, 0.4, 0.5, 0.625, 0.5, 0.25, 0.3, 0.375]);
        // Minimum 0.4 wants 0.6: reached at 0.625, and 0.5 stays armed. Minimum 0.25 disarms and wants 0.375.
        assert_eq!(
            seen,
            [
                Waiting, Waiting, Waiting, Begins, Armed, Waiting, Waiting, Begins
            ]
        );
    }

    #[test]
    fn smoothing_holds_back_a_single_high_value() {
        let mut arming = arming(ArmKind::AfterRise, 0.5, 4.0);
        // Mean of 0.2 0.2 0.2 0.4 is 0.25 < 0.3; then 0.25 + (0.4 − 0.25)/4 = 0.2875; then + (0.4 − 0.2875)/4 = 0.3156.
        let seen = style(&mut arming, &[0.2, 0.2, 0.2, 0.4, 0.4, 0.4]);
        assert_eq!(seen[4..], [Waiting, Begins]);
    }

    #[test]
    fn a_falling_or_constant_reward_never_arms() {
        let falling: Vec<f64> = (0..100).map(|i| 1.0 - 0.01 * f64::from(i)).collect();
        let never = |smoothing, means: &[f64]| {
            let mut arming = arming(ArmKind::AfterRise, 0.0, smoothing);
            style(&mut arming, means).iter().all(|arm| *arm == Waiting)
        };
        assert!(never(3.0, &falling) && never(1.0, &[0.25; 100]));
    }

    #[test]
    fn episodes_that_last_arm_and_robots_that_fall_again_disarm() {
        let mut arming = arming(ArmKind::EpisodesLast, 0.8, 2.0);
        let shares = [
            None,
            Some(0.4),
            Some(0.9),
            Some(1.0),
            None,
            Some(0.4),
            Some(1.0),
        ];
        // Nothing yet; 0.4; (0.4 + 0.9)/2 = 0.65; + (1 − 0.65)/2 = 0.825 ≥ 0.8; none ended: as it was; 0.6125; 0.80625.
        let seen = shares.map(|share| arming.observe(&report(0.3, share), 0));
        assert_eq!(
            seen,
            [Waiting, Waiting, Waiting, Begins, Armed, Waiting, Begins]
        );
    }

    #[test]
    fn robots_that_last_wait_for_a_task_that_stands_still() {
        let seen = |kind, held| {
            let mut arming = arming(kind, 0.8, 1.0).settling(3);
            [1, 2, 3, 4].map(|iteration| {
                let report = Report {
                    iteration,
                    ..report(0.3, Some(1.0))
                };
                arming.observe(&report, held)
            })
        };
        let lasting = seen(ArmKind::EpisodesLast, 0);
        assert_eq!(lasting, [Waiting, Waiting, Begins, Armed]);
        // Ramps that stood still once arrive an iteration later.
        let held = seen(ArmKind::EpisodesLast, 1);
        assert_eq!(held, [Waiting, Waiting, Waiting, Begins]);
        // Algorithm 1 as written knows of no such thing.
        assert_eq!(seen(ArmKind::WindowFull, 0), [Armed; 4]);
    }
}
