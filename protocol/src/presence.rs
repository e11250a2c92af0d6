//! Being there: joining a domain, noticing the dead, meeting the new.
//!
//! Separate because every process does this alike, whatever it writes or reads. A dead process
//! leaves its places in the streams taken until someone cleans up after it; everyone looks, every
//! [`TICK`].

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, Once, PoisonError, Weak};
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use iceoryx2::prelude::{
    LogLevel, NodeBuilder, NodeName, SignalHandlingMode, set_log_level_from_env_or,
};

use crate::domain::{self, Domain, Service};
use crate::error::PortError;
use crate::room;
use crate::shutdown::Shutdown;
use crate::watch::Watch;

/// Time between two looks for dead processes and new readers.
pub const TICK: Duration = Duration::from_millis(100);

/// Something that looks after its connections on every tick.
pub(crate) trait Tend: Send + Sync {
    fn tend(&self);
}

/// This process as a member of a domain. Clones are the same member; the last one leaves.
///
/// A thread ticks every [`TICK`], so that the dead are cleaned up and new peers connected also while
/// this process computes.
#[derive(Clone)]
pub struct Node(Arc<Presence>);

struct Presence {
    membership: Arc<Membership>,
    /// Dropping the sender ends the thread.
    keeper: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Drop for Presence {
    fn drop(&mut self) {
        // Waited for: the thread must not be the one that leaves, when the process is gone already.
        if let Some((sender, keeper)) = self.keeper.take() {
            drop(sender);
            let _ = keeper.join();
        }
    }
}

impl fmt::Debug for Node {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Node")
            .field("role", &self.0.membership.role)
            .field("incarnation", &self.incarnation())
            .finish_non_exhaustive()
    }
}

impl Node {
    /// Joins `domain` under a role such as `learner` or `actor-3`, and cleans up after the dead.
    pub fn join(domain: &Domain, role: &str, shutdown: &Shutdown) -> Result<Self, PortError> {
        let membership = Arc::new(Membership::new(domain, role, shutdown)?);
        let (sender, ending) = channel();
        let kept = Arc::clone(&membership);
        let keeper = std::thread::Builder::new()
            .name("presence".to_owned())
            .spawn(move || {
                while ending.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                    kept.tick();
                }
            })
            .map_err(|error| PortError::Join {
                role: role.to_owned(),
                cause: format!("starting its thread: {error}"),
            })?;
        let keeper = Some((sender, keeper));
        Ok(Self(Arc::new(Presence { membership, keeper })))
    }

    /// Number of this life of the process: a restarted process has a larger one.
    pub fn incarnation(&self) -> u64 {
        self.0.membership.incarnation
    }

    /// The request to stop that ends the waiting of this process.
    pub fn shutdown(&self) -> &Shutdown {
        &self.0.membership.shutdown
    }

    /// The domain that was joined.
    pub fn domain(&self) -> &Domain {
        &self.0.membership.domain
    }

    /// If the last look is [`TICK`] ago, cleans up after dead processes and connects ports to new
    /// peers; otherwise returns at once. A thread of this process and every waiting call do it too.
    pub fn tick(&self) {
        self.0.membership.tick();
    }

    pub(crate) fn membership(&self) -> &Arc<Membership> {
        &self.0.membership
    }
}

/// What the ports and the thread of a node share.
pub(crate) struct Membership {
    handle: iceoryx2::node::Node<Service>,
    ports: Mutex<Vec<Weak<dyn Tend>>>,
    watch: Mutex<Watch>,
    domain: Domain,
    role: String,
    shutdown: Shutdown,
    incarnation: u64,
    joined: Instant,
    /// Milliseconds after `joined` at which the next tick is due.
    due: AtomicU64,
}

impl Membership {
    fn new(domain: &Domain, role: &str, shutdown: &Shutdown) -> Result<Self, PortError> {
        static QUIET: Once = Once::new();
        // What it calls a warning is often the other side ending, which we report ourselves.
        QUIET.call_once(|| set_log_level_from_env_or(LogLevel::Error));

        let refused = |cause: String| PortError::Join {
            role: role.to_owned(),
            cause,
        };
        let config = domain.prepare()?;
        room::require("joining the run", 0)?;
        let name = NodeName::new(role).map_err(|error| refused(format!("{error:?}")))?;
        let handle = NodeBuilder::new()
            .name(&name)
            .config(&config)
            // The shells install their own handlers, see `Shutdown`.
            .signal_handling_mode(SignalHandlingMode::Disabled)
            .create::<Service>()
            .map_err(|error| refused(format!("{error:?}")))?;
        room::make_private(domain.prefix())
            .map_err(|error| refused(format!("making its memory private: {error}")))?;
        let since_epoch = SystemTime::now().duration_since(UNIX_EPOCH);
        Ok(Self {
            handle,
            ports: Mutex::new(Vec::new()),
            watch: Mutex::new(Watch::new(domain.root().join("nodes"))),
            domain: domain.clone(),
            role: role.to_owned(),
            shutdown: shutdown.clone(),
            // Nanoseconds fit u64 until the year 2554; a restart gives a larger number.
            incarnation: since_epoch.map_or(1, |time| time.as_nanos() as u64),
            joined: Instant::now(),
            due: AtomicU64::new(0),
        })
    }

    /// Both halves of a tick, when due.
    pub(crate) fn tick(&self) {
        if self.clean_when_due() {
            self.tend_ports();
        }
    }

    /// The half of a tick that touches no port: a port that is just sending holds its own lock and
    /// may call only this. Returns whether it was due.
    pub(crate) fn clean_when_due(&self) -> bool {
        let now = self.joined.elapsed().as_millis() as u64;
        let due = self.due.load(Ordering::Relaxed);
        let next = now + TICK.as_millis() as u64;
        let exchange = |due| {
            self.due
                .compare_exchange(due, next, Ordering::Relaxed, Ordering::Relaxed)
        };
        let ours = now >= due && exchange(due).is_ok();
        if ours
            && let Ok(mut watch) = self.watch.try_lock()
            && watch.suspects(|| self.processes())
        {
            self.clean();
        }
        ours
    }

    fn processes(&self) -> Vec<(String, u32)> {
        let members = domain::members(self.handle.config()).unwrap_or_default();
        let identify = |member: domain::Listed| (member.id, member.member.process);
        members.into_iter().map(identify).collect()
    }

    /// Cleans up after dead processes now.
    pub(crate) fn clean(&self) {
        let state = self.handle.try_cleanup_dead_nodes();
        if state.cleanups > 0 {
            tracing::info!(dead = state.cleanups, "cleaned up after dead processes");
        }
    }

    pub(crate) fn handle(&self) -> &iceoryx2::node::Node<Service> {
        &self.handle
    }

    pub(crate) fn shutdown(&self) -> &Shutdown {
        &self.shutdown
    }

    pub(crate) fn domain(&self) -> &Domain {
        &self.domain
    }

    /// Adds a port that wants to look after its connections on every tick.
    pub(crate) fn register(&self, port: Weak<dyn Tend>) {
        let mut ports = self.ports.lock().unwrap_or_else(PoisonError::into_inner);
        ports.retain(|port| port.strong_count() > 0);
        ports.push(port);
    }

    fn tend_ports(&self) {
        // Taken only while another thread of this process does the same.
        let Ok(ports) = self.ports.try_lock() else {
            return;
        };
        for port in ports.iter().filter_map(Weak::upgrade) {
            port.tend();
        }
    }
}
