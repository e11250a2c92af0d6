//! Before a group begins: what a killed supervisor, or a machine that crashed, has left.
//!
//! Its children were told to end when it died, but one may be in the middle of something, or stopped.
//! We hold the supervisor's role by now, so whoever else holds one in this run is an orphan.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use protocol::{Domain, DomainError};
use run::Folder;
use rustix::process::{Pid, Signal, kill_process};
use tokio::time::sleep;

use super::LOOK;
use super::roles::is_member;

/// Orphans get this long to save what they have, and then no more: a checkpoint is there anyway.
const GRACE: Duration = Duration::from_millis(1500);

/// Longest that the kernel may take to end a killed process.
const PATIENCE: Duration = Duration::from_secs(10);

/// Longest that one who only watches is waited for.
const LEAVING: Duration = Duration::from_millis(500);

/// Ends all orphans and removes what they left in memory.
pub(super) async fn clear(folder: &Folder, domain: &Domain) -> Result<()> {
    let began = Instant::now();
    let mut told = Vec::new();
    loop {
        let orphans = orphans(folder)?;
        if orphans.is_empty() {
            break;
        }
        let late = began.elapsed() >= GRACE;
        for (_, pid) in &orphans {
            if late {
                signal(pid, Signal::KILL);
            } else if !told.contains(pid) {
                signal(pid, Signal::TERM);
                told.push(pid.clone());
            }
        }
        if began.elapsed() >= PATIENCE {
            let named: Vec<String> = orphans
                .iter()
                .map(|(role, pid)| format!("{role} (process {pid})"))
                .collect();
            bail!(
                "an earlier group of this run is still alive: {}; end it first",
                named.join(", ")
            );
        }
        sleep(LOOK).await;
    }
    let alone = Instant::now();
    loop {
        match domain.remove() {
            Err(DomainError::InUse { .. }) if alone.elapsed() < LEAVING => sleep(LOOK).await,
            // Only one who watches is left, and nothing that is in use is stale.
            Err(DomainError::InUse { .. }) => return Ok(()),
            removed => {
                removed.context("clearing what an earlier group left")?;
                return Ok(());
            }
        }
    }
}

fn orphans(folder: &Folder) -> Result<Vec<(String, String)>> {
    let mut holders = folder.holders().context("looking for an earlier group")?;
    holders.retain(|(role, _)| is_member(role));
    Ok(holders)
}

fn signal(pid: &str, signal: Signal) {
    if let Some(pid) = pid.parse().ok().and_then(Pid::from_raw) {
        // It may have ended a moment ago.
        let _ = kill_process(pid, signal);
    }
}
