//! What the dashboard knows: the run's figures so far, and what its streams say now.
//!
//! Separate from the drawing because this is where the run is touched, and only in ways that nobody notices: streams
//! whose full buffer loses its oldest message, a file that is read, locks that are looked at.

use anyhow::{Context, Result};
use protocol::{
    Directive, DirectiveSubscriber, Domain, Node, RewardReport, RewardSubscriber, Shutdown,
    WeightsOrder, WeightsSubscriber,
};
use run::Folder;
use run::metrics::Tail;
use serde_json::Value;
use tracing::warn;

const LEARNER: &str = "learner";

/// A figure over the iterations: (iteration, value).
pub(super) type Curve = Vec<(f64, f64)>;

/// Everything that is shown.
#[derive(Debug, Default)]
pub(super) struct Board {
    pub(super) run: String,
    /// Iteration at which the run is complete; 0 = none.
    pub(super) iterations: u64,
    pub(super) style: Curve,
    pub(super) task: Curve,
    pub(super) style_weight: Curve,
    pub(super) episode_length: Curve,
    pub(super) rate: Curve,
    /// The newest line of the metrics.
    pub(super) newest: Value,
    /// The newest report of the learner, often ahead of the metrics' reader.
    pub(super) report: Option<RewardReport>,
    /// Reports that were lost on the way here.
    pub(super) missed: u64,
    pub(super) directive: Option<Directive>,
    pub(super) weights_version: Option<u64>,
    /// Roles with the process id of each.
    pub(super) processes: Vec<(String, String)>,
    pub(super) attached: bool,
}

/// Fills the board.
pub(super) struct Watcher {
    folder: Folder,
    tail: Tail,
    shutdown: Shutdown,
    streams: Option<Streams>,
    /// Set once the streams could not be opened: said once, not every quarter of a second.
    refused: bool,
}

/// The ends of a run's streams that a monitor may hold.
struct Streams {
    rewards: RewardSubscriber,
    directives: DirectiveSubscriber,
    weights: WeightsSubscriber,
}

impl Watcher {
    pub(super) fn new(folder: Folder, shutdown: Shutdown) -> Self {
        Self {
            tail: Tail::from_start(&folder.metrics_path()),
            folder,
            shutdown,
            streams: None,
            refused: false,
        }
    }

    /// Looks once. Attaches while a learner lives, and leaves as soon as it ends: the run's memory is removed then.
    pub(super) fn look(&mut self, board: &mut Board) -> Result<()> {
        for record in self.tail.poll()? {
            board.take(record);
        }
        board.processes = self.folder.holders()?;
        let alive = board.processes.iter().any(|(role, _)| role == LEARNER);
        if !alive {
            self.streams = None;
            self.refused = false;
        } else if self.streams.is_none() && !self.refused {
            match self.attach() {
                Ok(streams) => self.streams = Some(streams),
                Err(problem) => {
                    warn!(problem = format!("{problem:#}"), "watching the files only");
                    self.refused = true;
                }
            }
        }
        if let Some(streams) = &mut self.streams
            && streams.listen(board)?
        {
            self.streams = None;
        }
        board.attached = self.streams.is_some();
        Ok(())
    }

    fn attach(&self) -> Result<Streams> {
        let domain = Domain::for_run(self.folder.path())?;
        let node = Node::join(&domain, "monitor", &self.shutdown).context("joining the run")?;
        Ok(Streams {
            rewards: RewardSubscriber::new(&node)?,
            directives: DirectiveSubscriber::new(&node)?,
            weights: WeightsSubscriber::new(&node)?,
        })
    }
}

impl Streams {
    /// Takes all that has come; whether the learner has said its last word.
    fn listen(&mut self, board: &mut Board) -> Result<bool> {
        while let Some(arrival) = self.rewards.receive()? {
            // What was sent before this process listened is in the metrics.
            if !arrival.new_learner {
                board.missed += arrival.missed;
            }
            board.report = Some(arrival.report);
        }
        board.directive = self.directives.newest()?.or(board.directive);
        let mut last = false;
        if let Some(weights) = self.weights.newest()? {
            board.weights_version = Some(weights.header().version);
            last = weights.header().order() == Some(WeightsOrder::SaveThenStop);
        }
        Ok(last)
    }
}

impl Board {
    /// Takes a line of the metrics.
    pub(super) fn take(&mut self, record: Value) {
        let Some(iteration) = record["iteration"].as_f64() else {
            return;
        };
        let figures = [
            (&mut self.style, &record["style_mean"]),
            (&mut self.task, &record["task_mean"]),
            (&mut self.style_weight, &record["style_weight"]),
            (&mut self.episode_length, &record["episode_length"]),
            (&mut self.rate, &record["timing"]["samples_per_second"]),
        ];
        for (curve, value) in figures {
            // A resumed run writes some iterations again.
            while curve.last().is_some_and(|&(at, _)| at >= iteration) {
                curve.pop();
            }
            if let Some(value) = value.as_f64() {
                curve.push((iteration, value));
            }
        }
        self.newest = record;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn iterations_that_are_written_again_replace_those_before() {
        let mut board = Board::default();
        for (iteration, style) in [(1, 0.1), (2, 0.2), (3, 0.3), (2, 0.25)] {
            board.take(json!({ "iteration": iteration, "style_mean": style }));
        }
        assert_eq!(board.style, [(1.0, 0.1), (2.0, 0.25)]);
        assert_eq!(board.newest["iteration"], 2);
        assert!(board.rate.is_empty());
    }

    #[test]
    fn a_run_that_does_not_live_is_watched_from_its_files() {
        let runs = tempfile::tempdir().unwrap();
        let folder = Folder::create(runs.path(), "walk").unwrap();
        run::Metrics::open(&folder.metrics_path())
            .unwrap()
            .append(&json!({ "iteration": 7, "style_mean": 0.5 }))
            .unwrap();
        let domain = Domain::for_run(folder.path()).unwrap();
        let mut watcher = Watcher::new(folder, Shutdown::manual());
        let mut board = Board::default();
        watcher.look(&mut board).unwrap();
        assert_eq!(board.style, [(7.0, 0.5)]);
        assert!(!board.attached);
        assert!(
            domain.leftovers().unwrap().is_empty(),
            "nothing was made to look"
        );
    }
}
