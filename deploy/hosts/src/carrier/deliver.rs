//! One actor's rollouts, one after the other, each until it is acknowledged.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use hosts::{CallError, Delivered};
use run::journal::{Entry, OUTCOMES};
use tokio::sync::mpsc::Receiver;
use tokio::time::sleep;
use tracing::info;

use super::intake::Parcel;
use super::{Carrier, PAUSE};

/// Longest that a rollout may be on its way, with the wait for a learner's room.
const DELIVERY: Duration = Duration::from_secs(120);

impl Carrier {
    /// Sends what comes out of the queue, until nothing more can come.
    pub(super) async fn deliver_all(
        self: Arc<Self>,
        actor: u32,
        mut queue: Receiver<Parcel>,
    ) -> Result<()> {
        while let Some(Parcel { header, rows }) = queue.recv().await {
            // The learner may count on the checkpoint as soon as it has the rollout after it.
            if self.robots.are_due(actor, header.policy_version) {
                self.send_robots(actor, header.policy_version).await?;
            }
            let key = (actor, header.incarnation, header.sequence);
            let delivery = hosts::sent_rollout(&self.stay.life, &header, rows);
            let began = Instant::now();
            loop {
                let answer = self.line.call("Deliver", delivery.clone(), DELIVERY).await;
                match answer {
                    Ok(Delivered { taken: true }) => {
                        self.write_down(|| Entry::Carried(key));
                        let seconds = began.elapsed().as_secs_f32();
                        self.counted.acknowledged(header.policy_version, seconds);
                        break;
                    }
                    Ok(Delivered { taken: false }) if self.ended.load(Ordering::Relaxed) => {
                        info!(actor, "the run ended before a rollout was taken");
                        let [_, unheard, ..] = OUTCOMES;
                        self.write_down(|| Entry::Sent(key, unheard.to_owned()));
                        break;
                    }
                    Ok(Delivered { taken: false }) => {}
                    Err(CallError::Away(_)) => sleep(PAUSE).await,
                    Err(CallError::Refused(why)) => bail!("the gate refuses a rollout: {why}"),
                }
                self.counted.again();
            }
        }
        Ok(())
    }
}
