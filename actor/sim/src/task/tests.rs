//! Rewards by hand.

mod section;

use super::*;
use crate::gate::effort::Effort;
use crate::moment::{uprightness, velocity_error};
use crate::reward::track::Track;
use g1::RobotState;
use nalgebra::{UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_3};
use vocabulary::Ramp;

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

fn pay(task: &TaskConfig, command: [f32; 3], state: &RobotState, work: f32) -> f32 {
    task.pay(&Moment::new(&command, state, work))
}

fn track(kernel: f32, yaw_rate: f32) -> Track {
    Track {
        weight: 1.0.into(),
        kernel: kernel.into(),
        yaw_rate: yaw_rate.into(),
    }
}

fn paying(reward: RewardConfig) -> TaskConfig {
    TaskConfig {
        reward,
        ..TaskConfig::default()
    }
}

#[test]
fn equation_14_by_hand() {
    let task = TaskConfig::default();
    // v = (1, 0) in the heading frame. v* = (1, 0): no error, upright.
    assert!(close(pay(&task, [1.0, 0.0, 0.5], &walking(), 0.0), 1.0));
    // v* = (3, 1): error 2² + 1² = 5, exp(−5/4) = 0.286505.
    assert!(close(velocity_error(&[3.0, 1.0, 0.0], &walking()), 5.0));
    assert!(close(
        pay(&task, [3.0, 1.0, 0.0], &walking(), 0.0),
        0.286_504_8
    ));
    // The literal equation ignores the yaw rate.
    assert!(close(pay(&task, [1.0, 0.0, -9.0], &walking(), 0.0), 1.0));
}

#[test]
fn leaning_costs_the_cosine() {
    let mut state = walking();
    state.orientation *= UnitQuaternion::from_euler_angles(FRAC_PI_3, 0.0, 0.0);
    // Rolled by 60°: cos 60° = ½; the heading is unchanged.
    let mut task = TaskConfig::default();
    assert!(close(pay(&task, [1.0, 0.0, 0.0], &state, 0.0), 0.5));
    // A gate is raised to its weight: ½² = ¼, and taken away by 0.
    for (weight, left) in [(2.0, 0.25), (0.0, 1.0)] {
        task.gate.upright.as_mut().unwrap().weight = Ramp::Constant(weight);
        assert!(close(pay(&task, [1.0, 0.0, 0.0], &state, 0.0), left));
    }
    // Upside down pays nothing rather than less than nothing.
    state.orientation = UnitQuaternion::from_euler_angles(3.0, 0.0, 0.0);
    assert_eq!(uprightness(&state), 0.0);
}

#[test]
fn kernel_and_yaw_rate_of_the_recipe() {
    let task = paying(RewardConfig {
        track: Some(track(2.0, 0.25)),
        ..RewardConfig::default()
    });
    // Velocity error ½ m/s, yaw error 1 rad/s: exp(−2·(¼ + ¼·1)) = exp(−1).
    let reward = pay(&task, [1.5, 0.0, 1.5], &walking(), 0.0);
    assert!(close(reward, 0.367_879_44), "{reward}");
}

#[test]
fn work_costs_a_share_where_it_counts() {
    let mut task = TaskConfig::default();
    assert!(close(pay(&task, [1.0, 0.0, 0.5], &walking(), 9.0), 1.0));
    // Two joules at 0.05 each: exp(−0.1).
    task.gate.effort = Some(Effort {
        weight: 0.05.into(),
    });
    let reward = pay(&task, [1.0, 0.0, 0.5], &walking(), 2.0);
    assert!(close(reward, 0.904_837_4), "{reward}");
    // A violent step, of which e^−E alone would be 0: exp(−0.05·200) = 4.54e−5.
    let reward = pay(&task, [1.0, 0.0, 0.5], &walking(), 200.0);
    assert!((reward / 4.539_993e-5 - 1.0).abs() < 1e-4, "{reward}");
}

