//! Standing on one foot at a time, or running: long steps pay more than many short ones.
//!
//! Separate because it is a measure with a memory, and a wish of its own: Eq. 14 asks for a velocity,
//! and small quick steps, a shuffle or a hop obey it as well as a walk. The discriminator looks at a
//! tenth of a second; how long a foot stays in the air is beyond it.

use crate::config::{self, Invalid};
use crate::world::CONTROL_STEP;
use g1::gait::CONTACT_FORCE;
use serde::{Deserialize, Serialize};

/// What standing on one foot pays. As Isaac Lab's `feet_air_time_positive_biped`, which adds a reward;
/// here it is a factor, so that the task reward stays between 0 and 1, where Eq. 9 and Eq. 12 expect it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SingleStanceConfig {
    /// Share of the task reward that is paid for it. Default 0.3.
    pub share: f32,
    /// Time for which one foot has to stand and the other to swing until all of the share is paid, s.
    /// Default 0.4, nearly half of a stride of the reference gait at 1 m/s.
    pub seconds: f32,
    /// Commanded forward speed up to which long steps are paid, m/s; from there to a run all of the task reward is for
    /// obeying. Default: at any speed. Who sets off at once to a high speed has no time for long steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub walk_to: Option<f32>,
    /// Commanded forward speed from which a run is asked for, m/s: then how long a foot has been in the air
    /// counts, whether the other stands or not. Default: never. Robots walk at 2 m/s, though the clips there
    /// run. With this they ran once they were told nothing else, and went on with it while style counted little.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run_from: Option<f32>,
    /// Share of the task reward that is paid for a run, instead of `share`. Default: `share`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run_share: Option<f32>,
    /// Part of a run's pay that is for flight itself, all of it for 40 ms between one foot's lift-off and the other's
    /// landing. Default 0: then a walk of long steps earns as much as a run, and beside other commands robots that
    /// ran flew less and less.
    #[serde(skip_serializing_if = "is_nothing")]
    pub flight: f32,
    /// Share of the task reward that who is told to stand loses while a foot is in the air. Default 0: stepping on the
    /// spot obeys nearly as well, and robots that walk nearly always stayed at it.
    #[serde(skip_serializing_if = "is_nothing")]
    pub standing: f32,
}

fn is_nothing(share: &f32) -> bool {
    *share == 0.0
}

/// Flight for which all of [`SingleStanceConfig::flight`] is paid, s: an eighth of a step at three steps a second. Twice
/// a control step: what a foot touches in part of one counts as touched.
const FLIGHT: f32 = 0.04;

impl Default for SingleStanceConfig {
    fn default() -> Self {
        Self {
            share: 0.3,
            seconds: 0.4,
            walk_to: None,
            run_from: None,
            run_share: None,
            flight: 0.0,
            standing: 0.0,
        }
    }
}

impl SingleStanceConfig {
    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Result<(), Invalid> {
        config::share("single_stance.share", self.share)?;
        config::at_least("single_stance.seconds", self.seconds, CONTROL_STEP)?;
        config::share("single_stance.flight", self.flight)?;
        config::require(
            self.flight == 0.0 || self.run_from.is_some(),
            "single_stance.flight",
            self.flight,
            "say with run_from from which speed on it is paid",
        )?;
        if let Some(share) = self.run_share {
            config::share("single_stance.run_share", share)?;
            config::require(
                self.run_from.is_some(),
                "single_stance.run_share",
                share,
                "say with run_from from which speed on it counts",
            )?;
        }
        if let Some(speed) = self.walk_to {
            config::at_least("single_stance.walk_to", speed, 0.0)?;
        }
        config::share("single_stance.standing", self.standing)?;
        self.run_from.map_or(Ok(()), |speed| {
            config::at_least("single_stance.run_from", speed, 0.5)
        })
    }

    /// Factor of the task reward, 1 − s·(1 − p) with p = min(t/T, 1) up to t = 2·T and 0 beyond. t is how
    /// long the feet have been as they are, the shorter of the two, if just one of them stands, and 0
    /// otherwise; of a run, how long the foot that was lifted first is in the air, and then f of p is
    /// min(flight/40 ms, 1) instead, and s may be another. Between `walk_to` and a run it is 1. Who is told to stand gets 1 with both feet down, else 1 less `standing`.
    /// Without the end at 2·T those told to turn on the spot stood on one leg.
    pub(crate) fn factor(&self, command: &[f32; 3], feet: &Footing) -> f32 {
        if *command == [0.0; 3] {
            return if feet.down == [true; 2] {
                1.0
            } else {
                1.0 - self.standing
            };
        }
        let runs = self.run_from.is_some_and(|speed| command[0] >= speed);
        if !runs && self.walk_to.is_some_and(|speed| command[0] > speed) {
            return 1.0;
        }
        let time = if runs {
            feet.swing()
        } else {
            feet.single_stance()
        };
        let share = time / self.seconds;
        let paid = if share > 2.0 { 0.0 } else { share.min(1.0) };
        if !runs {
            return 1.0 - self.share * (1.0 - paid);
        }
        let paid = paid + self.flight * ((feet.flight() / FLIGHT).min(1.0) - paid);
        1.0 - self.run_share.unwrap_or(self.share) * (1.0 - paid)
    }
}

