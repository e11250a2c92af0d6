//! The way of one foot through a stride: planted in stance, human in swing.
//!
//! Separate because ground contact is what joint curves alone get wrong. In stance the path is exact
//! geometry: the foot has a place on the ground (see `foothold.rs`), and a rigid sole there rolls over
//! its heel edge, stands flat, and rolls over its toe edge, so the touching point never slips however
//! the body turns above it. In swing it is the human path, bent so that it leaves and meets stance
//! without a step in position or velocity, and lifted where the sole would scuff.
//!
//! The frame moves with the mean motion of the gait (see `way.rs`): x forward and y left from the mean
//! place of the pelvis, z up from the ground. Pitch is positive with the toe down.

use super::foothold::{Foothold, Footing, Side};
use super::harmonics::Harmonics;
use super::way::Way;
use g1::links::{SOLE_CORNERS, SOLE_DEPTH};
use nalgebra::{Isometry3, Point2, Translation3, UnitQuaternion};
use std::f64::consts::PI;

const HEEL: f64 = SOLE_CORNERS[0][0];
const TOE: f64 = SOLE_CORNERS[2][0];

/// Where the ankle is and how the sole is turned, in the moving frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sole {
    /// Ankle forward and to the left of the mean pelvis, m.
    pub(super) x: f64,
    pub(super) y: f64,
    /// Ankle above the ground, m.
    pub(super) z: f64,
    /// Heading of the foot, to the left positive, rad.
    pub(super) yaw: f64,
    /// Pitch, toe down positive, rad.
    pub(super) pitch: f64,
}

impl Sole {
    /// The frame of the foot's body in the moving frame.
    pub(super) fn frame(&self) -> Isometry3<f64> {
        Isometry3::from_parts(
            Translation3::new(self.x, self.y, self.z),
            UnitQuaternion::from_euler_angles(0.0, self.pitch, self.yaw),
        )
    }
}

/// How a foot rolls through stance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rocker {
    /// Share of the stride on the ground.
    pub(super) stance: f64,
    /// Pitch at contact (≤ 0: toe up), rad, and the share of the stride until the sole is flat.
    pub(super) contact_pitch: f64,
    pub(super) heel_share: f64,
    /// Pitch at toe-off (≥ 0: toe down), rad, and the share of the stride that it takes to rise.
    pub(super) toe_off_pitch: f64,
    pub(super) toe_share: f64,
}

impl Rocker {
    /// Pitch at a phase since contact.
    fn pitch(&self, phase: f64, foothold: &Foothold) -> f64 {
        let heel = (1.0 - phase / self.heel_share).max(0.0);
        let toe = (1.0 + (phase - self.stance) / self.toe_share).max(0.0);
        self.contact_pitch * foothold.contact * heel * heel
            + self.toe_off_pitch * foothold.toe_off * toe * toe
    }
}

/// The path of a foot.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootPath {
    pub(super) rocker: Rocker,
    pub(super) footing: Footing,
    /// Human swing: ankle forward of the pelvis, lowest point of the sole, pitch.
    pub(super) swing_x: Harmonics,
    pub(super) swing_lift: Harmonics,
    pub(super) swing_pitch: Harmonics,
    /// Least lift of the sole in the middle of swing, m.
    pub(super) clearance: f64,
}

impl FootPath {
    /// The foot of a side at a phase of the way.
    pub(super) fn at(&self, side: Side, phase: f64, way: &Way) -> Sole {
        let own = phase + side.lag();
        let here = self.foothold(side, own.floor(), way);
        if here.stays || own - here.contact_phase < self.rocker.stance {
            return self.planted(&here, own, way);
        }
        let next = self.foothold(side, own.floor() + 1.0, way);
        self.swing(&here, &next, own, way)
    }

    fn foothold(&self, side: Side, contact_phase: f64, way: &Way) -> Foothold {
        self.footing
            .foothold(side, contact_phase, self.rocker.stance, way)
    }

