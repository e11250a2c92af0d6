//! The way of one foot through a stride: planted in stance, human in swing.
//!
//! Separate because ground contact is what joint curves alone get wrong. In stance the path is exact
//! geometry of a rigid sole that rolls over its heel edge, stands flat, and rolls over its toe edge,
//! so the touching point never slips. In swing it is the human path, bent so that it leaves and meets
//! stance without a step in position or velocity, and lifted where the sole would scuff.
//!
//! The frame moves with the mean speed of the gait: x forward from the mean place of the pelvis,
//! z up from the ground. Pitch is positive with the toe down.

use super::harmonics::Harmonics;
use g1::links::{SOLE_CORNERS, SOLE_DEPTH};
use std::f64::consts::PI;

const HEEL: f64 = SOLE_CORNERS[0][0];
const TOE: f64 = SOLE_CORNERS[2][0];

/// Where the ankle is and how the sole is pitched, in the moving frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sole {
    /// Ankle forward of the mean pelvis, m.
    pub(super) x: f64,
    /// Ankle above the ground, m.
    pub(super) z: f64,
    /// Pitch, toe down positive, rad.
    pub(super) pitch: f64,
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
    fn pitch(&self, phase: f64) -> f64 {
        let heel = (1.0 - phase / self.heel_share).max(0.0);
        let toe = (1.0 + (phase - self.stance) / self.toe_share).max(0.0);
        self.contact_pitch * heel * heel + self.toe_off_pitch * toe * toe
    }
}

/// The path of a foot.
#[derive(Clone, Copy, Debug)]
pub(super) struct FootPath {
    pub(super) rocker: Rocker,
    /// Ground covered by a stride, m.
    pub(super) stride: f64,
    /// Mean place of the flat sole's ankle during stance, forward of the pelvis, m.
    pub(super) centre: f64,
    /// Human swing: ankle forward of the pelvis, lowest point of the sole, pitch.
    pub(super) swing_x: Harmonics,
    pub(super) swing_lift: Harmonics,
    pub(super) swing_pitch: Harmonics,
    /// Least lift of the sole in the middle of swing, m.
    pub(super) clearance: f64,
}

impl FootPath {
    /// The foot at a phase in [0, 1): stance first.
    pub(super) fn at(&self, phase: f64) -> Sole {
        if phase < self.rocker.stance {
            self.stance(phase)
        } else {
            self.swing(phase)
        }
    }

    fn stance(&self, phase: f64) -> Sole {
        let flat = self.centre + self.stride * (self.rocker.stance / 2.0 - phase);
        let pitch = self.rocker.pitch(phase);
        // The edge that touches stays where it is on the flat sole; the ankle turns about it.
        let edge = if pitch < 0.0 { HEEL } else { TOE };
        let (sin, cos) = pitch.sin_cos();
        Sole {
            x: flat + edge - (edge * cos - SOLE_DEPTH * sin),
            z: edge * sin + SOLE_DEPTH * cos,
            pitch,
        }
    }

    fn swing(&self, phase: f64) -> Sole {
        let off = self.rocker.stance;
        let u = (phase - off) / (1.0 - off);
        let x = self.bent(&self.swing_x, |p| self.stance(p).x, u);
        let pitch = self.bent(&self.swing_pitch, |p| self.stance(p).pitch, u);
        let free = self.bent(&self.swing_lift, |_| 0.0, u);
        let needed = self.clearance * (PI * u).sin().powi(2);
        let lift = smooth_max(free, needed, 0.02 * (PI * u).sin().powi(2));
        Sole {
            x,
            z: lift - lowest_offset(pitch),
            pitch,
        }
    }

    /// The human curve plus the cubic that closes its gaps to `stance` at both ends of swing, in
    /// value and slope. (In the moving frame each stance begins at the same place.)
    fn bent(&self, human: &Harmonics, stance: impl Fn(f64) -> f64, u: f64) -> f64 {
        let (off, h) = (self.rocker.stance, 1e-5);
        let span = 1.0 - off;
        let gap_off = stance(off) - human.at(off);
        let gap_on = stance(0.0) - human.at(1.0);
        let slope = |f: &dyn Fn(f64) -> f64, at: f64| (f(at + h) - f(at)) / h;
        let stance: &dyn Fn(f64) -> f64 = &stance;
        let curve = |p: f64| human.at(p);
        let slope_off = (slope(stance, off - h) - slope(&curve, off - h)) * span;
        let slope_on = (slope(stance, 0.0) - slope(&curve, 0.0)) * span;
        human.at(off + u * span) + hermite(u, gap_off, slope_off, gap_on, slope_on)
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
mod tests {
    use super::*;

    fn path() -> FootPath {
        FootPath {
            rocker: Rocker {
                stance: 0.6,
                contact_pitch: -0.2,
                heel_share: 0.1,
                toe_off_pitch: 0.5,
                toe_share: 0.2,
            },
            stride: 1.0,
            centre: 0.0,
            swing_x: Harmonics::still(0.0),
            swing_lift: Harmonics::still(0.0),
            swing_pitch: Harmonics::still(0.0),
            clearance: 0.04,
        }
    }

    fn edge(sole: Sole, x: f64) -> (f64, f64) {
        let (sin, cos) = sole.pitch.sin_cos();
        (
            sole.x + x * cos - SOLE_DEPTH * sin,
            sole.z - x * sin - SOLE_DEPTH * cos,
        )
    }

    #[test]
    fn the_touching_edge_moves_back_with_the_ground() {
        // A stride of 1 m: the ground passes at 1 m per unit of phase. Flat, the ankle is at
        // 0.3 − φ and stands 35 mm high; the heel is 50 mm behind it and the toe 120 mm ahead.
        for (phase, x) in [(0.0, HEEL), (0.05, HEEL), (0.5, TOE), (0.59, TOE)] {
            let (forward, height) = edge(path().at(phase), x);
            assert!((forward - (0.3 - phase + x)).abs() < 1e-12, "phase {phase}");
            assert!(height.abs() < 1e-12, "phase {phase}");
        }
        let flat = path().at(0.25);
        assert!((flat.x - 0.05).abs() < 1e-12 && (flat.z - 0.035).abs() < 1e-12);
        assert_eq!(flat.pitch, 0.0);
    }

    #[test]
    fn swing_joins_stance_without_a_step() {
        let h = 1e-6;
        for phase in [0.6, 0.0] {
            let [a, b, c, d] =
                [-2.0 * h, -h, h, 2.0 * h].map(|d: f64| path().at((phase + d).rem_euclid(1.0)));
            for get in [|s: Sole| s.x, |s: Sole| s.z, |s: Sole| s.pitch] {
                assert!((get(c) - get(b)).abs() < 1e-4, "position at {phase}");
                let (before, after) = ((get(b) - get(a)) / h, (get(d) - get(c)) / h);
                assert!((before - after).abs() < 0.05, "{before} {after} at {phase}");
            }
        }
    }

    #[test]
    fn swing_clears_the_ground() {
        for i in 1..40 {
            let sole = path().at(0.6 + 0.01 * f64::from(i));
            let lowest = edge(sole, HEEL).1.min(edge(sole, TOE).1);
            assert!(lowest > 0.0, "{sole:?}");
        }
        let (heel, toe) = (edge(path().at(0.8), HEEL).1, edge(path().at(0.8), TOE).1);
        assert!(heel.min(toe) > 0.035); // 4 cm asked for in mid-swing
    }
}
