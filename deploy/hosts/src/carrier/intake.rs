//! Rollouts of the actors here: made lean, and queued one by one for each actor.
//!
//! Of an actor one is on its way, one is queued, and one may wait for its place in the queue. While it waits nothing is
//! received, so that the streams fill and hold the actors up: memory stays bounded however long the gate is away.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

use anyhow::{Context, Result, anyhow};
use hosts::Lean;
use protocol::{RolloutHeader, RolloutSubscriber, TICK};
use tokio::sync::mpsc::{Receiver, Sender, channel};
use tracing::warn;

/// A rollout that is to be sent.
pub(super) struct Parcel {
    pub(super) header: RolloutHeader,
    pub(super) rows: Vec<u8>,
}

/// By actor what is to be sent of it.
pub(super) type Queues = Vec<(u32, Receiver<Parcel>)>;

/// The thread that receives.
pub(super) struct Intake {
    finishing: Arc<AtomicBool>,
    thread: JoinHandle<Result<()>>,
}

impl Intake {
    /// Begins to receive, and gives the queue of each of these actors.
    pub(super) fn begin(
        rollouts: RolloutSubscriber,
        lean: Lean,
        numbers: &[u32],
    ) -> Result<(Self, Queues)> {
        let mut senders = BTreeMap::new();
        let mut queues = Vec::new();
        for number in numbers {
            let (sender, queue) = channel(1);
            senders.insert(*number, sender);
            queues.push((*number, queue));
        }
        let finishing = Arc::new(AtomicBool::new(false));
        let finish = Arc::clone(&finishing);
        let thread = std::thread::Builder::new()
            .name("intake".to_owned())
            .spawn(move || receive(&rollouts, &lean, &senders, &finish))
            .context("starting the thread that receives rollouts")?;
        Ok((Self { finishing, thread }, queues))
    }

    /// Whether it has ended by itself.
    pub(super) fn has_failed(&self) -> bool {
        self.thread.is_finished()
    }

    /// Receives what is there and no more.
    pub(super) fn finish(&self) {
        self.finishing.store(true, Ordering::Relaxed);
    }

    /// Waits for its end, unless it waits for a queue that nobody empties any more.
    pub(super) fn end(self) -> Result<()> {
        self.finish();
        for _ in 0..20 {
            if self.thread.is_finished() {
                let ended = self.thread.join();
                return ended.unwrap_or_else(|_| Err(anyhow!("the intake panicked")));
            }
            std::thread::sleep(TICK / 10);
        }
        Ok(())
    }
}

fn receive(
    rollouts: &RolloutSubscriber,
    lean: &Lean,
    senders: &BTreeMap<u32, Sender<Parcel>>,
    finish: &AtomicBool,
) -> Result<()> {
    loop {
        let finishing = finish.load(Ordering::Relaxed);
        let Some(rollout) = rollouts.receive()? else {
            if finishing {
                return Ok(());
            }
            rollouts.wait(TICK)?;
            continue;
        };
        let header = *rollout.header();
        if rollout.layout() != *lean.layout() {
            warn!(actor = header.actor, "a rollout of other sizes is not sent");
            continue;
        }
        let Some(sender) = senders.get(&header.actor) else {
            warn!(
                actor = header.actor,
                "a rollout of an actor that is not this host's is not sent"
            );
            continue;
        };
        let rows = lean.strip(rollout.numbers());
        // Gives the memory back to the actor.
        drop(rollout);
        if sender.blocking_send(Parcel { header, rows }).is_err() {
            return Ok(());
        }
    }
}
