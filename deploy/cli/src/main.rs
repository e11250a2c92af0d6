//! `ampco`: the one command. Trains, joins, looks, evaluates, imports motion, measures.
//!
//! Each subcommand is a module with its arguments and its `run`; this file only chooses.

#![forbid(unsafe_code)]

mod actor;
mod config;
mod export;
mod play;
mod plot;
#[cfg(test)]
mod readme;
mod stages;
mod status;
mod train;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use terminal::{console, failure};

// As in the learner: `bench learner` is to time the same program.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const EXAMPLES: &str = "\
Examples:
  ampco train                                     train with the default preset, until Ctrl-C
  ampco train --minutes 20 --run walk             twenty minutes, in runs/walk
  ampco train --run walk --resume --minutes 20    twenty more, from the last checkpoint
  ampco train --preset amp-0.5 --set seed=7       another method, another seed
  ampco train --set task.reward.track.kernel=2.0  any key of the configuration
  ampco config g1 --diff ampco                    what is another in it, key by key
  ampco stages pushed                             runs in a row, each from the one before
  ampco status                                    the newest run: how it is going
  ampco actor --run walk                          lend another core to a running group
  ampco join node1:7000 --file walk.join          simulate for a run on another machine
  ampco evaluate walk --command 0.8,0,0 --json    how well the policy walks
  ampco evaluate walk --suite standard            everything it should be able to do, as a report
  ampco judge my-run walk --out judge             which walks more like the reference, by a fresh judge
  ampco plot walk                                 its learning curves, as SVG
  ampco motions import 02_01.amc --out walks      motion capture, onto the robot
  ampco export walk --out walk-policy             policy.onnx and all that a robot needs
  ampco play walk --html walk.html                a page that plays it
  ampco study run deploy/studies/flagship.toml    four methods, six seeds, in the paper's tables
  ampco bench sim                                 how fast this machine simulates
  ampco soak --kills 500                          kill at random, and see that nothing is lost

A run lives in runs/<name>/: config.toml (every value, defaults included), metrics.jsonl (a line per
iteration), logs/, checkpoints/. Exit status: 0 done, 1 failed, 2 bad arguments or configuration.";

/// Teaches the 23-joint Unitree G1 to walk, from reference motion and a task, on ordinary cores.
#[derive(Parser)]
#[command(name = "ampco", version, after_help = EXAMPLES, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Train(train::Train),
    Stages(stages::Stages),
    Config(config::Show),
    Actor(actor::AddActor),
    Join(gate::JoinRun),
    Status(status::Status),
    Evaluate(judge::Evaluate),
    Judge(judge::Fresh),
    Plot(plot::Plot),
    Motions(motions::Motions),
    Export(export::Export),
    Play(play::Play),
    Study(conduct::Study),
    Bench(bench::Bench),
    Soak(soak::Soak),
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    // This is the first thing that could set a log up, so it cannot be refused.
    let _ = run::log::init_console();
    let done = match arguments.command {
        Command::Train(train) => train.run(),
        Command::Stages(stages) => stages.run(),
        Command::Config(config) => config.run(),
        Command::Actor(actor) => actor.run(),
        Command::Join(join) => join.run(),
        Command::Status(status) => status.run(),
        Command::Evaluate(evaluate) => evaluate.run(),
        Command::Judge(judge) => judge.run(),
        Command::Plot(plot) => plot.run(),
        Command::Motions(motions) => motions.run(),
        Command::Export(export) => export.run(),
        Command::Play(play) => play.run(),
        Command::Study(study) => study.run(),
        Command::Bench(bench) => bench.run(),
        Command::Soak(soak) => soak.run(),
    };
    match done.and_then(|()| console::finish_results()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::say(&format!("ampco: {error:#}"));
            failure::exit_code(&error)
        }
    }
}
