//! `ampco-gate`: the two ends of a run that spans machines. Normally started by `ampco train` and `ampco join`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Carries rollouts and weights between the machines of a run.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    end: End,
}

#[derive(Subcommand)]
enum End {
    /// On the learner's machine: lets other machines in
    Gate {
        /// Folder of the run, with its config.toml
        #[arg(long)]
        run_dir: PathBuf,
        /// Where to listen, ADDRESS:PORT
        #[arg(long)]
        listen: String,
        /// Actors on this machine: others get the numbers from here on
        #[arg(long, default_value_t = 0)]
        here: u32,
    },
    /// Makes the files by which a run and its hosts know each other, before the run begins
    Passes {
        /// Where: in its folder join/
        #[arg(long)]
        folder: PathBuf,
        /// Name of the run
        #[arg(long)]
        run: String,
    },
    /// On another machine: stands in for the learner
    Carrier {
        /// Folder that `ampco join` has made
        #[arg(long)]
        run_dir: PathBuf,
    },
}

fn main() -> ExitCode {
    let (name, done) = match Arguments::parse().end {
        End::Gate {
            run_dir,
            listen,
            here,
        } => ("gate", gate::gate::run(&run_dir, &listen, here)),
        End::Passes { folder, run } => ("passes", gate::gate::passes(&folder, &run)),
        End::Carrier { run_dir } => ("carrier", gate::carrier::run(&run_dir)),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("ampco-gate {name}: {error:#}");
            ExitCode::FAILURE
        }
    }
}
