//! The two sections that belong to the run itself: `[run]` and `[fleet]`.
//!
//! Separate from [`crate::config`] because that reads any section, and these are fields with
//! meanings and defaults that learner, actors and command line share.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::invalid::{require, within};
use vocabulary::{Checked, Mechanics, Physics, Section, calm};

/// When actors collect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// Every rollout comes from the newest weights: deterministic for a seed and a set of actors.
    #[default]
    Lockstep,
    /// Actors collect with the last weights while the learner trains.
    Overlapped,
}

/// `[run]`: how long, how often, how patient.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RunConfig {
    /// The seed from which every process derives its own. A TOML integer: at most 2⁶³ − 1.
    pub seed: u64,
    /// When actors collect.
    pub mode: Mode,
    /// Overlapped: a rollout whose weights are more versions than this behind the newest is counted
    /// as stale and not used.
    pub max_lag: u64,
    /// The iteration at which the run is complete, counted from its very first; 0 = no limit.
    /// Table II: 20,000.
    pub iterations: u64,
    /// Time after which this launch ends in order, min; 0 = no limit.
    pub minutes: f64,
    /// Iterations between checkpoints; one more is written whenever the learner stops.
    pub checkpoint_every: u64,
    /// How many of the newest checkpoints stay on the disk, the best beside them.
    pub keep_checkpoints: usize,
    /// Folder of a checkpoint whose policy, critic and statistics of observations the run begins with
    /// (`ampco train --from`); empty: it begins with none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub from: String,
    /// Whether learner and actors write down what became of every single rollout, in
    /// `logs/*.rollouts`: some 100 bytes each. `ampco soak` asks for it.
    pub journal: bool,
    /// How long processes wait for one another.
    pub deadlines: Deadlines,
}

/// `[run.deadlines]`, all in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Deadlines {
    /// How long the learner waits for an actor's rollout before it goes on without that actor, s.
    pub rollout_seconds: f64,
    /// How long the learner, in lock-step, waits for the scheduler's answer before it goes on with the last directive, s.
    pub directive_seconds: f64,
    /// How long an actor waits for room in a full stream before it drops a rollout and counts it, s.
    pub send_seconds: f64,
    /// How long processes have after the order to end before they are killed, s.
    pub stop_seconds: f64,
}

/// `[fleet]`: how much is simulated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FleetConfig {
    /// Which engine moves the robots: `"rapier"` (default; the judge of every result) or `"batched"`, the fast solver for
    /// this one robot.
    pub physics: Physics,
    /// Whether a robot's legs, arms and trunk meet each other (default: true), in both engines. Without it they pass
    /// through each other, and policies learn to let them.
    pub self_collision: bool,
    /// Environments of the whole group, shared evenly among the actors it starts with.
    pub environments: usize,
    /// Control steps per environment and rollout (the paper: 24).
    pub steps: usize,
    /// Actor processes; 0 = one per core, written out when the run is made.
    pub actors: usize,
    /// Share of robots that explore half as widely as the others (default 0). Where all do alike, a policy may stand until
    /// noise has made it step, and without noise it stands.
    pub calm_share: f32,
}

impl Default for RunConfig {
    fn default() -> Self {
        Self {
            seed: 1,
            mode: Mode::default(),
            max_lag: 2,
            iterations: 20_000,
            minutes: 0.0,
            checkpoint_every: 50,
            keep_checkpoints: 5,
            from: String::new(),
            journal: false,
            deadlines: Deadlines::default(),
        }
    }
}

impl Default for Deadlines {
    fn default() -> Self {
        Self {
            rollout_seconds: 30.0,
            directive_seconds: 2.0,
            send_seconds: 10.0,
            stop_seconds: 30.0,
        }
    }
}

impl Default for FleetConfig {
    fn default() -> Self {
        Self {
            physics: Physics::default(),
            self_collision: true,
            environments: 256,
            steps: 32,
            actors: 0,
            calm_share: 0.0,
        }
    }
}

impl Section for RunConfig {
    const NAME: &'static str = "run";

