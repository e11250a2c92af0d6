//! `ampco evaluate`: how well a policy walks, by the definitions of III-F and by its gait.
//!
//! `--stress` tries it under what a real robot and a real floor do (`stress`); `--stress help` lists them:
//!
//! | stress | default | what |
//! | --- | --- | --- |
//! | `delay` | 20 ms | actions reach the motors later |
//! | `gains`, `strength` | 0.8, 0.9 times | of the motors: both gains, greatest torque |
//! | `payload` | 4 kg | on the torso |
//! | `friction`, `slope`, `bumps` | 0.3, 5°, 2 cm | of the floor |
//! | `push` | 250 N | on the trunk for 50 ms, every 3 to 5 s |
//! | `encoder`, `imu` | 0.02 rad, 2° | joints read wrong, the IMU stands aslant |
//! | `dry` | 1 N·m | dry friction in every joint |
//! | `velocity` | 0 | share of the pelvis' velocity and change of height that the policy is told |
//! | `commands` | 2 s | another command as often |
//!
//! The policy acts without noise. A robot that fell counts until it fell. Episodes are spread over
//! threads; the seed alone decides the result.

#![forbid(unsafe_code)]

mod command;
mod episodes;
mod fresh;
mod judge;
mod outcome;
mod pictures;
mod progress;
mod reference;
mod relearned;
mod report;
mod scenario;
mod spread;
mod stress;
mod subject;
mod table;
mod tally;
mod windows;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::builder::PossibleValuesParser;
use serde_json::Value;
use sim::GroundConfig;
use sim::randomization::ROWS;
use terminal::console::{self, Console};
use terminal::failure::usage;
use terminal::{Engine, Place, SelfCollision};

pub use command::Command;
use episodes::{Conditions, Unit, Walker};
pub use fresh::Fresh;
pub use judge::Judge;
use progress::Progress;
use report::Report;
use scenario::Scenario;
use stress::Stresses;
pub use subject::{Kept, Subject};
use tally::Tally;

const LONG: &str = "\
Walk with a trained policy: survival, velocity errors, energy, style, gait

The policy acts without exploration noise. Each command is tried by a number of robots, from standing,
without randomisation. `--suite standard` tries everything that a policy should be able to do: speeds
from 0 to 2 m/s, backwards, sideways, turning on the spot, at a walk and at a run, changes of the command,
pushes, from standing and from reference frames, with and without Table I.

A gait is good if it is what the whole command asks for, forward, aside and in turning, once two seconds have
passed since the start or a new command.

Style is the reward of a discriminator (Eq. 7). Every run trains its own, and a run whose discriminator
learnt little finds itself graceful. To compare runs, let one judge them all with --judge. A judge is a
checkpoint that is kept and never trained on, best of a long run that walks well:

  cp -r runs/walk/checkpoints/00000400 judge
  ampco evaluate other-run --judge judge";