#[test]
fn terms_are_paid_by_their_weights() {
    let mut task = paying(RewardConfig {
        track: Some(track(4.0, 0.0)),
        track_wide: Some(track(1.0, 0.0)),
    });
    // v = (1, 0), v* = (2, 0): ½·(e⁻⁴ + e⁻¹) = ½·(0.018316 + 0.367879).
    let reward = pay(&task, [2.0, 0.0, 0.5], &walking(), 0.0);
    assert!(close(reward, 0.193_097_5), "{reward}");
    assert!(close(pay(&task, [1.0, 0.0, 0.5], &walking(), 0.0), 1.0));
    // Three to one: (0.054947 + 0.367879) / 4.
    task.reward.track.as_mut().unwrap().weight = 3.0.into();
    let reward = pay(&task, [2.0, 0.0, 0.5], &walking(), 0.0);
    assert!(close(reward, 0.105_706_6), "{reward}");
    // One that weighs nothing does not exist.
    task.reward.track.as_mut().unwrap().weight = 0.0.into();
    let reward = pay(&task, [2.0, 0.0, 0.5], &walking(), 0.0);
    assert!(close(reward, 0.367_879_44), "{reward}");
}

/// Eq. 14 written out in one line, with the recipe's yaw rate: what tables of terms have to give to the last bit.
fn in_one_line(kernel: f32, yaw_rate: f32, command: &[f32; 3], state: &RobotState) -> f32 {
    let yaw_error = command[2] - state.angular_velocity.z;
    let error = velocity_error(command, state) + yaw_rate * yaw_error.powi(2);
    (-kernel * error).exp() * uprightness(state)
}

#[test]
fn the_paper_and_the_recipe_pay_the_same_bits_as_the_equation() {
    let mut rng = Pcg64Mcg::seed_from_u64(14);
    let mut draw = |size: f32| size * (2.0 * rng.random::<f32>() - 1.0);
    for _ in 0..2_000 {
        let state = RobotState {
            orientation: UnitQuaternion::from_euler_angles(draw(0.8), draw(0.8), draw(3.1)),
            linear_velocity: Vector3::new(draw(2.0), draw(2.0), draw(1.0)),
            angular_velocity: Vector3::new(draw(3.0), draw(3.0), draw(3.0)),
            ..RobotState::standing()
        };
        let command = [draw(2.0), draw(1.0), draw(1.0)];
        for (kernel, yaw_rate) in [(0.25, 0.0), (2.0, 0.25), (4.0, 0.25), (2.7, 0.25)] {
            let task = paying(RewardConfig {
                track: Some(track(kernel, yaw_rate)),
                ..RewardConfig::default()
            });
            let paid = pay(&task, command, &state, 2.5);
            let expected = in_one_line(kernel, yaw_rate, &command, &state);
            assert_eq!(paid.to_bits(), expected.to_bits(), "{command:?} {state:?}");
        }
    }
    // The default is the paper's.
    let one_line = in_one_line(0.25, 0.0, &[2.0, 0.5, 1.0], &walking());
    assert_eq!(
        pay(&TaskConfig::default(), [2.0, 0.5, 1.0], &walking(), 9.0),
        one_line
    );
}

#[test]
fn terms_are_told_by_name_and_only_those_that_exist() {
    let task: TaskConfig =
        read("[reward.track_wide]\nkernel = 1.0\n[gate.effort]\nweight = 0.05\n");
    let mut sums = Sums::default();
    for speed in [1.0, 2.0] {
        let command = [speed, 0.0, 0.5];
        task.pay_and_tell(&Moment::new(&command, &walking(), 2.0), &mut sums);
    }
    let told = sums.take(&NAMES);
    let names: Vec<&str> = told.iter().map(|(name, _)| *name).collect();
    assert_eq!(
        names,
        [
            "reward/track",
            "reward/track_wide",
            "gate/upright",
            "gate/effort"
        ]
    );
    // Errors of 0 and 1: ½·(1 + e^−¼), ½·(1 + e⁻¹); upright; e^−0.1.
    let means = [0.889_400_4, 0.683_939_7, 1.0, 0.904_837_4];
    assert!(
        told.iter()
            .zip(means)
            .all(|((_, told), mean)| close(*told, mean)),
        "{told:?}"
    );
}

fn read(text: &str) -> TaskConfig {
    toml::from_str(text).unwrap()
}

#[test]
fn names_are_told_once_each_and_fit_a_message() {
    for (i, name) in NAMES.iter().enumerate() {
        assert!(name.starts_with("reward/") || name.starts_with("gate/"));
        assert!(!NAMES[..i].contains(name), "{name}");
        assert!(name.len() <= 28, "{name}");
    }
}
