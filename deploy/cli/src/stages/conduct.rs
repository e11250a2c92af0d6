//! The runs of the stages, one after another, to the end or until it is stopped.

use std::ffi::OsString;
use std::os::unix::process::ExitStatusExt;
use std::process::{ExitStatus, Stdio};

use anyhow::{Context, Result, bail};
use run::Folder;
use rustix::process::{Pid, Signal, kill_process};
use supervise::{Stop, programs};
use terminal::Place;
use terminal::console::say;
use terminal::failure::usage;
use tokio::io::AsyncWriteExt;
use tokio::process::{Child, Command};
use wording::count;

use super::plan::{Plan, Planned};

/// Number of the signal that asks a run to end.
const INTERRUPT: i32 = Signal::INT.as_raw();

/// Runs what is not done yet.
pub(super) fn conduct(plan: &Plan, place: &Place) -> Result<()> {
    programs::runtime()?.block_on(async {
        let mut stop = Stop::install()?;
        for stage in &plan.stages {
            check_unchanged(stage, place)?;
        }
        let all = plan.stages.len();
        for (i, stage) in plan.stages.iter().enumerate() {
            let (run, iterations) = (&stage.run, count(stage.iterations, "iteration"));
            if done(stage, place)? {
                say(&format!("stage {} of {all}: {run} has its {iterations}", i + 1));
                continue;
            }
            let before = i.checked_sub(1).map(|i| plan.stages[i].run.as_str());
            say(&format!("stage {} of {all}: {run}, {iterations}", i + 1));
            let child = start(stage, before, place).await?;
            let (status, stopped) = follow(child, &mut stop).await?;
            // One that is asked to end before it can hear it ends by the signal itself.
            let ended = status.success() || stopped && status.signal() == Some(INTERRUPT);
            if !ended {
                bail!("stage {run}: `ampco train` {}", programs::describe(status));
            }
            if stopped {
                say("stopped; the same command goes on from here");
                return Ok(());
            }
            if !done(stage, place)? {
                bail!("stage {run} was ended before its last iteration; the same command goes on with it");
            }
        }
        let last = plan.stages.last().map_or("", |stage| stage.run.as_str());
        say(&format!("{} done; how well it walks: `ampco evaluate {last}`", count(all, "stage")));
        Ok(())
    })
}

/// The run of a stage, if it was begun.
fn folder(stage: &Planned, place: &Place) -> Result<Option<Folder>> {
    let path = place.runs_dir.join(&stage.run);
    let begun = path.join("config.toml").is_file();
    Ok(begun.then(|| Folder::open(&path)).transpose()?)
}

/// Whether all of a stage's iterations are done, and saved.
fn done(stage: &Planned, place: &Place) -> Result<bool> {
    let newest = folder(stage, place)?.and_then(|run| run.checkpoints().list().last().copied());
    Ok(newest.is_some_and(|newest| newest >= u64::from(stage.iterations)))
}

/// Refuses to go on with a run that was made with other values: what comes of it would be something else.
fn check_unchanged(stage: &Planned, place: &Place) -> Result<()> {
    let Some(run) = folder(stage, place)? else {
        return Ok(());
    };
    match stage.differs_from(&run.config()?) {
        None => Ok(()),
        Some((theirs, ours)) => Err(usage(format!(
            "run {} was made with `{theirs}` and this stage has `{ours}`; give another --run, or remove that run",
            stage.run
        ))),
    }
}

/// Starts the training of a stage, or goes on with it.
async fn start(stage: &Planned, before: Option<&str>, place: &Place) -> Result<Child> {
    let mut arguments: Vec<OsString> = vec!["train".into(), "--run".into(), (&stage.run).into()];
    arguments.extend(["--runs-dir".into(), (&place.runs_dir).into()]);
    let begun = folder(stage, place)?.is_some();
    if begun {
        arguments.push("--resume".into());
    } else {
        arguments.extend(["--preset".into(), "-".into()]);
        arguments.extend(before.iter().flat_map(|run| ["--from".into(), run.into()]));
    }
    let here = std::env::current_exe().context("finding this program's own path")?;
    let mut child = Command::new(here)
        .args(&arguments)
        // Who kills us leaves nobody training: the group ends in order, with a checkpoint.
        .env(
            protocol::SUPERVISOR_VARIABLE,
            std::process::id().to_string(),
        )
        .stdin(if begun { Stdio::null() } else { Stdio::piped() })
        // A group of its own: Ctrl-C in a terminal would come to it twice, and twice means at once.
        .process_group(0)
        .spawn()
        .with_context(|| format!("starting the training of {}", stage.run))?;
    if let Some(mut preset) = child.stdin.take() {
        // One that ends before it has read all says itself why.
        let _ = preset.write_all(stage.config.to_toml().as_bytes()).await;
    }
    Ok(child)
}

/// Waits for a run to end and passes requests to end on; how it ended, and whether it was asked to.
async fn follow(mut child: Child, stop: &mut Stop) -> Result<(ExitStatus, bool)> {
    let mut stopped = false;
    loop {
        let pid = child.id().and_then(|id| Pid::from_raw(id.cast_signed()));
        tokio::select! {
            status = child.wait() => return Ok((status.context("waiting for a run")?, stopped)),
            () = stop.requested() => {
                stopped = true;
                if let Some(pid) = pid {
                    // It may have ended a moment ago.
                    let _ = kill_process(pid, Signal::INT);
                }
            }
        }
    }
}
