//! What the policy and the discriminator see (Section III-A): 82 and 53 numbers.
//!
//! Separate because simulated and reference motion must pass through the very same lines;
//! a difference in layout would be the discriminator's easiest clue.

use crate::{DEFAULT_POSE, FEATURES, JOINTS, OBSERVATION, RobotState};
use nalgebra::{UnitQuaternion, Vector3};
use std::f32::consts::PI;
use std::ops::Range;

/// Pelvis height, m.
pub const HEIGHT: usize = 0;
/// Pelvis velocity in the base frame, m/s.
pub const LINEAR_VELOCITY: Range<usize> = 1..4;
/// Pelvis angular velocity in the base frame, rad/s.
pub const ANGULAR_VELOCITY: Range<usize> = 4..7;
/// Direction of gravity in the base frame.
pub const GRAVITY: Range<usize> = 7..10;
/// Command: forward, leftward velocity (m/s), yaw rate (rad/s).
pub const COMMAND: Range<usize> = 10..13;
/// Joint positions relative to the default pose, rad.
pub const JOINT_POSITION: Range<usize> = 13..36;
/// Joint velocities, rad/s.
pub const JOINT_VELOCITY: Range<usize> = 36..59;
/// The action of the step before.
pub const PREVIOUS_ACTION: Range<usize> = 59..82;

/// Joint positions (absolute, rad) in [`features`], whose first seven numbers are laid out as here.
pub const FEATURE_JOINT_POSITION: Range<usize> = 7..30;
/// Joint velocities (rad/s) in [`features`].
pub const FEATURE_JOINT_VELOCITY: Range<usize> = 30..53;

/// Writes the policy's observation of a state into `out` (82 numbers).
///
/// # Panics
/// If `out` is not 82 long.
#[inline]
pub fn policy_observation(
    state: &RobotState,
    command: &[f32; crate::COMMAND],
    previous_action: &[f32; JOINTS],
    out: &mut [f32],
) {
    let out: &mut [f32; OBSERVATION] = out.try_into().expect("an observation has 82 numbers");
    write_base(state, out);
    put(out, GRAVITY, &state.projected_gravity().into());
    put(out, COMMAND, command);
    let mut relative = state.joint_positions;
    for (position, default) in relative.iter_mut().zip(DEFAULT_POSE) {
        *position -= default;
    }
    put(out, JOINT_POSITION, &relative);
    put(out, JOINT_VELOCITY, &state.joint_velocities);
    put(out, PREVIOUS_ACTION, previous_action);
}

/// Writes what the discriminator sees of a state into `out` (53 numbers).
///
/// # Panics
/// If `out` is not 53 long.
#[inline]
pub fn features(state: &RobotState, out: &mut [f32]) {
    let out: &mut [f32; FEATURES] = out
        .try_into()
        .expect("the features of a step are 53 numbers");
    write_base(state, out);
    put(out, FEATURE_JOINT_POSITION, &state.joint_positions);
    put(out, FEATURE_JOINT_VELOCITY, &state.joint_velocities);
}

/// The state that [`features`] were written of, given the direction of gravity in the base frame:
/// over the world's origin and with a heading that means nothing, for neither is in the features.
///
/// # Panics
/// If `features` is not 53 long.
pub fn state_of(features: &[f32], gravity: [f32; 3]) -> RobotState {
    assert_eq!(
        features.len(),
        FEATURES,
        "the features of a step are 53 numbers"
    );
    // Upside down, any half turn will do.
    let orientation = UnitQuaternion::rotation_between(&Vector3::from(gravity), &-Vector3::z())
        .unwrap_or_else(|| UnitQuaternion::from_euler_angles(PI, 0.0, 0.0));
    let in_world =
        |numbers: Range<usize>| orientation * Vector3::from_row_slice(&features[numbers]);
    let joints = |numbers: Range<usize>| std::array::from_fn(|i| features[numbers.start + i]);
    RobotState {
        position: Vector3::new(0.0, 0.0, features[HEIGHT]),
        orientation,
        linear_velocity: in_world(LINEAR_VELOCITY),
        angular_velocity: in_world(ANGULAR_VELOCITY),
        joint_positions: joints(FEATURE_JOINT_POSITION),
        joint_velocities: joints(FEATURE_JOINT_VELOCITY),
    }
}

