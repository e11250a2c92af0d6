//! `ampco join`: takes part in a run on another machine.
//!
//! It asks the gate for the configuration and the motion, writes both into a folder of this machine, and starts the
//! carrier and the actors there. Everything in that folder can be had again: the run itself is on the learner's machine.

mod motion;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, Result};
use clap::Args;
use hosts::{CallError, Joined, Line, Pass};
use run::{Config, FleetConfig, Folder, FolderError, Lock, RunConfig};
use supervise::{Launch, Members, Stop, programs, supervise};
use terminal::Place;
use terminal::console::say;
use terminal::failure::usage;
use tokio::time::sleep;
use wording::count;

use crate::carrier::{GIVEN, SHOWN};
use crate::stay::{self, Stay};

/// Before a gate that is away is called again.
const PAUSE: Duration = Duration::from_secs(1);
/// Most hosts of one run in one folder of runs.
const MOST: u32 = 64;

/// Take part in a run on another machine: simulate for it, until it ends or Ctrl-C
///
/// On the learner's machine `ampco train --listen ADDRESS:PORT` writes a file to runs/<name>/join/; copy it here. The
/// same sources must be built on both machines. A gate that is away is waited for.
#[derive(Debug, Args)]
pub struct JoinRun {
    /// The learner's machine and the port on which it listens
    #[arg(value_name = "HOST:PORT")]
    gate: String,
    /// The file from the run's join/ folder
    #[arg(long, value_name = "JOIN")]
    file: PathBuf,
    /// Actor processes [default: one per core]
    #[arg(long, value_name = "N")]
    actors: Option<u32>,
    #[command(flatten)]
    place: Place,
}

impl JoinRun {
    /// Joins, and stays until the run ends or this process is told to end.
    ///
    /// # Errors
    /// A gate that refuses, a folder or a port that cannot be used, a process that cannot be kept alive.
    pub fn run(&self) -> Result<()> {
        protocol::end_with_supervisor()?;
        let whole = self.gate.rsplit_once(':');
        if whole.is_none_or(|(host, port)| host.is_empty() || port.parse::<u16>().is_err()) {
            let gate = &self.gate;
            return Err(usage(format!("{gate}: give HOST:PORT, as in node1:7000")));
        }
        let actors = self.actors.unwrap_or_else(cores);
        if actors == 0 {
            return Err(usage("--actors 0: a host needs at least one"));
        }
        let file = self.file.canonicalize();
        let file = file.with_context(|| self.file.display().to_string())?;
        let pass = Pass::read(&file)?;
        let (folder, _supervisor) = place(&self.place.runs_dir, &pass.run)?;
        begin_anew(&folder)?;
        let mut stay = Stay {
            gate: self.gate.clone(),
            file,
            host: stay::host(),
            life: stay::life(folder.path())?,
            numbers: Vec::new(),
        };
        let Some(joined) = enter(&stay, &pass, actors, folder.path())? else {
            return Ok(());
        };
        joined.notices.iter().for_each(|notice| say(notice));
        stay.numbers.clone_from(&joined.numbers);
        stay.write(folder.path())?;
        let mut config = Config::parse_written(&joined.config, "the run's config.toml")?;
        motion::point_to_copies(&mut config, folder.path());
        let comment = format!("Configuration of run {}, as the gate sent it.", joined.run);
        config.write(&folder.config_path(), &comment)?;
        let fleet: FleetConfig = config.section()?;
        let mut run: RunConfig = config.section()?;
        // The learner's machine says when the run ends.
        (run.minutes, run.iterations) = (0.0, 0);
        say(&format!(
            "joined run {} at {} with {} × {} × {} · in {} · Ctrl-C leaves it",
            joined.run,
            self.gate,
            numbered(&stay.numbers),
            count(fleet.environments_per_actor(), "environment"),
            count(fleet.steps, "step"),
            folder.path().display(),
        ));
        supervise(&Launch {
            folder: &folder,
            run: &run,
            fleet: &fleet,
            resume: false,
            members: Members::Guests {
                numbers: &stay.numbers,
                shown: SHOWN,
            },
        })?;
        Ok(())
    }
}

