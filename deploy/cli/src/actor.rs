//! `ampco actor`: one more actor for a running group.
//!
//! It starts `ampco-actor` under the next free index and stays with it: signals are passed on, and
//! its end is ours. Stopping it never stops the rest of the group.

use std::io::Write;
use std::process::ExitStatus;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use clap::Args;
use run::{FleetConfig, Folder};
use rustix::process::{Pid, Signal, kill_process};
use supervise::{Stop, programs, run_dir};
use terminal::Place;
use terminal::failure::usage;
use tokio::process::{Child, Command};
use tokio::time::{interval, timeout};

/// How long the new actor may take to take its role.
const JOINING: Duration = Duration::from_secs(30);

/// Add one actor to a running group; Ctrl-C takes it away again
#[derive(Debug, Args)]
pub(crate) struct AddActor {
    /// Name of the run
    #[arg(long, value_name = "NAME")]
    run: String,
    #[command(flatten)]
    place: Place,
}

impl AddActor {
    pub(crate) fn run(&self) -> Result<()> {
        let folder = self.place.find(Some(&self.run))?;
        if folder.holder("supervisor")?.is_none() && folder.holder("learner")?.is_none() {
            return Err(usage(format!(
                "run {0} is not running; start it with `ampco train --run {0}`, adding --resume if \
                 it has run before",
                folder.name()
            )));
        }
        let status = programs::runtime()?.block_on(stay_with(&folder))?;
        if !status.success() {
            bail!("the actor {}", programs::describe(status));
        }
        Ok(())
    }
}

/// Starts the actor and stays until it ends.
async fn stay_with(folder: &Folder) -> Result<ExitStatus> {
    let mut stop = Stop::install()?;
    let mut process = join(folder).await?;
    loop {
        tokio::select! {
            status = process.wait() => return status.context("waiting for the actor"),
            () = stop.requested() => tell(&process),
        }
    }
}

/// Starts an actor under the next free index and waits until it has taken that role.
async fn join(folder: &Folder) -> Result<Child> {
    // One at a time: between finding a free index and the actor's taking it, nobody else may look.
    let _turn = turn(folder).await?;
    let fleet: FleetConfig = folder.config()?.section()?;
    // The first indices are the group's own, also while one of them is being restarted.
    let first = u32::try_from(fleet.actors).context("counting the group's actors")?;
    let (index, free) = folder.lock_free_actor(first)?;
    drop(free);
    if index as usize >= protocol::MAX_ACTORS {
        bail!("the group is full: at most {} actors", protocol::MAX_ACTORS);
    }
    let mut process = Command::new(programs::find("ampco-actor")?)
        .args(run_dir(folder))
        .args(["--index", &index.to_string()])
        .env(
            protocol::SUPERVISOR_VARIABLE,
            std::process::id().to_string(),
        )
        .process_group(0)
        .spawn()
        .context("starting ampco-actor")?;
    let role = format!("actor-{index}");
    let since = Instant::now();
    while folder.holder(&role)?.is_none() && since.elapsed() < JOINING {
        if timeout(Duration::from_millis(10), process.wait())
            .await
            .is_ok()
        {
            return Ok(process); // it has said why; whoever waits for it learns its status
        }
    }
    // Nothing depends on anybody reading this.
    let _ = writeln!(std::io::stderr(), "{role} joined run {}", folder.name());
    Ok(process)
}

/// The right to look for a free index.
async fn turn(folder: &Folder) -> Result<run::Lock> {
    let mut looks = interval(Duration::from_millis(20));
    let since = Instant::now();
    loop {
        looks.tick().await;
        match folder.lock("joining") {
            Err(run::FolderError::Held { .. }) if since.elapsed() < JOINING => {}
            turn => return Ok(turn?),
        }
    }
}

/// Tells it to end.
fn tell(process: &Child) {
    if let Some(pid) = process.id().and_then(|id| Pid::from_raw(id.cast_signed())) {
        // It may have ended a moment ago.
        let _ = kill_process(pid, Signal::TERM);
    }
}
