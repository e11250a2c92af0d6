//! The learner's newest weights, for whoever waits for others than it has.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

use anyhow::{Context, Result};
use hosts::Newest;
use protocol::{Node, TICK, WeightsHeader, WeightsOrder, WeightsSubscriber};
use tokio::sync::watch;
use tracing::{error, info};

/// Weights, as they are sent.
#[derive(Debug)]
pub(super) struct Held {
    pub(super) header: WeightsHeader,
    pub(super) sent: Newest,
}

impl Held {
    /// What tells them from others: a version may come again with another order, or of another learner.
    pub(super) fn key(&self) -> [u64; 3] {
        let header = &self.header;
        [header.learner, header.version, u64::from(header.order)]
    }

    pub(super) fn order(&self) -> Option<WeightsOrder> {
        self.header.order()
    }
}

/// The newest weights; none before the learner's first.
pub(super) type Newer = watch::Receiver<Option<Arc<Held>>>;

/// Whether this process still has the supervisor that started it. When that is killed, the learner ends as it does at
/// the end of a run, but the run goes on once somebody starts it again: hosts are to wait, not to leave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Supervised(Option<u32>);

impl Supervised {
    /// As it is now, for a process that has a supervisor or not.
    pub(super) fn now(supervised: bool) -> Self {
        Self(supervised.then(std::os::unix::process::parent_id))
    }

    fn is_orphaned(self) -> bool {
        let parent = std::os::unix::process::parent_id;
        self.0.is_some_and(|supervisor| supervisor != parent())
    }
}

/// A thread that follows the learner's weights.
pub(super) struct Broadcast {
    ending: Arc<AtomicBool>,
    thread: JoinHandle<()>,
}

impl Broadcast {
    /// Follows them from here on.
    pub(super) fn follow(node: &Node, supervised: Supervised) -> Result<(Self, Newer)> {
        let weights = WeightsSubscriber::new(node).context("opening the weights stream")?;
        let (sender, newest) = watch::channel(None);
        let ending = Arc::new(AtomicBool::new(false));
        let end = Arc::clone(&ending);
        let thread = std::thread::Builder::new()
            .name("weights".to_owned())
            .spawn(move || {
                if let Err(error) = follow(&weights, &sender, &end, supervised) {
                    error!(
                        error = format!("{error:#}"),
                        "weights are no longer followed"
                    );
                    // Without weights this process is of no use; another one is started in its place.
                    std::process::abort();
                }
            })
            .context("starting the thread that follows weights")?;
        Ok((Self { ending, thread }, newest))
    }

    /// Ends it.
    pub(super) fn end(self) {
        self.ending.store(true, Ordering::Relaxed);
        // It panics only with this process.
        let _ = self.thread.join();
    }
}

fn follow(
    weights: &WeightsSubscriber,
    sender: &watch::Sender<Option<Arc<Held>>>,
    end: &AtomicBool,
    supervised: Supervised,
) -> Result<()> {
    while !end.load(Ordering::Relaxed) {
        if let Some(newest) = weights.newest()? {
            let header = *newest.header();
            if header.order() == Some(WeightsOrder::SaveThenStop) && supervised.is_orphaned() {
                info!("the supervisor was killed: hosts are not told that the run ends");
                return Ok(());
            }
            let sent = hosts::sent_weights(&header, hosts::sent_flat(newest.flat()));
            drop(newest);
            sender.send_replace(Some(Arc::new(Held { header, sent })));
        }
        weights.wait(TICK)?;
    }
    Ok(())
}
