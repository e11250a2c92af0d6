//! `ampco soak`: trains, kills at random, and tells whether anything was lost.
//!
//! It is one more process outside the group, which it sees as a user does: roles, metrics,
//! checkpoints, files. What became of every rollout it reads at the end from the journals that actors
//! and learner have written.

#![forbid(unsafe_code)]

mod figures;
mod group;
mod guest;
mod outcome;

use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use clap::Args;
use protocol::Shutdown;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use run::Folder;
use terminal::Place;
use terminal::console::{self, say};
use terminal::failure::usage;
use wording::count;

use figures::Figures;
use group::Group;
use outcome::{Outcome, Victim};

/// Kills, when neither number nor time is given.
const KILLS: u64 = 20;

/// A week.
const LONGEST_MINUTES: f64 = 10_080.0;

/// Between two looks at the group.
const LOOK: Duration = Duration::from_millis(20);

/// Longest pause of a whole group before the next kill, seconds.
const LONGEST_PAUSE: f64 = 1.5;

/// Share of kills after which another follows before the group can be whole again.
const DOUBLE_BLOWS: f64 = 0.25;

/// A group that takes longer will not become whole any more.
const GIVEN_UP: Duration = Duration::from_secs(60);

/// In this time a group must be whole again.
const PROMISED_SECONDS: f64 = 5.0;

/// Kill processes of a training group at random and see that nothing is lost; prints one JSON object
///
/// Ends when the kills are done or the minutes over, whichever comes first; with --kills 0 it only
/// trains and records memory and descriptors of every process, in runs/<name>/soak.jsonl. Exit
/// status 1 if the group took longer than 5 s to be whole, a rollout is unaccounted for, an earlier
/// checkpoint than the newest was gone on from, or anything is left at the end.
#[derive(Debug, Args)]
pub struct Soak {
    /// End after so many minutes
    #[arg(long, value_name = "M")]
    minutes: Option<f64>,
    /// Kill so many processes [default: 20 unless --minutes is given]
    #[arg(long, value_name = "N")]
    kills: Option<u64>,
    /// Seed of victims and moments
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Preset of the group
    #[arg(long, value_name = "NAME|FILE", default_value = "smoke")]
    preset: String,
    /// Actor processes
    #[arg(long, value_name = "N", default_value_t = 2)]
    actors: u32,
    /// Hosts that join over loopback, each with as many actors as there are on the learner's machine
    #[arg(long, value_name = "N", default_value_t = 0)]
    hosts: u32,
    /// Set one value of the group's configuration; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    place: Place,
}

impl Soak {
    /// Trains, kills, and prints what became of it.
    pub fn run(&self) -> Result<()> {
        let is_time = |minutes: f64| minutes > 0.0 && minutes <= LONGEST_MINUTES;
        if self.minutes.is_some_and(|minutes| !is_time(minutes)) {
            return Err(usage(format!(
                "--minutes is a time; give more than 0 and at most {LONGEST_MINUTES}"
            )));
        }
        let shutdown = Shutdown::on_signals()?;
        let mut session = Session::begin(self, &shutdown)?;
        let went = session.go(self);
        if let Err(problem) = &went {
            say(&format!("{problem:#}"));
        }
        let outcome = session.end(self.ends_early())?;
        console::print(&format!("{}\n", outcome.json()))?;
        went?;
        let failures = outcome.failures();
        if !failures.is_empty() {
            bail!("{}", failures.join("; "));
        }
        Ok(())
    }

    /// How many kills there are to be; none for as many as fit.
    fn kills(&self) -> Option<u64> {
        match (self.kills, self.minutes) {
            (None, None) => Some(KILLS),
            (kills, _) => kills,
        }
    }

    fn time(&self) -> Option<Duration> {
        let minutes = match (self.kills, self.minutes) {
            (Some(0), None) => Some(1.0),
            (_, minutes) => minutes,
        };
        minutes.map(|minutes| Duration::from_secs_f64(minutes * 60.0))
    }

