//! One program of the group: started, watched, started again.
//!
//! Separate from the group because the rule of what a death means is a small decision of its own,
//! and is tested as one.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{ExitStatus, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use rustix::process::{Pid, Signal, kill_process};
use tokio::io::{AsyncBufReadExt, BufReader};
use tokio::process::Command;
use tokio::sync::mpsc::UnboundedSender;

/// A program that lived less has lived briefly.
const BRIEF: Duration = Duration::from_secs(10);

/// So many brief lives in a row without any work done, and it is given up.
const MOST_IDLE_LIVES: u32 = 5;

/// So many brief lives in a row, and it is given up whatever it did in them.
const MOST_BRIEF_LIVES: u32 = 40;

/// What a death means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It ended of its own accord.
    Done,
    /// It is to be started again after this time.
    Restart(Duration),
    /// Starting it again would not help.
    GiveUp,
}

/// A line that a child wrote to standard error: its role and its words.
pub(crate) type Words = (String, String);

/// A program and what became of it.
#[derive(Debug)]
pub(crate) struct Child {
    pub(crate) role: String,
    pub(crate) program: PathBuf,
    pub(crate) arguments: Vec<OsString>,
    pub(crate) restarts: u32,
    state: State,
    lives: Lives,
    words: UnboundedSender<Words>,
}

#[derive(Debug)]
enum State {
    Waiting {
        until: Instant,
    },
    Running {
        process: tokio::process::Child,
        pid: u32,
        since: Instant,
    },
    Ended,
}

/// Brief lives in a row, the last one included if it was brief.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Lives {
    brief: u32,
    /// Those in a row in which it never came to work.
    idle: u32,
}

impl Lives {
    /// Counts one more.
    fn after(self, lived: Duration, worked: bool) -> Self {
        let brief = lived < BRIEF;
        Self {
            brief: if brief { self.brief + 1 } else { 0 },
            idle: if brief && !worked { self.idle + 1 } else { 0 },
        }
    }
}

impl Child {
    /// A program that has not been started yet.
    pub(crate) fn new(
        role: String,
        program: PathBuf,
        arguments: Vec<OsString>,
        words: UnboundedSender<Words>,
    ) -> Self {
        let until = Instant::now();
        Self {
            role,
            program,
            arguments,
            restarts: 0,
            state: State::Waiting { until },
            lives: Lives::default(),
            words,
        }
    }

    /// Starts it. It leads a process group of its own, so that Ctrl-C on the terminal reaches only
    /// us, and it asks the kernel for SIGTERM at our death.
    pub(crate) fn start(&mut self, now: Instant) -> Result<()> {
        let mut command = Command::new(&self.program);
        command
            .args(&self.arguments)
            .env(
                protocol::SUPERVISOR_VARIABLE,
                std::process::id().to_string(),
            )
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .process_group(0);
        let mut process = command
            .spawn()
            .with_context(|| format!("starting {}", self.program.display()))?;
        if let Some(stderr) = process.stderr.take() {
            let (role, words) = (self.role.clone(), self.words.clone());
            tokio::spawn(async move {
                let mut lines = BufReader::new(stderr).lines();
                while let Ok(Some(line)) = lines.next_line().await {
                    if words.send((role.clone(), line)).is_err() {
                        break;
                    }
                }
            });
        }
        self.state = State::Running {
            pid: process.id().unwrap_or_default(),
            process,
            since: now,
        };
        Ok(())
    }

    /// Looks whether it has died since the last look, and how. `worked` says whether the process of a
    /// role has come to work.
    pub(crate) fn died(
        &mut self,
        now: Instant,
        worked: impl Fn(&str, u32) -> bool,
    ) -> Result<Option<(ExitStatus, Verdict)>> {
        let State::Running {
            process,
            pid,
            since,
        } = &mut self.state
        else {
            return Ok(None);
        };
        let waited = process.try_wait();
        let Some(status) = waited.with_context(|| format!("waiting for {}", self.role))? else {
            return Ok(None);
        };
        self.lives = self.lives.after(now - *since, worked(&self.role, *pid));
        let verdict = verdict(status, self.lives, self.restarts);
        self.state = match verdict {
            Verdict::Restart(after) => State::Waiting { until: now + after },
            Verdict::Done | Verdict::GiveUp => State::Ended,
        };
        Ok(Some((status, verdict)))
    }

    /// Whether it is time to start it again.
    pub(crate) fn is_due(&self, now: Instant) -> bool {
        matches!(self.state, State::Waiting { until } if now >= until)
    }

    /// Has it started again although it ended of its own accord.
    pub(crate) fn start_again_at(&mut self, until: Instant) {
        self.restarts += 1;
        self.state = State::Waiting { until };
    }

    pub(crate) fn is_running(&self) -> bool {
        matches!(self.state, State::Running { .. })
    }

    /// Never to be started again; a running process is not touched.
    pub(crate) fn retire(&mut self) {
        if !self.is_running() {
            self.state = State::Ended;
        }
    }

    /// Sends a signal if it is running.
    pub(crate) fn signal(&self, signal: Signal) {
        if let State::Running { process, .. } = &self.state
            && let Some(pid) = process.id().and_then(|id| Pid::from_raw(id.cast_signed()))
        {
            // It may have ended a moment ago; the next look will see that.
            let _ = kill_process(pid, signal);
        }
    }
}

/// What a death means. `lives` counts this one, `restarts` those before.
fn verdict(status: ExitStatus, lives: Lives, restarts: u32) -> Verdict {
    if status.success() {
        return Verdict::Done;
    }
    // A first start that ends with an ordinary failure has said what is wrong; it would say it again.
    let refused = matches!(status.code(), Some(1 | 2)) && lives.idle > 0 && restarts == 0;
    if refused || lives.idle >= MOST_IDLE_LIVES || lives.brief >= MOST_BRIEF_LIVES {
        return Verdict::GiveUp;
    }
    // Who has worked is missed, and comes back at once.
    let doublings = lives.idle.saturating_sub(1).min(5);
    Verdict::Restart(Duration::from_millis(100 << doublings))
}

#[cfg(test)]
mod tests;
