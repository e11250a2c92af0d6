//! The actor's loop: newest weights, one rollout, send.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use protocol::{
    Domain, Node, RolloutHeader, RolloutPublisher, SendOutcome, Shutdown, TICK, TermMean, Weights,
    WeightsHeader, WeightsOrder, WeightsSubscriber,
};
use run::Folder;
use run::journal::{self, Entry, Journal};
use tracing::{info, warn};

use crate::config::ActorConfig;
use crate::worker::Worker;

/// Runs actor `index` of the run in `run_dir` until it is told to stop.
pub fn run(run_dir: &Path, index: u32) -> Result<()> {
    protocol::end_with_supervisor()?;
    let folder = Folder::open(run_dir)?;
    let role = format!("actor-{index}");
    run::log::init(&folder.logs(), &role)?;
    let mut held = folder.lock(&role)?;
    let config = ActorConfig::read(&folder)?;
    let shutdown = Shutdown::on_signals()?;
    let node = Node::join(&Domain::for_run(folder.path())?, &role, &shutdown)?;
    let weights = WeightsSubscriber::new(&node).context("opening the weights stream")?;
    let mut rollouts = RolloutPublisher::new(&node, index, config.layout, config.send_patience)
        .context("opening the rollout stream")?;
    let mut journal = Journal::open(&folder.logs(), &role, config.journal)?;
    info!(
        environments = config.layout.environments,
        steps = config.layout.steps,
        "ready"
    );

    let checkpoints = folder.checkpoints();
    let mut worker: Option<Worker> = None;
    let mut acting: Option<WeightsHeader> = None;
    let mut delivered = true;
    let mut faults = 0;
    loop {
        let idle = Instant::now();
        // In lock-step a version is answered once. Overlapped, the same weights may act again, but
        // not for a learner that is gone.
        let must_be_new = acting.is_none_or(|header| header.is_lockstep()) || !delivered;
        loop {
            if shutdown.requested() {
                return Ok(());
            }
            if let Some(newest) = weights.newest()? {
                let header = *newest.header();
                if let Some(difference) = header.unlike(&config.layout) {
                    bail!(
                        "the learner wants other rollouts than this run's configuration says: {difference}; \
                         restart the group so that all processes read the same config.toml"
                    );
                }
                if !obey(&newest, index, &config, &mut worker, &checkpoints)? {
                    info!(version = header.version, "told to stop");
                    return Ok(());
                }
                let worker = worker.as_mut().context("weights came without an order")?;
                worker.adopt(&config, &header, newest.flat())?;
                acting = Some(header);
                break;
            }
            if !must_be_new {
                break;
            }
            weights.wait(TICK)?;
        }
        let (Some(worker), Some(header)) = (worker.as_mut(), acting) else {
            continue;
        };
        let waited = idle.elapsed() + rollouts.waited();
        let mut loan = rollouts.loan()?;
        let started = Instant::now();
        let timing = worker.collect(&mut loan.view_mut());
        let key = rollouts.key();
        journal.write(|| Entry::Sending(key));
        let sent = rollouts.send(
            loan,
            RolloutHeader {
                learner: header.learner,
                policy_version: header.version,
                physics_seconds: timing.physics,
                observation_seconds: timing.observation,
                inference_seconds: timing.inference,
                waiting_seconds: waited.as_secs_f32(),
                collect_seconds: started.elapsed().as_secs_f32(),
                terms: TermMean::of(worker.take_terms()),
                ..RolloutHeader::default()
            },
        )?;
        journal.write(|| Entry::Sent(key, word(sent).to_owned()));
        delivered = sent == SendOutcome::Delivered;
        if delivered {
            held.at_work();
        }
        if worker.faults() > faults {
            faults = worker.faults();
            warn!(
                faults,
                "environments were reset after numbers that are not finite"
            );
        }
    }
}

/// The journal's word for what a send came to.
fn word(sent: SendOutcome) -> &'static str {
    let [delivered, unheard, full, interrupted] = journal::OUTCOMES;
    match sent {
        SendOutcome::Delivered => delivered,
        SendOutcome::Lost => unheard,
        SendOutcome::Dropped => full,
        SendOutcome::Interrupted => interrupted,
    }
}

/// Does what the order says before collecting. False: stop.
fn obey(
    weights: &Weights,
    index: u32,
    config: &ActorConfig,
    worker: &mut Option<Worker>,
    checkpoints: &run::Checkpoints,
) -> Result<bool> {
    let header = weights.header();
    let Some(order) = header.order() else {
        bail!(
            "the learner gave order {}, which this actor does not know; use programs of one build",
            header.order
        );
    };
    let version = header.version;
    match worker {
        // A snapshot that a life before this one wrote for the same order is kept, not replaced.
        None if order == WeightsOrder::SaveThenStop => {
            Worker::begin(config, index, header, weights.flat().len(), checkpoints)?;
            return Ok(false);
        }
        None => {
            *worker = Some(Worker::begin(
                config,
                index,
                header,
                weights.flat().len(),
                checkpoints,
            )?)
        }
        Some(worker) => match order {
            WeightsOrder::Collect => {}
            WeightsOrder::SaveThenCollect => worker.save(index, version, checkpoints),
            WeightsOrder::RestoreThenCollect => {
                let otherwise = "its episodes go on as they are";
                worker.restore_or_save(index, version, checkpoints, otherwise);
            }
            WeightsOrder::SaveThenStop => {
                worker.save(index, version, checkpoints);
                return Ok(false);
            }
        },
    }
    Ok(true)
}
