//! The way of the pelvis over the ground, phase by phase: at one velocity all along, or from
//! standing to it, or from it to standing.
//!
//! Separate because the feet are planted on the ground and the base is carried above it, and both
//! ask only where the moving frame is. That frame goes with the mean motion: x ahead, y to the left.
//! Phases are counted in strides, 0 at a contact of the right foot; one can be of any stride.

use crate::velocity::Velocity;
use nalgebra::Isometry2;

/// How the moving frame goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub(super) velocity: Velocity,
    /// Duration of a stride (two steps), s.
    pub(super) period: f64,
    pub(super) change: Change,
}

/// What becomes of the velocity.
#[derive(Clone, Copy, Debug)]
pub(super) enum Change {
    /// It stays: a periodic gait.
    Steady,
    /// From standing; the right foot is lifted first, at phase `lift`.
    Start { lift: f64, speed: Ramp, sway: Ramp },
    /// To standing; the right foot is put down last, at phase `last`.
    Stop { last: f64, speed: Ramp, sway: Ramp },
}

/// A smooth change from 0 to 1 between two phases: 3u² − 2u³.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ramp {
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Ramp {
    fn at(&self, phase: f64) -> f64 {
        let u = ((phase - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        u * u * (3.0 - 2.0 * u)
    }

    /// The area below it up to a phase.
    fn area(&self, phase: f64) -> f64 {
        let span = self.to - self.from;
        let u = ((phase - self.from) / span).clamp(0.0, 1.0);
        span * u * u * u * (1.0 - 0.5 * u) + (phase - self.to).max(0.0)
    }
}

impl Way {
    /// Share of the full velocity at a phase.
    pub(super) fn share(&self, phase: f64) -> f64 {
        match &self.change {
            Change::Steady => 1.0,
            Change::Start { speed, .. } => speed.at(phase),
            Change::Stop { speed, .. } => 1.0 - speed.at(phase),
        }
    }

    /// Share of the full sideways swing: weight is shifted fully before the first step is taken and
    /// until the last one is, however slow these are.
    pub(super) fn sway(&self, phase: f64) -> f64 {
        match &self.change {
            Change::Steady => 1.0,
            Change::Start { sway, .. } => sway.at(phase),
            Change::Stop { sway, .. } => 1.0 - sway.at(phase),
        }
    }

    /// The moving frame on the ground.
    pub(super) fn frame(&self, phase: f64) -> Isometry2<f64> {
        let strides = match &self.change {
            Change::Steady => phase,
            Change::Start { speed, .. } => speed.area(phase),
            Change::Stop { speed, .. } => phase - speed.area(phase),
        };
        self.velocity.after(strides * self.period)
    }

    /// The frame in which the feet stand side by side, if a foot put down at a phase is to stand.
    pub(super) fn rest(&self, landing: f64) -> Option<Isometry2<f64>> {
        match &self.change {
            Change::Start { lift, .. } if landing < *lift => Some(self.frame(f64::MIN)),
            // The other foot comes half a stride before.
            Change::Stop { last, speed, .. } if landing > last - 0.6 => Some(self.frame(speed.to)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: Ramp = Ramp { from: 0.5, to: 1.5 };

    fn way(change: Change) -> Way {
        Way {
            velocity: Velocity::from(2.0),
            period: 1.0,
            change,
        }
    }

    #[test]
    fn the_frame_moves_at_the_share_of_the_velocity() {
        let (speed, sway) = (UP, UP);
        for way in [
            way(Change::Steady),
            way(Change::Start {
                lift: 0.6,
                speed,
                sway,
            }),
            way(Change::Stop {
                last: 1.4,
                speed,
                sway,
            }),
        ] {
            for phase in [0.2, 0.6, 0.9, 1.3, 1.8] {
                let h = 1e-5;
                let x = |phase: f64| way.frame(phase).translation.x;
                let rate = (x(phase + h) - x(phase - h)) / (2.0 * h);
                assert!((rate - 2.0 * way.share(phase)).abs() < 1e-6, "{way:?}");
            }
        }
    }

    #[test]
    fn a_ramp_covers_half_of_the_way() {
        // Mean share 1/2 over the stride from 0.5 to 1.5, then all: 0.5 + 0.5 strides at 2.
        assert!((UP.area(2.0) - 1.0).abs() < 1e-12);
        let start = way(Change::Start {
            lift: 0.6,
            speed: UP,
            sway: UP,
        });
        assert!((start.frame(2.0).translation.x - 2.0).abs() < 1e-12);
        assert_eq!(start.frame(-9.0), Isometry2::identity());
        assert_eq!(start.rest(0.5), Some(Isometry2::identity()));
        assert_eq!(start.rest(1.0), None);
    }
}
