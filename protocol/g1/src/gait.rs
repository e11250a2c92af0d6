//! Measures of a gait that averages cannot fool: a hop has a fine velocity error too.
//!
//! Separate because training and evaluation must mean the same by them. They are sums over
//! transitions, so robots, rollouts and actors add up in any grouping.
//!
//! | subject | file |
//! | --- | --- |
//! | hips, contacts, strides: from features and foot forces | here |
//! | clearance, slip, step lengths: from states | `feet` |
//! | use of the motors' limits | `motors` |
//! | how fast it goes and turns, and how fast it was asked to | `pace` |
//! | where whole strides go, and how far off the command | `strides` |
//! | gait and pace by what is asked for: to go, to turn, to stay | `conduct` |
//! | all of it in a word | `verdict` |

mod conduct;
mod feet;
mod motors;
mod pace;
mod strides;
mod verdict;

pub use conduct::Conduct;
pub use feet::Feet;
pub use motors::{MotorUse, speed_use};
pub use pace::{Aim, Pace};
pub use strides::{Off, Strides};
pub use verdict::{Part, Signs, Verdict};

use crate::FEATURES;
use crate::observation::FEATURE_JOINT_POSITION;
use crate::observation::HEIGHT;

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
    height: f64,
    feet_down: [f64; 2],
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
        self.height += f64::from(features[HEIGHT]);
        let down = in_contact(forces);
        let landed = landings(forces, before);
        for foot in 0..2 {
            self.feet_down[foot] += f64::from(u8::from(down[foot]));
            self.touchdowns += f64::from(u8::from(landed[foot]));
        }
        self.in_flight += f64::from(u8::from(!down[0] && !down[1]));
    }

    /// Adds the steps of another sum.
    pub fn merge(&mut self, other: &Self) {
        self.steps += other.steps;
        self.left += other.left;
        self.right += other.right;
        self.left_squared += other.left_squared;
        self.right_squared += other.right_squared;
        self.product += other.product;
        self.height += other.height;
        for foot in 0..2 {
            self.feet_down[foot] += other.feet_down[foot];
        }
        self.in_flight += other.in_flight;
        self.touchdowns += other.touchdowns;
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
        let down: f64 = self.feet_down.iter().sum();
        (self.steps > 0.0).then(|| down / (2.0 * self.steps))
    }

    /// Correlation of left and right contact: −1 feet that alternate, +1 feet that land and lift
    /// together, whatever the hips do; `None` if a foot never lifts or never lands.
    pub fn contact_correlation(&self) -> Option<f64> {
        let [left, right] = self.feet_down.map(|down| down / self.steps);
        // Steps with both feet down, by counting: n = L + R − both + neither.
        let both = left + right + self.in_flight / self.steps - 1.0;
        let variance = left * (1.0 - left) * right * (1.0 - right);
        (variance > 0.0).then(|| (both - left * right) / variance.sqrt())
    }

    /// Mean height of the pelvis, m.
    pub fn pelvis_height(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.height / self.steps)
    }

    /// Share of time with no foot on the ground.
    pub fn flight_share(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.in_flight / self.steps)
    }

    /// Share of time with both feet on the ground: counted as n = left + right − both + neither.
    pub fn double_support(&self) -> Option<f64> {
        let down: f64 = self.feet_down.iter().sum();
        (self.steps > 0.0).then(|| (down + self.in_flight) / self.steps - 1.0)
    }

    /// Strides per second: landings of one foot, mean of both, at `control_hz` steps a second.
    pub fn stride_rate(&self, control_hz: f64) -> Option<f64> {
        (self.steps > 0.0).then(|| self.touchdowns / 2.0 / self.steps * control_hz)
    }
}

/// Which foot carries the robot.
fn in_contact(forces: [f32; 2]) -> [bool; 2] {
    forces.map(|force| force > CONTACT_FORCE)
}

/// Which foot came down in a step; none where nothing is known of the step before.
fn landings(forces: [f32; 2], before: Option<[f32; 2]>) -> [bool; 2] {
    let (now, before) = (in_contact(forces), in_contact(before.unwrap_or(forces)));
    [now[0] && !before[0], now[1] && !before[1]]
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

    #[test]
    fn contacts_that_alternate_are_told_from_contacts_that_agree() {
        let of = |forces: &[[f32; 2]]| {
            let mut gait = Gait::default();
            for &now in forces {
                gait.add(&features(0.0, 0.0), now, None);
            }
            gait.contact_correlation()
        };
        let (up, down) = (0.0, 300.0);
        let close = |got: Option<f64>, expected: f64| (got.unwrap() - expected).abs() < 1e-9;
        assert!(close(of(&[[down, up], [up, down]]), -1.0));
        assert!(close(of(&[[down, down], [up, up]]), 1.0));
        // Walking with double support: L R both, each foot down in 2 of 3.
        // P(both) = 1/3, so (1/3 − 4/9) / (2/3·1/3) = −1/2.
        assert!(close(of(&[[down, up], [up, down], [down, down]]), -0.5));
        assert_eq!(of(&[[down, down], [down, up]]), None); // the left never lifts
    }

    #[test]
    fn sums_of_parts_are_the_sum_of_all() {
        let steps = [
            (0.3, -0.3, [300.0, 0.0]),
            (0.1, 0.2, [0.0, 0.0]),
            (-0.2, 0.4, [0.0, 310.0]),
        ];
        let sum = |range: std::ops::Range<usize>| {
            let mut gait = Gait::default();
            for i in range {
                let (left, right, forces) = steps[i];
                let before = i.checked_sub(1).map(|before| steps[before].2);
                gait.add(&features(left, right), forces, before);
            }
            gait
        };
        let mut parts = sum(0..1);
        parts.merge(&sum(1..3));
        let whole = sum(0..3);
        assert_eq!(parts.duty_factor(), whole.duty_factor());
        assert_eq!(parts.stride_rate(50.0), whole.stride_rate(50.0));
        let gap = parts.hip_correlation().unwrap() - whole.hip_correlation().unwrap();
        assert!(gap.abs() < 1e-12);
        assert_eq!(parts.contact_correlation(), whole.contact_correlation());
    }
}
