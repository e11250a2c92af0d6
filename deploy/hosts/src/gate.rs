//! The gate: stands in for the actors of other machines.
//!
//! It holds one writing end of the rollouts' stream and one role for each of them, so that the learner sees the actors
//! themselves: their numbers, their lives, their gaps. It decides nothing and keeps nothing: killed and started again
//! it is as before, since hosts claim their actors anew with every connection.

mod answers;
mod robots;
mod seats;
mod weights;

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use hosts::{Doors, Limits, Passes};
use protocol::{Domain, Node, Shutdown, WeightsOrder};
use run::Folder;
use tokio::net::TcpListener;
use tokio::time::{MissedTickBehavior, interval};
use tracing::{info, warn};

use crate::local::Local;
use answers::Gate;
use weights::{Broadcast, Supervised};

/// Between two writings of what is known of the hosts.
const WRITING: Duration = Duration::from_secs(1);
/// Of so many writings one is kept, as a line of `hosts.jsonl`.
const KEPT: u64 = 10;
/// Once told to end: how long hosts have whose actors were told to save.
const LAST_ROBOTS: Duration = Duration::from_secs(20);

/// Lets other machines into the run in `run_dir`, at `listen`, until it is told to stop; actors there get the numbers
/// from `here` on.
///
/// # Errors
/// A run that cannot be opened, an address that cannot be had.
pub fn run(run_dir: &Path, listen: &str, here: u32) -> Result<()> {
    let supervised = Supervised::now(protocol::end_with_supervisor()?);
    let folder = Folder::open(run_dir)?;
    run::log::init(&folder.logs(), "gate")?;
    let mut held = folder.lock("gate")?;
    let config = folder.config()?;
    let local = Local::of(&config)?;
    let shutdown = Shutdown::on_signals()?;
    let node = Node::join(&Domain::for_run(folder.path())?, "gate", &shutdown)?;
    let passes = Passes::of(folder.path(), &folder.name())?;
    let limits = Limits::of(local.lean.most());
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .context("starting the loop that follows connections")?;
    let (broadcast, newest) = Broadcast::follow(&node, supervised)?;
    runtime.block_on(async {
        let listener = TcpListener::bind(listen)
            .await
            .with_context(|| format!("listening on {listen}"))?;
        let listens = listener.local_addr().context("asking for the own address")?;
        let gate = Gate::new(folder.clone(), &config, local, node, here, newest)?;
        let gate = Arc::new(gate);
        let doors = Doors::new(listener, passes.server()?, Arc::clone(&gate), limits);
        held.at_work();
        let carried = passes.carried.display();
        eprintln!(
            "ampco-gate: listens on {listens}; on another machine: ampco join HOST:{} --file {carried}",
            listens.port()
        );
        info!(%listens, "listening");
        let book = async {
            let mut ticks = interval(WRITING);
            ticks.set_missed_tick_behavior(MissedTickBehavior::Delay);
            let mut told: Option<Instant> = None;
            for turn in 0_u64.. {
                ticks.tick().await;
                gate.forget_silent();
                let known = gate.known(&listens.to_string(), doors.refused());
                write(&folder, &known, turn.is_multiple_of(KEPT));
                if !shutdown.requested() {
                    continue;
                }
                let told = *told.get_or_insert_with(Instant::now);
                let saving = gate.newest_order() == Some(WeightsOrder::SaveThenStop);
                if !saving || gate.is_empty() || told.elapsed() >= LAST_ROBOTS {
                    return;
                }
            }
        };
        // A request to stop is not to wait for the next tick.
        let stopped = async {
            let mut looks = interval(Duration::from_millis(50));
            loop {
                looks.tick().await;
                let saving = gate.newest_order() == Some(WeightsOrder::SaveThenStop);
                if shutdown.requested() && (!saving || gate.is_empty()) {
                    return;
                }
            }
        };
        doors
            .open(async {
                tokio::select! {
                    () = book => {}
                    () = stopped => {}
                }
            })
            .await;
        anyhow::Ok(())
    })?;
    broadcast.end();
    // Calls that are still waiting for the learner's buffer see the request to stop themselves.
    runtime.shutdown_timeout(Duration::from_secs(1));
    info!("done");
    Ok(())
}

/// Makes the passes of run `run` in `folder`, for a run that is still to begin: whoever has them in its own folder then
/// listens with them.
///
/// # Errors
/// Files that cannot be written.
pub fn passes(folder: &Path, run: &str) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let passes = Passes::of(folder, run)?;
    eprintln!("{}", passes.carried.display());
    Ok(())
}

fn write(folder: &Folder, known: &crate::known::Known, keep: bool) {
    let mut done = known.write(folder.path());
    if keep && done.is_ok() && !known.hosts.is_empty() {
        let kept = run::Metrics::open(&folder.path().join("hosts.jsonl"));
        done = kept
            .and_then(|mut lines| lines.append(known))
            .map_err(Into::into);
    }
    if let Err(error) = done {
        warn!(
            error = format!("{error:#}"),
            "what is known of hosts is not written"
        );
    }
}