    /// Whether memory can have settled before the end.
    fn ends_early(&self) -> bool {
        self.time().is_none_or(|time| time < figures::SETTLED * 2)
    }
}

/// A soak under way.
struct Session<'a> {
    shutdown: &'a Shutdown,
    group: Group,
    figures: Figures,
    generator: Pcg64Mcg,
    kills: u64,
    restarts: u64,
    longest: f64,
    victims: Vec<Victim>,
}

impl<'a> Session<'a> {
    fn begin(soak: &Soak, shutdown: &'a Shutdown) -> Result<Self> {
        let group = Group::launch(soak)?;
        say(&format!(
            "soak of run {} in {}",
            group.folder.name(),
            group.folder.path().display()
        ));
        Ok(Self {
            figures: Figures::begin(&group.folder)?,
            group,
            shutdown,
            generator: Pcg64Mcg::seed_from_u64(soak.seed),
            kills: 0,
            restarts: 0,
            longest: 0.0,
            victims: Vec::new(),
        })
    }

    fn go(&mut self, soak: &Soak) -> Result<()> {
        self.until_whole()?;
        self.restarts = 0;
        let began = Instant::now();
        let over = |session: &Self| {
            session.shutdown.requested()
                || soak.time().is_some_and(|time| began.elapsed() >= time)
                || soak
                    .kills()
                    .is_some_and(|kills| kills > 0 && session.kills >= kills)
        };
        while !over(self) {
            let pause = Duration::from_secs_f64(self.generator.random_range(0.0..LONGEST_PAUSE));
            self.rest(pause)?;
            if soak.kills() == Some(0) || over(self) {
                self.group.check()?;
                continue;
            }
            self.kill();
            let more = soak.kills().is_none_or(|kills| self.kills < kills);
            if more && self.generator.random_bool(DOUBLE_BLOWS) {
                let moment = self.generator.random_range(0.0..1.0);
                self.rest(Duration::from_secs_f64(moment))?;
                self.kill();
            }
            let took = self.until_whole()?;
            self.longest = self.longest.max(took.as_secs_f64());
        }
        Ok(())
    }

    /// Kills whoever is drawn.
    fn kill(&mut self) {
        let roles = self.group.roles();
        let role = roles[self.generator.random_range(0..roles.len())].clone();
        let victim = Victim::of(&self.group.folder, &role);
        if self.group.kill(&role) {
            self.kills += 1;
            self.victims.push(victim);
            if self.kills.is_multiple_of(50) {
                let longest = self.longest;
                say(&format!(
                    "{}, longest recovery {longest:.1} s",
                    count(self.kills, "kill")
                ));
            }
        }
    }

    /// Waits until the group is whole again, and says how long that took.
    fn until_whole(&mut self) -> Result<Duration> {
        let began = Instant::now();
        while !self.group.is_whole()? {
            if began.elapsed() > GIVEN_UP {
                self.longest = GIVEN_UP.as_secs_f64();
                bail!(
                    "after {GIVEN_UP:?} still missing: {}",
                    self.group.missing().join(", ")
                );
            }
            if self.shutdown.requested() {
                bail!("interrupted");
            }
            self.look();
        }
        self.restarts += self.group.new_lives();
        Ok(began.elapsed())
    }

    fn rest(&mut self, time: Duration) -> Result<()> {
        let began = Instant::now();
        while began.elapsed() < time && !self.shutdown.requested() {
            self.group.tend()?;
            self.look();
        }
        Ok(())
    }

    fn look(&mut self) {
        if let Err(error) = self.figures.take_when_due(&self.group.folder) {
            tracing::warn!(%error, "figures not recorded");
        }
        std::thread::sleep(LOOK);
    }

    fn end(mut self, early: bool) -> Result<Outcome> {
        self.group.end()?;
        if !early {
            say(&self.figures.summary());
        }
        let guests = self.group.guests.iter();
        let guests: Vec<Folder> = guests.filter_map(|guest| guest.folder()).collect();
        Outcome::of(
            &self.group.folder,
            &guests,
            self.kills,
            self.restarts,
            self.longest,
            &self.victims,
        )
    }
}
