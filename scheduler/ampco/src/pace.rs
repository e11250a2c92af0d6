//! How fast the run's ramps go: the `pace` knob.
//!
//! A ramp by the number of samples goes on whether or not robots keep up. Where commands widen faster than they are
//! learned, more and more episodes end early, and what is left teaches little. `progress` holds all ramps of task and robots
//! while episodes do not last, as published trainers widen commands and roughen ground by what robots have mastered.

use crate::ScheduleConfig;
use crate::config::PaceKind;

/// The share of the longest possible length that episodes have to last on average for ramps to go on.
const MASTERED: f64 = 0.9;

/// Counts the iterations in which ramps stood still.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pace {
    kind: PaceKind,
    smoothing: f64,
    count: f64,
    share: f64,
    held: u64,
}

impl Pace {
    /// As a checked configuration says.
    pub(crate) fn new(config: &ScheduleConfig) -> Self {
        Self {
            kind: config.pace,
            smoothing: config.smoothing,
            count: 0.0,
            share: 0.0,
            held: 0,
        }
    }

    /// Takes an iteration into account: the mean length of the episodes that ended in it, as a share of the longest possible,
    /// if any did.
    pub(crate) fn observe(&mut self, episode_share: Option<f64>) {
        if let Some(share) = episode_share {
            self.count = (self.count + 1.0).min(self.smoothing);
            self.share += (share - self.share) / self.count;
        }
        if self.kind == PaceKind::Progress && self.share < MASTERED {
            self.held += 1;
        }
    }

    /// Iterations in which ramps stood still so far.
    pub(crate) fn held(&self) -> u64 {
        self.held
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(pace: PaceKind, shares: &[Option<f64>]) -> Vec<u64> {
        let mut pace = Pace::new(&ScheduleConfig {
            pace,
            smoothing: 2.0,
            ..ScheduleConfig::default()
        });
        let mut after = |share: &Option<f64>| {
            pace.observe(*share);
            pace.held()
        };
        shares.iter().map(&mut after).collect()
    }

    #[test]
    fn ramps_wait_for_episodes_that_last() {
        let shares = [
            None,
            Some(0.7),
            Some(1.0),
            Some(1.0),
            None,
            Some(0.8),
            Some(1.0),
        ];
        // Nothing yet; 0.7; (0.7 + 1)/2 = 0.85; 0.925 ≥ 0.9; as it was; 0.8625; 0.93125.
        assert_eq!(held(PaceKind::Progress, &shares), [1, 2, 3, 3, 3, 4, 4]);
        assert_eq!(held(PaceKind::Samples, &shares), [0; 7]);
    }
}
