//! What the motors can do at speed: the torque of each falls as its joint turns faster.
//!
//! Separate from the joints because a simulation may leave it out: the tables' effort alone is what most trainers use. The
//! figures are Unitree's own test results of its motors, X1, X2, Y1 and Y2 in
//! `source/unitree_rl_lab/unitree_rl_lab/assets/robots/unitree_actuators.py` of unitreerobotics/unitree_rl_lab, Apache-2.0.
//! The ankles are moved by two motors of that kind each, the wrists by the kind of the arm.

use crate::JOINTS;
use crate::joints::{LEFT_LEG, RIGHT_LEG, WAIST};

/// How much torque a motor has at a speed: all of it up to the knee, none from the no-load speed on, a straight line
/// between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Greatest speed at full torque, rad/s.
    pub knee: f32,
    /// Speed at which no torque is left, rad/s.
    pub no_load: f32,
    /// Greatest torque that drives, N·m: along the speed.
    pub driving: f32,
    /// Greatest torque that brakes, N·m: against the speed.
    pub braking: f32,
}

const fn curve(knee: f32, no_load: f32, driving: f32, braking: f32) -> Curve {
    Curve {
        knee,
        no_load,
        driving,
        braking,
    }
}

/// N7520-14.3: hip pitch, hip yaw, waist.
const SMALL: Curve = curve(22.63, 35.52, 71.0, 83.3);
/// N7520-22.5: hip roll, knee.
const LARGE: Curve = curve(14.5, 22.7, 111.0, 131.0);
/// N5020-16: shoulder, elbow, wrist.
const ARM: Curve = curve(30.86, 40.13, 24.8, 31.9);
/// Two N5020-16 side by side.
const ANKLE: Curve = curve(30.86, 40.13, 49.6, 63.8);

/// The curve of every joint's motor.
pub const CURVES: [Curve; JOINTS] = {
    let leg = [SMALL, LARGE, SMALL, LARGE, ANKLE, ANKLE];
    let mut curves = [ARM; JOINTS];
    curves[WAIST] = SMALL;
    let mut i = 0;
    while i < leg.len() {
        curves[LEFT_LEG + i] = leg[i];
        curves[RIGHT_LEG + i] = leg[i];
        i += 1;
    }
    curves
};

impl Curve {
    /// Share of the torque that is left at a speed without sign, rad/s.
    pub fn left(&self, speed: f32) -> f32 {
        ((self.no_load - speed) / (self.no_load - self.knee)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joints::{JOINT_TABLE, index_of};

    #[test]
    fn torque_is_whole_up_to_the_knee_and_gone_at_the_no_load_speed() {
        let knee = CURVES[index_of("left_knee_joint").unwrap()];
        assert_eq!((knee.driving, knee.left(14.5)), (111.0, 1.0));
        // (22.7 − 18.6) / (22.7 − 14.5) = 4.1 / 8.2
        assert!((knee.left(18.6) - 0.5).abs() < 1e-6);
        assert_eq!((knee.left(22.7), knee.left(30.0)), (0.0, 0.0));
    }

    #[test]
    fn joints_of_one_motor_have_one_curve() {
        let of = |name: &str| CURVES[index_of(name).unwrap()];
        assert_eq!(of("right_hip_pitch_joint"), of("waist_yaw_joint"));
        assert_eq!(of("left_hip_roll_joint"), of("right_knee_joint"));
        assert_eq!(of("left_elbow_joint"), of("right_wrist_roll_joint"));
        assert_eq!(
            of("left_ankle_roll_joint").driving,
            2.0 * of("left_elbow_joint").driving
        );
        // Without any torque left no joint goes faster than its table says by much.
        for (joint, curve) in JOINT_TABLE.iter().zip(CURVES) {
            assert!(
                f64::from(curve.no_load) > joint.velocity_limit,
                "{}",
                joint.name
            );
        }
    }
}
