//! What the task pays: a mean of named terms, times what the gates leave of it.
//!
//!   rᴳ = ∏ gᵢ^vᵢ · Σ wᵢ·rᵢ / Σ wᵢ
//!
//! Terms and gates are in [0, 1], and so is rᴳ, where Eq. 9 and Eq. 12 expect it. Eq. 14 is one term, [`track`], and one
//! gate, `upright`; the default has no others. A term is a file of its own and a line of the table below.

pub mod track;

use crate::moment::Moment;
use crate::terms::{Sums, table};
use track::Track;
use vocabulary::{Checked, Invalid, Ramp, invalid};

table! {
    /// `[task.reward]`: the terms, each with its weight. One that is not listed, or weighs nothing, does not exist.
    RewardConfig, "reward", from 0;
    /// Following the command (Eq. 14).
    track: Track = Some(Track::default());
    /// The same with another kernel beside it. A sharp kernel pays next to nothing half a metre per second off, so that
    /// setting off sooner is felt only by its end; a wide one gives a slope to climb.
    track_wide: Track = None;
}

impl RewardConfig {
    /// The weighted mean of the terms.
    pub(crate) fn mean(&self, moment: &Moment<'_>, sums: &mut Sums) -> f32 {
        let (mut paid, mut weights) = (0.0, 0.0);
        self.each(|place, weight, term| {
            let value = term.value(moment);
            sums.add(place, value);
            paid += weight * value;
            weights += weight;
        });
        paid / weights
    }

    /// Refuses a table that pays for nothing, at any time.
    pub(crate) fn pays(&self) -> Checked {
        let lasts = |weight: &Ramp<f32>| weight.check("weight", invalid::positive).is_ok();
        if self.weights().any(|(_, weight)| lasts(weight)) {
            return Ok(());
        }
        Err(Invalid::new(
            "reward",
            "no term",
            "give at least one term a weight above 0 from beginning to end, such as reward.track.weight = 1",
        ))
    }
}
