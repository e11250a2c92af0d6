//! What a reference gait must be, measured on its frames by forward kinematics.

mod commands;
mod measures;
mod table;

use super::*;
use crate::clip::Clip;
use g1::kinematics::{forward_state, lowest_foot_point, lowest_sole_point};
use g1::mirror::mirror_state;
use g1::observation::features;
use g1::{FEATURES, JOINT_TABLE, JOINTS, LEFT_FOOT, RIGHT_FOOT};
use measures::{clearance, duty, stance_slip, successive};
use std::sync::LazyLock;

// Made once for all tests.
static WALKS: LazyLock<Vec<Clip>> = LazyLock::new(|| {
    (4..=18)
        .map(|i| walk(f64::from(i) / 10.0).unwrap())
        .collect()
});
static RUNS: LazyLock<Vec<Clip>> = LazyLock::new(|| {
    [1.8, 1.83, 2.0, 2.2, 2.4, 2.6, 2.7]
        .map(|v| run(v).unwrap())
        .into()
});

fn all() -> impl Iterator<Item = &'static Clip> {
    WALKS
        .iter()
        .chain(RUNS.iter())
        .chain(commands::STEADY.iter())
        .chain(commands::TRANSITIONS.iter())
}

#[test]
fn the_standing_foot_does_not_slip() {
    for clip in all() {
        for foot in [LEFT_FOOT, RIGHT_FOOT] {
            let slip = stance_slip(clip, foot);
            assert!(slip < 0.1, "{} slips at {slip} m/s", clip.name);
        }
    }
}

#[test]
fn soles_stay_above_ground_and_swing_clears_it() {
    for clip in all() {
        let lowest = clip
            .frames
            .iter()
            .map(|f| lowest_foot_point(&forward_state(f)));
        let lowest = lowest.fold(f32::INFINITY, f32::min);
        assert!(lowest > -1e-3, "{} sinks to {lowest}", clip.name);
        for foot in [LEFT_FOOT, RIGHT_FOOT] {
            let heights = clip
                .frames
                .iter()
                .map(|f| lowest_sole_point(&forward_state(f), foot));
            let peak = heights.fold(0.0, f32::max);
            assert!(peak > 0.03, "{} lifts by {peak}", clip.name);
            let clearance = clearance(clip, foot);
            assert!(clearance > 0.02, "{} clears {clearance}", clip.name);
        }
    }
}

#[test]
fn no_gait_touches_itself() {
    for clip in all() {
        let gap = |frame| g1::collision::nearest(frame);
        let nearest = clip.frames.iter().map(gap);
        let (pair, distance) = nearest.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
        let [a, b] = g1::collision::names(pair);
        assert!(distance > 0.0, "{}: {a} and {b} at {distance} m", clip.name);
    }
}

#[test]
fn joints_stay_within_their_limits() {
    for clip in all() {
        for frame in &clip.frames {
            for (j, joint) in JOINT_TABLE.iter().enumerate() {
                let (q, speed) = (frame.joint_positions[j], frame.joint_velocities[j].abs());
                let range = joint.lower..=joint.upper;
                assert!(
                    range.contains(&f64::from(q)),
                    "{}: {} at {q}",
                    clip.name,
                    joint.name
                );
                // The knee of a run at 2.7 m/s reaches 21.3 of 20 rad/s.
                let fastest = joint.velocity_limit as f32 * 1.1;
                assert!(
                    speed < fastest,
                    "{}: {} at {speed} rad/s",
                    clip.name,
                    joint.name
                );
            }
        }
    }
}

#[test]
fn mean_speed_is_the_one_asked_for() {
    for clip in WALKS.iter().chain(RUNS.iter()) {
        let n = clip.frames.len();
        let mean = clip
            .frames
            .iter()
            .map(|f| f.velocity_in_heading().x)
            .sum::<f32>()
            / n as f32;
        let asked = clip.command[0];
        // 3 %: the heading frame sways with the pelvis.
        assert!((mean / asked - 1.0).abs() < 0.03, "{}: {mean}", clip.name);
        let way = clip.frames[n - 1].position.x - clip.frames[0].position.x;
        let expected = asked * (n - 1) as f32 * FRAME_SECONDS as f32;
        assert!(
            (way / expected - 1.0).abs() < 0.03,
            "{}: {way} m",
            clip.name
        );
        assert!(
            (clip.name.split(' ').nth(1).unwrap().parse::<f32>().unwrap() - asked).abs() < 0.005
        );
    }
}

#[test]
fn left_is_right_half_a_stride_later() {
    let speed = 0.9;
    let period = normative::walking_period(speed);
    let strides = [straight_walk(speed, period), run::run(2.2.into(), 0.64)];
    for stride in strides.map(Option::unwrap) {
        for i in 0..10 {
            let time = 0.1 * f64::from(i) * stride.way.period;
            let here = mirror_state(&frame(&stride, time).unwrap());
            let there = frame(&stride, time + stride.way.period / 2.0).unwrap();
            let (mut a, mut b) = ([0.0; FEATURES], [0.0; FEATURES]);
            features(&here, &mut a);
            features(&there, &mut b);
            for (x, y) in a.iter().zip(&b) {
                assert!((x - y).abs() < 1e-3, "{a:?} is not {b:?}");
            }
        }
    }
}

