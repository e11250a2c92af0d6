//! Running at about 1.8 to 2.7 m/s, with phases of flight, straight ahead or on a curve.
//!
//! Separate because it is the choice of figures for a run: legs, base, waist and arms from a run of
//! the G1 at 1.83 m/s, stride rate from human running, the bounce from free fall.

use super::bounce::Bounce;
use super::foot::{FootPath, Rocker};
use super::foothold::Footing;
use super::g1_fits;
use super::harmonics::Harmonics;
use super::stride::{Base, Leg, Stride, human_swing};
use super::walk::{half_width, into_the_curve, sway};
use super::way::{Change, Way};
use crate::velocity::Velocity;

/// Share of the stride that a foot is on the ground: below one half, so that both leave it.
///
/// From 0.35 when jogging at 1.8 m/s to 0.30 at 2.7 m/s.
pub(super) fn stance_share(speed: f64) -> f64 {
    0.35 - (speed - 1.8) / 0.9 * 0.05
}

/// A run at a velocity; `None` if no pose of the legs makes it.
pub(super) fn run(velocity: Velocity, period: f64) -> Option<Stride> {
    let fit = &g1_fits::RUN;
    // The fit's phase is 0 with the foot furthest forward; contact follows when it swings back.
    const CONTACT: f64 = 0.09;
    let stance = stance_share(velocity.forward);
    let leg = Leg {
        hip_pitch: fit.hip_pitch.shifted(CONTACT),
        // A little less swing keeps the knee below its top speed at the higher stride rate.
        knee: fit.knee.shifted(CONTACT).swings_scaled(0.8),
        ankle_pitch: fit.ankle_pitch.shifted(CONTACT),
    };
    let pitch = fit.pitch.shifted(CONTACT).symmetric();
    let bounce = Bounce::Spring { period, stance };
    let level = 0.77;
    let [swing_x, swing_lift, swing_pitch] =
        human_swing(&leg, &pitch, |phase| level + bounce.at(phase));
    let half_width = half_width(0.085, &velocity, period);
    let (roll, shift) = into_the_curve(&velocity, level);
    Stride {
        way: Way {
            velocity,
            period,
            change: Change::Steady,
        },
        begin: 0.0,
        reversed: false,
        leg,
        base: Base {
            roll: fit.roll.shifted(CONTACT).antisymmetric().about(roll),
            pitch,
            yaw: fit.yaw.shifted(CONTACT).antisymmetric(),
            surge: Harmonics::still(0.0),
            sway: sway(half_width, period, stance),
            bounce,
            level,
            crouch: 0.0,
        },
        foot: FootPath {
            rocker: Rocker {
                stance,
                contact_pitch: -0.15,
                heel_share: 0.08,
                toe_off_pitch: 0.5,
                toe_share: 0.2,
            },
            footing: Footing {
                centre: -0.08,
                half_width,
                shift,
            },
            swing_x,
            swing_lift,
            swing_pitch,
            clearance: 0.05,
        },
        waist: fit.waist_yaw.shifted(CONTACT).antisymmetric(),
        arm: fit.arm.map(|curve| curve.shifted(CONTACT)),
    }
    .raised(level, 0.3)
}
