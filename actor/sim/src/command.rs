//! Commands c_t = (v*_x, v*_y, ω*): what the robot is asked to do, and for how long.
//!
//! Separate because commands are drawn at two moments, at a reset (where they may match the start)
//! and every few seconds after, by one sampler.

use crate::kind::{Kind, KindsConfig};
use crate::time::CONTROL_STEP;
use rand::{Rng, RngExt};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

/// Which velocities are commanded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CommandConfig {
    /// Forward velocity, m/s: least and greatest. Default 0.4 to 1.2; the paper gives no ranges. With a range that
    /// contains 0 from the start, robots learn to hop.
    pub forward: Ramp<[f32; 2]>,
    /// Leftward velocity, m/s. Default 0: the reference motion walks straight.
    pub lateral: Ramp<[f32; 2]>,
    /// Yaw rate, rad/s. Default 0, as above.
    pub yaw_rate: Ramp<[f32; 2]>,
    /// Share of drawn commands that are zero: stand still. Default 0.
    pub standing_share: Ramp<f32>,
    /// Share of the others that have one part alone, forward, lateral or yaw rate, each as often.
    /// Default 0: all three at once, and hardly ever straight on, aside or on the spot.
    pub pure_share: Ramp<f32>,
    /// Least size of commands to go back, aside or to turn alone, as a share of the end of their range on
    /// that side. Default 0. Standing obeys the small ones nearly as well as stepping does, and is learnt
    /// for all.
    #[serde(skip_serializing_if = "is_zero")]
    pub least_share: f32,
    /// Time between new commands, s, drawn uniformly. Default 3 to 10, the span in use among
    /// published trainers.
    pub resample_seconds: [f32; 2],
    /// Share of starts from reference motion whose command is that motion's own velocity. Where ranges move, motion that they
    /// do not ask for yet is not begun in, unless all of it is.
    /// Default 0.9, of the recipe that walked; 0.7 later in training.
    pub matched_share: Ramp<f32>,
    /// Robots that keep to one kind of command each, so that every kind gets its share of the samples.
    /// Default: none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kinds: Option<KindsConfig>,
    /// Where ranges moved before they were held: all that they ever ask for.
    #[serde(skip)]
    pub at_last: Option<[[f32; 2]; 3]>,
}

/// How far beyond a range motion may be that still passes for it: a gait's speed comes of its steps, to three digits or so.
const NEARLY: f32 = 0.02;

/// When and for whom a command is drawn. By default inside an episode, where it may be of any kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Occasion {
    /// At the start of an episode of a robot that keeps to a kind: that kind.
    pub kind: Option<Kind>,
    /// At a start in motion: the velocity that it goes at, which is the command in the matched share.
    pub motion: Option<[f32; 3]>,
}

impl Default for CommandConfig {
    fn default() -> Self {
        Self {
            forward: [0.4, 1.2].into(),
            lateral: [0.0, 0.0].into(),
            yaw_rate: [0.0, 0.0].into(),
            standing_share: 0.0.into(),
            pure_share: 0.0.into(),
            least_share: 0.0,
            resample_seconds: [3.0, 10.0],
            matched_share: 0.9.into(),
            kinds: None,
            at_last: None,
        }
    }
}

impl CommandConfig {
    /// Holds all that moves where it is after a number of samples.
    pub(crate) fn set(&mut self, samples: f64) {
        let widest = self.widest();
        for range in [&mut self.forward, &mut self.lateral, &mut self.yaw_rate] {
            if range.moves() {
                self.at_last = Some(widest);
            }
            range.set(samples);
        }
        self.standing_share.set(samples);
        self.pure_share.set(samples);
        self.matched_share.set(samples);
        if let Some(kinds) = &mut self.kinds {
            kinds.set(samples);
        }
    }

    /// All that is ever asked for: forward and leftward velocity (m/s), yaw rate (rad/s), least and greatest each.
    pub fn widest(&self) -> [[f32; 2]; 3] {
        let moving = [self.forward, self.lateral, self.yaw_rate].map(|range| {
            let [from, to] = [range.at(0.0), range.at(f64::INFINITY)];
            [from[0].min(to[0]), from[1].max(to[1])]
        });
        self.at_last.unwrap_or(moving)
    }

