//! Actors' robots: to the learner's checkpoint after they were saved, from it before they are restored.

use std::collections::BTreeSet;
use std::fs;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use anyhow::{Result, bail};
use hosts::{Attached, CallError, PIECE, Piece, RobotsWanted};
use run::checkpoint::robots_of;
use tokio::time::sleep;
use tracing::{info, warn};

use super::{Carrier, PAUSE};

/// Longest that a piece may be on its way.
const PATIENCE: Duration = Duration::from_secs(60);
/// Checkpoints whose robots are kept here.
const KEPT: usize = 3;

/// Which robots are still to be sent: (actor, iteration of the checkpoint).
#[derive(Debug, Default)]
pub(super) struct Robots(Mutex<BTreeSet<(u32, u64)>>);

impl Robots {
    pub(super) fn are_due(&self, actor: u32, version: u64) -> bool {
        self.lock().contains(&(actor, version))
    }

    fn lock(&self) -> MutexGuard<'_, BTreeSet<(u32, u64)>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Carrier {
    /// Makes a place for the robots that the actors are about to save, which are then to be sent.
    pub(super) fn expect_robots(&self, version: u64) {
        let place = self.checkpoints.path(version);
        if let Err(error) = fs::create_dir_all(&place) {
            warn!(version, %error, "no place for robots");
        }
        // Older ones are in the learner's checkpoints.
        if let Err(error) = self.checkpoints.prune(KEPT) {
            warn!(%error, "old robots stay");
        }
        let mut due = self.robots.lock();
        due.extend(self.stay.numbers.iter().map(|actor| (*actor, version)));
    }

    /// Sends the robots that an actor has saved; nothing where it has not, as when its disk is full.
    pub(super) async fn send_robots(&self, actor: u32, version: u64) -> Result<()> {
        let saved = self.checkpoints.attachment(version, &robots_of(actor));
        let bytes = match saved {
            Ok(Some(bytes)) => bytes,
            Ok(None) => {
                info!(actor, version, "no robots were saved");
                self.robots.lock().remove(&(actor, version));
                return Ok(());
            }
            Err(error) => {
                warn!(actor, version, %error, "robots are not sent");
                self.robots.lock().remove(&(actor, version));
                return Ok(());
            }
        };
        let mut from = 0;
        while from < bytes.len() {
            let piece = &bytes[from..(from + PIECE).min(bytes.len())];
            let robots = hosts::Robots {
                life: self.stay.life.clone(),
                actor,
                version,
                offset: from as u64,
                whole: bytes.len() as u64,
                bytes: piece.to_vec().into(),
            };
            match self.line.call("Attach", robots, PATIENCE).await {
                // A gate that was started again has nothing of them: they begin anew.
                Ok(Attached { so_far }) => from = (so_far as usize).min(bytes.len()),
                Err(CallError::Away(_)) => sleep(PAUSE).await,
                Err(CallError::Refused(why)) => bail!("the gate refuses robots: {why}"),
            }
        }
        self.robots.lock().remove(&(actor, version));
        Ok(())
    }

    /// Brings the robots that the checkpoint has of the actors here. Where it has none, what is here stays.
    pub(super) async fn bring_robots(&self, version: u64) -> Result<()> {
        for actor in &self.stay.numbers {
            let mut bytes = Vec::new();
            loop {
                let wanted = RobotsWanted {
                    life: self.stay.life.clone(),
                    actor: *actor,
                    version,
                    offset: bytes.len() as u64,
                };
                match self.line.call("Fetch", wanted, PATIENCE).await {
                    Ok(Piece { bytes: piece }) => {
                        bytes.extend_from_slice(&piece);
                        if piece.len() < PIECE {
                            break;
                        }
                    }
                    Err(CallError::Away(_)) => sleep(PAUSE).await,
                    Err(CallError::Refused(why)) => bail!("the gate refuses robots: {why}"),
                }
            }
            if bytes.is_empty() {
                continue;
            }
            match self.checkpoints.attach(version, &robots_of(*actor), &bytes) {
                Ok(()) => {
                    self.robots.lock().remove(&(*actor, version));
                    info!(actor, version, bytes = bytes.len(), "robots brought");
                }
                Err(error) => warn!(actor, version, %error, "robots cannot be written here"),
            }
        }
        Ok(())
    }
}
