//! Directives: the scheduler's newest decision, as plain numbers.
//!
//! Separate because a Rust enum must not cross shared memory: another process could write a number
//! that names no variant. What the numbers mean is the business of the two shells that speak here.

use std::time::{Duration, Instant};

use iceoryx2::prelude::ZeroCopySend;

use crate::error::PortError;
use crate::port::{Publisher, Subscriber, Wake};
use crate::presence::Node;
use crate::stream::{self, Spec, Stream};

/// How long an answer is still waited for once this process was asked to stop.
const LAST_WORD: Duration = Duration::from_secs(1);

/// A decision on its way to the learner. NaN stands for a number that does not exist yet.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, ZeroCopySend)]
#[type_name("ampco.Directive")]
pub struct Directive {
    /// Incarnation of the scheduler; filled by [`DirectivePublisher::send`].
    pub scheduler: u64,
    /// Directives of this scheduler before this one; filled by [`DirectivePublisher::send`].
    pub sequence: u64,
    /// Incarnation of the learner whose report it answers.
    pub learner: u64,
    /// Iteration of the last report that it answers.
    pub iteration: u64,
    /// Iteration whose report brought phase II; `u64::MAX` in phase I.
    pub switched_at: u64,
    /// Iterations in which the run's ramps stood still so far.
    pub held: u64,
    /// 1 or 2.
    pub phase: u32,
    /// Which rule: 0 fixed weights, 1 guided, 2 AdaMimic, 3 bounded.
    pub rule: u32,
    /// First parameter of the rule: style weight, ceiling, or lower bound.
    pub first: f32,
    /// Second parameter of the rule: upper bound.
    pub second: f32,
    /// Whose rewards the rule is evaluated on: 0 each transition's, 1 the batch's means.
    pub granularity: u32,
    /// 1 when the switch is doubtful: the style reward was falling.
    pub warned: u32,
    /// μ lower of Eq. 13.
    pub lower: f64,
    /// μ upper of Eq. 13.
    pub upper: f64,
    /// β.
    pub breakout_rate: f64,
    /// 1 − p, below which β means convergence.
    pub threshold: f64,
    /// Slope of the reward window, in reward per iteration.
    pub trend: f64,
    /// From the report to this decision, s: what scheduling costs.
    pub decision_seconds: f64,
}

impl Directive {
    /// Lower and upper bound of phase II.
    pub fn bounds(&self) -> Option<(f64, f64)> {
        Some((number(self.lower)?, number(self.upper)?))
    }

    /// β, once it exists.
    pub fn breakout_rate(&self) -> Option<f64> {
        number(self.breakout_rate)
    }

    /// Slope of the reward window, once it exists.
    pub fn trend(&self) -> Option<f64> {
        number(self.trend)
    }

    /// From the report to this decision in seconds, if the scheduler has told.
    pub fn decision_seconds(&self) -> Option<f64> {
        number(self.decision_seconds)
    }

    /// Iteration whose report brought phase II.
    pub fn switched_at(&self) -> Option<u64> {
        (self.switched_at != u64::MAX).then_some(self.switched_at)
    }

    /// Whether it answers iteration `iteration` of the learner with incarnation `learner`, or a
    /// later one.
    pub fn answers(&self, learner: u64, iteration: u64) -> bool {
        self.learner == learner && self.iteration >= iteration
    }
}

fn number(value: f64) -> Option<f64> {
    (!value.is_nan()).then_some(value)
}

/// The stream of directives.
#[derive(Debug)]
pub(crate) enum Directives {}

impl Stream for Directives {
    type Item = Directive;
    type Header = ();
    const SPEC: Spec = stream::DIRECTIVES;
}

/// The scheduler's end. There is one per run.
#[derive(Debug)]
pub struct DirectivePublisher {
    port: Publisher<Directives>,
    scheduler: u64,
    sequence: u64,
}

impl DirectivePublisher {
    /// Opens the stream; fails with [`PortError::Taken`] while another scheduler lives.
    pub fn new(node: &Node) -> Result<Self, PortError> {
        Ok(Self {
            port: Publisher::open(node, 1, Duration::ZERO)?,
            scheduler: node.incarnation(),
            sequence: 0,
        })
    }

    /// Sends a directive. Never waits; a learner that comes later gets the newest.
    pub fn send(&mut self, directive: Directive) -> Result<(), PortError> {
        let mut loan = self.port.loan(1)?;
        loan.payload_mut()[0] = Directive {
            scheduler: self.scheduler,
            sequence: self.sequence,
            ..directive
        };
        self.sequence += 1;
        self.port.send(loan)?;
        Ok(())
    }
}

/// Outcome of waiting for a directive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// The scheduler answered.
    Came(Directive),
    /// It did not answer in time; the newest directive remains in force.
    Late,
    /// This process was asked to stop, and so perhaps was the scheduler: no answer came within
    /// a second.
    Shutdown,
}

/// The learner's end, or a monitor's.
#[derive(Debug)]
pub struct DirectiveSubscriber {
    port: Subscriber<Directives>,
    newest: Option<Directive>,
}

impl DirectiveSubscriber {
    /// Opens the stream.
    pub fn new(node: &Node) -> Result<Self, PortError> {
        let port = Subscriber::open(node)?;
        Ok(Self { port, newest: None })
    }

    /// The newest directive ever received.
    pub fn newest(&mut self) -> Result<Option<Directive>, PortError> {
        if let Some(sample) = self.port.newest()? {
            self.newest = Some(sample.payload()[0]);
        }
        Ok(self.newest)
    }

    /// Sleeps until the scheduler has answered iteration `iteration` of the learner with
    /// incarnation `learner`, for at most `timeout`; ticks.
    pub fn wait_for(
        &mut self,
        learner: u64,
        iteration: u64,
        timeout: Duration,
    ) -> Result<Answer, PortError> {
        let mut deadline = Instant::now() + timeout;
        let mut stopping = false;
        loop {
            if let Some(directive) = self.newest()?
                && directive.answers(learner, iteration)
            {
                return Ok(Answer::Came(directive));
            }
            if self.port.is_stopping() && !stopping {
                // An answer takes milliseconds, and an iteration ended with it resumes exactly.
                deadline = deadline.min(Instant::now() + LAST_WORD);
                stopping = true;
            }
            let rest = deadline.saturating_duration_since(Instant::now());
            if rest.is_zero() {
                return Ok(if stopping {
                    Answer::Shutdown
                } else {
                    Answer::Late
                });
            }
            self.port.wait(rest)?;
        }
    }

    /// Sleeps until a directive was sent, `timeout` is over, or this process should stop; ticks.
    pub fn wait(&self, timeout: Duration) -> Result<Wake, PortError> {
        self.port.wait(timeout)
    }
}

#[cfg(test)]
mod tests;
