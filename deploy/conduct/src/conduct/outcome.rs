//! What became of a program that has ended: the next step of its run, or a failure that is noted.

use std::path::Path;
use std::process::ExitStatus;

use anyhow::Result;
use run::Folder;

use super::{Conductor, Job, Task};
use crate::group::{self, Standing};
use crate::judgement::Judgement;
use crate::records;

impl Conductor<'_> {
    pub(super) fn ended(&mut self, job: Job, status: ExitStatus) -> Result<()> {
        let planned = &self.planned[job.run];
        match job.task {
            Task::Training { .. } => {
                if Standing::of(planned, self.folder)? == Standing::Done {
                    let message = format!("{} is done", planned.name);
                    self.console.say(&message);
                    self.finished(job.run, job.place)
                } else if !status.success() {
                    let words = group::words(status, &self.folder.log(&planned.name));
                    self.fail(job.run, &words)
                } else if self.stopping {
                    Ok(())
                } else {
                    self.fail(job.run, "it was ended before its last iteration")
                }
            }
            Task::Judging { draft } => {
                if status.success() {
                    return self.judged(job.run, &draft);
                }
                // A draft that cannot be removed is overwritten by the next attempt.
                let _ = std::fs::remove_file(&draft);
                if self.stopping {
                    return Ok(());
                }
                let words = group::words(status, &self.folder.log(&planned.name));
                self.fail(job.run, &format!("judging it {words}"))
            }
        }
    }

    /// Keeps what was found of a run.
    fn judged(&mut self, run: usize, draft: &Path) -> Result<()> {
        let name = &self.planned[run].name;
        let made = self.folder.run(name)?;
        let (Some(made), Some(asked)) = (made, self.judging) else {
            return Ok(());
        };
        match Judgement::keep(&made, asked, draft) {
            Ok(()) => self.record(run, &made),
            Err(error) => self.fail(run, &format!("{error:#}")),
        }
    }

    /// Writes the record of a run that is done and judged.
    fn record(&mut self, run: usize, made: &Folder) -> Result<()> {
        let record = records::of(made, &self.planned[run], self.judging);
        let written = record.and_then(|record| self.folder.records().write(&record));
        match written {
            Ok(()) => Ok(()),
            Err(error) => self.fail(run, &format!("{error:#}")),
        }
    }

    /// A run whose training is done: judged, if that is asked for and was not done before in the same way.
    pub(super) fn finished(&mut self, run: usize, place: usize) -> Result<()> {
        let name = self.planned[run].name.clone();
        self.progress[run].done = self.progress[run].of;
        self.folder.note(&name, None)?;
        let Some(folder) = self.folder.run(&name)? else {
            return Ok(());
        };
        let Some(asked) = self.judging else {
            return self.record(run, &folder);
        };
        // One that cannot be read is found anew like one that was found otherwise.
        let known = Judgement::read(&folder).ok().flatten();
        if known.is_some_and(|known| known.is_as_asked(&folder, asked)) {
            return self.record(run, &folder);
        }
        if self.stopping {
            return Ok(());
        }
        let draft = Judgement::path(&folder).with_extension("draft");
        match group::evaluate(&folder, asked, &draft, self.folder, self.cores.get(place)) {
            Ok(child) => {
                let task = Task::Judging { draft };
                self.jobs.push(Job {
                    run,
                    place,
                    child,
                    task,
                });
                Ok(())
            }
            Err(error) => self.fail(run, &format!("{error:#}")),
        }
    }

    /// Says and notes that a run failed; the others go on.
    pub(super) fn fail(&mut self, run: usize, words: &str) -> Result<()> {
        let name = &self.planned[run].name;
        self.console
            .say(&format!("{name} failed and the others go on: {words}"));
        self.failures.push(name.clone());
        self.folder.note(name, Some(words))
    }
}
