//! The rise and fall of the base: over a stiff leg in a walk, thrown in a run.
//!
//! Separate because it is the mechanics of the two gaits, alike for every way and every leg.

use super::normative::GRAVITY;
use std::f64::consts::{PI, TAU};

/// How the base rises and falls.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bounce {
    /// Walking: over a stiff leg, highest in the middle of single support (amplitude in m).
    Vault { amplitude: f64, stance: f64 },
    /// Running: thrown up by stance and falling freely in flight (period in s).
    Spring { period: f64, stance: f64 },
}

impl Bounce {
    /// Height above the level, m.
    pub(super) fn at(&self, phase: f64) -> f64 {
        match *self {
            Self::Vault { amplitude, stance } => {
                amplitude * (2.0 * TAU * (phase - stance / 2.0)).cos()
            }
            Self::Spring { period, stance } => {
                let g = GRAVITY;
                let (t, ground) = (phase.rem_euclid(0.5) * period, stance * period);
                let flight = (0.5 - stance) * period;
                if t < ground {
                    // z̈ = −g + A·sin(πt/ground), A such that the speed turns from −g·flight/2 to +.
                    let push = g * (ground + flight) * ground / TAU;
                    g * t * (ground - t) / 2.0 - push * (PI * t / ground).sin()
                } else {
                    let t = t - ground;
                    g * t * (flight - t) / 2.0
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_falls_freely_in_flight_and_is_thrown_up_by_stance() {
        let (period, stance) = (0.6, 0.3);
        let bounce = Bounce::Spring { period, stance };
        let h = 1e-4;
        let z = |time: f64| bounce.at(time / period);
        let acceleration = |t: f64| (z(t + h) - 2.0 * z(t) + z(t - h)) / (h * h);
        // Half a period lasts 0.3 s: 0.18 s of stance, then 0.12 s of flight.
        for t in [0.19, 0.24, 0.29] {
            assert!((acceleration(t) + 9.81).abs() < 1e-3);
        }
        // Thrust is a half sine whose mean carries the weight of the flight too, so its peak is
        // π/2·(0.3/0.18)·g = 2.618 g, and the acceleration g less.
        assert!((acceleration(0.09) - 1.618 * 9.81).abs() < 0.01);
        // In 0.12 s of flight the base rises by g·0.12²/8 = 17.7 mm.
        assert!((z(0.24) - 0.017658).abs() < 1e-6 && z(0.18).abs() < 1e-9);
        let speed = |t: f64| (z(t + h) - z(t - h)) / (2.0 * h);
        for t in [0.0, 0.18, 0.3] {
            assert!((speed(t + 2.0 * h) - speed(t - 2.0 * h)).abs() < 1e-2); // no step at contact
        }
    }

    #[test]
    fn a_walk_is_highest_in_the_middle_of_single_support() {
        let bounce = Bounce::Vault {
            amplitude: 0.02,
            stance: 0.6,
        };
        // Right stance lasts to 0.6 and the left foot is off from 0.1 to 0.5: the middle is 0.3.
        assert!((bounce.at(0.3) - 0.02).abs() < 1e-12 && (bounce.at(0.05) + 0.02).abs() < 1e-12);
    }
}
