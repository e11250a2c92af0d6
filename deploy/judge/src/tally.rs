//! What is measured over episodes: sums that add up in any grouping.

use g1::gait::{Conduct, Feet, MotorUse, Off, Verdict};
use vocabulary::{Cause, Counts};

/// Steps per second.
pub(super) const CONTROL_HZ: f64 = 50.0;

/// Steps after a start or a new command until a robot counts as settled: two seconds to set off or turn in.
pub(super) const SETTLING: u32 = 100;

/// Sums over the steps of robots on their feet.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub(super) episodes: usize,
    /// How they ended; those that had all their time, by the time-out.
    pub(super) ends: Counts,
    pub(super) steps: f64,
    pub(super) squared_error: f64,
    /// Steps of settled robots, and the squared errors in them: planar, and of the yaw rate.
    pub(super) settled_steps: f64,
    pub(super) settled_error: f64,
    pub(super) settled_yaw_error: f64,
    /// Of the mean velocities of settled robots over whole strides.
    pub(super) off: Off,
    /// Squared errors of forward velocity, lateral velocity and yaw rate.
    pub(super) squared_errors: [f64; 3],
    pub(super) energy: f64,
    pub(super) style: f64,
    pub(super) task: f64,
    pub(super) conduct: Conduct,
    /// Of settled robots alone.
    pub(super) settled_conduct: Conduct,
    pub(super) feet: Feet,
    pub(super) motors: MotorUse,
    /// Of each episode, in order.
    pub(super) traces: Vec<Trace>,
}

/// One episode as it went, until the fall or the end.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Trace {
    pub(super) samples: Vec<Sample>,
}

/// One step of an episode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Forward and leftward velocity in the heading frame (m/s), yaw rate (rad/s).
    pub(super) velocity: [f32; 3],
    /// Left and right hip pitch, rad.
    pub(super) hips: [f32; 2],
    /// Whether the left and the right foot carry.
    pub(super) down: [bool; 2],
}

impl Tally {
    pub(super) fn merge(&mut self, other: Self) {
        self.episodes += other.episodes;
        self.ends.merge(&other.ends);
        self.steps += other.steps;
        self.squared_error += other.squared_error;
        self.settled_steps += other.settled_steps;
        self.settled_error += other.settled_error;
        self.settled_yaw_error += other.settled_yaw_error;
        self.off.merge(&other.off);
        for axis in 0..3 {
            self.squared_errors[axis] += other.squared_errors[axis];
        }
        self.energy += other.energy;
        self.style += other.style;
        self.task += other.task;
        self.conduct.merge(&other.conduct);
        self.settled_conduct.merge(&other.settled_conduct);
        self.feet.merge(&other.feet);
        self.motors.merge(&other.motors);
        self.traces.extend(other.traces);
    }

    /// Mean time to the fall or to the end, s.
    pub(super) fn seconds_survived(&self) -> f64 {
        self.steps / self.episodes as f64 / CONTROL_HZ
    }

    /// Episodes that ended before their time.
    pub(super) fn cut_short(&self) -> u64 {
        self.ends.total() - self.ends.by(Cause::TimeOut)
    }

    /// What the gait is, by the whole command. A robot that is setting off or turning in does not do yet what it is told.
    pub(super) fn verdict(&self) -> Verdict {
        // Of short episodes one fall among many would make the mean a short life.
        let most_fell = 2 * self.cut_short() as usize > self.episodes;
        let seconds = most_fell.then(|| self.seconds_survived());
        let conduct = if self.settled_conduct.is_empty() {
            &self.conduct
        } else {
            &self.settled_conduct
        };
        conduct.verdict(seconds, CONTROL_HZ)
    }
}

#[cfg(test)]
mod tests {
    use super::super::outcome::Outcome;
    use super::*;

    #[test]
    fn means_are_over_steps_and_survival_over_episodes() {
        let mut tally = Tally {
            episodes: 2,
            ends: Counts::of(&[1.0]),
            steps: 100.0,
            squared_error: 25.0,
            settled_steps: 50.0,
            settled_error: 2.0,
            settled_yaw_error: 8.0,
            squared_errors: [16.0, 9.0, 1.0],
            energy: 200.0,
            ..Tally::default()
        };
        tally.merge(Tally {
            episodes: 2,
            steps: 300.0,
            squared_error: 75.0,
            settled_steps: 150.0,
            settled_error: 6.0,
            settled_yaw_error: 24.0,
            squared_errors: [48.0, 27.0, 3.0],
            energy: 600.0,
            ..Tally::default()
        });
        let outcome = tally.outcome();
        assert_eq!(outcome.survival, 0.75);
        assert_eq!(outcome.seconds_survived, 2.0); // 400 steps / 4 / 50 Hz
        assert_eq!(outcome.rmse, 0.5); // √(100 / 400)
        assert_eq!(outcome.rmse_settled, Some(0.2)); // √(8 / 200)
        assert_eq!(outcome.rmse_yaw_rate_settled, Some(0.4)); // √(32 / 200)
        assert_eq!(outcome.rmse_forward, 0.4); // √(64 / 400)
        assert_eq!(outcome.rmse_yaw_rate, 0.1);
        assert_eq!(outcome.energy_j, 2_000.0); // 2 J a step
    }

    /// Steps of one robot that keeps both feet on the ground.
    fn standing(command: [f32; 3], velocity: [f32; 3], steps: usize) -> Conduct {
        let mut features = [0.0; g1::FEATURES];
        features[g1::observation::HEIGHT] = 0.78;
        let (mut conduct, forces) = (Conduct::default(), [157.0; 2]);
        for _ in 0..steps {
            conduct.add(command, velocity, &features, forces, Some(forces));
        }
        conduct.close();
        conduct
    }

    fn judged(conduct: Conduct, settled_conduct: Conduct) -> Outcome {
        let tally = Tally {
            episodes: 1,
            steps: 150.0,
            conduct,
            settled_conduct,
            ..Tally::default()
        };
        tally.outcome()
    }

    #[test]
    fn who_stands_though_told_to_turn_is_not_good() {
        let told = [0.0, 0.0, 1.0];
        let still = standing(told, [0.0, 0.0, 0.01], 150);
        let outcome = judged(still, still);
        assert!(!outcome.gait_is_good);
        assert_eq!(outcome.gait, "still: 0.01 of 1.00 rad/s");
        assert!((outcome.yaw_rate - 0.01).abs() < 1e-6);
    }

    #[test]
    fn who_is_setting_off_is_not_judged_unless_nobody_ever_settles() {
        let stay = [0.0; 3];
        let (mut all, settled) = (
            standing(stay, [0.5, 0.0, 0.0], 100),
            standing(stay, [0.0; 3], 50),
        );
        all.merge(&settled);
        assert_eq!(judged(all, settled).gait, "stand");
        // (100·0.5 + 50·0) / 150
        let short = judged(all, Conduct::default());
        assert_eq!(short.gait, "drift: 0.33 m/s, asked to stay");
        assert!((short.velocity[0] - 1.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn one_fall_among_many_short_episodes_is_no_verdict() {
        let tally = |falls| Tally {
            episodes: 16,
            ends: Counts::of(&vec![1.0; falls]),
            steps: 800.0, // one second each
            ..Tally::default()
        };
        assert!(tally(9).outcome().gait.starts_with("fall"));
        assert!(!tally(1).outcome().gait.starts_with("fall"));
    }
}
