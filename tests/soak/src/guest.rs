//! A host under a soak: `ampco join` as a child, in a folder of its own as on a machine of its own.

use std::fs::{self, File};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use run::Folder;
use rustix::process::{Pid, Signal, kill_process};
use supervise::programs;

use super::group::{ENDING, SUPERVISOR};

/// How a host is started, and what is known of it.
pub(super) struct Guest {
    pub(super) name: String,
    /// Its folder of runs.
    runs: PathBuf,
    gate: String,
    file: PathBuf,
    actors: u32,
    join: Child,
}

impl Guest {
    /// Starts a host that joins by `file`, which need not be there yet.
    pub(super) fn start(
        name: String,
        runs: PathBuf,
        gate: &str,
        file: &Path,
        actors: u32,
    ) -> Result<Self> {
        fs::create_dir_all(&runs).with_context(|| runs.display().to_string())?;
        let since = Instant::now();
        while !file.is_file() {
            if since.elapsed() > ENDING {
                bail!("{} was never written", file.display());
            }
            std::thread::sleep(super::LOOK);
        }
        let join = join(&runs, gate, file, actors)?;
        Ok(Self {
            name,
            runs,
            gate: gate.to_owned(),
            file: file.to_owned(),
            actors,
            join,
        })
    }

    /// Its folder, once it has one.
    pub(super) fn folder(&self) -> Option<Folder> {
        let entries = fs::read_dir(&self.runs).ok()?;
        let mut folders = entries.filter_map(Result::ok).map(|entry| entry.path());
        let found = folders.find(|path| path.is_dir())?;
        Folder::open(&found).ok()
    }

    /// The roles that it is to fill, as far as they are known.
    pub(super) fn roles(&self) -> Vec<String> {
        let numbers = || -> Option<Vec<u64>> {
            let text = fs::read(self.folder()?.path().join("host.json")).ok()?;
            let stay: serde_json::Value = serde_json::from_slice(&text).ok()?;
            let numbers = stay["numbers"].as_array()?.iter();
            numbers.map(serde_json::Value::as_u64).collect()
        };
        let actors = numbers().unwrap_or_default();
        let actors = actors.iter().map(|number| format!("actor-{number}"));
        let others = [SUPERVISOR, "carrier"].map(str::to_owned);
        others.into_iter().chain(actors).collect()
    }

    pub(super) fn holder(&self, role: &str) -> Option<u32> {
        self.folder()?.holder(role).ok()??.parse().ok()
    }

    /// The roles that nobody fills.
    pub(super) fn missing(&self) -> Vec<String> {
        let roles = self.roles();
        let fills = |role: &str| {
            self.holder(role).is_some_and(|pid| match role {
                SUPERVISOR => pid == self.join.id(),
                role => self
                    .folder()
                    .is_some_and(|folder| folder.has_worked(role, pid)),
            })
        };
        let whole = roles.len() == 2 + self.actors as usize;
        let unnamed = (!whole).then(|| "its actors".to_owned());
        let missing = roles.into_iter().filter(|role| !fills(role));
        let missing = missing.chain(unnamed);
        missing
            .map(|role| format!("{}/{role}", self.name))
            .collect()
    }

    /// Sends SIGKILL to whoever holds a role now; false if nobody does.
    pub(super) fn kill(&mut self, role: &str) -> bool {
        let Some(pid) = self.holder(role) else {
            return false;
        };
        let killed = Pid::from_raw(pid.cast_signed())
            .is_some_and(|pid| kill_process(pid, Signal::KILL).is_ok());
        if killed && pid == self.join.id() {
            let _ = self.join.wait();
        }
        killed
    }

    /// Starts it again if it was killed, as whoever keeps a machine does.
    pub(super) fn tend(&mut self) -> Result<()> {
        use std::os::unix::process::ExitStatusExt;
        let Some(status) = self.join.try_wait().context("waiting for ampco join")? else {
            return Ok(());
        };
        if status.signal() != Some(Signal::KILL.as_raw()) {
            let log = self.runs.join("join.log");
            let said = programs::last_words(&log, 0);
            let account = programs::account(status, said.as_deref(), &log, 0);
            bail!("{}: ampco join {account}", self.name);
        }
        self.join = join(&self.runs, &self.gate, &self.file, self.actors)?;
        Ok(())
    }

    /// Waits for its end, which follows the run's; one that waits for a gate is told to.
    pub(super) fn end(&mut self) -> Result<()> {
        let began = Instant::now();
        let mut told = false;
        while self
            .join
            .try_wait()
            .context("waiting for ampco join")?
            .is_none()
        {
            if began.elapsed() > ENDING {
                self.join.kill().context("killing ampco join")?;
                bail!("{} did not end within {ENDING:?} and was killed", self.name);
            }
            if !told
                && began.elapsed() > ENDING / 6
                && let Some(pid) = Pid::from_raw(self.join.id().cast_signed())
            {
                let _ = kill_process(pid, Signal::TERM);
                told = true;
            }
            std::thread::sleep(super::LOOK);
        }
        Ok(())
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        // After an orderly end there is nobody left to kill.
        let _ = self.join.kill();
        let _ = self.join.wait();
    }
}

fn join(runs: &Path, gate: &str, file: &Path, actors: u32) -> Result<Child> {
    let path = runs.join("join.log");
    let log = File::options().append(true).create(true).open(&path);
    let log = log.with_context(|| format!("opening {}", path.display()))?;
    Command::new(programs::find("ampco")?)
        .args(["join", gate, "--file"])
        .arg(file)
        .args(["--actors", &actors.to_string(), "--runs-dir"])
        .arg(runs)
        .env(
            protocol::SUPERVISOR_VARIABLE,
            std::process::id().to_string(),
        )
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(log)
        .process_group(0)
        .spawn()
        .context("starting ampco join")
}