/// Which feet stand, and for how long.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Footing {
    /// Of the left and the right foot.
    down: [bool; 2],
    /// Control steps since each came down or was lifted, or since the episode began.
    steps: [u32; 2],
}

impl Footing {
    /// Takes one more control step in: the vertical forces on the left and the right sole, N.
    pub(crate) fn step(&mut self, forces: [f32; 2]) {
        for (foot, force) in forces.into_iter().enumerate() {
            let down = force > CONTACT_FORCE;
            if down != self.down[foot] {
                self.steps[foot] = 0;
            }
            self.down[foot] = down;
            self.steps[foot] += 1;
        }
    }

    /// How long one foot has stood and the other has not, the shorter of the two, s; 0 with both or none
    /// on the ground.
    fn single_stance(&self) -> f32 {
        if self.down[0] == self.down[1] {
            return 0.0;
        }
        self.steps[0].min(self.steps[1]) as f32 * CONTROL_STEP
    }

    /// How long the foot that was lifted first is in the air, s; 0 with both on the ground.
    fn swing(&self) -> f32 {
        let aloft = |foot: usize| if self.down[foot] { 0 } else { self.steps[foot] };
        aloft(0).max(aloft(1)) as f32 * CONTROL_STEP
    }

    /// How long both feet have been in the air, or were before the one that stands came down, s; 0 with
    /// both on the ground, or if the other was lifted only after that.
    fn flight(&self) -> f32 {
        let [left, right] = self.steps;
        let steps = match self.down {
            [false, false] => left.min(right),
            [true, false] => right.saturating_sub(left),
            [false, true] => left.saturating_sub(right),
            [true, true] => 0,
        };
        steps as f32 * CONTROL_STEP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LEFT: [f32; 2] = [315.0, 0.0];
    const RIGHT: [f32; 2] = [0.0, 315.0];
    const BOTH: [f32; 2] = [160.0, 155.0];
    const NONE: [f32; 2] = [0.0; 2];
    const AHEAD: [f32; 3] = [1.0, 0.0, 0.0];

    /// Factor after steps with these forces.
    fn factor(steps: &[([f32; 2], usize)]) -> f32 {
        let mut feet = Footing::default();
        for &(forces, count) in steps {
            (0..count).for_each(|_| feet.step(forces));
        }
        SingleStanceConfig::default().factor(&AHEAD, &feet)
    }

    #[test]
    fn long_steps_pay_by_hand() {
        let close = |got: f32, expected: f32| assert!((got - expected).abs() < 1e-6, "{got}");
        close(factor(&[(BOTH, 9)]), 0.7);
        close(factor(&[(NONE, 9)]), 0.7);
        // The right foot has swung for 10 steps of 20 ms, half of 0.4 s, the left has stood for longer.
        close(factor(&[(BOTH, 9), (LEFT, 10)]), 0.85);
        close(factor(&[(BOTH, 9), (LEFT, 39)]), 1.0);
        close(factor(&[(BOTH, 9), (LEFT, 60)]), 0.7);
        // The left foot has just landed; how long the right has been in the air does not help.
        close(factor(&[(NONE, 30), (LEFT, 2)]), 0.7 + 0.3 * 0.1);
    }

    #[test]
    fn a_run_is_paid_for_its_flight_too() {
        let config = SingleStanceConfig {
            run_from: Some(1.8),
            ..SingleStanceConfig::default()
        };
        let mut feet = Footing::default();
        let mut step = |forces, count| {
            (0..count).for_each(|_| feet.step(forces));
            [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet))
        };
        let close = |got: [f32; 2], expected: [f32; 2]| {
            let near = |i: usize| (got[i] - expected[i]).abs() < 1e-6;
            assert!(near(0) && near(1), "{got:?}");
        };
        close(step(BOTH, 9), [0.7, 0.7]);
        close(step(LEFT, 10), [0.85, 0.85]);
        // The right foot has been in the air for 14 of 20 steps.
        close(step(NONE, 4), [0.7, 0.7 + 0.3 * 0.7]);
        // It lands; the left is in the air for 4 steps and 2.
        close(step(RIGHT, 2), [0.7 + 0.3 * 0.1, 0.7 + 0.3 * 0.3]);
    }

