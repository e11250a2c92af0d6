//! Gaits that go aside, turn, go backward, begin and end, over a grid of velocities.

use super::measures::{duty, gap};
use super::*;

const fn velocity(forward: f64, lateral: f64, yaw_rate: f64) -> Velocity {
    Velocity {
        forward,
        lateral,
        yaw_rate,
    }
}

/// All turns alone, all steps aside alone, and both up to half of their ranges.
fn grid(speeds: &[f64]) -> Vec<Velocity> {
    const WAYS: [[f64; 2]; 9] = [
        [0.0, 0.0],
        [0.0, 0.5],
        [0.0, 1.0],
        [0.0, -1.0],
        [0.2, 0.0],
        [0.4, 0.0],
        [-0.4, 0.0],
        [0.2, 0.5],
        [-0.2, 0.5],
    ];
    let at = |speed: &f64| WAYS.map(|[lateral, yaw_rate]| velocity(*speed, lateral, yaw_rate));
    speeds.iter().flat_map(at).collect()
}

const WALKED: [f64; 8] = [-0.6, -0.3, 0.0, 0.2, 0.5, 0.8, 1.2, 1.8];
const RUN: [f64; 3] = [1.8, 2.2, 2.7];

/// Periodic gaits.
pub(super) static STEADY: LazyLock<Vec<Clip>> = LazyLock::new(|| {
    let made = |make: fn(Velocity) -> Option<Clip>, speeds: &[f64]| {
        let make = move |v| make(v).unwrap_or_else(|| panic!("no pose at {v}"));
        grid(speeds).into_iter().map(make)
    };
    made(walk, &WALKED).chain(made(run, &RUN)).collect()
});

/// Starts and stops.
pub(super) static TRANSITIONS: LazyLock<Vec<Clip>> = LazyLock::new(|| {
    grid(&[-0.5, 0.0, 0.5, 1.0])
        .into_iter()
        .flat_map(|v| {
            [start(v), stop(v)].map(|clip| clip.unwrap_or_else(|| panic!("no pose at {v}")))
        })
        .collect()
});

#[test]
fn soles_stay_eight_centimetres_apart() {
    for clip in STEADY.iter().chain(TRANSITIONS.iter()) {
        let gap = gap(clip);
        assert!(gap > 0.08, "{}: soles {gap} m apart", clip.name);
    }
}

#[test]
fn the_mean_motion_is_the_one_asked_for() {
    for clip in STEADY.iter() {
        let n = clip.frames.len() as f32;
        let mean =
            |value: &dyn Fn(&RobotState) -> f32| clip.frames.iter().map(value).sum::<f32>() / n;
        let seen = [
            mean(&|f| f.velocity_in_heading().x),
            mean(&|f| f.velocity_in_heading().y),
            mean(&|f| f.angular_velocity.z),
        ];
        // The heading frame sways with the pelvis, which takes up to 2 cm/s of the way ahead.
        for (seen, asked) in seen.iter().zip(&clip.command) {
            assert!((seen - asked).abs() < 0.02, "{}: {seen}", clip.name);
        }
    }
}

#[test]
fn a_standing_sole_is_flat_from_side_to_side() {
    for clip in STEADY.iter().chain(TRANSITIONS.iter()) {
        for frame in &clip.frames {
            for foot in [LEFT_FOOT, RIGHT_FOOT] {
                let corners = g1::kinematics::sole_points(&forward_state(frame), foot);
                let tilt = (corners[0].z - corners[1].z).abs();
                assert!(tilt < 1e-4, "{} tilts a sole by {tilt} m", clip.name);
            }
        }
    }
}

#[test]
fn a_foot_is_always_down_but_in_a_run() {
    let walks = STEADY.iter().filter(|clip| clip.name.starts_with("walk"));
    for clip in walks.chain(TRANSITIONS.iter()) {
        let down = duty(clip, &[LEFT_FOOT, RIGHT_FOOT]);
        assert!(down > 0.99, "{} is down {down} of the time", clip.name);
    }
}

#[test]
fn going_to_the_right_is_going_to_the_left_in_a_mirror() {
    for left in [velocity(0.7, 0.1, 0.5), velocity(-0.4, 0.2, 0.0)] {
        let here = walking(left).unwrap().0;
        let there = walking(left.mirrored()).unwrap().0;
        for i in 0..10 {
            let time = 0.1 * f64::from(i) * here.way.period;
            let seen = mirror_state(&frame(&here, time).unwrap());
            let other = frame(&there, time + here.way.period / 2.0).unwrap();
            assert_alike(&seen, &other, 1e-3);
        }
    }
}

fn assert_alike(a: &RobotState, b: &RobotState, tolerance: f32) {
    let (mut x, mut y) = ([0.0; FEATURES], [0.0; FEATURES]);
    features(a, &mut x);
    features(b, &mut y);
    for (x, y) in x.iter().zip(&y) {
        assert!((x - y).abs() < tolerance, "{a:?} is not {b:?}");
    }
}

