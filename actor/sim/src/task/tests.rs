//! Rewards and falls by hand.

use super::*;
use nalgebra::{UnitQuaternion, Vector3};
use std::f32::consts::{FRAC_PI_2, FRAC_PI_3};

fn close(a: f32, b: f32) -> bool {
    (a - b).abs() < 1e-6
}

/// Facing world y and walking along it at 1 m/s, turning left at 0.5 rad/s.
fn walking() -> RobotState {
    RobotState {
        orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, FRAC_PI_2),
        linear_velocity: Vector3::new(0.0, 1.0, 0.3),
        angular_velocity: Vector3::new(0.0, 0.0, 0.5),
        ..RobotState::standing()
    }
}

#[test]
fn equation_14_by_hand() {
    let task = TaskConfig::default();
    // v = (1, 0) in the heading frame. v* = (1, 0): no error, upright.
    assert!(close(task.reward(&[1.0, 0.0, 0.5], &walking(), 0.0), 1.0));
    // v* = (3, 1): error 2² + 1² = 5, exp(−5/4) = 0.286505.
    assert!(close(tracking_error(&[3.0, 1.0, 0.0], &walking()), 5.0));
    assert!(close(
        task.reward(&[3.0, 1.0, 0.0], &walking(), 0.0),
        0.286_504_8
    ));
    // The literal equation ignores the yaw rate.
    assert!(close(task.reward(&[1.0, 0.0, -9.0], &walking(), 0.0), 1.0));
}

#[test]
fn leaning_costs_the_cosine() {
    let mut state = walking();
    state.orientation *= UnitQuaternion::from_euler_angles(FRAC_PI_3, 0.0, 0.0);
    // Rolled by 60°: cos 60° = ½; the heading is unchanged.
    assert!(close(
        TaskConfig::default().reward(&[1.0, 0.0, 0.0], &state, 0.0),
        0.5
    ));
    // Upside down pays nothing rather than less than nothing.
    state.orientation = UnitQuaternion::from_euler_angles(3.0, 0.0, 0.0);
    assert_eq!(upright(&state), 0.0);
}

#[test]
fn kernel_and_yaw_rate_weight_of_the_recipe() {
    let task = TaskConfig {
        kernel: 2.0,
        yaw_rate_weight: 0.25,
        ..TaskConfig::default()
    };
    // Velocity error ½ m/s, yaw error 1 rad/s: exp(−2·(¼ + ¼·1)) = exp(−1).
    let reward = task.reward(&[1.5, 0.0, 1.5], &walking(), 0.0);
    assert!(close(reward, 0.367_879_44), "{reward}");
}

#[test]
fn work_costs_a_share_where_it_counts() {
    let mut task = TaskConfig::default();
    assert!(close(task.reward(&[1.0, 0.0, 0.5], &walking(), 9.0), 1.0));
    // Two joules at 0.05 each: exp(−0.1).
    task.effort_weight = 0.05;
    let reward = task.reward(&[1.0, 0.0, 0.5], &walking(), 2.0);
    assert!(close(reward, 0.904_837_4), "{reward}");
}

#[test]
fn a_wide_kernel_pays_half() {
    let task = TaskConfig {
        kernel: 4.0,
        wide_kernel: Some(1.0),
        ..TaskConfig::default()
    };
    // v = (1, 0), v* = (2, 0): ½·(e⁻⁴ + e⁻¹) = ½·(0.018316 + 0.367879).
    let reward = task.reward(&[2.0, 0.0, 0.5], &walking(), 0.0);
    assert!(close(reward, 0.193_097_5), "{reward}");
    assert!(close(task.reward(&[1.0, 0.0, 0.5], &walking(), 0.0), 1.0));
}

#[test]
fn falls_are_low_or_tilted() {
    let task = TaskConfig::default();
    let mut state = RobotState::standing();
    assert!(!task.has_fallen(&state));
    state.position.z = 0.549;
    assert!(task.has_fallen(&state));
    state.position.z = 0.551;
    assert!(!task.has_fallen(&state));
    // cos 45° = 0.707, cos 46° = 0.695.
    state.orientation = UnitQuaternion::from_euler_angles(0.0, 45_f32.to_radians(), 0.0);
    assert!(!task.has_fallen(&state));
    state.orientation = UnitQuaternion::from_euler_angles(0.0, 46_f32.to_radians(), 0.0);
    assert!(task.has_fallen(&state));
    state.position.z = f32::NAN;
    assert!(task.has_fallen(&state));
}

#[test]
fn a_section_holds_only_its_differences() {
    let parsed: TaskConfig = serde_from("kernel = 2.0\n[start]\nlift = 0.01\n");
    assert_eq!(parsed.kernel, 2.0);
    assert_eq!(parsed.start.lift, 0.01);
    assert_eq!(parsed.episode_steps, 1_000);
    assert!(toml::from_str::<TaskConfig>("kernle = 2.0").is_err());
    parsed.validate().unwrap();
    let bad = TaskConfig {
        fall_height: 0.9,
        ..TaskConfig::default()
    };
    assert!(
        bad.validate()
            .unwrap_err()
            .to_string()
            .contains("fall_height = 0.9")
    );
}

fn serde_from(text: &str) -> TaskConfig {
    toml::from_str(text).unwrap()
}
