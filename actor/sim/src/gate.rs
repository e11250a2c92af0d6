//! What is left of the task's pay: named factors in [0, 1] (see [`crate::reward`]).
//!
//! Separate from the terms because a factor cannot be made up for: a robot that lies is paid nothing, however well it
//! follows. A gate is a file of its own and a line of the table below.

pub mod effort;
pub mod upright;

use crate::moment::Moment;
use crate::terms::{Sums, table};
use effort::Effort;
use upright::Upright;

table! {
    /// `[task.gate]`: the factors, each raised to its weight. One that is not listed, or weighs nothing, does not exist.
    GateConfig, "gate", from crate::reward::NAMES.len();
    /// Standing upright (Eq. 14).
    upright: Upright = Some(Upright::default());
    /// Sparing work.
    effort: Effort = None;
}

impl GateConfig {
    /// What all factors leave of a reward.
    pub(crate) fn of(&self, reward: f32, moment: &Moment<'_>, sums: &mut Sums) -> f32 {
        let mut left = reward;
        self.each(|place, weight, gate| {
            let factor = gate.raised(moment, weight);
            sums.add(place, factor);
            left *= factor;
        });
        left
    }
}
