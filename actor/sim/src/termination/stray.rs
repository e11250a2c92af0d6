//! Straying: going on at a velocity that was not asked for.
//!
//! Separate because it is a rule with a memory. A discriminator rewards whatever looks human, and
//! standing does. As long as style weighs most, a robot that stands, or strolls at one speed
//! whatever it is told, earns nearly as much as one that obeys; and it never falls. An end after a
//! second or two costs it the rest of the episode, whatever the weights are.

use crate::time::CONTROL_STEP;
use g1::RobotState;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

/// When a robot has strayed from its command.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct StrayConfig {
    /// Greatest error of the mean velocity as a share of the commanded speed. Default 0.5.
    pub share: Ramp<f32>,
    /// Error that is always allowed, m/s. Default 0.25: slow commands, and standing.
    pub least: Ramp<f32>,
    /// Time over which the velocity is averaged (exponentially), s. Default 2.
    pub seconds: f32,
    /// Time after a start or a new command in which nothing is counted, s. Default 0.3. With 1
    /// standing paid again: a discount of 0.99 looks two seconds ahead, about as long as it then lasted.
    pub grace: f32,
    /// The same, s, for a robot that begins in motion that fits its command. Default: no other. A
    /// short one tells it at once that to brake is to stray; a short `grace` as well would have others
    /// set off in a rush.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub grace_on_course: Option<f32>,
    /// Weight of the squared error of the yaw rate (rad²/s²) beside that of the velocity (m²/s²).
    /// Default 0.25.
    pub yaw_rate_weight: f32,
    /// Whether a push of Table I excuses as a new command does: nothing is counted for `grace` after it, and what was
    /// before is forgotten. Default false. A robot that is pushed at 0.7 m/s and steps out of it is as far off for half a
    /// second; without the excuse an end may follow the right answer.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub excuse_pushes: bool,
}

impl Default for StrayConfig {
    fn default() -> Self {
        Self {
            share: 0.5.into(),
            least: 0.25.into(),
            seconds: 2.0,
            grace: 0.3,
            grace_on_course: None,
            yaw_rate_weight: 0.25,
            excuse_pushes: false,
        }
    }
}

impl StrayConfig {
    /// Holds all that moves where it is after a number of samples.
    pub(crate) fn set(&mut self, samples: f64) {
        self.share.set(samples);
        self.least.set(samples);
    }

    /// Checks every parameter; names the first bad one.
    pub(crate) fn validate(&self) -> Checked {
        let from = |least| move |path: &str, value: f32| invalid::at_least(path, value, least);
        self.share.check("share", from(0.0))?;
        self.least.check("least", from(0.05))?;
        invalid::at_least("seconds", self.seconds, 0.1)?;
        invalid::at_least("grace", self.grace, 0.0)?;
        if let Some(grace) = self.grace_on_course {
            invalid::at_least("grace_on_course", grace, 0.0)?;
        }
        invalid::at_least("yaw_rate_weight", self.yaw_rate_weight, 0.0)
    }

    /// Length of a velocity or of the error of one: √(v_x² + v_y² + w·ω²), m/s.
    fn length(&self, velocity: [f32; 3]) -> f32 {
        let [x, y, yaw_rate] = velocity;
        (x * x + y * y + self.yaw_rate_weight * yaw_rate * yaw_rate).sqrt()
    }

    /// Greatest length of the error under a command, m/s.
    fn allowed(&self, command: &[f32; 3]) -> f32 {
        self.least
            .now()
            .max(self.share.now() * self.length(*command))
    }
}

/// What is remembered of a robot since its command was given.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Astray {
    /// How far the mean velocity is from the command: vx, vy (m/s), yaw rate (rad/s).
    error: [f32; 3],
    /// Control steps since the command.
    steps: u32,
    /// Whether the robot began in motion that fits the command.
    on_course: bool,
}

impl Astray {
    /// Of a robot that begins an episode, in motion that fits its command or not.
    pub(crate) fn at_start(on_course: bool) -> Self {
        Self {
            on_course,
            ..Self::default()
        }
    }

    /// The robot was pushed.
    pub(crate) fn pushed(&mut self, rule: &StrayConfig) {
        if rule.excuse_pushes {
            *self = Self::default();
        }
    }

