//! `ampco bench`: how fast this machine does each part.
//!
//! Each benchmark is a file of its own that returns one JSON object; this file prints it as the
//! last line of standard output, so that scripts read that line and people read what is above.

#![forbid(unsafe_code)]

mod fidelity;
mod ipc;
mod learner;
mod products;
mod scheduler;
mod sim;

use anyhow::{Context, Result};
use clap::{Args, Subcommand};
use serde_json::Value;
use terminal::console;

/// Measure one part on this machine; the last line printed is a JSON object
#[derive(Debug, Args)]
pub struct Bench {
    #[command(subcommand)]
    part: Part,
}

#[derive(Debug, Subcommand)]
enum Part {
    /// Physics and inference: control steps per second and core
    Sim(sim::SimBench),
    /// Physics: errors of the engines against converged solutions
    Fidelity(fidelity::FidelityBench),
    /// Learning: milliseconds per step, samples per second of a whole iteration
    Learner(learner::LearnerBench),
    /// Messages: wake-up time, throughput, time until new weights are adopted
    Ipc(ipc::IpcBench),
    /// Scheduling: microseconds per decision
    Scheduler(scheduler::SchedulerBench),
}

impl Bench {
    /// Measures, and prints a JSON object.
    pub fn run(&self) -> Result<()> {
        let (part, result) = match &self.part {
            Part::Sim(bench) => ("sim", bench.run()),
            Part::Fidelity(bench) => ("fidelity", bench.run()),
            Part::Learner(bench) => ("learner", bench.run()),
            Part::Ipc(bench) => ("ipc", bench.run()),
            Part::Scheduler(bench) => ("scheduler", bench.run()),
        };
        let result = result.with_context(|| format!("measuring {part}"))?;
        print(&result)
    }
}

fn print(result: &Value) -> Result<()> {
    console::print(&format!("{result}\n"))
}