/// "actors 2, 3".
fn numbered(numbers: &[u32]) -> String {
    let listed: Vec<String> = numbers.iter().map(u32::to_string).collect();
    let noun = if numbers.len() == 1 {
        "actor"
    } else {
        "actors"
    };
    format!("{noun} {}", listed.join(", "))
}

fn cores() -> u32 {
    std::thread::available_parallelism().map_or(1, |cores| cores.get() as u32)
}

/// The folder of this host's stay, which is free, and its supervisor's role. Machines may share a disk, and one may join
/// twice: the folder has the machine's name, and a number where there are several.
fn place(runs: &Path, run: &str) -> Result<(Folder, Lock)> {
    let run: String = run.chars().take(32).collect();
    let stem = format!("{run}.{}", stay::host());
    for number in 1..=MOST {
        let name = match number {
            1 => stem.clone(),
            _ => format!("{stem}-{number}"),
        };
        let folder = Folder::create(runs, &name).context("making this host's folder")?;
        match folder.lock("supervisor") {
            Ok(lock) => return Ok((folder, lock)),
            Err(FolderError::Held { .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    Err(usage(format!("this machine has joined {MOST} times")))
}

/// Forgets what an earlier stay in this folder has left: robots may be another run's of the same name.
fn begin_anew(folder: &Folder) -> Result<()> {
    let checkpoints = folder.path().join("checkpoints");
    let gone = |done: std::io::Result<()>| match done {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    };
    gone(std::fs::remove_dir_all(&checkpoints))
        .and_then(|()| std::fs::create_dir_all(&checkpoints))
        .and_then(|()| gone(std::fs::remove_file(folder.path().join(GIVEN))))
        .and_then(|()| gone(std::fs::remove_file(folder.path().join(SHOWN))))
        .with_context(|| format!("clearing {}", folder.path().display()))
}

/// Joins, and brings the motion; `None` if told to end before the gate was there.
fn enter(stay: &Stay, pass: &Pass, actors: u32, folder: &Path) -> Result<Option<Arc<Joined>>> {
    let line = Line::new(&stay.gate, pass.client()?, stay.hello(actors));
    programs::runtime()?.block_on(async {
        let mut stop = Stop::install()?;
        let entering = async {
            let mut told = false;
            loop {
                let joined = match line.joined().await {
                    Ok(joined) => motion::bring(&line, &joined, folder).await.map(|()| joined),
                    Err(error) => Err(error.into()),
                };
                let error = match joined {
                    Ok(joined) => return Ok(joined),
                    Err(error) => error,
                };
                match error.downcast::<CallError>() {
                    Ok(CallError::Away(why)) => {
                        if !told {
                            say(&format!("the gate is away ({why}); waiting for it"));
                            told = true;
                        }
                        sleep(PAUSE).await;
                    }
                    Ok(refused) => {
                        let context = format!("the gate at {} refuses", stay.gate);
                        return Err(anyhow::Error::from(refused).context(context));
                    }
                    Err(error) => return Err(error),
                }
            }
        };
        tokio::select! {
            () = stop.requested() => Ok(None),
            joined = entering => joined.map(Some),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_machine_may_join_twice_and_machines_may_share_a_disk() {
        let runs = tempfile::tempdir().unwrap();
        let (first, _held) = place(runs.path(), "walk").unwrap();
        assert_eq!(first.name(), format!("walk.{}", stay::host()));
        let (second, held) = place(runs.path(), "walk").unwrap();
        assert_eq!(second.name(), format!("walk.{}-2", stay::host()));
        drop(held);
        let (again, _held) = place(runs.path(), "walk").unwrap();
        assert_eq!(again, second);
        assert_ne!(
            stay::life(first.path()).unwrap(),
            stay::life(again.path()).unwrap()
        );
    }

    #[test]
    fn robots_of_an_earlier_stay_are_forgotten() {
        let runs = tempfile::tempdir().unwrap();
        let (folder, _held) = place(runs.path(), "walk").unwrap();
        let robots = folder.checkpoints().path(5);
        std::fs::create_dir_all(&robots).unwrap();
        std::fs::write(folder.path().join(GIVEN), "1 2 3").unwrap();
        begin_anew(&folder).unwrap();
        assert!(!robots.exists() && !folder.path().join(GIVEN).exists());
        assert!(folder.path().join("checkpoints").is_dir());
    }
}
