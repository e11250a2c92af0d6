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
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn commands_fill_their_ranges() {
        let config = CommandConfig {
            forward: [-1.0, 2.0],
            lateral: [0.5, 0.5],
            yaw_rate: [-0.3, 0.0],
            standing_share: 0.25,
            ..CommandConfig::default()
        };
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let draws: Vec<_> = (0..4_000).map(|_| config.draw(&mut rng)).collect();
        let standing = draws.iter().filter(|c| **c == [0.0; 3]).count();
        // Binomial(4000, ¼): 1000 ± 27, so five deviations are 137.
        assert!(standing.abs_diff(1_000) < 137, "{standing}");
        let moving = draws.iter().filter(|c| **c != [0.0; 3]);
        let (mut least, mut greatest) = (f32::MAX, f32::MIN);
        for [vx, vy, yaw] in moving {
            assert!((-1.0..=2.0).contains(vx) && *vy == 0.5 && (-0.3..=0.0).contains(yaw));
            least = least.min(*vx);
            greatest = greatest.max(*vx);
        }
        assert!(least < -0.95 && greatest > 1.95, "{least} {greatest}");
    }

    #[test]
    fn pure_commands_have_one_part() {
        let config = CommandConfig {
            forward: [0.1, 1.0],
            lateral: [0.1, 0.4],
            yaw_rate: [0.1, 1.0],
            pure_share: 0.6,
            ..CommandConfig::default()
        };
        let mut rng = Pcg64Mcg::seed_from_u64(4);
        let mut counts = [0; 4]; // forward, lateral, yaw rate alone; all
        for _ in 0..4_000 {
            let command = config.draw(&mut rng);
            let parts: Vec<_> = (0..3).filter(|&part| command[part] != 0.0).collect();
            counts[if let [part] = parts[..] { part } else { 3 }] += 1;
        }
        // Binomial(4000, 0.2) has a deviation of 25, Binomial(4000, 0.4) of 31.
        for (count, expected) in counts.into_iter().zip([800_i32, 800, 800, 1_600]) {
            assert!((expected - count).abs() < 155, "{counts:?}");
        }
    }

    #[test]
    fn pure_commands_keep_away_from_standing() {
        let config = CommandConfig {
            forward: [-0.6, 2.0],
            lateral: [-0.4, 0.4],
            yaw_rate: [-1.0, 1.0],
            pure_share: 1.0,
            least_share: 0.5,
            ..CommandConfig::default()
        };
        // From the range's end, and from near 0, by hand.
        assert_eq!(config.away(-0.4, config.lateral), -0.4);
        assert!((config.away(0.1, config.lateral) - 0.25).abs() < 1e-6);
        let mut rng = Pcg64Mcg::seed_from_u64(5);
        let mut slow = 0;
        for _ in 0..2_000 {
            let [forward, lateral, yaw_rate] = config.draw(&mut rng);
            assert!(forward >= 0.0 || (-0.6..=-0.3).contains(&forward));
            assert!(lateral == 0.0 || (0.2..=0.4).contains(&lateral.abs()));
            assert!(yaw_rate == 0.0 || (0.5..=1.0).contains(&yaw_rate.abs()));
            slow += usize::from(forward > 0.0 && forward < 0.5);
        }
        assert!(slow > 50, "slow walks are kept: {slow}");
    }

    #[test]
    fn starts_match_their_clip_in_the_given_share() {
        let clip = [0.8, 0.0, 0.1];
        let mut rng = Pcg64Mcg::seed_from_u64(2);
        for (share, expected) in [(0.0, 0), (0.9, 1_800), (1.0, 2_000)] {
            let config = CommandConfig {
                matched_share: share,
                ..CommandConfig::default()
            };
            let matched = (0..2_000)
                .filter(|_| config.draw_for_start(None, &clip, &mut rng) == clip)
                .count();
            // Binomial(2000, 0.9) has a deviation of 13.4.
            assert!(matched.abs_diff(expected) < 67, "{matched} of {expected}");
        }
    }

    #[test]
    fn intervals_are_seconds_in_steps() {
        let mut rng = Pcg64Mcg::seed_from_u64(3);
        let config = CommandConfig::default();
        for _ in 0..1_000 {
            assert!((150..=500).contains(&config.draw_interval(&mut rng))); // 3 to 10 s at 50 Hz
        }
    }

    #[test]
    fn bad_values_are_named() {
        let config = CommandConfig {
            forward: [1.0, 0.5],
            ..CommandConfig::default()
        };
        assert!(
            config
                .validate()
                .unwrap_err()
                .to_string()
                .contains("command.forward")
        );
        let config = CommandConfig {
            matched_share: 1.5,
            ..CommandConfig::default()
        };
        assert!(
            config
                .validate()
                .unwrap_err()
                .to_string()
                .contains("command.matched_share")
        );
        CommandConfig::default().validate().unwrap();
    }
}
