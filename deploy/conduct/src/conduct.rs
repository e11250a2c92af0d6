//! The runs of a study, one process group after another or several at once, to the end or until it is stopped.

mod outcome;
mod telling;

use std::collections::VecDeque;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use ::study::StudyFile;
use ::study::outlook::Progress;
use anyhow::{Context, Result};
use run::metrics::{self, Tail};
use rustix::process::Signal;
use rustix::thread::CpuSet;
use supervise::{Stop, programs};
use terminal::console::Console;
use terminal::figures::{Figures, Pace};
use tokio::process::Child;
use tokio::time::{MissedTickBehavior, interval};

use super::folder::StudyFolder;
use super::group::{self, Standing};
use super::judgement::Judging;
use super::plan::Planned;
use super::records;

/// Between two looks.
const LOOK: Duration = Duration::from_millis(100);
/// A group that an earlier study left is given this long to end.
const PATIENCE: Duration = Duration::from_secs(120);

/// Runs what is not done yet.
pub(super) fn conduct(
    folder: &StudyFolder,
    file: &StudyFile,
    planned: Vec<Planned>,
    judging: Option<&Judging>,
) -> Result<()> {
    programs::runtime()?.block_on(async {
        let mut stop = Stop::install()?;
        let mut conductor = Conductor::new(folder, file, planned, judging)?;
        conductor.until_done(&mut stop).await?;
        conductor.close()
    })
}

/// What runs now.
struct Job {
    run: usize,
    /// Whose cores it has, of those that are divided among the groups.
    place: usize,
    child: Child,
    task: Task,
}

enum Task {
    Training {
        tail: Tail,
        pace: Box<Pace>,
    },
    /// Judging: where the answer is written until it is whole.
    Judging {
        draft: PathBuf,
    },
}

struct Conductor<'a> {
    folder: &'a StudyFolder,
    judging: Option<&'a Judging>,
    planned: Vec<Planned>,
    progress: Vec<Progress>,
    queue: VecDeque<usize>,
    jobs: Vec<Job>,
    failures: Vec<String>,
    parallel: usize,
    /// The cores of each place; empty where groups are not kept to cores.
    cores: Vec<CpuSet>,
    console: Console,
    stopping: bool,
    /// Since when the first of the queue waits for an earlier group to end.
    waiting: Option<Instant>,
}

