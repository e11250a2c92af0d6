//! The bond between a supervisor and its children: no child outlives it, not even a SIGKILL.
//!
//! Separate because both ends must agree on one variable: the supervisor names itself in the
//! child's environment, and the child, first thing, asks the kernel for SIGTERM at its death.

use std::io;

use rustix::process::{Pid, Signal, getppid, set_parent_process_death_signal};

/// The environment variable in which a supervisor passes its process id to its children.
pub const SUPERVISOR: &str = "AMPCO_SUPERVISOR";

/// Called first thing by a program that may have a supervisor; without one it does nothing.
///
/// # Errors
/// When the supervisor is gone already, or the kernel refuses: the program should end.
pub fn follow_supervisor() -> io::Result<()> {
    match std::env::var(SUPERVISOR) {
        Ok(pid) => follow(&pid),
        Err(_) => Ok(()),
    }
}

fn follow(pid: &str) -> io::Result<()> {
    set_parent_process_death_signal(Some(Signal::TERM))?;
    // A supervisor that died before the line above will never send the signal.
    let parent = getppid().map(Pid::as_raw_nonzero);
    if parent.is_none_or(|parent| parent.to_string() != pid) {
        return Err(io::Error::other(format!(
            "the supervisor, process {pid}, is gone"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_supervisor_that_is_not_the_parent_is_gone() {
        let error = follow("1999999999").unwrap_err().to_string();
        assert!(error.contains("1999999999"), "{error}");
        set_parent_process_death_signal(None).unwrap();
    }

    #[test]
    fn the_parent_is_followed() {
        let parent = getppid().unwrap().as_raw_nonzero().to_string();
        follow(&parent).unwrap();
        set_parent_process_death_signal(None).unwrap();
    }
}
