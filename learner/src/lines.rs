//! The learner's lines to the outside: streams, metrics, checkpoints.

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use ampco::Schedule;
use anyhow::{Context, Result};
use protocol::{
    DirectiveSubscriber, Domain, Node, RewardPublisher, RolloutSubscriber, Shutdown, WeightsHeader,
    WeightsOrder, WeightsPublisher,
};
use run::journal::{self, Journal};
use run::{Events, Folder, Metrics};
use serde::Serialize;
use tracing::{info, warn};

use crate::config::LearnerConfig;
use crate::guidance::{Guidance, Guide};
use crate::intake::Intake;
use crate::state::State;

pub(crate) struct Lines {
    pub(crate) intake: Intake,
    guidance: Guidance,
    metrics: Metrics,
    /// The last line of the metrics could not be written.
    unwritten: bool,
    /// None once it could not be written.
    events: Option<Events>,
    rewards: RewardPublisher,
    weights: WeightsPublisher,
}

impl Lines {
    /// Opens all of them for a learner in `state`.
    pub(crate) fn open(folder: &Folder, config: &LearnerConfig, state: &mut State) -> Result<Self> {
        // Waiting must not end early when a stop is asked for: an iteration that has begun is
        // finished first. The loop looks at the real request.
        let node = Node::join(
            &Domain::for_run(folder.path())?,
            "learner",
            &Shutdown::manual(),
        )?;
        let schedule = Schedule::new(config.schedule.clone()).context("section [scheduler]")?;
        let terms = config.terms();
        let rollouts = RolloutSubscriber::new(&node, terms.layout.lists)
            .context("opening the rollout stream")?;
        let directives = DirectiveSubscriber::new(&node).context("opening the directive stream")?;
        let patience = if terms.lockstep {
            Duration::from_secs_f64(config.run.deadlines.directive_seconds)
        } else {
            Duration::ZERO
        };
        let mut guidance = Guidance::new(
            directives,
            node.incarnation(),
            patience,
            schedule.weighting(),
        );
        if let Some(remembered) = state.remembered {
            guidance.recall(remembered);
        }
        let mut journal = Journal::open(&folder.logs(), "learner", config.run.journal)?;
        journal.write(|| journal::Entry::Begun(node.incarnation(), state.iteration));
        let mut lines = Self {
            intake: Intake::new(
                rollouts,
                node.incarnation(),
                config.fleet.actors,
                terms,
                folder.clone(),
                journal,
            ),
            guidance,
            metrics: Metrics::open(&folder.metrics_path())?,
            unwritten: false,
            events: Events::create(folder.path(), state.iteration, now())
                .map_err(without_events)
                .ok(),
            rewards: RewardPublisher::new(&node).context("opening the reward stream")?,
            weights: WeightsPublisher::new(&node, state.learning.policy_flat().len())
                .context("opening the weights stream")?,
        };
        if let Some(report) = state.last_report {
            // The scheduler answers it from the log; what it knew of later iterations is void.
            lines.rewards.send(report)?;
        }
        Ok(lines)
    }

    /// A line of the metrics, and the same figures for TensorBoard. A disk that refuses stops the
    /// writing, not the training.
    pub(crate) fn log(&mut self, record: &impl Serialize) {
        match self.metrics.append(record) {
            Ok(()) if self.unwritten => {
                let lost = self.metrics.lost();
                info!(
                    lost,
                    "metrics are written again, with the lines that waited"
                );
                self.unwritten = false;
            }
            Ok(()) => {}
            Err(problem) => {
                if !self.unwritten {
                    let problem = format!("{:#}", anyhow::Error::from(problem));
                    warn!(
                        problem,
                        "metrics not written; training goes on, their lines wait"
                    );
                }
                self.unwritten = true;
            }
        }
        if let Some(events) = &mut self.events {
            let written = serde_json::to_value(record)
                .map_err(std::io::Error::from)
                .and_then(|figures| events.append(&figures, now()));
            if written.map_err(without_events).is_err() {
                self.events = None;
            }
        }
    }

    /// Makes the metrics outlive a power cut.
    pub(crate) fn sync(&self) {
        if let Err(problem) = self.metrics.sync() {
            let problem = format!("{:#}", anyhow::Error::from(problem));
            warn!(problem, "metrics are not on the disk yet");
        }
    }

    /// Tells the scheduler how iteration `state.iteration` was paid.
    pub(crate) fn report(&mut self, state: &State) -> Result<()> {
        if let Some(report) = state.last_report {
            self.rewards.send(report)?;
        }
        Ok(())
    }

    /// How the next batch is paid, once the scheduler has answered.
    pub(crate) fn guide(&mut self, state: &mut State) -> Result<Guide> {
        let (rewards, report) = (&mut self.rewards, state.last_report);
        let report_again = || match report {
            Some(report) => Ok(rewards.send(report)?),
            None => Ok(()),
        };
        let guide = self.guidance.after(state.reported(), report_again)?;
        state.remembered = self.guidance.remember();
        if let Some(directive) = &guide.directive {
            state.held = directive.held;
        }
        Ok(guide)
    }

    /// Whether the scheduler failed to answer when it was last waited for.
    pub(crate) fn is_scheduler_away(&self) -> bool {
        self.guidance.is_away()
    }

    /// Gives the actors the newest policy, and something to do with it.
    pub(crate) fn broadcast(
        &mut self,
        state: &mut State,
        config: &LearnerConfig,
        order: WeightsOrder,
    ) -> Result<()> {
        let terms = config.terms();
        let header = WeightsHeader::new(
            state.iteration,
            order,
            &config.learning.policy.hidden,
            config.learning.policy.observation_clip,
            terms.layout,
            terms.lockstep,
        )
        .after(state.ramped());
        self.weights
            .broadcast(header, state.learning.policy_flat())
            .with_context(|| format!("broadcasting policy version {}", state.iteration))
    }
}

/// A view of the figures is not worth a run.
fn without_events(problem: std::io::Error) {
    warn!(%problem, "no more TensorBoard events; the metrics go on");
}

/// Seconds since 1970, as TensorBoard's time axis has it.
fn now() -> f64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    since.map_or(0.0, |since| since.as_secs_f64())
}
