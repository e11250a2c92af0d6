//! Starting and stopping: a walk whose speed rises from nothing or falls to it within about a stride.
//!
//! Separate because it is the choice of moments: when weight is shifted, which foot goes, when the
//! speed is reached. Everything between follows from the way (`way.rs`). A stop is not a start seen
//! backward, since heels strike and toes push off in both; but a start backward is a stop seen so.

use super::stride::Stride;
use super::way::{Change, Ramp};

/// Strides before the first foot is lifted, or after the last is put down, in which the body is
/// already, or still, moving.
const SHIFT: f64 = 0.2;
/// Strides after the first lift or before the last landing in which the weight swings fully.
const SWING: f64 = 0.15;
/// Standing before and after, s.
const STILL: f64 = 0.1;
/// Strides of the steady gait before and after.
const STEADY: f64 = 0.25;
/// Greatest acceleration, m/s²: at a fifth of gravity the body still balances over a foot's length.
const ACCELERATION: f64 = 2.0;
/// Least bend of a knee, rad: half of a steady walk's.
const KNEE: f64 = 0.06;

/// From standing to a walk, and its duration, s. `None` if no pose of the legs makes it.
pub(super) fn start(walk: Stride) -> Option<(Stride, f64)> {
    if walk.reversed {
        halting(walk)
    } else {
        setting_off(walk)
    }
}

/// From a walk to standing, and its duration, s. `None` if no pose of the legs makes it.
pub(super) fn stop(walk: Stride) -> Option<(Stride, f64)> {
    if walk.reversed {
        setting_off(walk)
    } else {
        halting(walk)
    }
}

/// The speed rises with the phase.
fn setting_off(walk: Stride) -> Option<(Stride, f64)> {
    let lift = walk.foot.rocker.stance;
    let from = lift - SHIFT;
    let speed = Ramp {
        from,
        to: from + strides(&walk),
    };
    let sway = Ramp {
        from,
        to: lift + SWING,
    };
    let change = Change::Start { lift, speed, sway };
    let still = STILL / walk.way.period;
    clipped(walk, change, from - still, speed.to + STEADY)
}

/// The speed falls with the phase.
fn halting(walk: Stride) -> Option<(Stride, f64)> {
    let last = 2.0;
    let to = last + SHIFT;
    let speed = Ramp {
        from: to - strides(&walk),
        to,
    };
    let sway = Ramp {
        from: last - SWING,
        to,
    };
    let change = Change::Stop { last, speed, sway };
    let still = STILL / walk.way.period;
    clipped(walk, change, speed.from - STEADY, to + still)
}

/// How long the speed takes to change: one stride, more if that were too sudden.
fn strides(walk: &Stride) -> f64 {
    // The ramp is steepest in its middle, 1.5 times its mean.
    (1.5 * walk.way.velocity.speed() / ACCELERATION / walk.way.period).max(1.0)
}

fn clipped(mut walk: Stride, change: Change, first: f64, last: f64) -> Option<(Stride, f64)> {
    walk.way.change = change;
    walk.begin = if walk.reversed { last } else { first };
    let seconds = (last - first) * walk.way.period;
    Some((walk.crouched(first..=last, KNEE)?, seconds))
}
