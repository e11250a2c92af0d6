//! Standing on one foot at a time, or running: long steps pay more than many short ones.
//!
//! Separate because it is a measure with a memory, and a wish of its own: Eq. 14 asks for a velocity,
//! and small quick steps, a shuffle or a hop obey it as well as a walk. The discriminator looks at a
//! tenth of a second; how long a foot stays in the air is beyond it.

use crate::config::{self, Invalid};
use crate::kind::Kind;
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
    /// Exponent of what a walk is paid, at least 1. Default 1: pay grows with the length of a step. With 2 it grows with
    /// its square: where robots are pushed about, they took quick small steps however large the share was.
    #[serde(skip_serializing_if = "is_one")]
    pub power: f32,
    /// Share of the task reward that is paid for it to who is told anything but straight ahead, instead of `share`.
    /// Default: `share`. Robots that were paid alike in all directions fell more often aside and on the spot; what else
    /// changed when they no longer did has not been tried apart.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub aside_share: Option<f32>,
    /// Height of the swinging foot's sole up to which a walk's steps are paid in full, m; from there pay falls to nothing
    /// at twice it. Default: any height. Long steps were bought by lifting feet 14 cm, at twice the joules.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lift: Option<f32>,
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

fn is_one(power: &f32) -> bool {
    *power == 1.0
}

/// Flight for which all of [`SingleStanceConfig::flight`] is paid, s: an eighth of a step at three steps a second. Twice
/// a control step: what a foot touches in part of one counts as touched.
const FLIGHT: f32 = 0.04;

/// Least [`SingleStanceConfig::lift`], m: with less, hardly any step would be low enough to be paid.
const LEAST_LIFT: f32 = 0.01;

impl Default for SingleStanceConfig {
    fn default() -> Self {
        Self {
            share: 0.3,
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

impl SingleStanceConfig {
    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Result<(), Invalid> {
        config::share("single_stance.share", self.share)?;
        config::at_least("single_stance.seconds", self.seconds, CONTROL_STEP)?;
        config::at_least("single_stance.power", self.power, 1.0)?;
        if let Some(share) = self.aside_share {
            config::share("single_stance.aside_share", share)?;
        }
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
        if let Some(height) = self.lift {
            config::at_least("single_stance.lift", height, LEAST_LIFT)?;
        }
        if let Some(speed) = self.walk_to {
            config::at_least("single_stance.walk_to", speed, 0.0)?;
        }
        config::share("single_stance.standing", self.standing)?;
        self.run_from.map_or(Ok(()), |speed| {
            config::at_least("single_stance.run_from", speed, 0.5)
        })
    }

    /// Factor of the task reward, 1 − s·(1 − pⁿ) with p = min(t/T, 1) up to t = 2·T and 0 beyond. t is how long the
    /// feet have been as they are, the shorter of the two, if just one of them stands, and 0 otherwise. s may be another
    /// of any way but straight ahead. With `lift` l, pⁿ is times min(max(2 − h/l, 0), 1), h the height of the swinging
    /// foot (m), which is asked for only then. Without the end at 2·T those told to turn on the spot stood on one leg.
    ///
    /// Of a run, t is how long the foot that was lifted first is in the air, n is 1, no height counts, f of p is
    /// min(flight/40 ms, 1) instead, and s may be another. Between `walk_to` and a run the factor is 1. Who is told to
    /// stand gets 1 with both feet down, else 1 less `standing`.
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
                Kind::Forward => self.share,
                _ => self.aside_share.unwrap_or(self.share),
            };
            let low = match (self.lift, feet.swinging()) {
                (Some(lift), Some(foot)) => (2.0 - height(foot) / lift).clamp(0.0, 1.0),
                _ => 1.0,
            };
            return 1.0 - share * (1.0 - low * paid.powf(self.power));
        }
        let paid = paid + self.flight * ((feet.flight() / FLIGHT).min(1.0) - paid);
        1.0 - self.run_share.unwrap_or(self.share) * (1.0 - paid)
    }
}

/// A foot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Foot {
    Left,
    Right,
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

    /// The foot in the air while the other stands; none with both or none on the ground.
    fn swinging(&self) -> Option<Foot> {
        match self.down {
            [false, true] => Some(Foot::Left),
            [true, false] => Some(Foot::Right),
            _ => None,
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
mod tests;
