//! Running at about 1.8 to 2.7 m/s, with phases of flight.
//!
//! Separate because it is the choice of figures for a run: legs, base, waist and arms from a run of
//! the G1 at 1.83 m/s, stride rate from human running, the bounce from free fall.

use super::foot::{FootPath, Rocker};
use super::g1_fits;
use super::harmonics::Harmonics;
use super::stride::{Base, Bounce, Leg, Stride, human_swing};
use super::walk::sway;

/// Share of the stride that a foot is on the ground: below one half, so that both leave it.
///
/// From 0.35 when jogging at 1.8 m/s to 0.30 at 2.7 m/s.
pub(super) fn stance_share(speed: f64) -> f64 {
    0.35 - (speed - 1.8) / 0.9 * 0.05
}

/// A run at a speed, m/s; `None` if no pose of the legs makes it.
pub(super) fn run(speed: f64, period: f64) -> Option<Stride> {
    let fit = &g1_fits::RUN;
    // The fit's phase is 0 with the foot furthest forward; contact follows when it swings back.
    const CONTACT: f64 = 0.09;
    let stance = stance_share(speed);
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
    let half_width = 0.085;
    Stride {
        speed,
        period,
        leg,
        base: Base {
            roll: fit.roll.shifted(CONTACT).antisymmetric(),
            pitch,
            yaw: fit.yaw.shifted(CONTACT).antisymmetric(),
            surge: Harmonics::still(0.0),
            sway: sway(half_width, period, stance),
            bounce,
            level,
        },
        foot: FootPath {
            rocker: Rocker {
                stance,
                contact_pitch: -0.15,
                heel_share: 0.08,
                toe_off_pitch: 0.5,
                toe_share: 0.2,
            },
            stride: speed * period,
            centre: -0.08,
            swing_x,
            swing_lift,
            swing_pitch,
            clearance: 0.05,
        },
        half_width,
        waist: fit.waist_yaw.shifted(CONTACT).antisymmetric(),
        arm: fit.arm.map(|curve| curve.shifted(CONTACT)),
    }
    .raised(level, 0.3)
}