    fn validate(&self) -> Checked {
        require(
            i64::try_from(self.seed).is_ok(),
            "seed",
            self.seed,
            "use at most 2^63 - 1",
        )?;
        require(
            self.minutes.is_finite() && self.minutes >= 0.0,
            "minutes",
            self.minutes,
            "use 0 for no limit, or more",
        )?;
        require(
            self.checkpoint_every > 0,
            "checkpoint_every",
            self.checkpoint_every,
            "use 1 or more",
        )?;
        // With one, a checkpoint damaged on the disk would be the only one.
        require(
            self.keep_checkpoints >= 2,
            "keep_checkpoints",
            self.keep_checkpoints,
            "use 2 or more",
        )?;
        let deadlines = &self.deadlines;
        for (name, seconds) in [
            ("rollout_seconds", deadlines.rollout_seconds),
            ("directive_seconds", deadlines.directive_seconds),
            ("send_seconds", deadlines.send_seconds),
            ("stop_seconds", deadlines.stop_seconds),
        ] {
            let holds = seconds > 0.0 && seconds <= 86_400.0;
            let remedy = "use more than 0 and at most a day (86400)";
            within("deadlines", require(holds, name, seconds, remedy))?;
        }
        Ok(())
    }
}

impl Section for FleetConfig {
    const NAME: &'static str = "fleet";

    fn validate(&self) -> Checked {
        for (name, value, most) in [
            ("environments", self.environments, 1 << 20),
            ("steps", self.steps, 1 << 12),
        ] {
            let holds = (1..=most).contains(&value);
            require(holds, name, value, format!("use 1 to {most}"))?;
        }
        let share = self.calm_share;
        let holds = (0.0..=1.0).contains(&share);
        require(holds, "calm_share", share, "use 0, nobody, to 1, all")?;
        // The streams are opened for 64 publishers; more could never join.
        require(self.actors <= 64, "actors", self.actors, "use at most 64")?;
        require(
            self.actors <= self.environments,
            "actors",
            self.actors,
            format!(
                "use at most environments, {}; each actor simulates at least one",
                self.environments
            ),
        )
    }
}

impl FleetConfig {
    /// Robots of each rollout that explore calmly.
    pub fn calm_robots(&self) -> usize {
        calm(self.environments_per_actor(), self.calm_share)
    }

    /// The engine, and what may touch in it.
    pub fn mechanics(&self) -> Mechanics {
        Mechanics {
            physics: self.physics,
            self_collision: self.self_collision,
        }
    }

    /// Environments of one actor: an even share, rounded up so that all actors send one shape.
    pub fn environments_per_actor(&self) -> usize {
        self.environments.div_ceil(self.actors.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_in_range() {
        assert_eq!(RunConfig::default().validate(), Ok(()));
        assert_eq!(FleetConfig::default().validate(), Ok(()));
    }

    #[test]
    fn refusals_name_field_value_and_remedy() {
        let run = RunConfig {
            keep_checkpoints: 1,
            ..RunConfig::default()
        };
        let problem = run.validate().unwrap_err();
        assert_eq!(
            problem.to_string(),
            "keep_checkpoints = 1 is not usable: use 2 or more"
        );

        let mut run = RunConfig::default();
        run.deadlines.stop_seconds = f64::NAN;
        let problem = run.validate().unwrap_err();
        assert_eq!(
            (&*problem.path, &*problem.value),
            ("deadlines.stop_seconds", "NaN")
        );

        let fleet = FleetConfig {
            environments: 2,
            actors: 3,
            ..FleetConfig::default()
        };
        let problem = fleet.validate().unwrap_err().to_string();
        assert!(
            problem.starts_with("actors = 3") && problem.contains("environments, 2"),
            "{problem}"
        );
    }

    #[test]
    fn shares_are_even_and_rounded_up() {
        let share = |environments, actors| {
            let fleet = FleetConfig {
                environments,
                steps: 1,
                actors,
                ..FleetConfig::default()
            };
            fleet.environments_per_actor()
        };
        assert_eq!(share(256, 2), 128);
        assert_eq!(share(256, 3), 86); // 85⅓, and 3 × 86 = 258 ≥ 256
        assert_eq!(share(256, 0), 256); // not resolved yet: as one actor
    }
}
