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
use vocabulary::{Checked, Invalid};

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

    /// Refuses a table that at some time pays for nothing. Between the samples at which a weight begins to move or has
    /// arrived, the sum is a straight line, and no weight is below 0; samples are whole.
    pub(crate) fn pays(&self) -> Checked {
        let turns = self.weights().filter_map(|(_, weight)| weight.samples());
        let moments = turns
            .flatten()
            .flat_map(|turn| [turn.floor(), turn.floor() + 1.0]);
        let sum = |samples| -> f32 { self.weights().map(|(_, weight)| weight.at(samples)).sum() };
        if moments.chain([0.0]).all(|samples| sum(samples) > 0.0) {
            return Ok(());
        }
        Err(Invalid::new(
            "reward",
            "no term",
            "give at every time at least one term a weight above 0, such as reward.track.weight = 1",
        ))
    }
}
