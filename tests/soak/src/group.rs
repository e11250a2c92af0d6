//! The group under a soak: `ampco train` as a child, and the processes that it keeps.

use std::collections::BTreeMap;
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use run::Folder;
use run::metrics::Tail;
use rustix::process::{Pid, Signal, kill_process};
use supervise::programs;
use terminal::Place;

use super::Soak;
use super::guest::Guest;

pub(super) const SUPERVISOR: &str = "supervisor";

/// Longest that an orderly end may take.
pub(super) const ENDING: Duration = Duration::from_secs(90);

/// A training group and what is known of it.
pub(super) struct Group {
    pub(super) folder: Folder,
    place: Place,
    train: Child,
    /// What lets hosts in; nothing where there are none.
    listen: Vec<String>,
    /// Every role that a whole group has on the learner's machine.
    roles: Vec<String>,
    pub(super) guests: Vec<Guest>,
    /// Who held them when the group was last whole.
    lives: BTreeMap<String, u32>,
    tail: Tail,
    /// Since when everyone is at work, in the present search for wholeness.
    at_work: bool,
}

impl Group {
    /// Starts a group in a run of its own.
    pub(super) fn launch(soak: &Soak) -> Result<Self> {
        let place = soak.place.clone();
        let name = place.free_name("soak");
        let folder = Folder::create(&place.runs_dir, &name).context("making the run's folder")?;
        let mut arguments: Vec<String> = ["--preset", &soak.preset, "--actors"]
            .map(str::to_owned)
            .into();
        arguments.push((soak.actors * (1 + soak.hosts)).to_string());
        let gate = free_address()?;
        let here = soak.actors.to_string();
        let listen = match soak.hosts {
            0 => Vec::new(),
            _ => ["--listen", &gate, "--here", &here]
                .map(str::to_owned)
                .into(),
        };
        arguments.extend(listen.iter().cloned());
        // Endless: the soak says when it ends.
        for set in ["run.iterations=0", "run.minutes=0", "run.journal=true"] {
            arguments.extend(["--set".to_owned(), set.to_owned()]);
        }
        for set in &soak.set {
            arguments.extend(["--set".to_owned(), set.clone()]);
        }
        let actors = (0..soak.actors).map(|index| format!("actor-{index}"));
        let others = [SUPERVISOR, "scheduler", "learner"].map(str::to_owned);
        let doors = (soak.hosts > 0).then(|| "gate".to_owned());
        let train = start(&place, &folder, &arguments)?;
        let file = folder.path().join(format!("join/{name}.join"));
        let guest = |number: u32| {
            let own = place.runs_dir.join(format!("{name}.hosts/{number}"));
            Guest::start(format!("host-{number}"), own, &gate, &file, soak.actors)
        };
        Ok(Self {
            guests: (1..=soak.hosts).map(guest).collect::<Result<_>>()?,
            train,
            tail: Tail::from_start(&folder.metrics_path()),
            roles: others.into_iter().chain(doors).chain(actors).collect(),
            listen,
            lives: BTreeMap::new(),
            at_work: false,
            folder,
            place,
        })
    }

    /// Every role that is filled on any machine; those of hosts as `host-1/carrier`.
    pub(super) fn roles(&self) -> Vec<String> {
        let there = self.guests.iter().flat_map(|guest| {
            let roles = guest.roles().into_iter();
            roles.map(|role| format!("{}/{role}", guest.name))
        });
        self.roles.iter().cloned().chain(there).collect()
    }

    /// Sends SIGKILL to whoever holds a role now; false if nobody does.
    pub(super) fn kill(&mut self, role: &str) -> bool {
        self.at_work = false;
        if let Some((host, role)) = role.split_once('/') {
            let mut guests = self.guests.iter_mut();
            let guest = guests.find(|guest| guest.name == host);
            return guest.is_some_and(|guest| guest.kill(role));
        }
        let Some(pid) = self.holder(role) else {
            return false;
        };
        let killed = Pid::from_raw(pid.cast_signed())
            .is_some_and(|pid| kill_process(pid, Signal::KILL).is_ok());
        if killed && pid == self.train.id() {
            // It is gone when this returns, and `tend` will see that.
            let _ = self.train.wait();
        }
        killed
    }

