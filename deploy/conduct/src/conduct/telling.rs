//! What a study says: how far its runs are, and how it ended.

use anyhow::{Context, Result, anyhow};
use wording::count;

use super::{Conductor, Job, Task};
use crate::line::{Going, Stand};

impl Conductor<'_> {
    pub(super) fn stand(&self) -> Stand {
        let going = |job: &Job| {
            let (name, of) = (&self.planned[job.run].name, self.planned[job.run].target);
            let (iteration, rate) = match &job.task {
                Task::Training { pace, .. } => {
                    let rate = pace
                        .newest
                        .as_ref()
                        .and_then(|f| f.timing.samples_per_second);
                    (Some((self.progress[job.run].done, of)), rate)
                }
                Task::Judging { .. } => (None, None),
            };
            Going {
                name: name.clone(),
                iteration,
                samples_per_second: rate,
            }
        };
        Stand {
            runs: self.progress.clone(),
            failed: self.failures.len(),
            going: self.jobs.iter().map(going).collect(),
            parallel: self.parallel,
        }
    }

    /// The last words; a failure if a run failed.
    pub(super) fn close(&mut self) -> Result<()> {
        let path = self.folder.path().display();
        let done = self
            .progress
            .iter()
            .filter(|run| run.done >= run.of)
            .count();
        let all = self.progress.len();
        if self.stopping {
            let message = format!(
                "stopped: {done} of {} done; the same command goes on",
                count(all, "run")
            );
            self.console.say(&message);
            return Ok(());
        }
        if self.failures.is_empty() {
            self.measure_overhead()?;
        }
        let message = format!(
            "{done} of {} done in {path}; `ampco study report` of that folder writes the report",
            count(all, "run")
        );
        self.console.say(&message);
        if self.failures.is_empty() {
            return Ok(());
        }
        Err(anyhow!(
            "{} of {} failed: {}; see {path}/logs, and give the same command to try them again",
            self.failures.len(),
            count(all, "run"),
            self.failures.join(", ")
        ))
    }

    /// Times the scheduler alone, now that the machine is free.
    fn measure_overhead(&mut self) -> Result<()> {
        let here = std::env::current_exe().context("finding this program's own path")?;
        let output = std::process::Command::new(here)
            .args(["bench", "scheduler"])
            .output()
            .context("timing the scheduler")?;
        let said = String::from_utf8_lossy(&output.stdout);
        match said.lines().last().filter(|_| output.status.success()) {
            Some(figures) => self.folder.write("overhead.json", &format!("{figures}\n")),
            None => {
                self.console
                    .say("the scheduler could not be timed alone; the report will not have it");
                Ok(())
            }
        }
    }
}
