//! `ampco evaluate`: how well a policy walks.

use std::str::FromStr;

use anyhow::{Result, bail};
use clap::Args;

use crate::place::Place;

/// Measure how well a policy follows commands: survival, velocity error, energy, style
///
/// The policy acts without exploration noise. Each command is tried from standing by a number of
/// robots at once.
#[derive(Debug, Args)]
pub(crate) struct Evaluate {
    /// A run's name or folder, a checkpoint's folder, or the folder of a shipped policy
    run: String,
    #[command(flatten)]
    place: Place,
    /// Command to follow: forward and leftward velocity in m/s, yaw rate in rad/s; may be repeated
    #[arg(long = "command", value_name = "VX,VY,WZ", allow_hyphen_values = true)]
    commands: Vec<Command>,
    /// Length of an episode
    #[arg(long, value_name = "S", default_value_t = 20.0)]
    seconds: f64,
    /// Episodes per command
    #[arg(long, value_name = "N", default_value_t = 32)]
    episodes: usize,
    /// End with one JSON array, an object per command
    #[arg(long)]
    json: bool,
}

/// vx, vy (m/s, heading frame) and yaw rate (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Command(pub(crate) [f32; 3]);

impl FromStr for Command {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f32>, _> =
            text.split(',').map(|part| part.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[forward, left, yaw]) if [forward, left, yaw].iter().all(|x| x.is_finite()) => {
                Ok(Self([forward, left, yaw]))
            }
            _ => Err("expected three numbers, as in 0.8,0,0".to_owned()),
        }
    }
}

impl Evaluate {
    pub(crate) fn run(&self) -> Result<()> {
        bail!(
            "not written yet: {self:?} {}",
            self.place.runs_dir.display()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_three_finite_numbers() {
        assert_eq!("0.8, 0,-0.5".parse(), Ok(Command([0.8, 0.0, -0.5])));
        for text in ["", "0.8", "0.8,0", "0.8,0,0,0", "a,b,c", "inf,0,0"] {
            assert!(text.parse::<Command>().is_err(), "{text:?}");
        }
    }
}