#[inline]
fn write_base<const N: usize>(state: &RobotState, out: &mut [f32; N]) {
    out[HEIGHT] = state.position.z;
    put(out, LINEAR_VELOCITY, &state.velocity_in_base().into());
    put(
        out,
        ANGULAR_VELOCITY,
        &state.angular_velocity_in_base().into(),
    );
}

/// As arrays: a copy of a slice is a call, whose length is known only at run time.
#[inline]
fn put<const N: usize, const M: usize>(out: &mut [f32; N], place: Range<usize>, from: &[f32; M]) {
    let to = out[place].as_mut_array().expect("a place for each number");
    *to = *from;
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::FRAC_PI_2;

    /// Facing world y, moving along it at 2 m/s, turning left at 0.5 rad/s, joint i at i/10, speed i.
    fn moving() -> RobotState {
        RobotState {
            position: Vector3::new(5.0, 6.0, 0.7),
            orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2),
            linear_velocity: Vector3::new(0.0, 2.0, 0.25),
            angular_velocity: Vector3::new(0.0, 0.0, 0.5),
            joint_positions: std::array::from_fn(|i| i as f32 / 10.0),
            joint_velocities: std::array::from_fn(|i| i as f32),
        }
    }

    fn assert_close(got: &[f32], expected: &[f32]) {
        assert_eq!(got.len(), expected.len());
        for (a, b) in got.iter().zip(expected) {
            assert!((a - b).abs() < 1e-6, "{got:?} is not {expected:?}");
        }
    }

    #[test]
    fn the_policy_sees_82_numbers() {
        let mut out = [f32::NAN; OBSERVATION];
        let action = std::array::from_fn(|i| -(i as f32));
        policy_observation(&moving(), &[1.0, -0.5, 0.25], &action, &mut out);
        assert_close(&out[..7], &[0.7, 2.0, 0.0, 0.25, 0.0, 0.0, 0.5]);
        assert_close(&out[7..13], &[0.0, 0.0, -1.0, 1.0, -0.5, 0.25]);
        // Left hip pitch is at 0.0 with default −0.1; left knee at 0.3 with default 0.3.
        assert_close(&out[13..17], &[0.1, 0.1, 0.2, 0.0]);
        assert_close(&out[36..39], &[0.0, 1.0, 2.0]);
        assert_close(&out[59..62], &[0.0, -1.0, -2.0]);
        assert_eq!(out[81], -22.0);
    }

    #[test]
    fn the_discriminator_sees_53_numbers_without_place_or_heading() {
        let mut out = [f32::NAN; FEATURES];
        features(&moving(), &mut out);
        assert_close(&out[..7], &[0.7, 2.0, 0.0, 0.25, 0.0, 0.0, 0.5]);
        assert_close(&out[7..10], &[0.0, 0.1, 0.2]); // absolute, not relative to the default pose
        assert_close(&out[29..31], &[2.2, 0.0]);
        assert_eq!(out[52], 22.0);

        let mut elsewhere = moving();
        elsewhere.position.x -= 100.0;
        elsewhere.orientation = UnitQuaternion::identity();
        elsewhere.linear_velocity = Vector3::new(2.0, 0.0, 0.25);
        let mut same = [f32::NAN; FEATURES];
        features(&elsewhere, &mut same);
        assert_close(&same, &out);
    }

    #[test]
    fn standing_is_zero_but_for_height_and_gravity() {
        let mut out = [f32::NAN; OBSERVATION];
        policy_observation(&RobotState::standing(), &[0.0; 3], &[0.0; JOINTS], &mut out);
        let mut expected = [0.0; OBSERVATION];
        expected[HEIGHT] = 0.784_202_2;
        expected[GRAVITY.end - 1] = -1.0;
        assert_close(&out, &expected);
    }

    #[test]
    fn a_state_comes_back_but_for_place_and_heading() {
        let mut state = moving();
        state.orientation = UnitQuaternion::from_euler_angles(0.2, -0.3, 0.9);
        let mut seen = [f32::NAN; FEATURES];
        features(&state, &mut seen);
        let back = state_of(&seen, state.projected_gravity().into());
        assert!((back.projected_gravity() - state.projected_gravity()).norm() < 1e-6);
        let mut again = [f32::NAN; FEATURES];
        features(&back, &mut again);
        assert_close(&again, &seen);
    }
}
