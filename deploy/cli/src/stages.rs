//! `ampco stages`: runs one after another, each beginning with the policy of the one before.
//!
//! Separate because what one run cannot learn from nothing a row of runs can, and whoever wants the last policy
//! should have to ask once. Every stage is a run like any other, trained by this same program.

mod conduct;
mod plan;

use anyhow::Result;
use clap::Args;
use terminal::{Place, console};

use plan::Plan;

/// Train in stages: each run begins with the policy of the one before
///
/// Finished stages stay, a half-finished one goes on from its last checkpoint: give the same command as often as you
/// like. Ctrl-C ends the present run in order. The runs are called after the stages.
#[derive(Debug, Args)]
pub(crate) struct Stages {
    /// Stages that come with the program, or a TOML file like those in deploy/stages/ [default: say which there are]
    #[arg(value_name = "NAME|FILE")]
    which: Option<String>,
    /// The runs are <NAME>-<stage> [default: the name of the stages' file]
    #[arg(long, value_name = "NAME")]
    run: Option<String>,
    #[command(flatten)]
    place: Place,
    /// Actor processes [default: one per core]
    #[arg(long, value_name = "N")]
    actors: Option<u32>,
    /// Set one value in every stage's configuration, as in seed=7; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Only say what would be run
    #[arg(long)]
    dry_run: bool,
}

impl Stages {
    pub(crate) fn run(&self) -> Result<()> {
        let Some(which) = &self.which else {
            return print(&plan::list());
        };
        let plan = Plan::new(which, self.run.as_deref(), self.actors, &self.set)?;
        if self.dry_run {
            return print(&plan.describe());
        }
        conduct::conduct(&plan, &self.place)
    }
}

/// Whether there are such stages and all that they name.
#[cfg(test)]
pub(crate) fn check(which: &str) -> Result<()> {
    Plan::new(which, None, None, &[]).map(drop)
}

fn print(text: &str) -> Result<()> {
    console::print(&format!("{text}\n"))
}
