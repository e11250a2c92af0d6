//! `ampco evaluate`: how well a policy walks, by the definitions of III-F.
//!
//! The policy acts without noise. Every command is held for a whole episode by robots that begin
//! standing, without randomisation unless it is asked for; a robot that fell counts until it fell.

mod episodes;
mod judge;
mod subject;

use std::io::Write;
use std::str::FromStr;

use anyhow::{Context, Result};
use serde_json::{Value, json};

use crate::engine::Engine;
use crate::failure::usage;
use crate::place::Place;
use episodes::{Conditions, Outcome};
use subject::Subject;

/// Walk with a trained policy: survival, velocity error, energy, style, gait
///
/// The policy acts without exploration noise. Each command is tried by a number of robots at once,
/// from standing, without randomisation.
#[derive(Debug, clap::Args)]
pub(crate) struct Evaluate {
    /// A run's name or folder, a checkpoint's folder, or the folder of a shipped policy
    run: String,
    #[command(flatten)]
    place: Place,
    /// Command to follow: forward and leftward velocity in m/s, yaw rate in rad/s; may be repeated
    /// [default: 0.5,0,0 and 1,0,0]
    #[arg(long = "command", value_name = "VX,VY,WZ", allow_hyphen_values = true)]
    commands: Vec<Command>,
    /// Length of an episode
    #[arg(long, value_name = "S", default_value_t = 20.0)]
    seconds: f64,
    /// Episodes per command
    #[arg(long, value_name = "N", default_value_t = 32)]
    episodes: usize,
    /// Apply every row of the paper's domain randomisation (Table I)
    #[arg(long)]
    randomize: bool,
    /// Begin in frames of the reference motion instead of standing
    #[arg(long)]
    from_reference: bool,
    /// Engine that judges, whatever the policy was trained in
    #[arg(long, value_enum, default_value_t = Engine::Rapier)]
    physics: Engine,
    /// Seed of the episodes
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// End with one JSON array, an object per command
    #[arg(long)]
    json: bool,
}

/// vx, vy (m/s, heading frame) and yaw rate (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Command(pub(crate) [f32; 3]);

const DEFAULT_COMMANDS: [Command; 2] = [Command([0.5, 0.0, 0.0]), Command([1.0, 0.0, 0.0])];

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
        let (seconds, episodes) = (self.seconds, self.episodes);
        if !(0.02..=3_600.0).contains(&seconds) {
            return Err(usage(format!("--seconds {seconds}: give 0.02 to 3600")));
        }
        if !(1..=4_096).contains(&episodes) {
            return Err(usage(format!("--episodes {episodes}: give 1 to 4096")));
        }
        let mut subject = Subject::open(&self.place, &self.run)?;
        subject.task.physics = self.physics.into();
        let commands: &[Command] = match self.commands.as_slice() {
            [] => &DEFAULT_COMMANDS,
            given => given,
        };
        let conditions = Conditions {
            steps: (seconds * 50.0).round() as u32,
            episodes,
            randomize: self.randomize,
            from_reference: self.from_reference,
            seed: self.seed,
        };
        let mut out = std::io::stdout().lock();
        let mut rows = Vec::new();
        if !self.json {
            let (path, iteration) = (subject.path.display(), subject.iteration);
            writeln!(
                out,
                "{path}, iteration {iteration}: {episodes} episodes of {seconds} s each"
            )?;
            writeln!(out, "{HEADING}")?;
        }
        for &Command(command) in commands {
            let outcome = episodes::walk(&subject, command, &conditions)
                .with_context(|| format!("walking at {command:?}"))?;
            if self.json {
                rows.push(row(command, &outcome));
            } else {
                writeln!(out, "{}", line(command, &outcome))?;
            }
        }
        if self.json {
            writeln!(out, "{}", Value::Array(rows))?;
        }
        Ok(())
    }
}

const HEADING: &str = "\
      command      survival   rmse   energy   style   hips  stride   duty flight
   vx    vy    wz      %       m/s  J/1000      -      -      Hz      -      %";

fn line(command: [f32; 3], outcome: &Outcome) -> String {
    let or_dash = |number: Option<f64>, digits: usize| {
        number.map_or_else(|| "-".to_owned(), |number| format!("{number:.digits$}"))
    };
    let gait = &outcome.gait;
    format!(
        "{:5.2} {:5.2} {:5.2}  {:6.1}  {:7.3} {:8.0}  {:6.3} {:>6} {:>7} {:>6} {:>6}",
        command[0],
        command[1],
        command[2],
        100.0 * outcome.survival,
        outcome.rmse,
        outcome.energy_j,
        outcome.style_reward,
        or_dash(gait.hip_correlation(), 2),
        or_dash(gait.stride_rate(50.0), 2),
        or_dash(gait.duty_factor(), 2),
        or_dash(gait.flight_share().map(|share| 100.0 * share), 1),
    )
}

fn row(command: [f32; 3], outcome: &Outcome) -> Value {
    json!({
        "command": command,
        "episodes": outcome.episodes,
        "survival": outcome.survival,
        "rmse": outcome.rmse,
        "energy_j": outcome.energy_j,
        "style_reward": outcome.style_reward,
        "task_reward": outcome.task_reward,
        "velocity": outcome.velocity,
        "yaw_rate": outcome.yaw_rate,
        "seconds_survived": outcome.seconds_survived,
        "hip_correlation": outcome.gait.hip_correlation(),
        "stride_rate_hz": outcome.gait.stride_rate(50.0),
        "duty_factor": outcome.gait.duty_factor(),
        "flight_share": outcome.gait.flight_share(),
    })
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
