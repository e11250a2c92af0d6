//! Walking ahead at up to 1.8 m/s, sideways, on a curve, on the spot.
//!
//! Separate because it is the choice of figures for a walk: legs, pelvis and trunk from the
//! normative human tables, arms from a walk of the G1, contact and balance from geometry. The tables
//! begin at 0.4 m/s; from there down to stepping on the spot their motion fades, and what is left is
//! lifting one foot after the other.

use super::bounce::Bounce;
use super::foot::{FootPath, Rocker};
use super::foothold::{Footing, Side, standing};
use super::g1_fits;
use super::harmonics::Harmonics;
use super::normative::{self, GRAVITY, LEG};
use super::stride::{Base, Leg, Stride, human_swing};
use super::way::{Change, Way};
use crate::velocity::Velocity;
use g1::links::SOLE_DEPTH;
use std::f64::consts::TAU;

/// The slowest walk that the tables have, m/s.
const SLOWEST: f64 = 0.4;

/// Duration of a stride, s, at a velocity whose forward speed is not below 0.
///
/// Ahead it is the normative one, and from 0.4 m/s down it falls to the 1.1 s of marching on the spot.
/// Steps aside and turns cannot be long: on the spot a stride stays below 0.3 m aside and 1.2 rad,
/// however fast; a fast walk takes longer ones, since its feet pass one another.
pub(super) fn period(velocity: &Velocity) -> f64 {
    const ON_THE_SPOT: f64 = 1.1;
    let ahead = velocity.forward;
    let slowest = normative::walking_period(SLOWEST);
    let straight = if ahead < SLOWEST {
        ON_THE_SPOT + (slowest - ON_THE_SPOT) * ahead / SLOWEST
    } else {
        normative::walking_period(ahead)
    };
    let aside = (velocity.lateral / 0.3).hypot(velocity.yaw_rate / 1.2);
    let bound = closeness(velocity) * aside * aside;
    1.0 / (straight.powi(-2) + bound).sqrt()
}

/// How much the feet are in each other's way: 1 on the spot, less the farther apart they land.
fn closeness(velocity: &Velocity) -> f64 {
    1.0 / (1.0 + velocity.forward.powi(2))
}

/// A walk at a velocity whose forward speed is not below 0, and `lean`, its speed ahead as the trunk
/// leans to it, m/s; `None` if no pose of the legs makes it.
pub(super) fn walk(velocity: Velocity, period: f64, lean: f64) -> Option<Stride> {
    let fit = &g1_fits::WALK;
    let speed = velocity.forward.max(SLOWEST);
    // How much of the slowest walk's motion is left.
    let fade = (velocity.forward / SLOWEST).min(1.0);
    let faded = |on_the_spot: f64, walking: f64| on_the_spot + fade * (walking - on_the_spot);
    // Steps aside and turns are quick for the ground that they cover.
    let pace =
        (speed.powi(2) + (2.0 * velocity.lateral).powi(2) + (0.8 * velocity.yaw_rate).powi(2))
            .sqrt();
    let stance = normative::stance_share(pace);
    let relative = speed / 0.98; // to the speed of the G1's walk

    let tilt = normative::PELVIC_TILT.at_speed(speed).symmetric();
    // The waist cannot pitch, so the pelvis takes the trunk's lean, which grows with speed.
    let pitch = tilt.about(fit.pitch.mean * lean / 0.98).swings_scaled(fade);
    let flexion = normative::HIP_FLEXION.at_speed(speed);
    let leg = Leg {
        hip_pitch: flexion
            .about(flexion.mean - tilt.mean + pitch.mean)
            .scaled(-1.0),
        knee: normative::KNEE_FLEXION.at_speed(speed),
        ankle_pitch: normative::ANKLE_DORSIFLEXION.at_speed(speed).scaled(-1.0),
    };
    let yaw = normative::PELVIC_ROTATION
        .at_speed(speed)
        .antisymmetric()
        .scaled(fade);
    let trunk = normative::TRUNK_ROTATION
        .at_speed(speed)
        .antisymmetric()
        .scaled(fade);

    let half_width = half_width(0.09, &velocity, period);
    // Half of a compass gait's rise: the knee yields to the other half.
    let step = velocity.speed() * period / 2.0;
    let amplitude = 0.35 * (LEG - (LEG * LEG - step * step / 4.0).sqrt());
    let bounce = Bounce::Vault { amplitude, stance };
    let level = 0.785 - amplitude;
    let [swing_x, swing_lift, swing_pitch] =
        human_swing(&leg, &pitch, |phase| level + bounce.at(phase));
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
            roll: normative::PELVIC_OBLIQUITY
                .at_speed(speed)
                .antisymmetric()
                .scaled(-1.0)
                .about(roll),
            pitch,
            yaw,
            surge: fit
                .surge
                .symmetric()
                .about(0.0)
                .swings_scaled(relative * fade),
            sway: sway(half_width, period, stance),
            bounce,
            level,
            crouch: 0.0,
        },
        foot: FootPath {
            rocker: Rocker {
                stance,
                // A rigid sole rolls less than a human foot, which bends at the toes.
                contact_pitch: fade * (0.85 * swing_pitch.at(0.0)).clamp(-0.3, -0.04),
                heel_share: 0.12,
                toe_off_pitch: faded(0.08, (0.6 * swing_pitch.at(stance)).clamp(0.2, 0.65)),
                toe_share: 0.25,
            },
            footing: Footing {
                centre: faded(standing(Side::Right).translation.x, -0.06),
                half_width,
                shift,
            },
            swing_x: swing_x.swings_scaled(fade),
            swing_lift,
            swing_pitch: swing_pitch.scaled(fade),
            clearance: 0.04,
        },
        waist: trunk.plus(&yaw.scaled(-1.0)),
        arm: fit
            .arm
            .map(|curve| curve.swings_scaled(faded(0.15, relative.powf(0.75)))),
    }
    .raised(level, 0.12)
}

/// Half of the distance between the ankles' lines, m: `straight`, or what keeps 8 cm between the soles
/// where a step aside or a turn brings the feet together.
pub(super) fn half_width(straight: f64, velocity: &Velocity, period: f64) -> f64 {
    let closeness = closeness(velocity);
    // Soles 6 cm wide; a quarter of a stride's way aside, and some, since a foot swings beyond its
    // place before it is put down.
    let narrow = 0.078 + closeness * 0.32 * velocity.lateral.abs() * period;
    // The toes, 0.12 m ahead, turn toward each other by a quarter of a stride's turn, and some.
    let toes = 0.12 * (0.3 * velocity.yaw_rate * period).sin().abs();
    let toes = 0.5 * (1.0 + closeness) * toes;
    (straight + toes).max(narrow + 0.6 * toes)
}

/// Roll of the body (rad) on a curve, and how far the feet are then to the left of the pelvis (m).
///
/// tan(lean) = v·ω/g adds gravity and the curve's pull up along the legs; but the ankles roll by
/// 0.26 rad at most, so a tight curve is leaned into less.
pub(super) fn into_the_curve(velocity: &Velocity, level: f64) -> (f64, f64) {
    const MOST: f64 = 0.17;
    let lean = (velocity.forward * velocity.yaw_rate / GRAVITY).atan();
    let lean = MOST * (lean / MOST).tanh();
    (-lean, -lean.tan() * (level - SOLE_DEPTH))
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