    /// Starts the group again if its supervisor was killed: the one thing that nobody in it can do.
    pub(super) fn tend(&mut self) -> Result<()> {
        use std::os::unix::process::ExitStatusExt;
        self.guests.iter_mut().try_for_each(Guest::tend)?;
        let Some(status) = self.train.try_wait().context("waiting for ampco train")? else {
            return Ok(());
        };
        if status.signal() != Some(Signal::KILL.as_raw()) {
            let log = self.folder.logs().join("train.log");
            let said = programs::last_words(&log, 0);
            let account = programs::account(status, said.as_deref(), &log, 0);
            bail!("ampco train {account}");
        }
        let arguments = [&["--resume".to_owned()], self.listen.as_slice()].concat();
        self.train = start(&self.place, &self.folder, &arguments)?;
        Ok(())
    }

    /// Fails if the group has ended by itself.
    pub(super) fn check(&mut self) -> Result<()> {
        self.tend()
    }

    /// Whether every role is held by a process that has come to work, and an iteration was done since.
    pub(super) fn is_whole(&mut self) -> Result<bool> {
        self.tend()?;
        if !self.missing().is_empty() {
            self.at_work = false;
            return Ok(false);
        }
        let lines = self.tail.poll().context("following the metrics")?;
        if !self.at_work {
            // These lines may be older than the last who came.
            self.at_work = true;
            return Ok(false);
        }
        Ok(!lines.is_empty())
    }

    /// The roles that nobody fills.
    pub(super) fn missing(&self) -> Vec<String> {
        let fills = |role: &&String| {
            self.holder(role).is_some_and(|pid| match role.as_str() {
                SUPERVISOR => pid == self.train.id(),
                role => self.folder.has_worked(role, pid),
            })
        };
        let here = self.roles.iter().filter(|role| !fills(role)).cloned();
        let there = self.guests.iter().flat_map(Guest::missing);
        here.chain(there).collect()
    }

    /// How many roles are held by another process than when this was last asked.
    pub(super) fn new_lives(&mut self) -> u64 {
        let holder = |role: &String| Some((role.clone(), self.holder(role)?));
        let mut lives: BTreeMap<String, u32> = self.roles.iter().filter_map(holder).collect();
        for guest in &self.guests {
            let there = guest.roles().into_iter();
            let held = there.filter_map(|role| {
                let pid = guest.holder(&role)?;
                Some((format!("{}/{role}", guest.name), pid))
            });
            lives.extend(held);
        }
        let new = lives
            .iter()
            .filter(|(role, pid)| self.lives.get(*role) != Some(pid));
        let new = new.count() as u64;
        self.lives = lives;
        new
    }

    fn holder(&self, role: &str) -> Option<u32> {
        self.folder.holder(role).ok()??.parse().ok()
    }

    /// Ends the group in order.
    pub(super) fn end(&mut self) -> Result<()> {
        if let Some(pid) = Pid::from_raw(self.train.id().cast_signed()) {
            // It may have ended by itself.
            let _ = kill_process(pid, Signal::TERM);
        }
        let began = Instant::now();
        while self
            .train
            .try_wait()
            .context("waiting for ampco train")?
            .is_none()
        {
            if began.elapsed() > ENDING {
                self.train.kill().context("killing ampco train")?;
                bail!("ampco train did not end within {ENDING:?} and was killed");
            }
            std::thread::sleep(super::LOOK);
        }
        self.guests.iter_mut().try_for_each(Guest::end)
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        // After an orderly end there is nobody left to kill.
        let _ = self.train.kill();
        let _ = self.train.wait();
    }
}

/// An address that nobody had a moment ago.
fn free_address() -> Result<String> {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").context("looking for a port")?;
    let address = listener.local_addr().context("looking for a port")?;
    Ok(address.to_string())
}

/// `ampco train` with what it says in a log, in a process group of its own: Ctrl-C is for the soak.
fn start(place: &Place, folder: &Folder, arguments: &[String]) -> Result<Child> {
    let path = folder.logs().join("train.log");
    let log = File::options()
        .append(true)
        .create(true)
        .open(&path)
        .with_context(|| format!("opening {}", path.display()))?;
    Command::new(programs::find("ampco")?)
        .args(["train", "--no-pictures", "--run", &folder.name()])
        .arg("--runs-dir")
        .arg(&place.runs_dir)
        .args(arguments)
        .env(
            protocol::SUPERVISOR_VARIABLE,
            std::process::id().to_string(),
        )
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(log)
        .process_group(0)
        .spawn()
        .context("starting ampco train")
}
