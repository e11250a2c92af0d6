//! `ampco-actor`: one actor of a run's process group. Normally started by `ampco train`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

/// Simulates robots for a run and publishes their rollouts until it is told to stop.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Folder of the run, with its config.toml.
    #[arg(long)]
    run_dir: PathBuf,
    /// Number of this actor within the run; it seeds the actor's robots.
    #[arg(long, default_value_t = 0)]
    index: u32,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match actor::process::run(&arguments.run_dir, arguments.index) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ampco-actor {}: {error:#}", arguments.index);
            ExitCode::FAILURE
        }
    }
}