    fn planted(&self, foothold: &Foothold, phase: f64, way: &Way) -> Sole {
        let pitch = self.rocker.pitch(phase - foothold.contact_phase, foothold);
        // The edge that touches stays where it is on the flat sole; the ankle turns about it.
        let edge = if pitch < 0.0 { HEEL } else { TOE };
        let (sin, cos) = pitch.sin_cos();
        let rolled = edge - (edge * cos - SOLE_DEPTH * sin);
        let place = way.frame(phase - foothold.side.lag()).inverse() * foothold.place;
        let ankle = place * Point2::new(rolled, 0.0);
        Sole {
            x: ankle.x,
            y: ankle.y,
            z: edge * sin + SOLE_DEPTH * cos,
            yaw: place.rotation.angle(),
            pitch,
        }
    }

    /// Between two footholds: the human curve plus the cubic that closes its gaps to stance at both
    /// ends, in value and slope.
    fn swing(&self, from: &Foothold, to: &Foothold, phase: f64, way: &Way) -> Sole {
        const H: f64 = 1e-5;
        let (off, on) = (from.contact_phase + self.rocker.stance, to.contact_phase);
        let span = on - off;
        let u = (phase - off) / span;
        let share = way.share(0.5 * (off + on) - from.side.lag());
        let leaving = [off - H, off].map(|phase| self.planted(from, phase, way));
        let meeting = [on, on + H].map(|phase| self.planted(to, phase, way));
        let bent = |human: &dyn Fn(f64) -> f64, stance: &dyn Fn(&Sole) -> f64| {
            let gap = |sole: &Sole, phase: f64| stance(sole) - human(phase);
            let gap_off = gap(&leaving[1], off);
            let gap_on = gap(&meeting[0], on);
            let slope_off = (gap_off - gap(&leaving[0], off - H)) / H * span;
            let slope_on = (gap(&meeting[1], on + H) - gap_on) / H * span;
            human(phase) + hermite(u, gap_off, slope_off, gap_on, slope_on)
        };
        let human = |curve: &Harmonics, phase| curve.mean + share * (curve.at(phase) - curve.mean);
        let pitch = bent(&|phase| human(&self.swing_pitch, phase), &|sole| sole.pitch);
        let free = bent(&|phase| human(&self.swing_lift, phase), &|_| 0.0);
        let needed = self.clearance * (PI * u).sin().powi(2);
        let lift = smooth_max(free, needed, 0.02 * (PI * u).sin().powi(2));
        // Stance turns about an edge, swing about the rounded lowest point: they differ by the rounding.
        let rounding = bent(&|_| 0.0, &|sole| sole.z + lowest_offset(sole.pitch));
        Sole {
            x: bent(&|phase| human(&self.swing_x, phase), &|sole| sole.x),
            y: bent(&|_| 0.0, &|sole| sole.y),
            z: lift + rounding - lowest_offset(pitch),
            yaw: bent(&|_| 0.0, &|sole| sole.yaw),
            pitch,
        }
    }
}

/// Cubic with values a, b and slopes da, db at u = 0 and u = 1.
fn hermite(u: f64, a: f64, da: f64, b: f64, db: f64) -> f64 {
    let (u2, u3) = (u * u, u * u * u);
    a * (2.0 * u3 - 3.0 * u2 + 1.0)
        + da * (u3 - 2.0 * u2 + u)
        + b * (3.0 * u2 - 2.0 * u3)
        + db * (u3 - u2)
}

/// The larger of two numbers, rounded where they cross.
fn smooth_max(a: f64, b: f64, width: f64) -> f64 {
    0.5 * (a + b + ((a - b).powi(2) + width * width).sqrt())
}

/// Height of the sole's lowest point below (negative) the ankle, rounded where heel and toe change
/// places so that the ankle's speed has no step there.
pub(super) fn lowest_offset(pitch: f64) -> f64 {
    let (sin, cos) = pitch.sin_cos();
    let (heel, toe) = (
        -HEEL * sin - SOLE_DEPTH * cos,
        -TOE * sin - SOLE_DEPTH * cos,
    );
    const ROUNDING: f64 = 0.004;
    let gap = ((toe - heel) / ROUNDING).clamp(-60.0, 60.0);
    heel - ROUNDING * (1.0 + (-gap).exp()).ln()
}

#[cfg(test)]
mod tests;