    /// Takes one more control step in:  e ← e + (Δt/τ)·(v* − v − e), after the grace. Whether the robot
    /// has strayed.
    pub(crate) fn step(
        &mut self,
        rule: &StrayConfig,
        command: &[f32; 3],
        state: &RobotState,
    ) -> bool {
        self.steps += 1;
        let velocity = state.velocity_in_heading();
        let moving = [velocity.x, velocity.y, state.angular_velocity.z];
        let error: [f32; 3] = std::array::from_fn(|axis| command[axis] - moving[axis]);
        let other = rule.grace_on_course.filter(|_| self.on_course);
        if self.steps as f32 * CONTROL_STEP <= other.unwrap_or(rule.grace) {
            return false;
        }
        let part = CONTROL_STEP / rule.seconds;
        for (mean, error) in self.error.iter_mut().zip(error) {
            *mean += part * (error - *mean);
        }
        rule.length(self.error) > rule.allowed(command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Steps until a standing robot has strayed from a command, or 1,000.
    fn steps(rule: &StrayConfig, command: [f32; 3]) -> usize {
        let (mut astray, state) = (Astray::default(), RobotState::standing());
        let strayed = |_: &usize| astray.step(rule, &command, &state);
        (1..=1_000).find(strayed).unwrap_or(1_000)
    }

    #[test]
    fn who_stands_strays_from_walking_after_a_while() {
        let rule = StrayConfig::default();
        // After a grace of 15 steps the error of a robot at rest is v*·(1 − (1 − 0.01)ⁿ), above ½·v* when
        // 0.99ⁿ < ½: n = 69.
        assert_eq!(steps(&rule, [1.0, 0.0, 0.0]), 84);
        assert_eq!(steps(&rule, [0.0, -0.6, 0.0]), 84);
        // At 0.3 m/s ¼ m/s is allowed: 0.99ⁿ < 1/6, n = 179.
        assert_eq!(steps(&rule, [0.3, 0.0, 0.0]), 194);
        // Turning at 1 rad/s counts as ½ m/s, half of which is allowed.
        assert_eq!(steps(&rule, [0.0, 0.0, 1.0]), 84);
    }

    #[test]
    fn who_brakes_strays_sooner_than_who_does_not_set_off() {
        let rule = StrayConfig {
            grace_on_course: Some(0.1),
            ..StrayConfig::default()
        };
        let mut astray = Astray::at_start(true);
        let standing = RobotState::standing();
        let braked = (1..).find(|_| astray.step(&rule, &[1.0, 0.0, 0.0], &standing));
        // 5 steps of grace, then 0.99ⁿ < ½: n = 69.
        assert_eq!(braked, Some(74));
        // A robot that begins at rest has all of the longer grace: 15 and 69 steps, as above.
        assert_eq!(steps(&rule, [1.0, 0.0, 0.0]), 84);
    }

    #[test]
    fn a_push_excuses_where_it_should() {
        let stands_on_with = |excuse_pushes| {
            let rule = StrayConfig {
                excuse_pushes,
                ..StrayConfig::default()
            };
            let (mut astray, standing) = (Astray::at_start(true), RobotState::standing());
            let step = |astray: &mut Astray| astray.step(&rule, &[1.0, 0.0, 0.0], &standing);
            assert!((0..60).all(|_| !step(&mut astray)));
            astray.pushed(&rule);
            (1..).find(|_| step(&mut astray))
        };
        // 84 steps from the start, or 84 from the push.
        assert_eq!(stands_on_with(false), Some(24));
        assert_eq!(stands_on_with(true), Some(84));
    }

    #[test]
    fn who_obeys_never_strays() {
        let rule = StrayConfig::default();
        assert_eq!(steps(&rule, [0.0; 3]), 1_000);
        assert_eq!(steps(&rule, [0.2, 0.0, 0.0]), 1_000);
        let mut state = RobotState::standing();
        state.linear_velocity.x = 0.6;
        let mut astray = Astray::default();
        assert!((0..1_000).all(|_| !astray.step(&rule, &[1.0, 0.0, 0.0], &state)));
        // Told to stand it has gone too far a second after the grace.
        assert!((0..150).any(|_| astray.step(&rule, &[0.0; 3], &state)));
    }
}
