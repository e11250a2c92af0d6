//! The process group: started, watched, restarted, ended in order, cleaned up after.
//!
//! One thread and one loop. The thread matters: the kernel ties a child's life to the thread that
//! started it. The loop waits for signals, for words of the children and for the next look.

#![forbid(unsafe_code)]

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitStatus;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use protocol::Domain;
use run::metrics::Tail;
use run::{FleetConfig, Folder, RunConfig};
use rustix::process::{Pid, Signal, kill_process};
use terminal::console::Console;
use terminal::figures::{Outlook, Pace, clock};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::time::{MissedTickBehavior, interval};
use wording::count;

use crate::child::{Child, Verdict, Words};

mod child;
mod ending;
mod orphans;
pub mod programs;
mod stop;

pub use stop::Stop;

/// Between two looks at the children.
const LOOK: Duration = Duration::from_millis(50);

/// Between two looks at the metrics.
const GLANCE: Duration = Duration::from_millis(500);

const LEARNER: &str = "learner";
const SCHEDULER: &str = "scheduler";

/// What is to be supervised.
#[derive(Debug)]
pub struct Launch<'a> {
    /// The run.
    pub folder: &'a Folder,
    /// How long it may take.
    pub run: &'a RunConfig,
    /// How many actors there are to be.
    pub fleet: &'a FleetConfig,
    /// Whether the learner goes on from a checkpoint.
    pub resume: bool,
}

/// Why the group ends.
#[derive(Debug)]
enum Reason {
    /// The learner has done all iterations.
    Complete,
    /// The minutes are over.
    TimeUp,
    /// Ctrl-C or SIGTERM.
    Asked,
    /// A process cannot be kept alive: its role and its last end.
    GivenUp(String, ExitStatus),
    /// Watching itself failed.
    Failed(anyhow::Error),
}

/// Starts the group, watches it to its end, and leaves nothing behind.
pub fn supervise(launch: &Launch<'_>) -> Result<()> {
    programs::runtime()?.block_on(async {
        let mut stop = Stop::install()?;
        let domain = Domain::for_run(launch.folder.path())?;
        orphans::clear(launch.folder, &domain).await?;
        let mut group = Group::new(launch, domain)?;
        let reason = group.watch(&mut stop).await;
        group.end(reason, &mut stop).await
    })
}

struct Group<'a> {
    launch: &'a Launch<'a>,
    domain: Domain,
    children: Vec<Child>,
    words: UnboundedReceiver<Words>,
    console: Console,
    tail: Tail,
    pace: Pace,
    /// By role the last line of the present life on standard error.
    said: BTreeMap<String, String>,
    /// By role the length of the log, in bytes, when the present life began.
    logged: BTreeMap<String, u64>,
    started: Instant,
    glanced: Instant,
    /// The end was asked for once more: nobody is waited for.
    forced: bool,
}

impl<'a> Group<'a> {
    fn new(launch: &'a Launch<'a>, domain: Domain) -> Result<Self> {
        let (sender, words) = unbounded_channel();
        let metrics = launch.folder.metrics_path();
        let now = Instant::now();
        Ok(Self {
            launch,
            domain,
            children: children(launch, &sender)?,
            words,
            console: Console::on_stderr(),
            tail: if launch.resume {
                Tail::from_end(&metrics)
            } else {
                Tail::from_start(&metrics)
            },
            pace: Pace::default(),
            said: BTreeMap::new(),
            logged: BTreeMap::new(),
            started: now,
            glanced: now,
            forced: false,
        })
    }

