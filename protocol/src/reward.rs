//! Reward reports: what the scheduler is told about each iteration.
//!
//! Separate because these are the only numbers that leave the learner for the scheduler, and every
//! one counts: a percentile over a window with holes is another percentile.

use std::time::Duration;

use iceoryx2::prelude::ZeroCopySend;
use serde::{Deserialize, Serialize};
use vocabulary::number;

use crate::error::PortError;
use crate::port::{Publisher, Subscriber, Wake};
use crate::presence::Node;
use crate::stream::{self, Spec, Stream};

/// Rewards of one iteration's batch, before blending.
///
/// The means are `f64`, as in `metrics.jsonl`: a scheduler that rebuilds its state from there must
/// come to the same bits. As JSON, for a checkpoint, it has no sender, and NaN is `null`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, ZeroCopySend, Serialize, Deserialize)]
#[type_name("ampco.RewardReport")]
pub struct RewardReport {
    /// Incarnation of the learner; filled by [`RewardPublisher::send`].
    #[serde(skip)]
    pub learner: u64,
    /// Reports of this learner before this one; filled by [`RewardPublisher::send`].
    #[serde(skip)]
    pub sequence: u64,
    /// Number of the iteration.
    pub iteration: u64,
    /// Transitions that the means are over.
    pub samples: u64,
    /// r̄ˢ, mean style reward.
    pub style_mean: f64,
    /// σˢ, standard deviation of the style reward.
    pub style_std: f64,
    /// Standard deviation of the robots' mean style rewards about what their commands make of them; NaN where it is not known.
    #[serde(default = "number::unknown", deserialize_with = "number::or_nan")]
    pub style_std_robots: f64,
    /// Smallest style reward.
    pub style_min: f64,
    /// Largest style reward.
    pub style_max: f64,
    /// Mean task reward.
    pub task_mean: f64,
    /// Standard deviation of the task reward; NaN where it is not known.
    #[serde(default = "number::unknown", deserialize_with = "number::or_nan")]
    pub task_std: f64,
    /// Mean length of the episodes that ended, as a share of the longest possible; NaN where none ended.
    #[serde(default = "number::unknown", deserialize_with = "number::or_nan")]
    pub episode_share: f64,
}

/// The stream of reports.
#[derive(Debug)]
pub(crate) enum Rewards {}

impl Stream for Rewards {
    type Item = RewardReport;
    type Header = ();
    const SPEC: Spec = stream::REWARDS;
}

/// The learner's end. There is one per run.
#[derive(Debug)]
pub struct RewardPublisher {
    port: Publisher<Rewards>,
    learner: u64,
    sequence: u64,
}

impl RewardPublisher {
    /// Opens the stream; fails with [`PortError::Taken`] while another learner lives.
    pub fn new(node: &Node) -> Result<Self, PortError> {
        Ok(Self {
            port: Publisher::open(node, 1, Duration::ZERO)?,
            learner: node.incarnation(),
            sequence: 0,
        })
    }

    /// Sends a report. Never waits; a scheduler that is away finds the numbers in the metrics.
    pub fn send(&mut self, report: RewardReport) -> Result<(), PortError> {
        let mut loan = self.port.loan(1)?;
        loan.payload_mut()[0] = RewardReport {
            learner: self.learner,
            sequence: self.sequence,
            ..report
        };
        self.sequence += 1;
        self.port.send(loan)?;
        Ok(())
    }
}

/// A report, and what is missing before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RewardArrival {
    /// The report.
    pub report: RewardReport,
    /// Reports of the same learner between the last arrival and this one that were lost, or that it
    /// sent before this process listened.
    pub missed: u64,
    /// This is another learner than that of the last arrival, or the first at all.
    pub new_learner: bool,
}

/// The scheduler's end, or a monitor's. Never holds the learner up.
#[derive(Debug)]
pub struct RewardSubscriber {
    port: Subscriber<Rewards>,
    gaps: Gaps,
}

impl RewardSubscriber {
    /// Opens the stream. 64 reports wait for a slow reader, then the oldest is lost.
    pub fn new(node: &Node) -> Result<Self, PortError> {
        let port = Subscriber::open(node)?;
        let gaps = Gaps::default();
        Ok(Self { port, gaps })
    }

    /// The next report, if there is one.
    pub fn receive(&mut self) -> Result<Option<RewardArrival>, PortError> {
        let Some(sample) = self.port.receive()? else {
            return Ok(None);
        };
        Ok(Some(self.gaps.arrive(sample.payload()[0])))
    }

    /// Reports missed so far.
    pub fn missed(&self) -> u64 {
        self.gaps.missed
    }

    /// Sleeps until a report was sent, `timeout` is over, or this process should stop; ticks.
    pub fn wait(&self, timeout: Duration) -> Result<Wake, PortError> {
        self.port.wait(timeout)
    }
}

/// Sequence numbers of one learner after the other.
#[derive(Debug, Default)]
struct Gaps {
    learner: Option<u64>,
    next: u64,
    missed: u64,
}

impl Gaps {
    fn arrive(&mut self, report: RewardReport) -> RewardArrival {
        let new_learner = self.learner != Some(report.learner);
        if new_learner {
            self.learner = Some(report.learner);
            self.next = 0;
        }
        let missed = report.sequence.saturating_sub(self.next);
        self.next = report.sequence.saturating_add(1);
        self.missed = self.missed.saturating_add(missed);
        RewardArrival {
            report,
            missed,
            new_learner,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrive(gaps: &mut Gaps, learner: u64, sequence: u64) -> (u64, bool) {
        let arrival = gaps.arrive(RewardReport {
            learner,
            sequence,
            ..RewardReport::default()
        });
        (arrival.missed, arrival.new_learner)
    }

    #[test]
    fn gaps_are_counted_per_learner() {
        let mut gaps = Gaps::default();
        assert_eq!(arrive(&mut gaps, 1, 0), (0, true));
        assert_eq!(arrive(&mut gaps, 1, 1), (0, false));
        assert_eq!(arrive(&mut gaps, 1, 4), (2, false)); // 2 and 3
        assert_eq!(arrive(&mut gaps, 2, 1), (1, true)); // 0 of the new learner
        assert_eq!(gaps.missed, 3);
    }

    #[test]
    fn a_report_outlives_a_checkpoint_without_its_sender() {
        let report = RewardReport {
            learner: 7,
            sequence: 3,
            iteration: 12,
            samples: 96,
            style_mean: 0.1 + 0.2, // 0.30000000000000004, to the last bit
            task_std: 0.25,
            episode_share: f64::NAN,
            ..RewardReport::default()
        };
        let text = serde_json::to_string(&report).unwrap();
        let back: RewardReport = serde_json::from_str(&text).unwrap();
        assert!(back.episode_share.is_nan(), "{text}");
        let comparable = RewardReport {
            episode_share: 0.0,
            ..back
        };
        let expected = RewardReport {
            learner: 0,
            sequence: 0,
            episode_share: 0.0,
            ..report
        };
        assert_eq!(comparable, expected);
    }

    #[test]
    fn a_report_of_a_program_that_measured_less_is_read() {
        let text = r#"{"iteration":2,"samples":8,"style_mean":0.5,"style_std":0.25,
            "style_min":0.0,"style_max":1.0,"task_mean":0.75}"#;
        let report: RewardReport = serde_json::from_str(text).unwrap();
        assert_eq!((report.iteration, report.task_mean), (2, 0.75));
        assert!(
            [
                report.style_std_robots,
                report.task_std,
                report.episode_share
            ]
            .iter()
            .all(|x| x.is_nan())
        );
    }
}
