//! A group while it lives: who died, who is due, what they say, what the metrics say.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use protocol::Domain;
use run::metrics::Tail;
use rustix::process::{Pid, Signal, kill_process};
use terminal::console::Console;
use terminal::figures::{Outlook, Pace, clock};
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};
use tokio::time::{MissedTickBehavior, interval};
use wording::count;

use crate::child::{Child, Verdict, Words};
use crate::roles::{
    LEARNER, SCHEDULER, children, has_checkpoint, is_actor, learner_arguments, log,
};
use crate::{LOOK, Launch, Members, Reason, Stop, programs};

/// Between two looks at the metrics.
const GLANCE: Duration = Duration::from_millis(500);

pub(crate) struct Group<'a> {
    pub(super) launch: &'a Launch<'a>,
    pub(super) domain: Domain,
    pub(super) children: Vec<Child>,
    pub(super) words: UnboundedReceiver<Words>,
    pub(super) console: Console,
    tail: Tail,
    pub(super) pace: Pace,
    /// By role the last line of the present life on standard error.
    pub(super) said: BTreeMap<String, String>,
    /// By role the length of the log, in bytes, when the present life began.
    pub(super) logged: BTreeMap<String, u64>,
    pub(super) started: Instant,
    glanced: Instant,
    /// The end was asked for once more: nobody is waited for.
    pub(super) forced: bool,
}

impl<'a> Group<'a> {
    pub(super) fn new(launch: &'a Launch<'a>, domain: Domain) -> Result<Self> {
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

    pub(super) async fn watch(&mut self, stop: &mut Stop) -> Reason {
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
                Verdict::Done if child.role == self.launch.members.head() => {
                    return Ok(Some(Reason::Complete));
                }
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
    pub(super) fn alive(&self, meant: impl Fn(&str) -> bool) -> Vec<String> {
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

    pub(super) fn signal(&self, signal: Signal, meant: impl Fn(&str) -> bool) {
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

    pub(super) fn glance(&mut self) -> Result<()> {
        for line in self.tail.poll().context("following the metrics")? {
            self.pace.take(&line);
        }
        Ok(())
    }

    pub(super) fn show(&mut self, now: Instant) {
        if let Members::Guests { shown, .. } = self.launch.members {
            let path = self.launch.folder.path().join(shown);
            let line = std::fs::read_to_string(path).unwrap_or_default();
            let alive = count(self.alive(is_actor).len(), "actor");
            let time = clock(now - self.started);
            self.console
                .show(&format!("{line} · {alive} alive · {time}"), now);
            return;
        }
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

    pub(super) fn relay(&mut self, (role, line): &Words) {
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
