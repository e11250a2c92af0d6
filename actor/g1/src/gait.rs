//! Measures of a gait that averages cannot fool: a hop has a fine velocity error too.
//!
//! Separate because training and evaluation must mean the same by them. They are sums over
//! transitions, so robots, rollouts and actors add up in any grouping.

use crate::FEATURES;
use crate::observation::FEATURE_JOINT_POSITION;

/// Hip pitch of the left and the right leg within the features.
const LEFT_HIP_PITCH: usize = FEATURE_JOINT_POSITION.start;
const RIGHT_HIP_PITCH: usize = FEATURE_JOINT_POSITION.start + 6;

/// A foot that carries less than this (N) is in the air; the robot weighs 315 N.
pub const CONTACT_FORCE: f32 = 20.0;

/// Sums from which the measures follow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gait {
    steps: f64,
    left: f64,
    right: f64,
    left_squared: f64,
    right_squared: f64,
    product: f64,
    feet_down: f64,
    in_flight: f64,
    touchdowns: f64,
}

impl Gait {
    /// Adds one robot's control step: features (53) and foot forces (N; left, right) at its end,
    /// and the foot forces one step before, or `None` at an episode's first step.
    pub fn add(&mut self, features: &[f32], forces: [f32; 2], before: Option<[f32; 2]>) {
        assert_eq!(features.len(), FEATURES, "features of one step");
        let (left, right) = (
            f64::from(features[LEFT_HIP_PITCH]),
            f64::from(features[RIGHT_HIP_PITCH]),
        );
        self.steps += 1.0;
        self.left += left;
        self.right += right;
        self.left_squared += left * left;
        self.right_squared += right * right;
        self.product += left * right;
        let down = forces.map(|force| force > CONTACT_FORCE);
        self.feet_down += f64::from(u8::from(down[0]) + u8::from(down[1]));
        self.in_flight += f64::from(u8::from(!down[0] && !down[1]));
        if let Some(before) = before {
            for foot in 0..2 {
                let lands = down[foot] && before[foot] <= CONTACT_FORCE;
                self.touchdowns += f64::from(u8::from(lands));
            }
        }
    }

    /// Correlation of left and right hip pitch: −1 a walk, +1 a hop; `None` if a hip never moved.
    pub fn hip_correlation(&self) -> Option<f64> {
        let covariance = self.product - self.left * self.right / self.steps;
        let left = self.left_squared - self.left * self.left / self.steps;
        let right = self.right_squared - self.right * self.right / self.steps;
        // Below a thousandth of a radian of movement the quotient is rounding.
        let still = 1e-6 * self.steps;
        (left > still && right > still).then(|| covariance / (left * right).sqrt())
    }

    /// Share of time that a foot is on the ground, mean of both feet.
    pub fn duty_factor(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.feet_down / (2.0 * self.steps))
    }

    /// Share of time with no foot on the ground.
    pub fn flight_share(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.in_flight / self.steps)
    }

    /// Strides per second: landings of one foot, mean of both, at `control_hz` steps a second.
    pub fn stride_rate(&self, control_hz: f64) -> Option<f64> {
        (self.steps > 0.0).then(|| self.touchdowns / 2.0 / self.steps * control_hz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn features(left: f32, right: f32) -> [f32; FEATURES] {
        let mut features = [0.0; FEATURES];
        features[LEFT_HIP_PITCH] = left;
        features[RIGHT_HIP_PITCH] = right;
        features
    }

    #[test]
    fn opposite_hips_walk_and_equal_hips_hop() {
        let (mut walk, mut hop, mut still) = (Gait::default(), Gait::default(), Gait::default());
        for angle in [0.3, -0.3, 0.2, -0.2] {
            walk.add(&features(angle, -angle), [300.0, 0.0], None);
            hop.add(&features(angle, angle), [0.0, 0.0], None);
            still.add(&features(0.1, 0.1), [157.0, 157.0], None);
        }
        assert!((walk.hip_correlation().unwrap() + 1.0).abs() < 1e-9);
        assert!((hop.hip_correlation().unwrap() - 1.0).abs() < 1e-9);
        assert_eq!(still.hip_correlation(), None);
    }

    #[test]
    fn feet_are_counted_by_the_force_they_carry() {
        // Four steps: both down, left only, none, right lands.
        let forces = [[160.0, 155.0], [315.0, 0.0], [0.0, 0.0], [0.0, 400.0]];
        let mut gait = Gait::default();
        let mut before = None;
        for now in forces {
            gait.add(&features(0.0, 0.0), now, before);
            before = Some(now);
        }
        assert_eq!(gait.duty_factor(), Some(0.5)); // (2 + 1 + 0 + 1) / (2 · 4)
        assert_eq!(gait.flight_share(), Some(0.25)); // 1 of 4
        assert_eq!(gait.stride_rate(50.0), Some(6.25)); // one landing / 2 feet / 4 steps · 50 Hz
    }
}
