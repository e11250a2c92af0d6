//! Walks of a stick figure become walks of the robot: no snaps, no slip, whatever the figure is like.

use super::*;
use crate::puppet::{self, Walk};
use crate::report::SNAP;
use g1::kinematics::sole_points;
use nalgebra::Vector3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Tries a property on many walks, the same every time.
fn always(cases: u32, walks: &impl Strategy<Value = Walk>, property: fn(&Walk)) {
    let config = Config {
        cases,
        failure_persistence: None,
        ..Config::default()
    };
    let generator = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let tried = TestRunner::new_with_rng(config, generator).run(walks, |walk| {
        property(&walk);
        Ok(())
    });
    if let Err(failure) = tried {
        panic!("{failure}");
    }
}

/// Walks as people walk: legs bent to nearly straight, feet that roll, any build, rate and phase.
fn natural() -> impl Strategy<Value = Walk> {
    // A stride of 0.6 to 1.5 legs in 0.95 to 1.35 s.
    let way = (0.6..1.5, 0.95..1.35, 0.58..0.68, -0.4..0.4);
    let body = (0.7..0.98, 0.46..0.54, 0.97..0.998, 0.0..0.012);
    let feet = (0.0..0.3, 0.0..0.6, 0.05..0.14, 0.0..1.0);
    let fps = prop::sample::select(vec![30.0, 50.0, 60.0, 100.0, 120.0]);
    (way, body, feet, fps).prop_map(|(way, body, feet, fps)| Walk {
        fps,
        speed: way.0 * body.0 / way.1,
        period: way.1,
        stance: way.2,
        curvature: way.3,
        leg: body.0,
        thigh: body.1,
        reach: body.2,
        bob: body.3,
        strike: feet.0,
        push: feet.1,
        lift: feet.2,
        phase: feet.3,
        ..Walk::PLAIN
    })
}

/// The same with steps longer than the legs, slow or hasty, wrong markers and ways that rise.
fn hard() -> impl Strategy<Value = Walk> {
    let worse = (0.98..1.03, 0.0..0.004, -0.25..0.25, 0.2..2.0, 0.7..2.5);
    (natural(), worse).prop_map(|(walk, worse)| Walk {
        reach: worse.0,
        noise: worse.1,
        slope: worse.2,
        speed: worse.3 * walk.leg / worse.4,
        period: worse.4,
        ..walk
    })
}

fn sharpest(report: &Report) -> f64 {
    report
        .sharpest
        .iter()
        .map(|s| s.degrees)
        .fold(0.0, f64::max)
}

/// Speeds over the ground of the lowest corners of soles on it, m/s.
fn slips(postures: &[Posture]) -> Vec<f64> {
    let mut slips = Vec::new();
    for pair in postures.windows(2) {
        let [a, b] = [0, 1].map(|i| forward(&pair[i].base, &pair[i].joints));
        for foot in [LEFT_FOOT, RIGHT_FOOT] {
            let (p, q) = (sole_points(&a, foot), sole_points(&b, foot));
            let low = |k: &usize| p[*k].z + q[*k].z;
            let k = (0..4).min_by(|j, k| low(j).total_cmp(&low(k))).unwrap();
            if p[k].z < 0.005 && q[k].z < 0.005 {
                slips.push((q[k] - p[k]).xy().norm() * RATE);
            }
        }
    }
    slips
}

fn assert_possible(postures: &[Posture]) {
    for posture in postures {
        assert!(lowest_foot_point(&forward(&posture.base, &posture.joints)) > -1e-6);
        for (q, joint) in posture.joints.iter().zip(&JOINT_TABLE) {
            assert!((joint.lower..=joint.upper).contains(q), "{}", joint.name);
        }
        for knee in LEGS.map(|leg| leg + crate::limb::KNEE) {
            let above = posture.joints[knee] - JOINT_TABLE[knee].lower;
            assert!(above.to_degrees() > 2.0, "a knee {above} rad from its stop");
        }
    }
    for pair in postures.windows(2) {
        for (j, joint) in JOINT_TABLE.iter().enumerate() {
            let speed = (pair[1].joints[j] - pair[0].joints[j]).abs() * RATE;
            assert!(speed < joint.velocity_limit, "{} at {speed}", joint.name);
        }
    }
}

#[test]
fn a_walking_puppet_becomes_a_walking_robot() {
    let (postures, report) = retarget(&puppet::walking(120.0, 4.4));
    assert_eq!((postures.len(), report.frames), (221, 221));
    assert!((report.speed / report.scaled_speed - 1.0).abs() < 0.01);
    assert!(report.direction_error < 5.0, "{}°", report.direction_error);
    assert!(report.stances >= 8, "{}", report.stances);
    assert_possible(&postures);
}