/// Walk with a trained policy: survival, velocity errors, energy, style, gait
#[derive(Debug, clap::Args)]
#[command(long_about = LONG)]
pub struct Evaluate {
    /// A run's name or folder, a checkpoint's folder, or the folder of a shipped policy
    #[arg(required_unless_present = "stress")]
    run: Option<String>,
    #[command(flatten)]
    place: Place,
    /// Command to follow: forward and leftward velocity in m/s, yaw rate in rad/s; may be repeated
    /// [default: 0.5,0,0 and 1,0,0]
    #[arg(long = "command", value_name = "VX,VY,WZ", allow_hyphen_values = true)]
    commands: Vec<Command>,
    /// Try a whole suite of scenarios and write report.json, report.md and plots
    #[arg(long, value_name = "NAME", conflicts_with_all = ["commands", "randomize", "from_reference"])]
    suite: Option<Suite>,
    /// Folder for the report and the plots [default with --suite: RUN/evaluation/SUITE]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Score style by the discriminator of this checkpoint instead of the policy's own
    #[arg(long, value_name = "CHECKPOINT")]
    judge: Option<String>,
    /// Length of an episode
    #[arg(long, value_name = "S", default_value_t = 20.0)]
    seconds: f64,
    /// Episodes per command or scenario
    #[arg(long, value_name = "N", default_value_t = 32)]
    episodes: usize,
    /// Apply every row of the paper's domain randomisation (Table I)
    #[arg(long)]
    randomize: bool,
    /// Apply only this row of Table I, as the configuration names it; may be repeated. Tells which of
    /// them a robot cannot bear
    #[arg(long = "row", value_name = "ROW", conflicts_with_all = ["randomize", "suite"], value_parser = PossibleValuesParser::new(ROWS))]
    rows: Vec<String>,
    /// Try each command under what real robots and floors do: stresses by name, as in delay=20,push or standard;
    /// `--stress help` lists them
    #[arg(long, value_name = "LIST", conflicts_with_all = ["randomize", "rows", "suite"])]
    stress: Option<Stresses>,
    /// Begin in frames of the reference motion nearest to the command instead of standing
    #[arg(long)]
    from_reference: bool,
    /// Engine that judges, whatever the policy was trained in
    #[arg(long, value_enum, default_value_t = Engine::Rapier)]
    physics: Engine,
    /// Whether legs, arms and trunk meet each other, whatever the policy was trained with
    #[arg(long, value_enum, default_value_t = SelfCollision::On)]
    self_collision: SelfCollision,
    /// Walk on hills with slopes up to so many degrees in every direction, at most 5. Without it and --bumps the floor
    /// is level, whatever the policy was trained on
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    slope: f32,
    /// Walk over bumps of up to so many metres, at most 0.02
    #[arg(long, value_name = "M", default_value_t = 0.0)]
    bumps: f32,
    /// Seed of the episodes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads that simulate; the result does not depend on it [default: one per core]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// End with JSON: an array with an object per command, or the suite's report
    #[arg(long)]
    json: bool,
}

/// A named list of scenarios.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Suite {
    /// All that a policy should be able to do
    Standard,
}

const DEFAULT_COMMANDS: [Command; 2] = [Command([0.5, 0.0, 0.0]), Command([1.0, 0.0, 0.0])];

impl Evaluate {
    /// Walks, and prints and writes how well.
    pub fn run(&self) -> Result<()> {
        if self.stress == Some(Stresses::Help) {
            return console::print(&stress::explained());
        }
        let run = self
            .run
            .as_deref()
            .ok_or_else(|| usage("give a run: its name, its folder, or that of a checkpoint"))?;
        let conditions = self.conditions()?;
        let mut subject = Subject::open(&self.place, run)?;
        subject.mechanics = self.self_collision.within(self.physics);
        subject.task.ground = self.ground()?;
        let given = self.judge.as_deref();
        let frozen = given
            .map(|judge| Kept::open(&self.place, judge))
            .transpose()
            .context("opening the judge of --judge")?;
        let scenarios = self.scenarios();
        let out = self.out(&subject);
        let judge = frozen.as_ref().unwrap_or(&subject.kept);
        let tallies = self.try_all(&subject, judge, &scenarios, &conditions)?;
        let report = Report::of(
            &subject,
            frozen.as_ref(),
            self.suite_name(),
            &scenarios,
            &tallies,
            &conditions,
        );
        if let Some(folder) = &out {
            report.write(folder)?;
            pictures::write(folder, &scenarios, &tallies, &conditions)?;
        }
        self.print(&report, out.as_deref())
    }

    fn conditions(&self) -> Result<Conditions> {
        let (seconds, episodes) = (self.seconds, self.episodes);
        if !(0.02..=3_600.0).contains(&seconds) {
            return Err(usage(format!("--seconds {seconds}: give 0.02 to 3600")));
        }
        if !(1..=4_096).contains(&episodes) {
            return Err(usage(format!("--episodes {episodes}: give 1 to 4096")));
        }
        if self.threads == Some(0) {
            return Err(usage("--threads 0: give at least 1"));
        }
        Ok(Conditions {
            steps: (seconds * tally::CONTROL_HZ).round() as u32,
            episodes,
            seed: self.seed,
            traced: self.suite.is_some() || self.out.is_some(),
        })
    }

