//! Standing on one foot at a time, or running: long steps pay more than many short ones.
//!
//! A wish of its own: Eq. 14 asks for a velocity, and small quick steps, a shuffle or a hop obey it as well as a walk. The
//! discriminator looks at a tenth of a second; how long a foot stays in the air is beyond it.

use crate::feet::{Foot, Footing};
use crate::kind::Kind;
use crate::moment::Moment;
use crate::terms::Term;
use crate::time::CONTROL_STEP;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use vocabulary::{Checked, Ramp, invalid};

/// What standing on one foot pays. As Isaac Lab's `feet_air_time_positive_biped`, which adds a reward;
/// here it is a factor, so that the task reward stays between 0 and 1, where Eq. 9 and Eq. 12 expect it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SingleStance {
    /// The power that the factor is raised to. Default 1.
    pub weight: Ramp<f32>,
    /// Share of the task reward that is paid for it. Default 0.3.
    pub share: Ramp<f32>,
    /// Time for which one foot has to stand and the other to swing until all of the share is paid, s.
    /// Default 0.4, nearly half of a stride of the reference gait at 1 m/s.
    pub seconds: f32,
    /// Exponent of what a walk is paid, at least 1. Default 1: pay grows with the length of a step. With 2 it grows with
    /// its square, against the quick small steps of robots that are pushed about.
    #[serde(skip_serializing_if = "is_one")]
    pub power: f32,
    /// Share of the task reward that is paid for it to a robot that is told anything but straight ahead, instead of
    /// `share`. Default: `share`. Less than it leaves more of the reward for obeying where steps are harder.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aside_share: Option<f32>,
    /// Height of the swinging foot's sole up to which a walk's steps are paid in full, m; from there pay falls to nothing
    /// at twice it. Default: any height; steps are then long because feet are lifted high, at twice the work.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lift: Option<f32>,
    /// Commanded forward speed up to which long steps are paid, m/s; from there to a run all of the task reward is for
    /// obeying. Default: at any speed. A robot that sets off at once to a high speed has no time for long steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub walk_to: Option<f32>,
    /// Commanded forward speed from which a run is asked for, m/s: then how long a foot has been in the air
    /// counts, whether the other stands or not. Default: never; robots then walk at 2 m/s, though the clips there run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run_from: Option<f32>,
    /// Share of the task reward that is paid for a run, instead of `share`. Default: `share`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub run_share: Option<f32>,
    /// Part of a run's pay that is for flight itself, all of it for 40 ms between one foot's lift-off and the other's
    /// landing. Default 0: then a walk of long steps earns as much as a run.
    #[serde(skip_serializing_if = "is_nothing")]
    pub flight: f32,
    /// Share of the task reward that a robot that is told to stand loses while a foot is in the air. Default 0: stepping on
    /// the spot then obeys nearly as well as standing.
    #[serde(skip_serializing_if = "is_nothing")]
    pub standing: f32,
}

fn is_nothing(share: &f32) -> bool {
    *share == 0.0
}

fn is_one(power: &f32) -> bool {
    *power == 1.0
}

/// Flight for which all of [`SingleStance::flight`] is paid, s: an eighth of a step at three steps a second. Twice
/// a control step: what a foot touches in part of one counts as touched.
const FLIGHT: f32 = 0.04;

/// Least [`SingleStance::lift`], m: with less, hardly any step would be low enough to be paid.
const LEAST_LIFT: f32 = 0.01;

impl Default for SingleStance {
    fn default() -> Self {
        Self {
            weight: 1.0.into(),
            share: 0.3.into(),
            seconds: 0.4,
            power: 1.0,
            aside_share: None,
            lift: None,
            walk_to: None,
            run_from: None,
            run_share: None,
            flight: 0.0,
            standing: 0.0,
        }
    }
}

impl SingleStance {
    /// Factor of the task reward, 1 − s·(1 − pⁿ) with p = min(t/T, 1) up to t = 2·T and 0 beyond. t is how long the
    /// feet have been as they are, the shorter of the two, if just one of them stands, and 0 otherwise. s may be another
    /// of any way but straight ahead. With `lift` l, pⁿ is times min(max(2 − h/l, 0), 1), h the height of the swinging
    /// foot (m), which is asked for only then. Without the end at 2·T robots that are told to turn on the spot stand on one leg.
    ///
    /// Of a run, t is how long the foot that was lifted first is in the air, n is 1, no height counts, f of p is
    /// min(flight/40 ms, 1) instead, and s may be another. Between `walk_to` and a run the factor is 1. A robot that is
    /// told to stand gets 1 with both feet down, else 1 less `standing`.
    pub(crate) fn factor(
        &self,
        command: &[f32; 3],
        feet: &Footing,
        height: impl FnOnce(Foot) -> f32,
    ) -> f32 {
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
            let share = match Kind::of(*command) {
                Kind::Forward => self.share.now(),
                _ => self.aside_share.unwrap_or(self.share.now()),
            };
            let low = match (self.lift, feet.swinging()) {
                (Some(lift), Some(foot)) => (2.0 - height(foot) / lift).clamp(0.0, 1.0),
                _ => 1.0,
            };
            return 1.0 - share * (1.0 - low * paid.powf(self.power));
        }
        let paid = paid + self.flight * ((feet.flight() / FLIGHT).min(1.0) - paid);
        1.0 - self.run_share.unwrap_or(self.share.now()) * (1.0 - paid)
    }
}

impl Term for SingleStance {
    fn weight(&self) -> &Ramp<f32> {
        &self.weight
    }

    fn value(&self, moment: &Moment<'_>) -> f32 {
        let height = |foot: Foot| foot.height(moment.state);
        self.factor(moment.command, moment.feet, height)
    }

    fn set(&mut self, samples: f64) {
        self.weight.set(samples);
        self.share.set(samples);
    }

    fn validate(&self) -> Checked {
        self.share.check("share", invalid::share)?;
        invalid::at_least("seconds", self.seconds, CONTROL_STEP)?;
        invalid::at_least("power", self.power, 1.0)?;
        if let Some(share) = self.aside_share {
            invalid::share("aside_share", share)?;
        }
        invalid::share("flight", self.flight)?;
        invalid::require(
            self.flight == 0.0 || self.run_from.is_some(),
            "flight",
            self.flight,
            "say with run_from from which speed on it is paid",
        )?;
        if let Some(share) = self.run_share {
            invalid::share("run_share", share)?;
            invalid::require(
                self.run_from.is_some(),
                "run_share",
                share,
                "say with run_from from which speed on it counts",
            )?;
        }
        if let Some(height) = self.lift {
            invalid::at_least("lift", height, LEAST_LIFT)?;
        }
        if let Some(speed) = self.walk_to {
            invalid::at_least("walk_to", speed, 0.0)?;
        }
        invalid::share("standing", self.standing)?;
        self.run_from
            .map_or(Ok(()), |speed| invalid::at_least("run_from", speed, 0.5))
    }
}

#[cfg(test)]
mod tests;