impl<'a> Conductor<'a> {
    fn new(
        folder: &'a StudyFolder,
        file: &StudyFile,
        planned: Vec<Planned>,
        judging: Option<&'a Judging>,
    ) -> Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let widest = planned.iter().map(|run| run.cores).max().unwrap_or(1);
        let mut progress = Vec::new();
        for run in &planned {
            progress.push(so_far(run, folder, judging)?);
        }
        let parallel = match file.jobs {
            0 => (cores / widest.max(1)).max(1),
            given => given,
        };
        Ok(Self {
            folder,
            judging,
            queue: (0..planned.len()).collect(),
            progress,
            jobs: Vec::new(),
            failures: Vec::new(),
            cores: group::divided(parallel, widest)?,
            parallel,
            planned,
            console: Console::on_stderr(),
            stopping: false,
            waiting: None,
        })
    }

    async fn until_done(&mut self, stop: &mut Stop) -> Result<()> {
        let mut looks = interval(LOOK);
        looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                () = stop.requested() => self.stop(),
                _ = looks.tick() => {
                    self.look()?;
                    if self.jobs.is_empty() && (self.stopping || self.queue.is_empty()) {
                        self.console.finish();
                        return Ok(());
                    }
                }
            }
        }
    }

    /// Passes the request on; asked once more, the groups kill at once.
    fn stop(&mut self) {
        if !self.stopping {
            self.console
                .say("stopping: each run finishes its iteration and writes a checkpoint");
        }
        self.stopping = true;
        for job in &self.jobs {
            match job.task {
                Task::Training { .. } => group::signal(&job.child, Signal::INT),
                Task::Judging { .. } => group::signal(&job.child, Signal::TERM),
            }
        }
    }

    fn look(&mut self) -> Result<()> {
        let mut index = 0;
        while index < self.jobs.len() {
            self.follow(index)?;
            match self.jobs[index]
                .child
                .try_wait()
                .context("waiting for a run")?
            {
                None => index += 1,
                Some(status) => {
                    let job = self.jobs.swap_remove(index);
                    self.ended(job, status)?;
                }
            }
        }
        while !self.stopping && self.jobs.len() < self.parallel {
            if !self.start_next()? {
                break;
            }
        }
        let line = self.stand().line();
        self.console.show(&line, Instant::now());
        Ok(())
    }

    /// Reads what a run has written since the last look.
    fn follow(&mut self, index: usize) -> Result<()> {
        let job = &mut self.jobs[index];
        if let Task::Training { tail, pace } = &mut job.task {
            for line in tail.poll().context("following the metrics")? {
                pace.take(&line);
            }
            let progress = &mut self.progress[job.run];
            if let Some(newest) = &pace.newest {
                progress.done = newest.iteration;
            }
            progress.pace = pace.seconds().or(progress.pace);
        }
        Ok(())
    }

    /// Starts what the queue holds first; false if nothing could be started now.
    fn start_next(&mut self) -> Result<bool> {
        let Some(run) = self.queue.front().copied() else {
            return Ok(false);
        };
        let name = &self.planned[run].name;
        if records::stands(self.folder, name, self.judging)? {
            self.queue.pop_front();
            self.progress[run].done = self.progress[run].of;
            self.folder.note(name, None)?;
            return Ok(true);
        }
        if let Some(pid) = self.held(run)? {
            let since = *self.waiting.get_or_insert_with(Instant::now);
            if since.elapsed() < PATIENCE {
                return Ok(false);
            }
            self.queue.pop_front();
            self.waiting = None;
            self.fail(run, &format!("process {pid} still trains it"))?;
            return Ok(true);
        }
        self.queue.pop_front();
        self.waiting = None;
        let planned = &self.planned[run];
        let standing = Standing::of(planned, self.folder)?;
        let taken: Vec<usize> = self.jobs.iter().map(|job| job.place).collect();
        let place = (0..).find(|place| !taken.contains(place)).unwrap_or(0);
        if standing == Standing::Done {
            self.finished(run, place)?;
            return Ok(true);
        }
        match group::train(planned, self.folder, standing, self.cores.get(place)) {
            Ok(child) => {
                let path = self.folder.runs().join(&planned.name).join("metrics.jsonl");
                let tail = if standing == Standing::Begun {
                    Tail::from_end(&path)
                } else {
                    Tail::from_start(&path)
                };
                let pace = Box::default();
                let task = Task::Training { tail, pace };
                self.jobs.push(Job {
                    run,
                    place,
                    child,
                    task,
                });
            }
            Err(error) => self.fail(run, &format!("{error:#}"))?,
        }
        Ok(true)
    }

    /// The supervisor that holds a run: one that an earlier study left and that is ending.
    fn held(&self, run: usize) -> Result<Option<String>> {
        let Some(folder) = self.folder.run(&self.planned[run].name)? else {
            return Ok(None);
        };
        Ok(folder.holder("supervisor")?)
    }
}

/// How far a run has come by what it has written.
fn so_far(planned: &Planned, folder: &StudyFolder, judging: Option<&Judging>) -> Result<Progress> {
    let mut progress = Progress {
        of: planned.target,
        ..Progress::default()
    };
    if records::stands(folder, &planned.name, judging)? {
        progress.done = planned.target;
    } else if let Some(run) = folder.run(&planned.name)?
        && let Some(figures) = metrics::newest(&run.metrics_path())?
            .as_ref()
            .and_then(Figures::read)
    {
        progress.done = figures.iteration;
        progress.pace = figures.timing.iteration_seconds;
    }
    Ok(progress)
}
