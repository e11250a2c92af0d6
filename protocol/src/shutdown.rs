//! The request to stop: from a signal, from a supervisor's end, or from this process itself.
//!
//! Separate because it concerns a process as a whole, whether it has joined a domain or not.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};

/// Environment variable by which a supervisor tells its children its process id.
pub const SUPERVISOR_VARIABLE: &str = "AMPCO_SUPERVISOR";

/// A request to stop, seen by everyone who holds a clone.
#[derive(Clone, Debug, Default)]
pub struct Shutdown(Arc<AtomicBool>);

impl Shutdown {
    /// Requested by SIGTERM or SIGINT. A second signal adds nothing: whoever cannot wait kills.
    pub fn on_signals() -> Result<Self, PresenceError> {
        let shutdown = Self::default();
        for signal in [SIGTERM, SIGINT] {
            signal_hook::flag::register(signal, Arc::clone(&shutdown.0))
                .map_err(PresenceError::Signals)?;
        }
        Ok(shutdown)
    }

    /// Requested only by [`Self::request`]: for tests, and for a process that must keep talking
    /// after a signal and therefore looks at the signals itself.
    pub fn manual() -> Self {
        Self::default()
    }

    /// Asks everyone who holds a clone to stop.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether to stop.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Why a process cannot be present.
#[derive(Debug, thiserror::Error)]
pub enum PresenceError {
    /// The handlers of SIGTERM and SIGINT could not be installed.
    #[error("installing the handlers of SIGTERM and SIGINT")]
    Signals(#[source] std::io::Error),
    /// The variable that names the supervisor holds no process id.
    #[error("{SUPERVISOR_VARIABLE}={value}: expected the process id of the supervisor")]
    Variable {
        /// Its value.
        value: String,
    },
    /// The system refused to tie this process to its parent.
    #[error("asking for a signal when the supervisor ends")]
    ParentSignal(#[source] std::io::Error),
    /// The supervisor ended before this process could tie itself to it.
    #[error("supervisor {supervisor} has already ended: start the run again")]
    Orphaned {
        /// Its process id.
        supervisor: u32,
    },
}

/// Makes this process receive SIGTERM when its supervisor ends, however that ends.
///
/// Call it first in `main`. Returns false and does nothing when [`SUPERVISOR_VARIABLE`] is not set,
/// that is, when the program was started by hand. The kernel watches the *thread* that started the
/// child: a supervisor must start children from a thread that lives as long as it does.
pub fn end_with_supervisor() -> Result<bool, PresenceError> {
    let Some(value) = std::env::var_os(SUPERVISOR_VARIABLE) else {
        return Ok(false);
    };
    let value = value.to_string_lossy().into_owned();
    let Ok(supervisor) = value.parse::<u32>() else {
        return Err(PresenceError::Variable { value });
    };
    rustix::process::set_parent_process_death_signal(Some(rustix::process::Signal::TERM))
        .map_err(|error| PresenceError::ParentSignal(error.into()))?;
    // The supervisor may have ended before the line above; then no signal will ever come.
    if std::os::unix::process::parent_id() != supervisor {
        return Err(PresenceError::Orphaned { supervisor });
    }
    Ok(true)
}
