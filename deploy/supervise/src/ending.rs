//! The end of a group: in order, within a time, with nothing left behind.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use protocol::DomainError;
use rustix::process::Signal;
use terminal::figures::clock;
use tokio::time::{interval, sleep};
use wording::count;

use super::group::Group;
use super::roles::{self, LEARNER, is_actor};
use super::stop::Stop;
use super::{Ending, LOOK, Reason};
use crate::programs;

/// Actors that the learner has told to save and stop get this long before they are told again.
const GRACE: Duration = Duration::from_secs(5);

impl Group<'_> {
    /// Ends everyone in order: the learner first, since it tells the actors to save.
    pub(super) async fn end(mut self, reason: Reason, stop: &mut Stop) -> Result<Ending> {
        let guests = self.launch.members.are_guests();
        if !matches!(reason, Reason::Complete) {
            self.console.say(match &reason {
                Reason::Asked if guests => {
                    "leaving: finishing the rollouts (once more to kill at once)"
                }
                Reason::TimeUp => "time is up: finishing the iteration",
                Reason::Failed(_) | Reason::GivenUp(..) => "ending the group",
                _ => "ending: finishing the iteration (once more to kill at once)",
            });
        }
        let patience = Duration::from_secs_f64(self.launch.run.deadlines.stop_seconds);
        for child in &mut self.children {
            child.retire();
        }
        if guests {
            // What they have begun still goes to the learner.
            self.signal(Signal::TERM, is_actor);
            self.until_ended(patience, stop, is_actor).await?;
        }
        self.signal(Signal::TERM, |role| role == LEARNER);
        let saved = self
            .until_ended(patience, stop, |role| role == LEARNER)
            .await?;
        if saved && !matches!(reason, Reason::Failed(_) | Reason::GivenUp(..)) {
            self.until_ended(GRACE.min(patience), stop, is_actor)
                .await?;
        }
        self.signal(Signal::TERM, |role| role != LEARNER);
        self.until_ended(patience, stop, |role| role != LEARNER)
            .await?;
        let killed = self.alive(|_| true);
        self.signal(Signal::KILL, |_| true);
        let forced = std::mem::take(&mut self.forced);
        self.until_ended(GRACE, stop, |_| true).await?;

        while let Ok(words) = self.words.try_recv() {
            self.relay(&words);
        }
        self.glance()?;
        self.show(Instant::now());
        self.console.finish();
        self.remove_memory().await?;
        self.report(&reason, &killed);
        match reason {
            Reason::Failed(error) => Err(error),
            Reason::GivenUp(role, status) => {
                let log = roles::log(self.launch.folder, &role);
                let before = self.logged.get(&role).copied().unwrap_or(0);
                let said = self.said.get(&role).map(String::as_str);
                let account = programs::account(status, said, &log, before);
                bail!("{role} is given up; it {account}")
            }
            _ if forced => Ok(Ending::Forced),
            _ => self.nothing_lost().map(|()| Ending::InOrder),
        }
    }

    /// An error where the last weights are in no checkpoint, as when the disk was full.
    fn nothing_lost(&self) -> Result<()> {
        let folder = &self.launch.folder;
        let saved = folder.checkpoints().list().pop();
        match (&self.pace.newest, saved) {
            (Some(newest), saved) if saved.is_none_or(|saved| saved < newest.iteration) => {
                bail!(
                    "what was learnt in iterations {} to {} is lost: {} could not be written, and the log says why; once that is mended, go on with `ampco train --resume --run {}`",
                    saved.unwrap_or(0) + 1,
                    newest.iteration,
                    folder.checkpoints().path(newest.iteration).display(),
                    folder.name()
                )
            }
            _ => Ok(()),
        }
    }

    /// Removes the run's shared memory. One who only watches leaves when it sees the end, which takes it a moment.
    async fn remove_memory(&self) -> Result<()> {
        let until = Instant::now() + GRACE;
        loop {
            match self.domain.remove() {
                Err(DomainError::InUse { .. }) if Instant::now() < until => sleep(LOOK).await,
                removed => {
                    removed.context("removing the run's shared memory")?;
                    return Ok(());
                }
            }
        }
    }

    /// Waits until nobody of those meant is alive; false when some are still after `patience`, or
    /// when the end was asked for once more.
    async fn until_ended(
        &mut self,
        patience: Duration,
        stop: &mut Stop,
        meant: impl Fn(&str) -> bool,
    ) -> Result<bool> {
        let until = Instant::now()
            + if self.forced {
                Duration::ZERO
            } else {
                patience
            };
        let mut looks = interval(LOOK);
        loop {
            tokio::select! {
                () = stop.requested() => {
                    self.forced = true;
                    return Ok(self.alive(&meant).is_empty());
                }
                Some(words) = self.words.recv() => self.relay(&words),
                _ = looks.tick() => {
                    let now = Instant::now();
                    for child in &mut self.children {
                        child.died(now, |_, _| true)?;
                        child.retire();
                    }
                    if self.alive(&meant).is_empty() {
                        return Ok(true);
                    }
                    if now >= until {
                        return Ok(false);
                    }
                }
            }
        }
    }

    fn report(&mut self, reason: &Reason, killed: &[String]) {
        let what = match reason {
            Reason::Complete => "complete",
            Reason::TimeUp | Reason::Asked => "ended",
            Reason::Failed(_) | Reason::GivenUp(..) => "failed",
        };
        let run = self.launch.folder.name();
        let whose = if self.launch.members.are_guests() {
            "host of run"
        } else {
            "run"
        };
        let mut report = format!(
            "{whose} {run} {what} after {}",
            clock(self.started.elapsed())
        );
        if let Some(figures) = &self.pace.newest {
            report += &format!(
                " at iteration {}, {}",
                figures.iteration,
                count(figures.samples, "sample")
            );
        }
        report += &match self.launch.folder.checkpoints().list().last() {
            // They are the learner's.
            _ if self.launch.members.are_guests() => String::new(),
            Some(iteration) => format!("; last checkpoint {iteration:08}"),
            None => "; no checkpoint".to_owned(),
        };
        let left = self.alive(|_| true);
        report += &match (left.as_slice(), killed) {
            ([], []) => "; all processes ended, shared memory removed".to_owned(),
            ([], killed) => format!("; killed: {}; shared memory removed", killed.join(", ")),
            (left, _) => format!("; still alive: {}", left.join(", ")),
        };
        self.console.say(&report);
    }
}
