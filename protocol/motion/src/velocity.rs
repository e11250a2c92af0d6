//! Where a gait goes: a velocity that is kept in the robot's own heading.
//!
//! Separate because gaits are asked for by it and cyclic clips are repeated along it: both need the
//! line, the circle or the turn on the spot that it makes on the ground.

use nalgebra::{Isometry2, Vector2};

/// A velocity on the ground in the heading frame: what a command asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Velocity {
    /// Ahead, m/s; negative is backward.
    pub forward: f64,
    /// To the left, m/s.
    pub lateral: f64,
    /// Turning, rad/s; positive is to the left.
    pub yaw_rate: f64,
}

impl From<f64> for Velocity {
    /// Straight ahead at a speed, m/s.
    fn from(forward: f64) -> Self {
        Self {
            forward,
            lateral: 0.0,
            yaw_rate: 0.0,
        }
    }
}

impl From<[f32; 3]> for Velocity {
    /// A command: forward, leftward velocity (m/s), yaw rate (rad/s).
    fn from(command: [f32; 3]) -> Self {
        let [forward, lateral, yaw_rate] = command.map(f64::from);
        Self {
            forward,
            lateral,
            yaw_rate,
        }
    }
}

impl Velocity {
    /// The command that asks for it.
    pub fn command(&self) -> [f32; 3] {
        [self.forward, self.lateral, self.yaw_rate].map(|v| v as f32)
    }

    /// Where it leads from the origin, and the heading there, after a time (s).
    ///
    /// x = v·sin ωt/ω − u·(1 − cos ωt)/ω, y = v·(1 − cos ωt)/ω + u·sin ωt/ω, v forward and u to the left.
    pub fn after(&self, seconds: f64) -> Isometry2<f64> {
        let turn = self.yaw_rate * seconds;
        let (ahead, aside) = if self.yaw_rate.abs() < 1e-9 {
            (seconds, 0.0)
        } else {
            let (sin, cos) = turn.sin_cos();
            (sin / self.yaw_rate, (1.0 - cos) / self.yaw_rate)
        };
        let way = Vector2::new(
            self.forward * ahead - self.lateral * aside,
            self.forward * aside + self.lateral * ahead,
        );
        Isometry2::new(way, turn)
    }

    /// The velocity of the same motion run backward in time.
    pub(super) fn reversed(&self) -> Self {
        Self {
            forward: -self.forward,
            lateral: -self.lateral,
            yaw_rate: -self.yaw_rate,
        }
    }

    /// The velocity seen in a mirror: left and right swapped.
    pub(super) fn mirrored(&self) -> Self {
        Self {
            forward: self.forward,
            lateral: 0.0 - self.lateral,
            yaw_rate: 0.0 - self.yaw_rate,
        }
    }

    /// Planar speed, m/s.
    pub(super) fn speed(&self) -> f64 {
        self.forward.hypot(self.lateral)
    }
}

impl std::fmt::Display for Velocity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let side = |positive: bool| if positive { "left" } else { "right" };
        write!(f, "{:.2} m/s", self.forward)?;
        if self.lateral != 0.0 {
            let (aside, speed) = (side(self.lateral > 0.0), self.lateral.abs());
            write!(f, ", {speed:.2} m/s {aside}")?;
        }
        if self.yaw_rate != 0.0 {
            let (aside, rate) = (side(self.yaw_rate > 0.0), self.yaw_rate.abs());
            write!(f, ", turning {aside} {rate:.2} rad/s")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn half_a_circle_ends_across_its_diameter() {
        // 1 m/s at 0.5 rad/s: a circle of 2 m radius, half of it after 2π s.
        let velocity = Velocity {
            forward: 1.0,
            lateral: 0.0,
            yaw_rate: 0.5,
        };
        let end = velocity.after(2.0 * PI);
        assert!((end.translation.vector - Vector2::new(0.0, 4.0)).norm() < 1e-12);
        assert!((end.rotation.angle().abs() - PI).abs() < 1e-12);
        let quarter = velocity.after(PI);
        assert!((quarter.translation.vector - Vector2::new(2.0, 2.0)).norm() < 1e-12);
        assert!((quarter.rotation.angle() - FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn ways_add_up_and_run_back() {
        let velocity = Velocity {
            forward: 0.7,
            lateral: -0.3,
            yaw_rate: 0.4,
        };
        let sum = velocity.after(0.6) * velocity.after(1.1);
        assert!((sum.to_matrix() - velocity.after(1.7).to_matrix()).norm() < 1e-12);
        let back = velocity.after(0.6) * velocity.reversed().after(0.6);
        assert!((back.to_matrix() - Isometry2::identity().to_matrix()).norm() < 1e-12);
    }

    #[test]
    fn it_says_where_it_goes() {
        assert_eq!(Velocity::from(0.8).to_string(), "0.80 m/s");
        let velocity = Velocity {
            forward: -0.4,
            lateral: -0.2,
            yaw_rate: 0.5,
        };
        assert_eq!(
            velocity.to_string(),
            "-0.40 m/s, 0.20 m/s right, turning left 0.50 rad/s"
        );
    }
}
