//! `ampco motions`: reference motion, from files of any format to a folder to train on.
//!
//! Each subcommand is a file of its own with its arguments and its `run`; what they share (which files,
//! read how, shown how) has files beside them.

#![forbid(unsafe_code)]

mod check;
mod files;
mod import;
mod inspect;
mod mirror;
mod output;
mod plots;
mod report;
mod synth;
mod table;

use anyhow::Result;
use clap::{Args, Subcommand};

const EXAMPLES: &str = "\
Examples:
  ampco motions import CMU/02 --out walks               CMU's .amc with the .asf beside them
  ampco motions import LAFAN1/*.bvh --out lafan         human captures, retargeted
  ampco motions import unitree/*.csv --fps 30 --out g1  Unitree's tables of the G1
  ampco motions inspect walks --plots plots             figures and SVG plots of each clip
  ampco motions check walks                             is it balanced over speeds, is it sound?
  ampco train --set 'motion.clips=[{folder=\"walks\"}]'   train on it

Formats are told by content: AMASS and SMPL-X .npz, BVH, ASF/AMC, tables of the G1 (.csv),
BeyondMimic .npz, Isaac Lab .npz, Isaac Gym .npy, GMR .pkl, ASAP, PBHC and PHC .pkl, MimicKit .pkl,
ProtoMotions .motion and .pt, amp-rsl-rl .npy and .npz, DeepMimic and TienKung-Lab .json and .txt.";

/// Import, measure, make and mirror reference motion
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Motions {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// Turn motion files of any known format into clips of the G1 at 50 Hz
    Import(import::Import),
    /// Show what clips are like: speeds, contacts, ranges, quality
    Inspect(inspect::Inspect),
    /// Write the built-in gait at given speeds as clips
    Synth(synth::Synth),
    /// Check a set of clips: balance over speeds, defects; exit status 1 if any makes a clip unfit
    Check(check::Check),
    /// Write clips with left and right swapped
    Mirror(mirror::Mirror),
}

impl Motions {
    /// Does what was asked for.
    pub fn run(&self) -> Result<()> {
        match &self.action {
            Action::Import(import) => import.run(),
            Action::Inspect(inspect) => inspect.run(),
            Action::Synth(synth) => synth.run(),
            Action::Check(check) => check.run(),
            Action::Mirror(mirror) => mirror.run(),
        }
    }
}