    async fn watch(&mut self, stop: &mut Stop) -> Reason {
        let mut looks = interval(LOOK);
        looks.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            tokio::select! {
                () = stop.requested() => return Reason::Asked,
                Some(words) = self.words.recv() => self.relay(&words),
                _ = looks.tick() => match self.look(Instant::now()) {
                    Ok(None) => {}
                    Ok(Some(reason)) => return reason,
                    Err(error) => return Reason::Failed(error),
                },
            }
        }
    }

    /// One look: who died, who is due, what the metrics say, whether time is up.
    fn look(&mut self, now: Instant) -> Result<Option<Reason>> {
        for index in 0..self.children.len() {
            let folder = self.launch.folder;
            let worked = |role: &str, pid| folder.has_worked(role, pid);
            let Some((status, verdict)) = self.children[index].died(now, worked)? else {
                continue;
            };
            let child = &mut self.children[index];
            let end = programs::describe(status);
            match verdict {
                Verdict::Done if child.role == LEARNER => return Ok(Some(Reason::Complete)),
                Verdict::Done if child.role == SCHEDULER => {
                    child.start_again_at(now);
                    self.console.say("scheduler ended; starting it again");
                }
                Verdict::Done => {
                    let message = format!("{} ended; the others go on", child.role);
                    self.console.say(&message);
                }
                Verdict::Restart(_) => {
                    child.restarts += 1;
                    let message = format!("{} {end}; restart {}", child.role, child.restarts);
                    self.console.say(&message);
                }
                Verdict::GiveUp => {
                    return Ok(Some(Reason::GivenUp(child.role.clone(), status)));
                }
            }
        }
        for child in &mut self.children {
            if child.is_due(now) {
                if child.role == LEARNER && child.restarts > 0 {
                    child.arguments = learner_arguments(self.launch, has_checkpoint(self.launch));
                }
                let log = log(self.launch.folder, &child.role);
                let length = std::fs::metadata(log).map_or(0, |facts| facts.len());
                self.logged.insert(child.role.clone(), length);
                self.said.remove(&child.role);
                child.start(now)?;
            }
        }
        if now - self.glanced >= GLANCE {
            self.glanced = now;
            self.glance()?;
            self.show(now);
        }
        let up = self.time_left(now).is_some_and(|left| left.is_zero());
        Ok(up.then_some(Reason::TimeUp))
    }

    /// The roles meant that are alive: our children, and actors that others have added.
    fn alive(&self, meant: impl Fn(&str) -> bool) -> Vec<String> {
        let ours = self.children.iter().filter(|child| child.is_running());
        let ours = ours.map(|child| child.role.clone());
        let others = self.others().into_iter().map(|(role, _)| role);
        ours.chain(others).filter(|role| meant(role)).collect()
    }

    /// Actors of this run that are not our children, with their process ids.
    fn others(&self) -> Vec<(String, String)> {
        // A folder that cannot be read now hides nobody for long: this is asked again and again.
        let mut holders = self.launch.folder.holders().unwrap_or_default();
        let ours = |role: &str| self.children.iter().any(|child| child.role == role);
        holders.retain(|(role, _)| is_actor(role) && !ours(role));
        holders
    }

    fn signal(&self, signal: Signal, meant: impl Fn(&str) -> bool) {
        for child in self.children.iter().filter(|child| meant(&child.role)) {
            child.signal(signal);
        }
        for (_, pid) in self.others().iter().filter(|(role, _)| meant(role)) {
            if let Some(pid) = pid.parse().ok().and_then(Pid::from_raw) {
                // It may have ended a moment ago.
                let _ = kill_process(pid, signal);
            }
        }
    }

    fn glance(&mut self) -> Result<()> {
        for line in self.tail.poll().context("following the metrics")? {
            self.pace.take(&line);
        }
        Ok(())
    }

    fn show(&mut self, now: Instant) {
        let outlook = Outlook {
            iterations: self.launch.run.iterations,
            actors_alive: self.alive(is_actor).len(),
            left: self.left(now),
        };
        let line = match &self.pace.newest {
            Some(figures) => figures.line(&outlook),
            None => format!(
                "no iteration yet · {} alive · {}",
                count(outlook.actors_alive, "actor"),
                clock(now - self.started)
            ),
        };
        self.console.show(&line, now);
    }

    /// Time until the end, whichever comes first.
    fn left(&self, now: Instant) -> Option<Duration> {
        let by_pace = self.pace.until(self.launch.run.iterations);
        [self.time_left(now), by_pace].into_iter().flatten().min()
    }

    /// Time until the minutes are over, if they are limited.
    fn time_left(&self, now: Instant) -> Option<Duration> {
        let minutes = self.launch.run.minutes;
        if minutes == 0.0 {
            return None;
        }
        let limit = Duration::from_secs_f64(minutes * 60.0);
        Some(limit.saturating_sub(now - self.started))
    }

    fn relay(&mut self, (role, line): &Words) {
        if !line.trim().is_empty() {
            self.said.insert(role.clone(), line.trim().to_owned());
        }
        if line.starts_with("ampco-") {
            self.console.say(line);
        } else {
            self.console.say(&format!("{role}: {}", line.trim_start()));
        }
    }
}

fn is_actor(role: &str) -> bool {
    role.starts_with("actor-")
}

/// Scheduler, learner and actors of a launch; any order would do.
fn children(launch: &Launch<'_>, words: &UnboundedSender<Words>) -> Result<Vec<Child>> {
    let child = |role: String, program: &str, arguments| -> Result<Child> {
        Ok(Child::new(
            role,
            programs::find(program)?,
            arguments,
            words.clone(),
        ))
    };
    let mut children = vec![
        child(
            SCHEDULER.to_owned(),
            "ampco-scheduler",
            run_dir(launch.folder),
        )?,
        child(
            LEARNER.to_owned(),
            "ampco-learner",
            learner_arguments(launch, launch.resume),
        )?,
    ];
    for index in 0..launch.fleet.actors {
        let mut arguments = run_dir(launch.folder);
        arguments.extend(["--index".into(), index.to_string().into()]);
        children.push(child(format!("actor-{index}"), "ampco-actor", arguments)?);
    }
    Ok(children)
}

fn learner_arguments(launch: &Launch<'_>, resume: bool) -> Vec<OsString> {
    let mut arguments = run_dir(launch.folder);
    if resume {
        arguments.push("--resume".into());
    }
    arguments
}

/// Where a role writes its log.
fn log(folder: &Folder, role: &str) -> PathBuf {
    folder.logs().join(format!("{role}.log"))
}

/// The argument that every program of the group takes.
pub fn run_dir(folder: &Folder) -> Vec<OsString> {
    vec!["--run-dir".into(), folder.path().into()]
}

fn has_checkpoint(launch: &Launch<'_>) -> bool {
    !launch.folder.checkpoints().list().is_empty()
}
