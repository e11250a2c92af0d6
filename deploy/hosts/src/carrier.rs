//! The carrier: stands in for the learner on another machine.
//!
//! It reads the rollouts of the actors here, sends them to the gate one by one, and gives the actors the weights that
//! the gate has. Killed and started again it gives them the newest weights, and they go on.

mod deliver;
mod figures;
mod intake;
mod poll;
mod robots;

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use hosts::{Leave, Line, Pass};
use protocol::{Domain, Node, RolloutSubscriber, Shutdown};
use run::journal::{Entry, Journal};
use run::{Checkpoints, Folder};
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep, timeout};
use tracing::{info, warn};

use crate::local::Local;
use crate::stay::Stay;
pub(crate) use figures::SHOWN;
pub(crate) use poll::GIVEN;

use figures::Counted;
use intake::Intake;
use robots::Robots;

/// Between two looks whether this process should stop.
const LOOK: Duration = Duration::from_millis(50);
/// Before a gate that is away is called again.
const PAUSE: Duration = Duration::from_millis(200);
/// Longest that saying good-bye may take.
const GOODBYE: Duration = Duration::from_secs(3);

/// What the carrier's tasks share.
struct Carrier {
    line: Line,
    stay: Stay,
    local: Local,
    folder: Folder,
    checkpoints: Checkpoints,
    robots: Robots,
    counted: Counted,
    /// The run has ended: nobody will take what the gate does not take now.
    ended: AtomicBool,
    journal: Mutex<Journal>,
}

/// Carries for the actors of the host whose folder is `run_dir`, until it is told to stop or the run ends.
///
/// # Errors
/// A folder that `ampco join` did not make, a gate that refuses.
pub fn run(run_dir: &Path) -> Result<()> {
    protocol::end_with_supervisor()?;
    let folder = Folder::open(run_dir)?;
    run::log::init(&folder.logs(), "carrier")?;
    let mut held = folder.lock("carrier")?;
    let local = Local::of(&folder.config()?)?;
    let stay = Stay::read(folder.path())?;
    let shutdown = Shutdown::on_signals()?;
    let node = Node::join(&Domain::for_run(folder.path())?, "carrier", &shutdown)?;
    let lists = local.layout().lists;
    let rollouts = RolloutSubscriber::new(&node, lists).context("opening the rollout stream")?;
    let mut journal = local.journal(&folder, "carrier")?;
    for number in &stay.numbers {
        journal.write(|| Entry::Carrying(*number));
    }
    let pass = Pass::read(&stay.file)?;
    let runtime = tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .context("starting the loop that follows the line")?;
    let carrier = Arc::new(Carrier {
        line: Line::new(&stay.gate, pass.client()?, stay.hello(0)),
        checkpoints: folder.checkpoints(),
        counted: Counted::new(&local),
        robots: Robots::default(),
        ended: AtomicBool::new(false),
        journal: Mutex::new(journal),
        stay,
        local,
        folder,
    });
    held.at_work();
    info!(gate = carrier.stay.gate, numbers = ?carrier.stay.numbers, "carrying");
    runtime.block_on(carrier.carry(node, rollouts, &shutdown))?;
    info!("done");
    Ok(())
}

impl Carrier {
    async fn carry(
        self: &Arc<Self>,
        node: Node,
        rollouts: RolloutSubscriber,
        shutdown: &Shutdown,
    ) -> Result<()> {
        let lean = self.local.lean.clone();
        let (intake, queues) = Intake::begin(rollouts, lean, &self.stay.numbers)?;
        let mut tasks: JoinSet<Result<()>> = JoinSet::new();
        for (actor, queue) in queues {
            tasks.spawn(Arc::clone(self).deliver_all(actor, queue));
        }
        let poll = Arc::clone(self);
        let mut polling = tokio::spawn(async move { poll.poll(&node).await });
        let last = loop {
            tokio::select! {
                ended = &mut polling => {
                    break Some(ended.context("the weights' task")??);
                }
                Some(ended) = tasks.join_next() => {
                    ended.context("an actor's task")??;
                    bail!("an actor's rollouts are no longer sent");
                }
                () = sleep(LOOK) => {
                    self.show();
                    if intake.has_failed() {
                        return intake.end();
                    }
                    if shutdown.requested() {
                        break None;
                    }
                }
            }
        };
        if let Some((version, _)) = &last {
            self.ended.store(true, Ordering::Relaxed);
            self.until_saved(*version).await;
        }
        // What the actors sent is in the queues by then; each is sent to its end.
        intake.finish();
        let drained = async {
            while let Some(ended) = tasks.join_next().await {
                ended.context("an actor's task")??;
            }
            anyhow::Ok(())
        };
        match timeout(self.local.stop / 2, drained).await {
            Ok(drained) => drained?,
            Err(_) => warn!("the gate is away: the last rollouts are lost"),
        }
        if let Some((version, _)) = &last {
            for actor in &self.stay.numbers {
                self.send_robots(*actor, *version).await?;
            }
        }
        let leave = Leave {
            life: self.stay.life.clone(),
            numbers: self.stay.numbers.clone(),
        };
        match self.line.call("Leave", leave, GOODBYE).await {
            Ok(Leave { .. }) => {}
            Err(error) => info!(%error, "the gate was not told"),
        }
        self.show();
        polling.abort();
        intake.end()
    }

    /// Waits until the actors, which were told to save and stop, have done both; not for one that has died.
    async fn until_saved(&self, version: u64) {
        let until = Instant::now() + self.local.stop / 2;
        loop {
            let done = self.stay.numbers.iter().all(|actor| {
                let gone = self.folder.holder(&format!("actor-{actor}"));
                let robots = run::checkpoint::robots_of(*actor);
                matches!(gone, Ok(None)) && self.checkpoints.path(version).join(robots).is_file()
            });
            if done {
                return;
            }
            if Instant::now() >= until {
                warn!(version, "not all actors have saved their robots");
                return;
            }
            sleep(LOOK).await;
        }
    }

    fn write_down(&self, entry: impl FnOnce() -> Entry) {
        let mut journal = self.journal.lock().unwrap_or_else(PoisonError::into_inner);
        journal.write(entry);
    }

    fn show(&self) {
        self.counted.show(self.folder.path(), self.line.figures());
    }
}
