//! The gate's answers to hosts.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::net::SocketAddr;
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use hosts::{
    Answer, Attached, Delivered, Delivery, Desk, Join, Joined, Leave, MotionFile, Newest, PIECE,
    Piece, PieceWanted, Robots, RobotsWanted, Said, Wanted,
};
use motion::{Dataset, MotionConfig};
use protocol::{Node, RolloutHeader, SendOutcome, WeightsOrder};
use run::journal::{Entry, Journal};
use run::motion::Print;
use run::{Config, Folder};
use tracing::warn;

use super::robots::Moving;
use super::seats::{House, Seat, Seats};
use super::weights::Newer;
use crate::known::Known;
use crate::local::Local;

/// Longest that a host waits for weights before it hears that there are none: it asks again then.
const POLL: Duration = Duration::from_secs(5);
/// Longest that a rollout waits here for a learner, which may be starting again.
const WAITING: Duration = Duration::from_secs(10);
/// Between two looks for one.
const LOOK: Duration = Duration::from_millis(50);

/// What answers.
pub(super) struct Gate {
    folder: Folder,
    config: String,
    local: Local,
    node: Node,
    first: u32,
    motion: Vec<MotionFile>,
    newest: Newer,
    journal: Mutex<Journal>,
    seats: Mutex<Seats>,
    moving: Mutex<Moving>,
}

impl Gate {
    pub(super) fn new(
        folder: Folder,
        config: &Config,
        local: Local,
        node: Node,
        first: u32,
        newest: Newer,
    ) -> Result<Self> {
        let section: MotionConfig = config.section()?;
        let files = Dataset::files(&section, folder.path()).context("looking for the motion")?;
        let mut motion = Vec::new();
        for Print { file, sha256 } in Print::of_all(&files)? {
            let length = file.metadata().context("looking at a motion file")?.len();
            motion.push(MotionFile {
                path: file.display().to_string(),
                sha256,
                length,
            });
        }
        Ok(Self {
            journal: Mutex::new(local.journal(&folder, "gate")?),
            config: config.to_toml(),
            folder,
            local,
            node,
            first,
            motion,
            newest,
            seats: Mutex::default(),
            moving: Mutex::default(),
        })
    }

    pub(super) fn forget_silent(&self) {
        lock(&self.seats).forget_silent();
    }

    pub(super) fn is_empty(&self) -> bool {
        lock(&self.seats).is_empty()
    }

    /// What the learner has said last.
    pub(super) fn newest_order(&self) -> Option<WeightsOrder> {
        self.newest.borrow().as_ref()?.order()
    }

    pub(super) fn known(&self, listens: &str, refused: u64) -> Known {
        Known {
            listens: listens.to_owned(),
            refused,
            hosts: lock(&self.seats).known(),
        }
    }

    /// Passes a rollout on, whose bytes are `rows`; false where no learner took it in time.
    fn pass_on(&self, seat: &Seat, header: RolloutHeader, rows: &[u8]) -> Answer<bool> {
        let refused = |words: String| Said::Refused(format!("actor {}: {words}", header.actor));
        let since = Instant::now();
        // One at a time: a rollout that comes again waits until it is known what became of the first.
        let mut publisher = lock(&seat.publisher);
        loop {
            let loan = publisher.loan();
            let mut loan = loan.map_err(|error| Said::Later(error.to_string()))?;
            let restored = self.local.lean.restore(rows, loan.numbers_mut());
            restored.map_err(|error| refused(error.to_string()))?;
            let sent = publisher.forward(loan, header);
            match sent.map_err(|error| refused(error.to_string()))? {
                SendOutcome::Delivered => {
                    let key = (header.actor, header.incarnation, header.sequence);
                    lock(&self.journal).write(|| Entry::Passed(key));
                    return Ok(true);
                }
                // Nobody listens: the learner is not there yet, or no longer, and comes again unless the run has ended.
                SendOutcome::Lost
                    if since.elapsed() < WAITING
                        && !self.node.shutdown().requested()
                        && self.newest_order() != Some(WeightsOrder::SaveThenStop) =>
                {
                    std::thread::sleep(LOOK);
                }
                SendOutcome::Lost | SendOutcome::Dropped | SendOutcome::Interrupted => {
                    return Ok(false);
                }
            }
        }
    }

    fn take_in(&self, from: SocketAddr, join: &Join) -> Answer<Joined> {
        let house = House {
            folder: &self.folder,
            node: &self.node,
            layout: self.local.layout(),
            patience: self.local.patience,
            first: self.first,
            journal: &self.journal,
        };
        let numbers = lock(&self.seats).join(&from.to_string(), join, &house)?;
        let mut notices = Vec::new();
        let ours = hosts::features();
        if ours != join.features {
            let only = |one: &[String], other: &[String]| -> String {
                let rest = one.iter().filter(|name| !other.contains(name));
                let rest: Vec<&str> = rest.map(String::as_str).collect();
                if rest.is_empty() {
                    "none".to_owned()
                } else {
                    rest.join(" ")
                }
            };
            let notice = format!(
                "{} and the learner's machine have other processors (only there: {}; only here: {}): the run learns, but it is \
                 not bit for bit the same as on one machine",
                join.host,
                only(&join.features, &ours),
                only(&ours, &join.features)
            );
            warn!("{notice}");
            notices.push(notice);
        }
        let surplus = numbers
            .iter()
            .filter(|number| **number as usize >= self.local.actors);
        let surplus = surplus.count();
        if surplus > 0 {
            notices.push(format!(
                "{surplus} of these actors are more than the run was launched with, {} in all",
                self.local.actors
            ));
        }
        Ok(Joined {
            run: self.folder.name(),
            config: self.config.clone(),
            motion: self.motion.clone(),
            numbers,
            notices,
        })
    }
}

