//! How far the motors are driven into their limits.
//!
//! Separate because these come from torques, which rollouts do not carry: they are measured where
//! the robot is simulated.

use crate::observation::FEATURE_JOINT_VELOCITY;
use crate::{JOINT_TABLE, JOINTS};

/// From this share of its effort limit on a motor gives all it has.
const SATURATED: f32 = 0.999;

/// Greatest shares and sums over control steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorUse {
    steps: f64,
    saturated_steps: f64,
    torque_sum: [f64; JOINTS],
    torque_peak: [f32; JOINTS],
    speed_peak: [f32; JOINTS],
}

impl MotorUse {
    /// Adds one robot's control step: each joint's greatest torque (share of its effort limit) and
    /// speed (share of its velocity limit) in it.
    pub fn add(&mut self, torque: &[f32; JOINTS], speed: &[f32; JOINTS]) {
        self.steps += 1.0;
        let saturated = torque.iter().any(|share| *share >= SATURATED);
        self.saturated_steps += f64::from(u8::from(saturated));
        for joint in 0..JOINTS {
            self.torque_sum[joint] += f64::from(torque[joint]);
            self.torque_peak[joint] = self.torque_peak[joint].max(torque[joint]);
            self.speed_peak[joint] = self.speed_peak[joint].max(speed[joint]);
        }
    }

    /// Adds the steps of another sum.
    pub fn merge(&mut self, other: &Self) {
        self.steps += other.steps;
        self.saturated_steps += other.saturated_steps;
        for joint in 0..JOINTS {
            self.torque_sum[joint] += other.torque_sum[joint];
            self.torque_peak[joint] = self.torque_peak[joint].max(other.torque_peak[joint]);
            self.speed_peak[joint] = self.speed_peak[joint].max(other.speed_peak[joint]);
        }
    }

    /// Each joint's greatest torque, as a share of its effort limit.
    pub fn torque_peaks(&self) -> &[f32; JOINTS] {
        &self.torque_peak
    }

    /// Mean over steps of each joint's greatest torque in the step, as a share of its effort limit.
    pub fn torque_means(&self) -> Option<[f64; JOINTS]> {
        (self.steps > 0.0).then(|| self.torque_sum.map(|sum| sum / self.steps))
    }

    /// Each joint's greatest speed, as a share of its velocity limit.
    pub fn speed_peaks(&self) -> &[f32; JOINTS] {
        &self.speed_peak
    }

    /// The joint that came nearest to its effort limit, and its share.
    pub fn torque_peak(&self) -> (usize, f32) {
        greatest(&self.torque_peak)
    }

    /// The joint that came nearest to its velocity limit, and its share; beyond 1 it was faster
    /// than the real motor can be.
    pub fn speed_peak(&self) -> (usize, f32) {
        greatest(&self.speed_peak)
    }

    /// Share of steps in which some motor gave all it has.
    pub fn saturated_share(&self) -> Option<f64> {
        (self.steps > 0.0).then(|| self.saturated_steps / self.steps)
    }
}

/// The greatest joint speed in the features of a state (53), as a share of that joint's velocity
/// limit.
pub fn speed_use(features: &[f32]) -> f32 {
    let speeds = &features[FEATURE_JOINT_VELOCITY];
    let shares = speeds.iter().zip(&JOINT_TABLE);
    shares.fold(0.0, |most, (speed, joint)| {
        most.max(speed.abs() / joint.velocity_limit as f32)
    })
}

fn greatest(shares: &[f32; JOINTS]) -> (usize, f32) {
    let mut found = (0, shares[0]);
    for (joint, &share) in shares.iter().enumerate() {
        if share > found.1 {
            found = (joint, share);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_are_of_joints_and_saturation_is_of_steps() {
        let share = |joint: usize, share: f32| {
            let mut shares = [0.0; JOINTS];
            shares[joint] = share;
            shares
        };
        let mut used = MotorUse::default();
        assert_eq!(used.saturated_share(), None);
        used.add(&share(3, 1.0), &share(4, 0.2));
        used.add(&share(3, 0.5), &share(9, 1.5));
        let mut other = MotorUse::default();
        other.add(&share(9, 0.75), &share(4, 0.4));
        other.add(&share(9, 0.25), &share(4, 0.1));
        used.merge(&other);
        assert_eq!(used.torque_peak(), (3, 1.0));
        assert_eq!(used.speed_peak(), (9, 1.5));
        assert_eq!(used.saturated_share(), Some(0.25)); // 1 of 4 steps
        let means = used.torque_means().unwrap();
        assert_eq!((means[3], means[9]), (0.375, 0.25)); // 1.5 / 4 and 1 / 4
        assert_eq!(used.speed_peaks()[4], 0.4);
    }

    #[test]
    fn speeds_in_features_count_by_their_joints_limit() {
        let mut features = [0.0; crate::FEATURES];
        features[30] = 16.0; // left hip pitch: half of 32 rad/s
        features[33] = -12.0; // left knee: 0.6 of 20 rad/s
        assert_eq!(speed_use(&features), 0.6);
    }
}
