//! `ampco train --resume`: what a run goes on with.
//!
//! Separate because here two configurations meet, that of the checkpoint and the one that is asked for now. All that the
//! checkpoint cannot take is refused before a byte is written, so that a mistake leaves the run as it was.

use anyhow::{Context, Result};
use configuration::{presets, resolve};
use run::checkpoint::CONFIG;
use run::resume::{self, Change};
use run::{Checkpoint, Config, FleetConfig, Folder, RunConfig, metrics};
use serde::Deserialize;
use terminal::console::say;
use terminal::failure::usage;
use wording::count;

use super::{Ready, Train, check};

/// What a run goes on from.
pub(super) struct GoingOn {
    iteration: u64,
    /// What changes from here on.
    changes: Vec<Change>,
    /// Why a newer checkpoint is not gone on from, if there is one.
    passed_over: Option<String>,
    /// Why the checkpoint's robots are left behind, if they are.
    anew: Option<String>,
    /// The configuration so far, for a checkpoint of an older program, which has none of its own.
    note: Option<Config>,
}

impl Train {
    pub(super) fn resumed(&self) -> Result<Ready> {
        let folder = self.place.find(self.run.as_deref())?;
        let before = present(&folder)?;
        let mut config = before.clone();
        if let Some(name) = &self.preset {
            let notices = presets::lay_over(&mut config, name)?;
            notices.iter().for_each(|notice| say(notice));
        }
        self.apply(&mut config)?;
        resolve::anchor_files(&mut config)?;
        let resolved = resolve::resolve(&mut config)?;
        let going_on = if folder.checkpoints().list().is_empty() {
            say("there is no checkpoint yet: the run begins anew");
            None
        } else {
            let checkpoint = folder.checkpoints().open_whole(None)?;
            let going_on = going_on(&folder, &checkpoint, before, &config)?;
            has_more_to_do(&folder, going_on.iteration, &config, &resolved.run)?;
            Some(going_on)
        };
        let motion = check(&config, &resolved)?;
        Ok(Ready {
            folder,
            config,
            resolved,
            motion,
            going_on,
        })
    }
}

impl Ready {
    /// Iterations done.
    pub(super) fn iteration(&self) -> u64 {
        self.going_on
            .as_ref()
            .map_or(0, |going_on| going_on.iteration)
    }

    /// In which files the motion is no longer what the checkpoint was learned from.
    fn motion_differences(&self) -> Result<Vec<String>> {
        let learned = self.folder.motion()?;
        let before = run::motion::at(&learned, self.iteration());
        Ok(before.map_or_else(Vec::new, |before| {
            run::motion::differences(before, &self.motion)
        }))
    }

    /// Says what changes, and makes a checkpoint of an older program tell its configuration before the run's is replaced.
    pub(super) fn tell(&self) -> Result<()> {
        let Some(going_on) = &self.going_on else {
            return Ok(());
        };
        if let Some(passed_over) = &going_on.passed_over {
            say(passed_over);
        }
        // What is asked for now counts in the iteration after the checkpoint's.
        let at = going_on.iteration + 1;
        for change in &going_on.changes {
            say(&format!("from iteration {at} on: {change}"));
        }
        if let Some(anew) = &going_on.anew {
            say(&format!("from iteration {at} on: {anew}"));
        }
        for change in self.motion_differences()? {
            say(&format!(
                "from iteration {at} on: the reference motion is another, {change}"
            ));
        }
        if let Some(before) = &going_on.note {
            let at = self.folder.checkpoints().path(going_on.iteration);
            let path = at.join("config.toml");
            let comment = "The configuration under which this checkpoint was trained.";
            before.write(&path, comment)?;
        }
        Ok(())
    }
}

/// The configuration as it lies in the run's folder. One that was damaged is mended from its checkpoint.
fn present(folder: &Folder) -> Result<Config> {
    folder.config().map_err(|error| {
        let checkpoint = folder.checkpoints().open_whole(None);
        let own = checkpoint.map(|checkpoint| (checkpoint.iteration, checkpoint.part(CONFIG).is_some()));
        let remedy = match own {
            Ok((iteration, true)) => format!(
                "; the configuration under which its checkpoint was trained is {}: copy that over it",
                folder.checkpoints().path(iteration).join(CONFIG).display()
            ),
            _ => String::new(),
        };
        usage(format!("{:#}{remedy}", anyhow::Error::from(error)))
    })
}