    /// What the robots walk on; none for a level floor.
    fn ground(&self) -> Result<Option<GroundConfig>> {
        let ground = GroundConfig {
            slope: self.slope,
            bumps: self.bumps,
        };
        ground.validate().map_err(|invalid| {
            let (path, value, remedy) = (invalid.path, invalid.value, invalid.remedy);
            usage(format!("--{path} {value}: {remedy}"))
        })?;
        Ok((ground != GroundConfig::default()).then_some(ground))
    }

    fn scenarios(&self) -> Vec<Scenario> {
        if let Some(Suite::Standard) = self.suite {
            return scenario::standard();
        }
        let commands: &[Command] = match self.commands.as_slice() {
            [] => &DEFAULT_COMMANDS,
            given => given,
        };
        let rows = if self.randomize {
            ROWS.map(str::to_owned).to_vec()
        } else {
            self.rows.clone()
        };
        let scenario = |&Command(command): &Command| Scenario {
            from_reference: self.from_reference,
            rows: rows.clone(),
            ..Scenario::holding(command.map(|x| x.to_string()).join(","), command)
        };
        let plain: Vec<Scenario> = commands.iter().map(scenario).collect();
        match &self.stress {
            Some(Stresses::Rows(rows)) => plain
                .iter()
                .flat_map(|scenario| rows.iter().map(|row| scenario.under(row)))
                .collect(),
            _ => plain,
        }
    }

    fn suite_name(&self) -> &'static str {
        match self.suite {
            Some(Suite::Standard) => "standard",
            None if self.stress.is_some() => "stress",
            None => "commands",
        }
    }

    /// Where the report goes, if anywhere.
    fn out(&self, subject: &Subject) -> Option<PathBuf> {
        let of_suite = || {
            self.suite
                .map(|_| subject.kept.evaluations().join(self.suite_name()))
        };
        self.out.clone().or_else(of_suite)
    }

    /// All episodes of all scenarios: a tally each.
    fn try_all(
        &self,
        subject: &Subject,
        judge: &Kept,
        scenarios: &[Scenario],
        conditions: &Conditions,
    ) -> Result<Vec<Tally>> {
        let units: Vec<(usize, Unit<'_>)> = scenarios
            .iter()
            .enumerate()
            .flat_map(|(index, scenario)| {
                episodes::units(scenario, conditions).map(move |unit| (index, unit))
            })
            .collect();
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let progress = Progress::new(units.iter().map(|(_, unit)| unit.episodes), conditions);
        let mut console = Console::on_stderr();
        let parts = spread::spread(
            &units,
            self.threads.unwrap_or(cores),
            || Walker::new(subject, judge),
            |walker, (_, unit)| {
                let before = progress.of_unit(unit.episodes);
                let walked = walker.walk(unit, conditions, |robots| before.step(robots));
                walked.with_context(|| format!("trying {}", unit.scenario.name))
            },
            || console.show(&progress.line(), Instant::now()),
        );
        console.finish();
        let mut tallies = vec![Tally::default(); scenarios.len()];
        // In the order of the episodes, so that the sums round alike whoever did them.
        for ((index, _), part) in units.iter().zip(parts?) {
            tallies[*index].merge(part);
        }
        Ok(tallies)
    }

    fn print(&self, report: &Report, out: Option<&std::path::Path>) -> Result<()> {
        let mut text = if self.json {
            let value = match self.suite {
                Some(_) => serde_json::to_value(report)?,
                None => Value::Array(report.rows()?),
            };
            value.to_string()
        } else {
            report.text()
        };
        if let Some(folder) = out.filter(|_| !self.json) {
            text.push_str(&format!("\n\nwritten to {}", folder.display()));
        }
        text.push('\n');
        console::print(&text)
    }
}