#[test]
fn stride_rate_follows_the_speed_law() {
    type Law = fn(f64) -> f64;
    let walks = WALKS
        .iter()
        .map(|clip| (clip, normative::walking_period as Law));
    let runs = RUNS
        .iter()
        .map(|clip| (clip, normative::running_period as Law));
    for (clip, law) in walks.chain(runs) {
        // Contacts of the right foot, counted around the cycle.
        let down: Vec<_> = clip
            .frames
            .iter()
            .map(|f| lowest_sole_point(&forward_state(f), RIGHT_FOOT) < 2e-3)
            .collect();
        let n = down.len();
        let contacts = (0..n).filter(|&i| down[(i + 1) % n] && !down[i]).count();
        let period = n as f64 * FRAME_SECONDS / contacts as f64;
        let expected = law(f64::from(clip.command[0]));
        assert!(
            (period / expected - 1.0).abs() < 0.01,
            "{}: {period} s",
            clip.name
        );
    }
}

#[test]
fn velocities_are_the_derivatives_of_positions() {
    for clip in all() {
        let frames = successive(clip);
        let step = 2.0 * FRAME_SECONDS as f32;
        let (mut error, mut size) = ([0.0; 3], [0.0; 3]);
        for three in frames.windows(3) {
            let [a, now, b] = three else { unreachable!() };
            let spin = (b.orientation * a.orientation.inverse()).scaled_axis() / step;
            let velocity = (b.position - a.position) / step;
            error[0] += (velocity - now.linear_velocity).norm_squared();
            size[0] += now.linear_velocity.norm_squared();
            error[1] += (spin - now.angular_velocity).norm_squared();
            size[1] += now.angular_velocity.norm_squared();
            for j in 0..JOINTS {
                let rate = (b.joint_positions[j] - a.joint_positions[j]) / step;
                error[2] += (rate - now.joint_velocities[j]).powi(2);
                size[2] += now.joint_velocities[j].powi(2);
            }
        }
        // Differences over 40 ms smooth what the exact derivative shows, most at a running foot and in
        // quick steps aside.
        for (kind, (e, s)) in error.iter().zip(&size).enumerate() {
            assert!(
                (e / s).sqrt() < 0.16,
                "{} velocity {kind}: {}",
                clip.name,
                (e / s).sqrt()
            );
        }
    }
}

#[test]
fn a_walk_always_has_a_foot_down_and_a_run_flies() {
    for clip in WALKS.iter() {
        assert!(
            duty(clip, &[LEFT_FOOT, RIGHT_FOOT]) > 0.99,
            "{} flies",
            clip.name
        );
        assert!(duty(clip, &[LEFT_FOOT]) > 0.5 && duty(clip, &[LEFT_FOOT]) < 0.75);
    }
    for clip in RUNS.iter() {
        let aloft = 1.0 - duty(clip, &[LEFT_FOOT, RIGHT_FOOT]);
        assert!(aloft > 0.1, "{} flies {aloft} of the time", clip.name);
    }
}

#[test]
fn legs_alternate() {
    for clip in WALKS.iter().chain(RUNS.iter()) {
        let angle = |j: usize| {
            let q: Vec<f32> = clip.frames.iter().map(|f| f.joint_positions[j]).collect();
            let mean = q.iter().sum::<f32>() / q.len() as f32;
            q.into_iter().map(move |q| q - mean).collect::<Vec<_>>()
        };
        let (left, right) = (angle(0), angle(6));
        let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f32>();
        let correlation = dot(&left, &right) / (dot(&left, &left) * dot(&right, &right)).sqrt();
        assert!(
            correlation < -0.5,
            "{}: hips correlate by {correlation}",
            clip.name
        );
    }
}

#[test]
fn the_pelvis_is_carried_as_high_as_the_robot_stands() {
    for clip in WALKS.iter().chain(RUNS.iter()) {
        let mean = clip.frames.iter().map(|f| f.position.z).sum::<f32>() / clip.frames.len() as f32;
        assert!((0.73..0.79).contains(&mean), "{} at {mean}", clip.name);
    }
}

fn straight_walk(speed: f64, period: f64) -> Option<Stride> {
    walk::walk(speed.into(), period, speed)
}

#[test]
fn walking_looks_human() {
    // Against the normative knee and hip curves: rms over a stride below 16° and 8°.
    for speed in [0.6, 0.8, 1.0, 1.2] {
        let stride = straight_walk(speed, normative::walking_period(speed)).unwrap();
        let rms = |joint: usize, human: &harmonics::Harmonics| {
            let gap = |i: u32| {
                let phase = f64::from(i) / 100.0;
                let pose = stride.pose(phase * stride.way.period).unwrap();
                (pose.joints[joint] - human.at(phase)).powi(2) / 100.0
            };
            (0..100).map(gap).sum::<f64>().sqrt().to_degrees()
        };
        assert!(
            rms(9, &stride.leg.knee) < 16.0,
            "knee at {speed}: {}",
            rms(9, &stride.leg.knee)
        );
        assert!(rms(6, &stride.leg.hip_pitch) < 8.0);
    }
}

#[test]
fn every_speed_in_range_is_possible_and_no_other() {
    for cm in (-60..=180).step_by(7) {
        assert!(walk(f64::from(cm) / 100.0).is_some(), "walk at {cm} cm/s");
    }
    for cm in (180..=270).step_by(9) {
        assert!(run(f64::from(cm) / 100.0).is_some(), "run at {cm} cm/s");
    }
    for speed in [-1.0, -0.61, 1.81, f64::NAN, f64::INFINITY] {
        assert!(walk(speed).is_none());
    }
    assert!(run(1.0).is_none() && run(2.8).is_none() && run(f64::NAN).is_none());
}

#[test]
fn standing_stands() {
    let clip = stand();
    assert!(clip.frames.iter().all(|f| *f == RobotState::standing()));
    assert_eq!((clip.command, clip.frames.len()), ([0.0; 3], 50));
}
