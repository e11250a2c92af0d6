//! Feet whose height over the ground is known.

use super::*;
use g1::DEFAULT_POSE;
use g1::state::STANDING_HEIGHT;
use nalgebra::{UnitQuaternion, Vector3};

/// Standing in the default pose, soles at `height(i)` m over the ground.
fn standing(frames: usize, height: impl Fn(usize) -> f64) -> Vec<Row> {
    let row = |i: usize| Row {
        position: Vector3::new(0.0, 0.0, height(i)),
        orientation: UnitQuaternion::identity(),
        joints: DEFAULT_POSE.map(f64::from),
        dropped: [0.0; 6],
    };
    let mut rows: Vec<Row> = (0..frames).map(row).collect();
    // STANDING_HEIGHT is rounded; the lowest corner of the soles is what counts.
    let down = lowest(&standing_at_zero());
    rows.iter_mut().for_each(|row| row.position.z -= down);
    rows
}

fn standing_at_zero() -> Row {
    Row {
        position: Vector3::zeros(),
        orientation: UnitQuaternion::identity(),
        joints: DEFAULT_POSE.map(f64::from),
        dropped: [0.0; 6],
    }
}

#[test]
fn the_median_of_standing_soles_is_on_the_ground() {
    assert!((lowest(&standing_at_zero()) + STANDING_HEIGHT).abs() < 1e-4);
    // Four fifths of the frames stand at 12 mm, a fifth at 0: the lowest tenth is 0, the median 12 mm.
    let mut rows = standing(100, |i| if (40..60).contains(&i) { 0.0 } else { 0.012 });
    let mut decisions = Vec::new();
    put(&mut rows, &mut decisions);
    for (i, row) in rows.iter().enumerate() {
        let height = lowest(row);
        // 3 mm are on the ground; lifting reaches 1 frame, and is smoothed over 1 more.
        if (40..60).contains(&i) {
            assert!((height + 0.003).abs() < 1e-9, "frame {i} at {height}");
        } else if !(38..62).contains(&i) {
            assert!(height.abs() < 1e-9, "frame {i} at {height}");
        }
    }
    assert!(
        decisions[0].starts_with("ground: moved by -12.0 mm, by the median")
            && decisions[0].ends_with("lifted by up to 9.0 mm where a sole sank"),
        "{decisions:?}"
    );
}

#[test]
fn a_foot_that_is_held_up_does_not_stand() {
    // The left leg bent by 1.2 and 1.6 rad for the whole clip: its sole is still, but high.
    let mut rows = standing(50, |_| 0.03);
    for row in &mut rows {
        row.joints[0] -= 1.2;
        row.joints[3] += 1.6;
    }
    let soles = soles(&rows[0]).map(|foot| foot.map(|corner| corner.z));
    assert!(soles[0].iter().all(|z| *z > 0.1) && soles[1].iter().any(|z| *z < 0.031));
    put(&mut rows, &mut Vec::new());
    assert!(lowest(&rows[25]).abs() < 1e-9);
}

#[test]
fn the_flight_of_a_jump_stays() {
    // 12 frames of 50 in the air on a parabola of 0.2 m, from and to the ground.
    let jump = |i: usize| {
        let t = (i as f64 - 20.0) / 12.0;
        if (0.0..=1.0).contains(&t) {
            0.8 * t * (1.0 - t)
        } else {
            0.0
        }
    };
    let mut rows = standing(50, |i| jump(i) - 0.4);
    put(&mut rows, &mut Vec::new());
    for (i, row) in rows.iter().enumerate() {
        assert!((lowest(row) - jump(i)).abs() < 1e-9, "frame {i}");
    }
}

#[test]
fn where_no_sole_stands_the_lowest_tenth_does() {
    // Gliding at 2 m/s, 5 cm too low.
    let mut rows = standing(50, |_| -0.05);
    for (i, row) in rows.iter_mut().enumerate() {
        row.position.x = 2.0 * 0.02 * i as f64;
    }
    let mut decisions = Vec::new();
    put(&mut rows, &mut decisions);
    assert!(lowest(&rows[25]).abs() < 1e-9);
    assert!(
        decisions[0].contains("+50.0 mm, by a tenth"),
        "{decisions:?}"
    );
}

#[test]
fn a_floor_that_rises_is_measured_before_it_is_hidden() {
    // 6 cm over 4 s: 0.3 mm a frame, of which the second frames of the pieces at the ends are 175 apart.
    for way in [1.0, -1.0] {
        let mut rows = standing(201, |i| way * 0.0003 * i as f64);
        let floor = put(&mut rows, &mut Vec::new()).unwrap();
        assert!((floor.by - 0.0525).abs() < 2e-4, "{floor:?}");
        assert_eq!(floor.highest > floor.lowest, way > 0.0);
    }
    let level = put(&mut standing(201, |_| 0.1), &mut Vec::new()).unwrap();
    assert!(level.by < 1e-9);
}
