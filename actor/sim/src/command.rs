//! Commands c_t = (v*_x, v*_y, ω*): what the robot is asked to do, and for how long.
//!
//! Separate because commands are drawn at two moments, at a reset (where they may match the start)
//! and every few seconds after, by the same rule.

use crate::config::{self, Invalid, range};
use crate::kind::{Kind, KindsConfig};
use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

/// Which velocities are commanded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CommandConfig {
    /// Forward velocity, m/s: least and greatest. Default 0.4 to 1.2, where the recipe began that
    /// walked; the paper gives no ranges. Ranges that contain 0 from the start taught hopping.
    pub forward: [f32; 2],
    /// Leftward velocity, m/s. Default 0: the reference motion walks straight.
    pub lateral: [f32; 2],
    /// Yaw rate, rad/s. Default 0, as above.
    pub yaw_rate: [f32; 2],
    /// Share of drawn commands that are zero: stand still. Default 0.
    pub standing_share: f32,
    /// Share of the others that have one part alone, forward, lateral or yaw rate, each as often.
    /// Default 0: all three at once, and hardly ever straight on, aside or on the spot.
    pub pure_share: f32,
    /// Least size of commands to go back, aside or to turn alone, as a share of the end of their range on
    /// that side. Default 0. Standing obeys the small ones nearly as well as stepping does, and is learnt
    /// for all.
    #[serde(skip_serializing_if = "is_zero")]
    pub least_share: f32,
    /// Seconds between new commands, drawn uniformly. Default 3 to 10, the span in use among
    /// published trainers.
    pub resample_seconds: [f32; 2],
    /// Share of starts from reference motion whose command is that motion's own velocity.
    /// Default 0.9, of the recipe that walked; 0.7 later in training.
    pub matched_share: f32,
    /// Robots that keep to one kind of command each, so that every kind gets its share of the samples.
    /// Default: none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kinds: Option<KindsConfig>,
}

impl Default for CommandConfig {
    fn default() -> Self {
        Self {
            forward: [0.4, 1.2],
            lateral: [0.0, 0.0],
            yaw_rate: [0.0, 0.0],
            standing_share: 0.0,
            pure_share: 0.0,
            least_share: 0.0,
            resample_seconds: [3.0, 10.0],
            matched_share: 0.9,
            kinds: None,
        }
    }
}

impl CommandConfig {
    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Result<(), Invalid> {
        range("command.forward", self.forward)?;
        range("command.lateral", self.lateral)?;
        range("command.yaw_rate", self.yaw_rate)?;
        config::share("command.standing_share", self.standing_share)?;
        config::share("command.pure_share", self.pure_share)?;
        config::share("command.least_share", self.least_share)?;
        range("command.resample_seconds", self.resample_seconds)?;
        config::at_least(
            "command.resample_seconds[0]",
            self.resample_seconds[0],
            0.02,
        )?;
        config::share("command.matched_share", self.matched_share)?;
        self.kinds
            .as_ref()
            .map_or(Ok(()), |kinds| kinds.validate(self))
    }

    /// A command from the ranges.
    pub fn draw(&self, rng: &mut impl Rng) -> [f32; 3] {
        // All numbers are drawn whatever the outcome, so that a change of one share leaves the rest
        // of a run's random sequence alone.
        let stand = rng.random::<f32>() < self.standing_share;
        let mut command = [self.forward, self.lateral, self.yaw_rate]
            .map(|[least, greatest]| rng.random_range(least..=greatest));
        if self.pure_share > 0.0 {
            let pure = rng.random::<f32>() < self.pure_share;
            let part = rng.random_range(0..command.len());
            if pure {
                let value = match part {
                    0 if command[0] >= 0.0 => command[0],
                    0 => self.away(command[0], self.forward),
                    1 => self.away(command[1], self.lateral),
                    _ => self.away(command[2], self.yaw_rate),
                };
                command = [0.0; 3];
                command[part] = value;
            }
        }
        if stand { [0.0; 3] } else { command }
    }

    /// A value of a range as far from 0 as `least_share` says; all values as likely as before, on the
    /// same side.
    pub(crate) fn away(&self, value: f32, [least, greatest]: [f32; 2]) -> f32 {
        let end = if value < 0.0 { least } else { greatest };
        value + self.least_share * (end - value)
    }

    /// A command for the beginning of an episode of a robot that keeps to a kind, or to none.
    pub fn draw_of(&self, kind: Option<Kind>, rng: &mut impl Rng) -> [f32; 3] {
        match kind {
            Some(kind) => kind.draw(self, rng),
            None => self.draw(rng),
        }
    }

    /// A command for a start from motion that goes at `clip`: that velocity in the matched share.
    pub fn draw_for_start(
        &self,
        kind: Option<Kind>,
        clip: &[f32; 3],
        rng: &mut impl Rng,
    ) -> [f32; 3] {
        let drawn = self.draw_of(kind, rng);
        if rng.random::<f32>() < self.matched_share {
            *clip
        } else {
            drawn
        }
    }

    /// Control steps until the next command.
    pub fn draw_interval(&self, rng: &mut impl Rng) -> u32 {
        config::steps(self.resample_seconds, rng)
    }
}

/// Whether an option is off.
fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

#[cfg(test)]
mod tests;
