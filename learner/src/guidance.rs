//! The scheduler's word, and what holds while it is silent.
//!
//! In lock-step the rule of iteration n + 1 is the answer to report n, whoever is faster, so the
//! learner waits for it; a scheduler that is away is waited for once, and the last word stays.

use std::time::{Duration, Instant};

use ampco::{Numbers, RuleError, Weighting};
use anyhow::{Context, Result};
use protocol::{Answer, Directive, DirectiveSubscriber};
use tracing::{info, warn};

/// An answer takes milliseconds; after so long a report is sent again. It is answered alike, however
/// often it comes.
const ASK_AGAIN: Duration = Duration::from_millis(300);

/// How the next batch is paid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Guide {
    pub(crate) weighting: Weighting,
    /// The directive it comes from; `None` before the first.
    pub(crate) directive: Option<Directive>,
}

/// Follows the scheduler.
pub(crate) struct Guidance {
    directives: DirectiveSubscriber,
    learner: u64,
    /// How long an answer is waited for; zero where none is.
    patience: Duration,
    away: bool,
    /// The guide comes from the scheduler, in this life of the learner or an earlier one.
    told: bool,
    guide: Guide,
}

impl Guidance {
    /// Begins with the weighting that holds before any report.
    pub(crate) fn new(
        directives: DirectiveSubscriber,
        learner: u64,
        patience: Duration,
        weighting: Weighting,
    ) -> Self {
        Self {
            directives,
            learner,
            patience,
            away: false,
            told: false,
            guide: Guide {
                weighting,
                directive: None,
            },
        }
    }

    /// The guide for the iteration after `iteration`, of which a report was sent (or none, at 0).
    /// `report_again` sends it once more, to a scheduler that was killed and has not heard it.
    pub(crate) fn after(
        &mut self,
        iteration: u64,
        report_again: impl FnMut() -> Result<()>,
    ) -> Result<Guide> {
        if iteration == 0 {
            return Ok(self.guide);
        }
        match self.wait_for(iteration, report_again)? {
            Answer::Came(directive) => {
                if self.away {
                    info!(iteration, "the scheduler is back");
                }
                self.away = false;
                self.follow(directive)?;
            }
            Answer::Late | Answer::Shutdown => {
                if !self.away && !self.patience.is_zero() {
                    warn!(
                        iteration,
                        "the scheduler does not answer; its last directive stays in force"
                    );
                    self.away = true;
                }
                if let Some(newest) = self.directives.newest()?
                    && newest.answers(self.learner, 0)
                {
                    self.follow(newest)?;
                }
            }
        }
        Ok(self.guide)
    }

    fn wait_for(
        &mut self,
        iteration: u64,
        mut report_again: impl FnMut() -> Result<()>,
    ) -> Result<Answer> {
        // Once away, it is not waited for again until it has spoken.
        let patience = if self.away {
            Duration::ZERO
        } else {
            self.patience
        };
        let deadline = Instant::now() + patience;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            let slice = left.min(ASK_AGAIN);
            let answer = self.directives.wait_for(self.learner, iteration, slice)?;
            if answer != Answer::Late || left <= ASK_AGAIN {
                return Ok(answer);
            }
            report_again()?;
        }
    }

    /// Whether the scheduler failed to answer when it was last waited for.
    pub(crate) fn is_away(&self) -> bool {
        self.away
    }

    /// What the scheduler has said last, for a checkpoint.
    pub(crate) fn remember(&self) -> Option<Weighting> {
        self.told.then_some(self.guide.weighting)
    }

    /// Takes up what a checkpoint remembers, until the scheduler speaks.
    pub(crate) fn recall(&mut self, weighting: Weighting) {
        self.told = true;
        self.guide.weighting = weighting;
    }

    fn follow(&mut self, directive: Directive) -> Result<()> {
        let before = self.guide.directive.map_or(1, |directive| directive.phase);
        if directive.phase != before {
            let (lower, upper) = directive.bounds().unzip();
            info!(phase = directive.phase, switched_at = ?directive.switched_at(), ?lower, ?upper, "phase");
        }
        self.told = true;
        self.guide = Guide {
            weighting: weighting(&directive).context("a directive of the scheduler")?,
            directive: Some(directive),
        };
        Ok(())
    }
}

/// What a directive puts in force, checked.
fn weighting(directive: &Directive) -> Result<Weighting, RuleError> {
    Weighting::try_from(Numbers {
        rule: directive.rule,
        first: directive.first,
        second: directive.second,
        granularity: directive.granularity,
    })
}
