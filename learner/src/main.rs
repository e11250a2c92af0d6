//! `ampco-learner`: the learner of a run's process group. Normally started by `ampco train`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;

// Tensors of a few megabytes come and go every step; glibc would map and unmap each of them.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Learns from a run's rollouts and broadcasts the policy's weights until it is told to stop.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Folder of the run, with its config.toml.
    #[arg(long)]
    run_dir: PathBuf,
    /// Go on from the newest good checkpoint instead of starting at iteration 0.
    #[arg(long)]
    resume: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match learner::process::run(&arguments.run_dir, arguments.resume) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ampco-learner: {error:#}");
            ExitCode::FAILURE
        }
    }
}