impl Desk for Gate {
    async fn join(self: Arc<Self>, from: SocketAddr, join: Join) -> Answer<Joined> {
        let gate = self;
        aside(move || gate.take_in(from, &join)).await
    }

    async fn motion(self: Arc<Self>, wanted: PieceWanted) -> Answer<Piece> {
        let known = self.motion.iter().find(|file| file.sha256 == wanted.sha256);
        let file = known.ok_or_else(|| Said::Refused("no such motion file".to_owned()))?;
        let path = file.path.clone();
        aside(move || {
            let read = piece(Path::new(&path), wanted.offset);
            read.map_err(|error| Said::Refused(format!("{path}: {error}")))
        })
        .await
    }

    async fn newest(self: Arc<Self>, wanted: Wanted) -> Answer<Newest> {
        let hear = |out: usize| -> Answer<()> {
            let mut seats = lock(&self.seats);
            let guest = seats.hear(&wanted.life)?;
            guest.figures = wanted.figures.unwrap_or_default();
            guest.bytes_out += out as u64;
            Ok(())
        };
        hear(0)?;
        let mut newest = self.newest.clone();
        let other = newest.wait_for(|held| {
            let key = held.as_ref().map(|held| held.key());
            key.is_some_and(|key| key.as_slice() != wanted.has.as_slice())
        });
        let found = match tokio::time::timeout(POLL, other).await {
            Ok(Ok(held)) => held.clone(),
            Ok(Err(_)) => return Err(Said::Later("the gate is ending".to_owned())),
            Err(_) => None,
        };
        let sent = found.map(|held| held.sent.clone()).unwrap_or_default();
        hear(sent.flat.len())?;
        Ok(sent)
    }

    async fn deliver(self: Arc<Self>, delivery: Delivery) -> Answer<Delivered> {
        let seat = lock(&self.seats).seat(&delivery.life, delivery.actor)?;
        let header = hosts::rollout_of(&delivery).map_err(|e| Said::Refused(e.to_string()))?;
        let layout = self.local.layout();
        let ours = (layout.environments, layout.steps);
        let theirs = (header.environments as usize, header.steps as usize);
        if theirs != ours {
            let said =
                |(environments, steps)| format!("{environments} environments by {steps} steps");
            return Err(Said::Refused(format!(
                "actor {} sends {}, this run's configuration says {}",
                header.actor,
                said(theirs),
                said(ours)
            )));
        }
        let rows = header.layout(layout.lists, layout.len());
        rows.map_err(|error| Said::Refused(error.to_string()))?;
        let gate = Arc::clone(&self);
        let (life, bytes) = (delivery.life, delivery.rows.len());
        let rows = delivery.rows;
        let taken = aside(move || gate.pass_on(&seat, header, &rows)).await?;
        if let Ok(guest) = lock(&self.seats).hear(&life) {
            guest.bytes_in += bytes as u64;
            guest.rollouts += u64::from(taken);
        }
        Ok(Delivered { taken })
    }

    async fn attach(self: Arc<Self>, robots: Robots) -> Answer<Attached> {
        lock(&self.seats).seat(&robots.life, robots.actor)?;
        lock(&self.seats).hear(&robots.life)?.bytes_in += robots.bytes.len() as u64;
        let gate = Arc::clone(&self);
        aside(move || lock(&gate.moving).attach(&robots, &gate.folder.checkpoints())).await
    }

    async fn fetch(self: Arc<Self>, wanted: RobotsWanted) -> Answer<Piece> {
        lock(&self.seats).seat(&wanted.life, wanted.actor)?;
        let gate = Arc::clone(&self);
        let life = wanted.life.clone();
        let piece =
            aside(move || Ok(lock(&gate.moving).fetch(&wanted, &gate.folder.checkpoints())));
        let piece = piece.await?;
        lock(&self.seats).hear(&life)?.bytes_out += piece.bytes.len() as u64;
        Ok(piece)
    }

    async fn leave(self: Arc<Self>, leave: Leave) -> Answer<Leave> {
        lock(&self.seats).leave(&leave.life, &leave.numbers);
        Ok(leave)
    }
}

/// Runs what blocks beside the loop of connections.
async fn aside<T: Send + 'static>(work: impl FnOnce() -> Answer<T> + Send + 'static) -> Answer<T> {
    let done = tokio::task::spawn_blocking(work).await;
    done.unwrap_or_else(|_| Err(Said::Later("the gate is ending".to_owned())))
}

fn piece(path: &Path, offset: u64) -> std::io::Result<Piece> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(offset))?;
    let mut bytes = Vec::new();
    file.take(PIECE as u64).read_to_end(&mut bytes)?;
    Ok(Piece {
        bytes: bytes.into(),
    })
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