#[test]
fn velocities_are_derivatives_to_a_thousandth() {
    let steady = |v: Velocity| walking(v).unwrap().0;
    let curve = velocity(0.6, 0.1, 0.6);
    let (begins, _) = transition::start(steady(0.8.into())).unwrap();
    let (ends, _) = transition::stop(steady(velocity(-0.3, 0.0, 0.5))).unwrap();
    for stride in [steady(curve), steady((-0.5).into()), begins, ends] {
        let (mut error, mut size) = ([0.0; 3], [0.0; 3]);
        for i in 0..50 {
            const H: f64 = 5e-5;
            let time = 0.02 * f64::from(i);
            let now = frame(&stride, time).unwrap();
            let [a, b] = [time - H, time + H].map(|t| stride.pose(t).unwrap());
            let rate = (b.base.translation.vector - a.base.translation.vector) / (2.0 * H);
            let spin = (b.base.rotation * a.base.rotation.inverse()).scaled_axis() / (2.0 * H);
            error[0] += (rate - now.linear_velocity.cast()).norm_squared();
            size[0] += rate.norm_squared();
            error[1] += (spin - now.angular_velocity.cast()).norm_squared();
            size[1] += spin.norm_squared();
            for j in 0..JOINTS {
                let rate = (b.joints[j] - a.joints[j]) / (2.0 * H);
                error[2] += (rate - f64::from(now.joint_velocities[j])).powi(2);
                size[2] += rate * rate;
            }
        }
        for (e, s) in error.iter().zip(&size) {
            let share = (e / s).sqrt();
            assert!(share < 1e-3, "{:?}: {share}", stride.way.velocity);
        }
    }
}

#[test]
fn backward_is_forward_run_back_in_time() {
    let backward = walking((-0.5).into()).unwrap().0;
    let forward = Stride {
        reversed: false,
        ..backward
    };
    for i in 0..20 {
        let time = 0.05 * f64::from(i);
        let (back, ahead) = (frame(&backward, time), frame(&forward, -time));
        let (back, ahead) = (back.unwrap(), ahead.unwrap());
        assert_eq!(back.position, ahead.position);
        assert_eq!(back.joint_positions, ahead.joint_positions);
        let sum = back.linear_velocity + ahead.linear_velocity;
        assert!(sum.norm() < 1e-4, "{sum:?}");
        for (v, w) in back.joint_velocities.iter().zip(&ahead.joint_velocities) {
            assert!((v + w).abs() < 1e-3, "{v} and {w}");
        }
    }
    // It leans to where it goes, by 0.042·0.5/0.98 rad.
    assert!((backward.base.pitch.mean + 0.0217).abs() < 1e-3);
}

#[test]
fn a_start_leads_from_standing_to_the_walk_and_a_stop_back() {
    for v in [
        0.5.into(),
        velocity(-0.4, 0.0, 0.3),
        velocity(0.0, 0.3, 0.0),
    ] {
        let steady = walking(v).unwrap().0;
        // Phases count on through both, so the walk is at the same one where they meet.
        let walked = |phase: f64| {
            let phase = if steady.reversed { -phase } else { phase };
            frame(&steady, phase * steady.way.period).unwrap()
        };
        let standing = RobotState::standing();
        // A foot planted while the speed still changes stands up to 1 cm beside its steady place.
        const NEARLY: f32 = 0.25;
        let sense = if steady.reversed { -1.0 } else { 1.0 };
        let (begins, seconds) = transition::start(steady).unwrap();
        let end = begins.begin + sense * seconds / steady.way.period;
        assert_alike(&frame(&begins, 0.0).unwrap(), &standing, 1e-3);
        assert_alike(&frame(&begins, seconds).unwrap(), &walked(end), NEARLY);
        let (ends, seconds) = transition::stop(steady).unwrap();
        assert_alike(&frame(&ends, 0.0).unwrap(), &walked(ends.begin), NEARLY);
        assert_alike(&frame(&ends, seconds).unwrap(), &standing, 1e-3);
    }
}

#[test]
fn a_change_takes_about_a_stride() {
    for clip in TRANSITIONS.iter() {
        assert!(clip.name.starts_with("start") || clip.command == [0.0; 3]);
        // With a moment of standing and of steady walking; the slowest stride takes 1.65 s.
        assert!((0.8..2.5).contains(&clip.seconds()), "{}", clip.name);
        assert!(!clip.cyclic);
    }
    let go = start(0.8).unwrap();
    assert_eq!(go.command, [0.8, 0.0, 0.0]);
    assert_eq!(stop(0.8).unwrap().command, [0.0; 3]);
}

#[test]
fn what_no_leg_can_do_is_refused() {
    for v in [
        velocity(1.8, 0.4, 1.0),
        velocity(0.5, 0.5, 0.0),
        velocity(0.5, 0.0, -1.1),
        velocity(0.5, f64::NAN, 0.0),
    ] {
        assert!(walk(v).is_none() && start(v).is_none() && stop(v).is_none());
    }
    assert!(run(velocity(2.7, 0.4, 1.0)).is_none());
}
