//! The process group: started, watched, restarted, ended in order, cleaned up after.
//!
//! One thread and one loop. The thread matters: the kernel ties a child's life to the thread that
//! started it. The loop waits for signals, for words of the children and for the next look.

#![forbid(unsafe_code)]

mod child;
mod ending;
mod group;
mod orphans;
pub mod programs;
mod roles;
mod stop;

use std::process::ExitStatus;
use std::time::Duration;

use anyhow::Result;
use protocol::Domain;
use run::{FleetConfig, Folder, RunConfig};

use group::Group;
pub use roles::run_dir;
pub use stop::Stop;

/// Between two looks at the children.
const LOOK: Duration = Duration::from_millis(50);

/// What is to be supervised.
#[derive(Debug)]
pub struct Launch<'a> {
    /// The run.
    pub folder: &'a Folder,
    /// How long it may take.
    pub run: &'a RunConfig,
    /// How many actors there are to be.
    pub fleet: &'a FleetConfig,
    /// Whether the learner goes on from a checkpoint.
    pub resume: bool,
    /// Who is started on this machine.
    pub members: Members<'a>,
}

/// Who is started on this machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Members<'a> {
    /// Learner, scheduler and all actors.
    All,
    /// Learner, scheduler, a gate for other machines, and the first of the actors.
    Hosts {
        /// How many of the actors.
        here: usize,
        /// Where the gate listens, ADDRESS:PORT.
        listen: &'a str,
    },
    /// A carrier and some of the actors, for a learner on another machine.
    Guests {
        /// Numbers of the actors.
        numbers: &'a [u32],
        /// Name of the file in the run's folder whose text is shown.
        shown: &'a str,
    },
}

impl Members<'_> {
    /// The role whose end is the group's.
    pub(crate) fn head(&self) -> &'static str {
        match self {
            Self::All | Self::Hosts { .. } => roles::LEARNER,
            Self::Guests { .. } => roles::CARRIER,
        }
    }

    /// Whether the learner is on another machine.
    pub(crate) fn are_guests(&self) -> bool {
        matches!(self, Self::Guests { .. })
    }
}

/// Why the group ends.
#[derive(Debug)]
enum Reason {
    /// The learner has done all iterations, or the run has ended on the learner's machine.
    Complete,
    /// The minutes are over.
    TimeUp,
    /// Ctrl-C or SIGTERM.
    Asked,
    /// A process cannot be kept alive: its role and its last end.
    GivenUp(String, ExitStatus),
    /// Watching itself failed.
    Failed(anyhow::Error),
}

/// How a group has ended that did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// With its last iteration in a checkpoint.
    InOrder,
    /// At once, because the end was asked for twice.
    Forced,
}

/// Starts the group, watches it to its end, and leaves nothing behind.
pub fn supervise(launch: &Launch<'_>) -> Result<Ending> {
    programs::runtime()?.block_on(async {
        let mut stop = Stop::install()?;
        let domain = Domain::for_run(launch.folder.path())?;
        orphans::clear(launch.folder, &domain).await?;
        let mut group = Group::new(launch, domain)?;
        let reason = group.watch(&mut stop).await;
        group.end(reason, &mut stop).await
    })
}
