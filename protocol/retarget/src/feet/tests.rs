//! Feet of made-up motions: planted, joined, within reach.

use super::*;
use g1::links::SOLE_CORNERS;

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
        let above = |z: f64| [0.1, -0.1].map(|y| Vector3::new(0.01 * i as f64, y, z));
        Free {
            feet: [at(0.1), at(-0.1)],
            hips: above(0.6),
            ankles: above(0.033),
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
        let [a, b] = [i, i + 1].map(|i| corners(&plan.feet[i][0].frame));
        let lowest = (0..4).min_by(|&j, &k| (a[j].z + b[j].z).total_cmp(&(a[k].z + b[k].z)));
        let k = lowest.unwrap();
        assert!((a[k] - b[k]).xy().norm() < 1e-9, "frame {i}");
        assert!(a[k].z.abs() < 1e-9, "frame {i} at {}", a[k].z);
    }
    // 4.5 cm from the middle of the slide, less half of what rolling over heel and toe goes along
    // with it: 35 mm times 0.30 rad, the pitches of -0.2 and 0.16 being laid to -0.17 and 0.13.
    assert!((plan.moved - 0.0397).abs() < 0.002, "{}", plan.moved);
}

#[test]
fn swings_join_without_a_step_and_clear_the_ground() {
    let (free, contacts) = sliding();
    let plan = plan(&free, &contacts);
    for i in 10..20 {
        let low = corners(&plan.feet[i][0].frame)
            .map(|c| c.z)
            .into_iter()
            .fold(1.0, f64::min);
        assert!(low > 0.0, "frame {i}");
    }
    let x = |i: usize| plan.feet[i][0].frame.translation.x;
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
fn a_foot_is_firm_in_stance_and_freed_sooner_than_it_is_caught() {
    let (free, contacts) = sliding();
    let plan = plan(&free, &contacts);
    let firm = |i: usize| plan.feet[i][0].firm;
    assert_eq!([firm(0), firm(9), firm(20), firm(29)], [1.0; 4]);
    // Free three frames after the stance, bound six before the next one.
    assert!((firm(10) - 2.0 / 3.0).abs() < 1e-12 && (firm(11) - 1.0 / 3.0).abs() < 1e-12);
    assert_eq!([firm(12), firm(14)], [0.0; 2]);
    assert!((firm(15) - 1.0 / 6.0).abs() < 1e-12 && (firm(19) - 5.0 / 6.0).abs() < 1e-12);
    assert_eq!(plan.feet[5][0].clearance, 0.0);
    // Frame 14 is the fifth of ten: sin²(5π/11) of 15 mm.
    let arch = 0.015 * (5.0 * PI / 11.0).sin().powi(2);
    assert!((plan.feet[14][0].clearance - arch).abs() < 1e-12);
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