    #[test]
    fn flight_pays_until_the_next_foot_is_lifted_and_a_walk_has_none() {
        let config = SingleStanceConfig {
            share: 1.0,
            run_from: Some(1.8),
            flight: 1.0,
            ..SingleStanceConfig::default()
        };
        let mut feet = Footing::default();
        let mut paid = |forces, count| {
            (0..count).for_each(|_| feet.step(forces));
            [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet))[1]
        };
        let close = |got: f32, expected: f32| assert!((got - expected).abs() < 1e-6, "{got}");
        close(paid(BOTH, 9), 0.0);
        close(paid(LEFT, 10), 0.0);
        // The left foot follows: 20 ms of 40.
        close(paid(NONE, 1), 0.5);
        // Whoever lands after that has flown for as long, and for nothing more.
        close(paid(RIGHT, 12), 0.5);
        close(paid(NONE, 2), 1.0);
        close(paid(NONE, 3), 1.0);
        close(paid(LEFT, 3), 1.0);
        // Down with both, and off with one: a walk again.
        close(paid(BOTH, 1), 0.0);
        close(paid(RIGHT, 8), 0.0);
    }

    #[test]
    fn a_part_of_a_run_is_paid_for_flight() {
        let config = SingleStanceConfig {
            run_from: Some(1.8),
            flight: 0.5,
            ..SingleStanceConfig::default()
        };
        let mut feet = Footing::default();
        (0..10).for_each(|_| feet.step(LEFT));
        // Half of 0.4 s pays half of the share, of which half is for flight at a run: none yet.
        let factors = [1.7, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet));
        assert!((factors[0] - 0.85).abs() < 1e-6 && (factors[1] - 0.775).abs() < 1e-6);
    }

    #[test]
    fn beyond_a_walk_and_below_a_run_only_obeying_is_paid() {
        let config = SingleStanceConfig {
            walk_to: Some(1.2),
            run_from: Some(1.8),
            run_share: Some(0.1),
            ..SingleStanceConfig::default()
        };
        // Both feet down: no long step is paid for, and neither is flight.
        let feet = Footing::default();
        let factors = [1.2, 1.3, 1.8].map(|speed| config.factor(&[speed, 0.0, 0.0], &feet));
        assert_eq!(factors, [0.7, 1.0, 0.9]);
    }

    #[test]
    fn who_is_told_to_stand_is_not_asked_to_lift_a_foot() {
        let feet = Footing::default();
        let config = SingleStanceConfig::default();
        assert_eq!(config.factor(&[0.0; 3], &feet), 1.0);
        assert_eq!(config.factor(&[0.0, 0.0, 0.5], &feet), 0.7);
    }

    #[test]
    fn who_is_told_to_stand_may_be_asked_to_keep_both_feet_down() {
        let config = SingleStanceConfig {
            standing: 0.4,
            ..SingleStanceConfig::default()
        };
        let mut feet = Footing::default();
        feet.step(BOTH);
        assert_eq!(config.factor(&[0.0; 3], &feet), 1.0);
        assert_eq!(config.factor(&[0.0, 0.0, 0.5], &feet), 0.7);
        for forces in [LEFT, NONE] {
            feet.step(forces);
            assert_eq!(config.factor(&[0.0; 3], &feet), 0.6);
        }
    }

    #[test]
    fn shares_beyond_all_and_times_of_nothing_are_refused() {
        let refused = |share, seconds| {
            let config = SingleStanceConfig {
                share,
                seconds,
                run_from: Some(0.2),
                ..SingleStanceConfig::default()
            };
            config.validate().unwrap_err().to_string()
        };
        assert!(refused(1.5, 0.4).contains("single_stance.share = 1.5"));
        assert!(refused(0.5, 0.0).contains("single_stance.seconds = 0"));
        assert!(refused(0.5, 0.4).contains("single_stance.run_from = 0.2"));
        let unpaid = SingleStanceConfig {
            flight: 0.5,
            ..SingleStanceConfig::default()
        };
        let refused = unpaid.validate().unwrap_err().to_string();
        assert!(refused.contains("single_stance.flight = 0.5"), "{refused}");
        let never = SingleStanceConfig {
            run_share: Some(0.2),
            ..SingleStanceConfig::default()
        };
        let refused = never.validate().unwrap_err().to_string();
        assert!(refused.contains("run_share = 0.2"), "{refused}");
        let backward = SingleStanceConfig {
            walk_to: Some(-1.0),
            ..SingleStanceConfig::default()
        };
        let refused = backward.validate().unwrap_err().to_string();
        assert!(refused.contains("walk_to = -1"), "{refused}");
        SingleStanceConfig::default().validate().unwrap();
    }
}
