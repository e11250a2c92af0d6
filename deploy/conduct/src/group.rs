//! One program that a study has started: `ampco train` of a run, or `ampco evaluate` of what came of it.
//!
//! A run is trained as anybody would train it, by this same program, so that a study adds nothing to it and any of its
//! runs can be repeated by hand.

use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::path::Path;
use std::process::{ExitStatus, Stdio};

use anyhow::{Context, Result};
use run::Folder;
use rustix::process::{Pid, Signal, kill_process};
use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use supervise::programs;
use tokio::process::{Child, Command};

use super::folder::StudyFolder;
use super::judgement::Judging;
use super::plan::Planned;

/// How far a run has come, from its folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// Nothing that could be gone on with.
    New,
    /// There is a checkpoint.
    Begun,
    /// All iterations are done, and saved.
    Done,
}

impl Standing {
    pub(super) fn of(planned: &Planned, folder: &StudyFolder) -> Result<Self> {
        let Some(run) = folder.run(&planned.name)? else {
            return Ok(Self::New);
        };
        Ok(match run.checkpoints().list().last() {
            None => Self::New,
            Some(newest) if *newest >= planned.target => Self::Done,
            Some(_) => Self::Begun,
        })
    }
}

/// Starts the training of a run, or goes on with it.
pub(super) fn train(
    planned: &Planned,
    folder: &StudyFolder,
    standing: Standing,
    cores: Option<&CpuSet>,
) -> Result<Child> {
    let name = &planned.name;
    let mut arguments: Vec<OsString> = vec!["train".into(), "--run".into(), name.into()];
    // The study's report has figures of its own.
    arguments.push("--no-pictures".into());
    arguments.extend(["--runs-dir".into(), folder.runs().into()]);
    if standing == Standing::New {
        // Killed before its first checkpoint: there is nothing to go on from, and lines that would be in the way.
        let left = folder.runs().join(name);
        if left.exists() {
            std::fs::remove_dir_all(&left)
                .with_context(|| format!("clearing {}", left.display()))?;
        }
        arguments.extend(["--preset".into(), folder.config(name).into()]);
    } else {
        arguments.push("--resume".into());
    }
    start(&arguments, Stdio::null(), (folder, name), cores)
}

/// Starts the evaluation of a finished run; its answer goes to `draft`.
pub(super) fn evaluate(
    run: &Folder,
    asked: &Judging,
    draft: &Path,
    folder: &StudyFolder,
    cores: Option<&CpuSet>,
) -> Result<Child> {
    let (name, evaluation) = (run.name(), &asked.evaluation);
    let mut arguments: Vec<OsString> = vec!["evaluate".into(), name.clone().into()];
    arguments.extend(["--runs-dir".into(), folder.runs().into(), "--json".into()]);
    for [x, y, yaw] in &evaluation.commands {
        arguments.push(format!("--command={x},{y},{yaw}").into());
    }
    arguments.push(format!("--episodes={}", evaluation.episodes).into());
    arguments.push(format!("--seconds={}", evaluation.seconds).into());
    if let Some(judge) = &asked.judge {
        arguments.extend(["--judge".into(), judge.into()]);
    }
    if let Some(parent) = draft.parent() {
        std::fs::create_dir_all(parent)
            .with_context(|| format!("making the folder {}", parent.display()))?;
    }
    let answer = File::create(draft).with_context(|| format!("creating {}", draft.display()))?;
    start(&arguments, answer.into(), (folder, &name), cores)
}

fn start(
    arguments: &[OsString],
    stdout: Stdio,
    (folder, name): (&StudyFolder, &str),
    cores: Option<&CpuSet>,
) -> Result<Child> {
    let log = folder.log(name);
    let opened = OpenOptions::new().append(true).create(true).open(&log);
    let log = opened.with_context(|| format!("opening {}", log.display()))?;
    let here = std::env::current_exe().context("finding this program's own path")?;
    let mut command = Command::new(here);
    command
        .args(arguments)
        // A study that is killed leaves nobody training: the group ends in order, with a checkpoint.
        .env(
            protocol::SUPERVISOR_VARIABLE,
            std::process::id().to_string(),
        )
        .stdin(Stdio::null())
        .stdout(stdout)
        .stderr(log)
        .process_group(0);
    on_cores(cores, || command.spawn())?.with_context(|| format!("starting {name}"))
}

/// Does something with this thread on some cores: what it starts stays there, with all that that starts.
fn on_cores<T>(cores: Option<&CpuSet>, start: impl FnOnce() -> T) -> Result<T> {
    let Some(cores) = cores else {
        return Ok(start());
    };
    let before = sched_getaffinity(None).context("asking for the cores of this program")?;
    sched_setaffinity(None, cores).context("keeping a run to its cores")?;
    let started = start();
    sched_setaffinity(None, &before).context("taking back the cores of this program")?;
    Ok(started)
}

/// The cores of each of `jobs` groups that take `width` of them; none if there are not enough for all, or if one group has
/// the machine to itself.
pub(super) fn divided(jobs: usize, width: usize) -> Result<Vec<CpuSet>> {
    let allowed = sched_getaffinity(None).context("asking for the cores of this program")?;
    let allowed: Vec<usize> = (0..CpuSet::MAX_CPU)
        .filter(|core| allowed.is_set(*core))
        .collect();
    if jobs < 2 || jobs * width > allowed.len() {
        return Ok(Vec::new());
    }
    let set = |cores: &[usize]| {
        let mut set = CpuSet::new();
        cores.iter().for_each(|core| set.set(*core));
        set
    };
    Ok(allowed.chunks(width).take(jobs).map(set).collect())
}

/// Passes a request to end on.
pub(super) fn signal(child: &Child, signal: Signal) {
    if let Some(pid) = child.id().and_then(|id| Pid::from_raw(id.cast_signed())) {
        // It may have ended a moment ago.
        let _ = kill_process(pid, signal);
    }
}

/// Why a program failed: the last thing it said.
pub(super) fn words(status: ExitStatus, log: &Path) -> String {
    let said = programs::last_words(log, 0);
    programs::account(status, said.as_deref(), log, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_share_no_core_and_what_is_started_has_its_own() {
        let allowed = sched_getaffinity(None).unwrap();
        let all = allowed.count() as usize;
        assert!(divided(1, 1).unwrap().is_empty());
        assert!(divided(all + 1, 1).unwrap().is_empty());
        let one = CpuSet::MAX_CPU
            - (0..CpuSet::MAX_CPU)
                .rev()
                .position(|core| allowed.is_set(core))
                .unwrap()
            - 1;
        let mut last = CpuSet::new();
        last.set(one);
        let inside = on_cores(Some(&last), || sched_getaffinity(None).unwrap()).unwrap();
        assert_eq!((inside.count(), inside.is_set(one)), (1, true));
        assert_eq!(sched_getaffinity(None).unwrap(), allowed);
        if all >= 2 {
            let sets = divided(all, 1).unwrap();
            assert_eq!(sets.len(), all);
            for core in 0..CpuSet::MAX_CPU {
                let in_sets = sets.iter().filter(|set| set.is_set(core)).count();
                assert_eq!(in_sets, usize::from(allowed.is_set(core)));
            }
        }
    }
}
