//! Waiting for something that programs under test are to bring about.
//!
//! Separate because a wait must also end when nobody is left who could bring it about: a program that was refused its start
//! says so in a moment, and the test with it.

use std::cell::RefCell;
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, WaitId, WaitIdOptions, waitid};

use super::{Captured, PATIENCE};

/// How often a condition is looked at again.
pub(super) const GLANCE: Duration = Duration::from_millis(10);

/// Time for last looks once all have ended: what a program did last may be seen only then.
const AFTERWARDS: Duration = Duration::from_millis(500);

thread_local! {
    /// Programs that this thread has started and whose end nobody has asked for yet.
    static STARTED: RefCell<Vec<(Pid, Captured)>> = const { RefCell::new(Vec::new()) };
}

/// Counts a program among those that may bring about what is waited for.
pub(super) fn started(pid: Pid, stderr: Captured) {
    STARTED.with_borrow_mut(|all| all.push((pid, stderr)));
}

/// Its end is the test's own business from now on.
pub(super) fn awaited_end(pid: Pid) {
    STARTED.with_borrow_mut(|all| all.retain(|(other, _)| *other != pid));
}

/// What they said, if some were started and all have ended.
fn all_ended() -> Option<String> {
    STARTED.with_borrow(|all| {
        let ended = |(pid, _): &(Pid, Captured)| {
            let options = WaitIdOptions::EXITED | WaitIdOptions::NOWAIT | WaitIdOptions::NOHANG;
            matches!(waitid(WaitId::Pid(*pid), options), Ok(Some(_)))
        };
        let said = || {
            all.iter()
                .map(|(_, stderr)| stderr.text())
                .collect::<Vec<_>>()
        };
        (!all.is_empty() && all.iter().all(ended)).then(|| said().join("\n"))
    })
}

/// Looks again and again until there is an answer; panics, naming what was awaited, if none comes or none can come any
/// more.
pub(crate) fn until<T>(awaited: &str, look: impl FnMut() -> Option<T>) -> T {
    until_within(PATIENCE, awaited, look)
}

pub(super) fn until_within<T>(
    patience: Duration,
    awaited: &str,
    mut look: impl FnMut() -> Option<T>,
) -> T {
    let started = Instant::now();
    let mut ended: Option<Instant> = None;
    loop {
        if let Some(answer) = look() {
            return answer;
        }
        assert!(
            started.elapsed() < patience,
            "waited {patience:?} in vain for {awaited}"
        );
        if let Some(said) = all_ended() {
            let since = *ended.get_or_insert_with(Instant::now);
            assert!(
                since.elapsed() < AFTERWARDS,
                "nobody is left who could bring about {awaited}; the last words: {said}"
            );
        }
        thread::park_timeout(GLANCE);
    }
}

#[cfg(test)]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::process::Command;

    use super::*;
    use crate::harness::Process;

    #[test]
    fn a_wait_ends_when_nobody_is_left_who_could_end_it() {
        let mut command = Command::new("sh");
        command.args(["-c", "echo no room >&2; exit 3"]);
        let mut process = Process::start(command);
        let began = Instant::now();
        let waited = catch_unwind(AssertUnwindSafe(|| until("the moon", || None::<()>)));
        let words = waited.unwrap_err();
        let words = words.downcast_ref::<String>().expect("words");
        assert!(
            words.contains("the moon") && words.contains("no room"),
            "{words}"
        );
        assert!(began.elapsed() < PATIENCE / 4, "{:?}", began.elapsed());
        // Its status is still there for who asks.
        assert_eq!(process.end().code(), Some(3));
    }
}
