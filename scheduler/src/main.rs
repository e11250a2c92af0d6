//! `ampco-scheduler`: the scheduler of a run's process group. Normally started by `ampco train`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

/// Decides phase and weighting for a run from its learner's reports until it is told to stop.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Folder of the run, with its config.toml.
    #[arg(long)]
    run_dir: PathBuf,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match scheduler::process::run(&arguments.run_dir) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ampco-scheduler: {error:#}");
            ExitCode::FAILURE
        }
    }
}
