//! Each row of Table I, on and off.

use super::*;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use std::ops::Range;

fn rng() -> Pcg64Mcg {
    Pcg64Mcg::seed_from_u64(7)
}

/// Least and greatest of many draws.
fn spread(mut draw: impl FnMut() -> f32) -> [f32; 2] {
    (0..2_000)
        .map(|_| draw())
        .fold([f32::MAX, f32::MIN], |[a, b], x| [a.min(x), b.max(x)])
}

/// The draws fill the range of Table I: they stay inside and come within 2 % of both ends.
fn fills(got: [f32; 2], [least, greatest]: [f32; 2]) {
    let margin = 0.02 * (greatest - least);
    assert!(
        got[0] >= least && got[1] <= greatest,
        "{got:?} leaves {least} to {greatest}"
    );
    assert!(
        got[0] < least + margin && got[1] > greatest - margin,
        "{got:?} does not fill"
    );
}

#[test]
fn rows_of_the_robot_and_the_floor() {
    let none = RandomizationConfig::none();
    assert_eq!(none.draw_variation(&mut rng()), Variation::NOMINAL);
    assert!(!none.varies());

    let mass = RandomizationConfig {
        mass_variation: true,
        ..RandomizationConfig::none()
    };
    let mut rng = rng();
    fills(
        spread(|| mass.draw_variation(&mut rng).torso_mass),
        [-0.5, 0.5],
    );
    let drawn = mass.draw_variation(&mut rng);
    assert_eq!(
        Variation {
            torso_mass: 0.0,
            ..drawn
        },
        Variation::NOMINAL
    );

    let friction = RandomizationConfig {
        friction: true,
        ..RandomizationConfig::none()
    };
    fills(
        spread(|| friction.draw_variation(&mut rng).friction),
        [0.5, 1.0],
    );
    let drawn = friction.draw_variation(&mut rng);
    assert_eq!(
        Variation {
            friction: 1.0,
            ..drawn
        },
        Variation::NOMINAL
    );

    let com = RandomizationConfig {
        com_offset: true,
        ..RandomizationConfig::none()
    };
    for axis in 0..3 {
        fills(
            spread(|| com.draw_variation(&mut rng).torso_com[axis]),
            [-0.1, 0.1],
        );
    }
    let drawn = com.draw_variation(&mut rng);
    assert_eq!(
        Variation {
            torso_com: [0.0; 3],
            ..drawn
        },
        Variation::NOMINAL
    );
}

#[test]
fn row_of_pushes() {
    assert_eq!(
        RandomizationConfig::none().draw_push_interval(&mut rng()),
        None
    );
    let pushes = RandomizationConfig {
        impulse: true,
        ..RandomizationConfig::none()
    };
    let mut rng = rng();
    for axis in 0..2 {
        fills(
            spread(|| pushes.draw_push(&mut rng)[axis].abs()),
            [0.0, 0.5],
        );
        // Both signs come about equally often: Binomial(2000, ½) has a deviation of 22.
        let left = (0..2_000)
            .filter(|_| pushes.draw_push(&mut rng)[axis] < 0.0)
            .count();
        assert!(left.abs_diff(1_000) < 112, "{left}");
    }
    assert_eq!(pushes.draw_push(&mut rng).z, 0.0);
    for _ in 0..500 {
        let steps = pushes.draw_push_interval(&mut rng).unwrap();
        assert!((250..=500).contains(&steps)); // 5 to 10 s at 50 Hz
    }
}

#[test]
fn rows_of_the_sensors() {
    let none = RandomizationConfig::none();
    type Row = (fn(&mut RandomizationConfig), Range<usize>, f32);
    let rows: [Row; 5] = [
        (|c| c.linear_velocity_noise = true, 1..4, 0.1),
        (|c| c.angular_velocity_noise = true, 4..7, 0.2),
        (|c| c.gravity_noise = true, 7..10, 0.05),
        (|c| c.joint_position_noise = true, 13..36, 0.01),
        (|c| c.joint_velocity_noise = true, 36..59, 1.5),
    ];
    let mut rng = rng();
    let mut still = [0.25; g1::OBSERVATION];
    SensorNoise::of(&none).blur(&mut still, &mut rng);
    assert_eq!(still, [0.25; g1::OBSERVATION]);
    for (switch, numbers, size) in rows {
        let mut config = none.clone();
        switch(&mut config);
        let noise = SensorNoise::of(&config);
        let mut blur = || {
            let mut observation = [0.0; g1::OBSERVATION];
            noise.blur(&mut observation, &mut rng);
            observation
        };
        for (i, number) in blur().into_iter().enumerate() {
            assert_eq!(number != 0.0, numbers.contains(&i), "number {i}");
        }
        fills(spread(|| blur()[numbers.start]), [-size, size]);
    }
}

#[test]
fn impossible_ranges_are_refused() {
    RandomizationConfig::default().validate().unwrap();
    let bad = RandomizationConfig {
        mass_range: [-8.0, 0.0],
        ..RandomizationConfig::default()
    };
    assert!(
        bad.validate()
            .unwrap_err()
            .to_string()
            .contains("mass_range")
    );
    let bad = RandomizationConfig {
        com_range: [0.1, -0.1],
        ..RandomizationConfig::default()
    };
    assert!(
        bad.validate()
            .unwrap_err()
            .to_string()
            .contains("com_range")
    );
}

#[test]
fn the_table_grows_with_the_samples() {
    let config = RandomizationConfig {
        strength: Ramp::moving(0.0, 1.0, [1e6, 3e6]),
        gravity_noise: false,
        ..RandomizationConfig::default()
    };
    config.validate().unwrap();
    assert_eq!(config.at(1e6), RandomizationConfig::none());
    let half = config.at(2e6);
    assert_eq!(half.mass_range, [-0.25, 0.25]);
    assert_eq!(half.friction_range, [0.75, 1.0]); // halfway from 1
    assert_eq!(half.joint_velocity_range, [-0.75, 0.75]);
    assert!(half.impulse && !half.gravity_noise);
    let grown = RandomizationConfig {
        strength: 1.0.into(),
        ..config.clone()
    };
    assert_eq!(config.at(9e6), grown);
    let whole = RandomizationConfig::default();
    assert_eq!(whole.at(0.0), whole);
    let backward = RandomizationConfig {
        strength: Ramp::moving(0.0, 1.0, [1e6, 0.5e6]),
        ..config
    };
    let error = backward.validate().unwrap_err().to_string();
    assert!(error.contains("strength.samples"), "{error}");
}

#[test]
fn every_row_can_be_alone() {
    for row in ROWS {
        let only = RandomizationConfig::only([row]).unwrap();
        let switched = toml::Table::try_from(&only).unwrap();
        let on =
            |(key, value): (String, toml::Value)| (value.as_bool() == Some(true)).then_some(key);
        let on: Vec<String> = switched.into_iter().filter_map(on).collect();
        assert_eq!(on, [row]);
    }
    assert_eq!(
        RandomizationConfig::only([]),
        Some(RandomizationConfig::none())
    );
    assert_eq!(
        RandomizationConfig::only(ROWS),
        Some(RandomizationConfig::default())
    );
    assert_eq!(RandomizationConfig::only(["push"]), None);
}