#[test]
fn people_walk_without_snaps_and_with_their_own_knees() {
    always(60, &natural(), |walk| {
        let (postures, report) = retarget(&walk.capture());
        assert_possible(&postures);
        assert!(sharpest(&report) < SNAP, "{:?}", report.sharpest);
        assert!(
            report.knee_error < 4.5,
            "knees off by {}°",
            report.knee_error
        );
        assert!(report.off_target < 0.02, "{} off", report.off_target);
        let slip = signal::median(&mut slips(&postures));
        assert!(slip < 0.001, "{slip} m/s");
        let speed = report.speed / report.scaled_speed;
        assert!((speed - 1.0).abs() < 0.03, "speed times {speed}");
    });
}

#[test]
fn what_cannot_be_walked_is_walked_without_snaps() {
    always(60, &hard(), |walk| {
        let (postures, report) = retarget(&walk.capture());
        assert_possible(&postures);
        assert!(sharpest(&report) < SNAP, "{:?}", report.sharpest);
    });
}

/// Straight knees over planted feet, where a leg's length says least of its knee.
#[test]
fn straight_legs_do_not_snap() {
    for k in 0..20 {
        let walk = Walk {
            fps: 30.0,
            reach: 0.99 + 0.001 * f64::from(k),
            bob: 0.002 * f64::from(k % 5),
            strike: 0.2,
            push: 0.4,
            phase: 0.05 * f64::from(k),
            ..Walk::PLAIN
        };
        let (_, report) = retarget(&walk.capture());
        assert!(sharpest(&report) < SNAP, "{walk:?}: {:?}", report.sharpest);
    }
}

/// A capture that is cut, frozen for half a second or moved across the room is no reason to snap.
#[test]
fn breaks_of_a_capture_are_crossed_without_snaps() {
    let clean = puppet::walking(60.0, 3.0);
    for at in [50, 63, 76, 89] {
        let (mut moved, mut frozen, mut cut) = (clean.clone(), clean.clone(), clean.clone());
        for frame in &mut moved.frames[at..] {
            for point in &mut frame.0 {
                *point += Vector3::new(1.0, 0.5, 0.0);
            }
        }
        frozen.frames[at..at + 30].fill(clean.frames[at]);
        cut.frames.drain(at..at + 10);
        for capture in [moved, frozen, cut] {
            let (postures, report) = retarget(&capture);
            assert!(sharpest(&report) < SNAP, "{at}: {:?}", report.sharpest);
            assert_possible(&postures);
        }
    }
}

/// Steps of twice the legs' length: no foot gets there, and the report says so.
#[test]
fn feet_out_of_reach_are_kept_back_and_it_is_said() {
    let walk = Walk {
        speed: 1.5,
        period: 2.0,
        leg: 0.75,
        reach: 1.0,
        ..Walk::PLAIN
    };
    let (postures, report) = retarget(&walk.capture());
    assert_possible(&postures);
    assert!(
        report.lowered > 0.05 && report.unreached > 0.005,
        "{report:?}"
    );
    let said = report.actions().join("\n");
    assert!(said.contains("reach: kept standing feet up to"), "{said}");
}

#[test]
fn standing_feet_do_not_slip() {
    let (postures, _) = retarget(&puppet::walking(120.0, 4.4));
    let mut slips = slips(&postures);
    assert!(slips.len() > 200, "{}", slips.len());
    let slip = signal::median(&mut slips);
    assert!(slip < 0.001, "{slip} m/s");
}

#[test]
fn the_same_capture_gives_the_same_clip_wherever_it_happens() {
    let here = puppet::walking(100.0, 2.2);
    let mut there = here.clone();
    for frame in &mut there.frames {
        for point in &mut frame.0 {
            *point += Vector3::new(30.0, -7.0, 0.4); // another room, another floor
        }
    }
    let (a, b) = (retarget(&here).0, retarget(&there).0);
    for (a, b) in a.iter().zip(&b) {
        assert!((a.base.translation.z - b.base.translation.z).abs() < 1e-3);
        for (p, q) in a.joints.iter().zip(&b.joints) {
            assert!((p - q).abs() < 1e-3, "{p} {q}");
        }
    }
}

/// Longer than a window of the solver: nothing shows where windows meet.
#[test]
fn long_clips_are_as_smooth_as_short_ones() {
    let [short, long] = [4.0, 12.0].map(|seconds| retarget(&puppet::walking(50.0, seconds)).1);
    assert!(short.frames < 240 && long.frames > 600);
    let (short, long) = (sharpest(&short), sharpest(&long));
    assert!(
        long < 1.1 * short,
        "{long}° a frame², in a short clip {short}°"
    );
}

#[test]
fn two_frames_are_enough() {
    let (postures, report) = retarget(&puppet::walking(50.0, 0.02));
    assert_eq!(postures.len(), 2);
    assert!(
        report.sharpest.is_empty(),
        "no three frames, no second difference"
    );
    assert_possible(&postures);
}