/// What changes between a checkpoint and the configuration that is asked for, which `before` was before that.
fn going_on(
    folder: &Folder,
    checkpoint: &Checkpoint,
    before: Config,
    config: &Config,
) -> Result<GoingOn> {
    let iteration = checkpoint.iteration;
    let own = checkpoint.config()?;
    let note = own.is_none().then(|| before.clone());
    let mut learned = own.unwrap_or(before);
    let was = resolve::resolve(&mut learned)
        .with_context(|| format!("reading the configuration of checkpoint {iteration}"))?;
    let mut phase = Ok(1);
    let in_phase_two = || {
        phase = phase_at(folder, iteration);
        !matches!(phase, Ok(1))
    };
    let checked = resume::check(&learned, config, in_phase_two);
    phase.context("looking for the phase of the run")?;
    let changes = checked.map_err(|refused| usage(format!("run {}: {refused}", folder.name())))?;
    Ok(GoingOn {
        iteration,
        changes,
        passed_over: passed_over(folder, iteration)?,
        anew: left_behind(&was.fleet, &config.section()?),
        note,
    })
}

/// Why the robots of a checkpoint do not fit the fleet that goes on, if they do not: the same as actors find.
fn left_behind(was: &FleetConfig, is: &FleetConfig) -> Option<String> {
    let mut why = Vec::new();
    if was.physics != is.physics {
        why.push(format!(
            "they are in {}, and it is {} now",
            engine(was),
            engine(is)
        ));
    }
    let [before, now] = [was, is].map(FleetConfig::environments_per_actor);
    if before != now {
        let before = count(before, "environment");
        why.push(format!("each actor had {before}, and it has {now} now"));
    }
    (!why.is_empty()).then(|| {
        let why = why.join("; ");
        format!("the checkpoint's robots are left behind, new episodes begin: {why}")
    })
}

/// The engine of a fleet as it is written.
fn engine(fleet: &FleetConfig) -> String {
    format!("{:?}", fleet.physics).to_lowercase()
}

/// Refuses an end that the run has passed: there would be nothing to do, and "complete" would pass for an answer.
fn has_more_to_do(folder: &Folder, iteration: u64, config: &Config, run: &RunConfig) -> Result<()> {
    let end = run.iterations;
    if end == 0 || iteration < end {
        return Ok(());
    }
    if iteration == end {
        say(&format!(
            "run {} has reached its end already, iteration {end}; give a greater --iterations to go on",
            folder.name()
        ));
        return Ok(());
    }
    let origin = config.origin("run.iterations").unwrap_or("the defaults");
    Err(usage(format!(
        "run {} is at iteration {iteration}, past the end that run.iterations = {} sets ({origin}); give the iteration to end \
         at, counted from the run's first, as in --iterations {}, or --minutes",
        folder.name(),
        run.iterations,
        iteration + 100,
    )))
}

/// Why a run goes on from this iteration although a newer checkpoint is good by itself: what actors were to add to it is
/// missing or damaged, and with it the exact continuation.
fn passed_over(folder: &Folder, iteration: u64) -> Result<Option<String>> {
    let checkpoints = folder.checkpoints();
    let newest = checkpoints.open_newest(None)?;
    Ok((newest.iteration > iteration).then(|| {
        format!(
            "checkpoint {} is passed over ({}): the run goes on from iteration {iteration}, and does anew what came after",
            newest.iteration,
            checkpoints.lacks(&newest).join("; ")
        )
    }))
}

/// The phase that the metrics tell of an iteration, or of the newest before it.
fn phase_at(folder: &Folder, iteration: u64) -> Result<u32> {
    #[derive(Deserialize)]
    struct Line {
        iteration: u64,
        // A refused iteration has none.
        phase: Option<u32>,
    }
    let lines: Vec<Line> = metrics::read(&folder.metrics_path())?;
    let told = lines.iter().filter(|line| line.iteration <= iteration);
    Ok(told.filter_map(|line| line.phase).next_back().unwrap_or(1))
}

#[cfg(test)]
mod tests;