    /// Checks every field; names the first bad one.
    pub(crate) fn validate(&self) -> Checked {
        let within = |limits, why| {
            move |path: &str, range: [f32; 2]| invalid::range_between(path, range, limits, why)
        };
        let metres = "metres per second; a sprinter does 10";
        self.forward
            .check("forward", within([-10.0, 10.0], metres))?;
        let metres = "metres per second; nobody steps aside faster";
        self.lateral.check("lateral", within([-5.0, 5.0], metres))?;
        let radians = "radians per second; a turn and a half a second is 9.4";
        self.yaw_rate
            .check("yaw_rate", within([-10.0, 10.0], radians))?;
        self.standing_share
            .check("standing_share", invalid::share)?;
        self.pure_share.check("pure_share", invalid::share)?;
        invalid::share("least_share", self.least_share)?;
        invalid::range_between(
            "resample_seconds",
            self.resample_seconds,
            [0.02, 86_400.0],
            "seconds, from one control step to a day",
        )?;
        self.matched_share.check("matched_share", invalid::share)?;
        self.kinds
            .as_ref()
            .map_or(Ok(()), |kinds| kinds.validate(self.widest()))
    }

    /// A command: the one sampler, for resets and for changes inside an episode.
    pub fn draw(&self, occasion: Occasion, rng: &mut impl Rng) -> [f32; 3] {
        let drawn = match occasion.kind {
            Some(kind) => self.draw_of(kind, rng),
            None => self.draw_any(rng),
        };
        match occasion.motion {
            Some(motion) if rng.random::<f32>() < self.matched_share.now() => motion,
            _ => drawn,
        }
    }

    /// Whether motion of a command waits: ranges that move will ask for it, and do not yet. What they never ask for, as a
    /// clip of standing beside commands to walk, is begun in at all times.
    pub(crate) fn waits(&self, command: [f32; 3]) -> bool {
        let within = |ranges: [[f32; 2]; 3]| {
            let mut parts = ranges.iter().zip(command);
            parts.all(|([least, greatest], value)| {
                (least - NEARLY..=greatest + NEARLY).contains(&value)
            })
        };
        let now = [self.forward, self.lateral, self.yaw_rate].map(|range| range.now());
        self.at_last.is_some_and(within) && !within(now)
    }

    /// A command of one kind from the ranges.
    fn draw_of(&self, kind: Kind, rng: &mut impl Rng) -> [f32; 3] {
        let ([slowest, fastest], lateral) = (self.forward.now(), self.lateral.now());
        let yaw_rates = self.yaw_rate.now();
        let forward = match kind {
            Kind::Forward => [slowest.max(0.0), fastest],
            Kind::Backward => [slowest, fastest.min(0.0)],
            _ => [slowest, fastest],
        };
        // A range that moves may be one that leaves nothing of this kind yet: then its near end.
        let forward = [forward[0].min(fastest), forward[1].max(slowest)];
        let [vx, vy, yaw_rate] = [forward, lateral, yaw_rates]
            .map(|[least, greatest]| rng.random_range(least..=greatest));
        let ahead = self
            .kinds
            .as_ref()
            .map_or(0.0, |kinds| kinds.approach.now());
        match kind {
            Kind::Standing => [0.0; 3],
            Kind::Forward => [vx, 0.0, 0.0],
            Kind::Backward => [self.away(vx, forward), 0.0, 0.0],
            Kind::Lateral => [ahead, self.away(vy, lateral), 0.0],
            Kind::Turning => [ahead, 0.0, self.away(yaw_rate, yaw_rates)],
            Kind::Mixed => [vx, vy, yaw_rate],
        }
    }

    /// A command of any kind from the ranges.
    fn draw_any(&self, rng: &mut impl Rng) -> [f32; 3] {
        // All numbers are drawn whatever the outcome, so that a change of one share leaves the rest
        // of a run's random sequence alone.
        let stand = rng.random::<f32>() < self.standing_share.now();
        let ranges = [self.forward, self.lateral, self.yaw_rate].map(|range| range.now());
        let mut command = ranges.map(|[least, greatest]| rng.random_range(least..=greatest));
        if self.pure_share != Ramp::Constant(0.0) {
            let pure = rng.random::<f32>() < self.pure_share.now();
            let part = rng.random_range(0..command.len());
            if pure {
                let value = match part {
                    0 if command[0] >= 0.0 => command[0],
                    0 => self.away(command[0], ranges[0]),
                    1 => self.away(command[1], ranges[1]),
                    _ => self.away(command[2], ranges[2]),
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

    /// Control steps until the next command.
    pub fn draw_interval(&self, rng: &mut impl Rng) -> u32 {
        steps(self.resample_seconds, rng)
    }
}

/// A number of control steps for a duration drawn from a range of seconds; at least one.
pub(crate) fn steps(seconds: [f32; 2], rng: &mut impl Rng) -> u32 {
    let seconds = rng.random_range(seconds[0]..=seconds[1]);
    ((seconds / CONTROL_STEP).round() as u32).max(1)
}

/// Whether an option is off.
fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

#[cfg(test)]
mod tests;
