//! Programs of ours: where they lie, the loop that follows them, and what is known of one that ended.

use std::path::{Path, PathBuf};
use std::process::ExitStatus;

use anyhow::{Context, Result};
use rustix::process::Signal;
use terminal::failure::usage;
use tokio::runtime::Runtime;

/// The loop of who starts programs. One thread: the kernel ties a child's life to the thread that started it.
pub fn runtime() -> Result<Runtime> {
    tokio::runtime::Builder::new_current_thread()
        .enable_all()
        .build()
        .context("starting the loop that follows programs")
}

/// The program `name`, which lies beside the present one.
pub fn find(name: &str) -> Result<PathBuf> {
    let here = std::env::current_exe().context("finding this program's own path")?;
    let folder = here.parent().unwrap_or(Path::new("."));
    let path = folder.join(name);
    if path.is_file() {
        Ok(path)
    } else {
        Err(usage(format!(
            "{name} is not in {}; build all programs, as deploy/local.sh does",
            folder.display()
        )))
    }
}

/// "was killed by signal 9 (SIGKILL)", "failed with status 1".
pub fn describe(status: ExitStatus) -> String {
    use std::os::unix::process::ExitStatusExt;
    match (status.code(), status.signal()) {
        (Some(0), _) => "ended".to_owned(),
        (Some(code), _) => format!("failed with status {code}"),
        (None, Some(signal)) => match of_signal(signal) {
            Some((name, _)) => format!("was killed by signal {signal} ({name})"),
            None => format!("was killed by signal {signal}"),
        },
        (None, None) => "ended in an unknown way".to_owned(),
    }
}

/// A signal's name, and what usually is behind it.
fn of_signal(signal: i32) -> Option<(&'static str, &'static str)> {
    let bug = "that is a bug of the program";
    Some(match Signal::from_named_raw(signal)? {
        Signal::ILL => (
            "SIGILL",
            "this processor lacks an instruction that the program was built for: build it on this machine",
        ),
        Signal::ABORT => ("SIGABRT", bug),
        Signal::BUS => ("SIGBUS", "look whether /dev/shm or the disk is full"),
        Signal::FPE => ("SIGFPE", bug),
        Signal::KILL => (
            "SIGKILL",
            "somebody sent it, or the kernel, as it does when memory runs out",
        ),
        Signal::SEGV => ("SIGSEGV", bug),
        Signal::TERM => ("SIGTERM", "somebody sent it"),
        Signal::HUP => ("SIGHUP", "its terminal was closed"),
        Signal::INT => ("SIGINT", "somebody sent it"),
        Signal::XCPU => ("SIGXCPU", "its limit of processor time was reached"),
        Signal::XFSZ => ("SIGXFSZ", "its limit of the size of files was reached"),
        _ => return None,
    })
}

/// What is known of a death: the end, the last words if there were any, the log if this life wrote anything to it, else
/// what usually is behind such an end. `before` is the length of the log, in bytes, when this life began.
pub fn account(status: ExitStatus, said: Option<&str>, log: &Path, before: u64) -> String {
    use std::os::unix::process::ExitStatusExt;
    let mut account = describe(status);
    let length = std::fs::metadata(log).ok().map(|facts| facts.len());
    let place = log.display();
    if let Some(said) = said {
        account += &format!(": {}", wording::said(said));
    }
    if length > Some(before) {
        return format!("{account}; see {place}");
    }
    let cause = status.signal().and_then(of_signal);
    if let (None, Some((_, cause))) = (said, cause) {
        account += &format!("; {cause}");
    }
    if said.is_none() {
        account += &match length {
            None => format!("; it said nothing and {place} was never made"),
            Some(0) => format!("; it said nothing and {place} is empty"),
            Some(_) => format!("; it said nothing, and nothing of this time is in {place}"),
        };
    }
    account
}

/// The last thing that stands in a log since it was `before` bytes long: what a program of ours said as it failed, else its
/// last line.
pub fn last_words(log: &Path, before: u64) -> Option<String> {
    let bytes = std::fs::read(log).ok()?;
    let said = String::from_utf8_lossy(bytes.get(usize::try_from(before).ok()?..)?);
    let mut lines = said.lines().rev().filter(|line| !line.trim().is_empty());
    let last = lines.clone().next()?;
    let complaint = lines.find(|line| line.starts_with("ampco: "));
    Some(complaint.unwrap_or(last).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::process::ExitStatusExt;

    // A wait status holds the signal in its low seven bits and the exit code in the next byte.
    fn killed() -> ExitStatus {
        ExitStatus::from_raw(9)
    }

    fn failed(code: i32) -> ExitStatus {
        ExitStatus::from_raw(code << 8)
    }

    #[test]
    fn ends_are_named() {
        assert_eq!(describe(killed()), "was killed by signal 9 (SIGKILL)");
        // A real-time signal has no name.
        let nameless = ExitStatus::from_raw(40);
        assert_eq!(describe(nameless), "was killed by signal 40");
        assert_eq!(describe(failed(3)), "failed with status 3");
    }

    #[test]
    fn an_empty_log_is_not_pointed_to() {
        let folder = tempfile::tempdir().unwrap();
        let log = folder.path().join("learner.log");
        let of = |status, said, before| account(status, said, &log, before);
        let missing = of(killed(), None, 0);
        assert!(
            missing
                .starts_with("was killed by signal 9 (SIGKILL); somebody sent it, or the kernel")
        );
        assert!(
            missing.ends_with("learner.log was never made") && !missing.contains("see "),
            "{missing}"
        );
        std::fs::write(&log, "").unwrap();
        let empty = of(failed(1), None, 0);
        assert!(
            empty.starts_with("failed with status 1; it said nothing and "),
            "{empty}"
        );
        assert!(
            empty.ends_with("learner.log is empty") && !empty.contains("see "),
            "{empty}"
        );
        let spoken = of(failed(1), Some("no motion"), 0);
        assert_eq!(spoken, "failed with status 1: no motion");
        std::fs::write(&log, "0123456789").unwrap();
        let silent = of(failed(3), None, 10);
        assert!(silent.contains("nothing of this time is in "), "{silent}");
        let logged = of(failed(3), None, 4);
        assert_eq!(
            logged,
            format!("failed with status 3; see {}", log.display())
        );
        let both = of(failed(3), Some("no"), 4);
        assert_eq!(
            both,
            format!("failed with status 3: no; see {}", log.display())
        );
    }

    #[test]
    fn last_words_are_the_complaint_or_the_last_line_of_this_life() {
        let folder = tempfile::tempdir().unwrap();
        let log = folder.path().join("run.log");
        assert_eq!(last_words(&log, 0), None);
        let old = "ampco: an old complaint\n";
        std::fs::write(&log, old).unwrap();
        assert_eq!(last_words(&log, old.len() as u64), None);
        std::fs::write(&log, format!("{old}one\ntwo\n\n")).unwrap();
        assert_eq!(last_words(&log, old.len() as u64).unwrap(), "two");
        std::fs::write(&log, format!("{old}ampco: no disk\ntwo\n")).unwrap();
        assert_eq!(
            last_words(&log, old.len() as u64).unwrap(),
            "ampco: no disk"
        );
        assert_eq!(last_words(&log, 1_000), None);
    }

    #[test]
    fn a_program_that_was_not_built_is_named_with_the_remedy() {
        let error = find("ampco-nothing").unwrap_err().to_string();
        assert!(
            error.contains("ampco-nothing") && error.contains("local.sh"),
            "{error}"
        );
    }
}
