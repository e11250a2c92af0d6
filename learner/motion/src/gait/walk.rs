//! Walking at any speed from 0.4 to 1.8 m/s.
//!
//! Separate because it is the choice of figures for a walk: legs, pelvis and trunk from the
//! normative human tables, arms from a walk of the G1, contact and balance from geometry.

use super::foot::{FootPath, Rocker};
use super::g1_fits;
use super::harmonics::Harmonics;
use super::normative::{self, GRAVITY, LEG};
use super::stride::{Base, Bounce, Leg, Stride, human_swing};
use std::f64::consts::TAU;

/// A walk at a speed, m/s; `None` if no pose of the legs makes it.
pub(super) fn walk(speed: f64, period: f64) -> Option<Stride> {
    let fit = &g1_fits::WALK;
    let stride = speed * period;
    let stance = normative::stance_share(speed);
    let relative = speed / 0.98; // to the speed of the G1's walk

    let tilt = normative::PELVIC_TILT.at_speed(speed).symmetric();
    // The waist cannot pitch, so the pelvis takes the trunk's lean, which grows with speed.
    let pitch = tilt.about(fit.pitch.mean * relative);
    let flexion = normative::HIP_FLEXION.at_speed(speed);
    let leg = Leg {
        hip_pitch: flexion
            .about(flexion.mean - tilt.mean + pitch.mean)
            .scaled(-1.0),
        knee: normative::KNEE_FLEXION.at_speed(speed),
        ankle_pitch: normative::ANKLE_DORSIFLEXION.at_speed(speed).scaled(-1.0),
    };
    let yaw = normative::PELVIC_ROTATION.at_speed(speed).antisymmetric();
    let trunk = normative::TRUNK_ROTATION.at_speed(speed).antisymmetric();

    let half_width = 0.09;
    // Half of a compass gait's rise: the knee yields to the other half.
    let step = stride / 2.0;
    let amplitude = 0.35 * (LEG - (LEG * LEG - step * step / 4.0).sqrt());
    let bounce = Bounce::Vault { amplitude, stance };
    let level = 0.785 - amplitude;
    let [swing_x, swing_lift, swing_pitch] =
        human_swing(&leg, &pitch, |phase| level + bounce.at(phase));

    Stride {
        speed,
        period,
        leg,
        base: Base {
            roll: normative::PELVIC_OBLIQUITY
                .at_speed(speed)
                .antisymmetric()
                .scaled(-1.0),
            pitch,
            yaw,
            surge: fit.surge.symmetric().about(0.0).swings_scaled(relative),
            sway: sway(half_width, period, stance),
            bounce,
            level,
        },
        foot: FootPath {
            rocker: Rocker {
                stance,
                // A rigid sole rolls less than a human foot, which bends at the toes.
                contact_pitch: (0.85 * swing_pitch.at(0.0)).clamp(-0.3, -0.04),
                heel_share: 0.12,
                toe_off_pitch: (0.6 * swing_pitch.at(stance)).clamp(0.2, 0.65),
                toe_share: 0.25,
            },
            stride,
            centre: -0.06,
            swing_x,
            swing_lift,
            swing_pitch,
            clearance: 0.04,
        },
        half_width,
        waist: trunk.plus(&yaw.scaled(-1.0)),
        arm: fit
            .arm
            .map(|curve| curve.swings_scaled(relative.powf(0.75))),
    }
    .raised(level, 0.12)
}

/// Sideways motion of the base toward the standing foot, m (left positive).
///
/// An inverted pendulum that changes feet every half period swings to
/// w·(1 − 1/cosh(ωT/4)), ω = √(g/z), and is furthest over in the middle of single support.
pub(super) fn sway(half_width: f64, period: f64, stance: f64) -> Harmonics {
    let omega = (GRAVITY / 0.7).sqrt();
    let amplitude = half_width * (1.0 - 1.0 / (omega * period / 4.0).cosh());
    let (sin, cos) = (TAU * stance / 2.0).sin_cos();
    let mut curve = Harmonics::still(0.0);
    // −amplitude·cos(2π(φ − stance/2)): rightward while the right foot stands.
    (curve.cos[0], curve.sin[0]) = (-amplitude * cos, -amplitude * sin);
    curve
}
