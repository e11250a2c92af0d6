//! Feet of made-up motions: planted, joined, within reach.

use super::*;

/// A foot that slides forward at 1 cm a frame, 2 cm too low, pitching from heel to toe, and
/// stands in frames 0–9 and 20–29.
fn sliding() -> (Vec<Free>, Vec<Contact>) {
    let frame = |i: usize| {
        let pitch = 0.04 * (i % 20) as f64 - 0.2;
        let at = |y: f64| {
            Isometry3::from_parts(
                [0.01 * i as f64, y, 0.015].into(),
                UnitQuaternion::from_euler_angles(0.05, pitch, 0.1),
            )
        };
        Free {
            feet: [at(0.1), at(-0.1)],
            hips: [Vector3::new(0.01 * i as f64, 0.1, 0.6); 2],
        }
    };
    let contact = |i: usize| Contact {
        stands: [i % 20 < 10; 2],
        flat: [false; 2],
    };
    ((0..30).map(frame).collect(), (0..30).map(contact).collect())
}

fn corners(foot: &Isometry3<f64>) -> [Vector3<f64>; 4] {
    SOLE_CORNERS.map(|c| foot.translation.vector + foot.rotation * Vector3::from(c))
}

#[test]
fn a_standing_foot_rolls_without_slipping_and_touches_the_ground() {
    let (free, contacts) = sliding();
    let plan = plan(&free, &contacts);
    assert_eq!(plan.stances, 4);
    for i in (0..9).chain(20..29) {
        let [a, b] = [i, i + 1].map(|i| corners(&plan.feet[i][0]));
        let lowest = (0..4).min_by(|&j, &k| (a[j].z + b[j].z).total_cmp(&(a[k].z + b[k].z)));
        let k = lowest.unwrap();
        assert!((a[k] - b[k]).xy().norm() < 1e-9, "frame {i}");
        assert!(a[k].z.abs() < 1e-9, "frame {i} at {}", a[k].z);
    }
    // 4.5 cm from the middle of the slide, less half of what rolling over heel and toe goes along
    // with it: 35 mm times 0.36 rad.
    assert!((plan.moved - 0.0387).abs() < 0.002, "{}", plan.moved);
}

#[test]
fn swings_join_without_a_step_and_clear_the_ground() {
    let (free, contacts) = sliding();
    let plan = plan(&free, &contacts);
    for i in 10..20 {
        let low = corners(&plan.feet[i][0])
            .map(|c| c.z)
            .into_iter()
            .fold(1.0, f64::min);
        assert!(low > 0.0, "frame {i}");
    }
    let x = |i: usize| plan.feet[i][0].translation.x;
    // Planted, then two strides' worth of slide (20 cm) in 11 frames: 1.8 cm a frame on average.
    for i in 9..20 {
        assert!(
            (0.0..0.045).contains(&(x(i + 1) - x(i))),
            "{i}: {}",
            x(i + 1) - x(i)
        );
    }
}

#[test]
fn the_pelvis_comes_down_to_what_the_legs_reach() {
    let (mut free, contacts) = sliding();
    for frame in &mut free {
        for hip in &mut frame.hips {
            hip.z = 0.75;
        }
    }
    let plan = plan(&free, &contacts);
    for (i, frame) in free.iter().enumerate() {
        for s in 0..2 {
            let excess = beyond_reach(&frame.hips[s], plan.raise[i], &plan.feet[i][s]);
            assert!(excess < 1e-9, "frame {i}: {excess}");
        }
    }
    assert!(plan.lowered > 0.05);
}

#[test]
fn bridges_continue_slopes_and_hold_ends() {
    let series = [
        None,
        Some(0.0),
        Some(1.0),
        None,
        None,
        Some(4.0),
        Some(5.0),
        None,
    ];
    let bridged = bridged(&series);
    for (i, value) in bridged.iter().enumerate().take(7).skip(1) {
        assert!((value - (i as f64 - 1.0)).abs() < 1e-12, "{bridged:?}");
    }
    assert_eq!((bridged[0], bridged[7]), (0.0, 5.0));
}
