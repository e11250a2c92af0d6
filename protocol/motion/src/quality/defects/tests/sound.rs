//! What has no defects: the built-in gaits, and motion of the living.

use super::*;

#[test]
fn built_in_gaits_have_no_defects() {
    let straight = [-0.6, -0.3, 0.0, 0.4, 0.98, 1.4, 1.8].map(Velocity::from);
    let ways = [
        (0.0, 0.4, 0.0),
        (0.5, -0.4, 0.0),
        (0.0, 0.0, 1.0),
        (0.8, 0.2, -0.5),
    ]
    .map(|(forward, lateral, yaw_rate)| Velocity {
        forward,
        lateral,
        yaw_rate,
    });
    let mut clips = vec![gait::stand()];
    for v in straight.into_iter().chain(ways) {
        clips.extend(gait::walk(v));
        if v.forward <= 1.0 {
            clips.extend(gait::start(v));
            clips.extend(gait::stop(v));
        }
    }
    clips.extend([1.8, 2.2, 2.7].map(|v| gait::run(v).unwrap()));
    assert_eq!(clips.len(), 1 + 11 + 18 + 3);
    for clip in clips {
        for clip in [clip.mirrored(), clip.unrolled(5.0)] {
            let mut defects = of(&clip);
            // A walk back is told, since its name says so.
            if clip.command[0] < 0.0 || clip.name.contains('-') {
                defects.retain(|defect| {
                    (defect.kind, defect.severity) != (Kind::Backward, Severity::Odd)
                });
            }
            assert_eq!(defects, [], "{}", clip.name);
        }
    }
}

#[test]
fn what_is_alive_has_no_defects() {
    // A crouch to a pelvis of 0.5 m and back within 2 s; knees and hips fold twice as far as ankles.
    let crouch = standing(101, |i, frame| {
        let depth = (std::f64::consts::PI * i as f64 / 100.0).sin().powi(2) as f32;
        for leg in [0, 6] {
            frame.joint_positions[leg] -= 0.7 * depth;
            frame.joint_positions[leg + 3] += 1.3 * depth;
            frame.joint_positions[leg + 4] -= 0.6 * depth;
        }
        let bodies = g1::kinematics::forward_state(frame);
        frame.position.z -= g1::kinematics::lowest_foot_point(&bodies);
    });
    assert!(crouch.frames[50].position.z < 0.6);
    assert_eq!(of(&crouch), []);
    // A jump of 0.4 m: 2√(2·0.4/9.81) = 0.571 s, 28 frames, in the air.
    let jump = standing(100, |i, frame| {
        let t = (i as f32 - 50.0) * 0.02;
        frame.position.z += (0.4 - 0.5 * 9.81 * t * t).max(0.0);
    });
    assert_eq!(of(&jump), []);
    // A kick: hip and knee swing by 1.2 rad within 0.3 s, ½·1.2·(2π/0.3)²/2 = 132 rad/s² at most.
    let kick = standing(100, |i, frame| {
        let phase = (i.saturating_sub(40) as f32 / 15.0).min(1.0);
        let swing = 0.6 * (1.0 - (std::f32::consts::TAU * phase).cos());
        frame.joint_positions[0] -= swing;
        frame.joint_positions[3] += 0.5 * swing;
    });
    assert_eq!(of(&kick), []);
}
