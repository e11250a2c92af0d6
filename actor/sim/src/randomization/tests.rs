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
    let none = RandomizationConfig::default();
    assert_eq!(none.draw_variation(&mut rng()), Variation::NOMINAL);

    let mass = RandomizationConfig::only(["mass_variation"]).unwrap();
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

    let friction = RandomizationConfig::only(["friction"]).unwrap();
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

    let com = RandomizationConfig::only(["com_offset"]).unwrap();
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
        RandomizationConfig::default().draw_push_interval(&mut rng()),
        None
    );
    let pushes = RandomizationConfig::only(["impulse"]).unwrap();
    assert_eq!(
        RandomizationConfig::default().draw_push(&mut rng()),
        None,
        "no row, no push"
    );
    let mut rng = rng();
    for axis in 0..2 {
        fills(
            spread(|| pushes.draw_push(&mut rng).unwrap()[axis].abs()),
            [0.0, 0.5],
        );
        // Both signs come about equally often: Binomial(2000, ½) has a deviation of 22.
        let left = (0..2_000)
            .filter(|_| pushes.draw_push(&mut rng).unwrap()[axis] < 0.0)
            .count();
        assert!(left.abs_diff(1_000) < 112, "{left}");
    }
    assert_eq!(pushes.draw_push(&mut rng).unwrap().z, 0.0);
    for _ in 0..500 {
        let steps = pushes.draw_push_interval(&mut rng).unwrap();
        assert!((250..=500).contains(&steps)); // 5 to 10 s at 50 Hz
    }
}

#[test]
fn rows_of_the_sensors() {
    let none = RandomizationConfig::default();
    let rows: [(&str, Range<usize>, f32); 5] = [
        ("linear_velocity_noise", 1..4, 0.1),
        ("angular_velocity_noise", 4..7, 0.2),
        ("gravity_noise", 7..10, 0.05),
        ("joint_position_noise", 13..36, 0.01),
        ("joint_velocity_noise", 36..59, 1.5),
    ];
    let mut rng = rng();
    let seen = Tables::default().actor;
    let mut still = [0.25; g1::OBSERVATION];
    SensorNoise::of(&none, &seen).blur(&mut still, &mut rng);
    assert_eq!(still, [0.25; g1::OBSERVATION]);
    for (row, numbers, size) in rows {
        let config = RandomizationConfig::only([row]).unwrap();
        let noise = SensorNoise::of(&config, &seen);
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
    RandomizationConfig::table_one().validate().unwrap();
    let refused = |text: &str| {
        let config: RandomizationConfig = toml::from_str(text).unwrap();
        config.validate().unwrap_err().path
    };
    for (text, path) in [
        // The torso weighs 7.8 kg.
        (
            "mass_variation = { range = [-8.0, 0.0] }",
            "mass_variation.range",
        ),
        ("com_offset = { range = [0.1, -0.1] }", "com_offset.range"),
        ("friction = { range = [-0.1, 1.0] }", "friction.range"),
        ("impulse = { range = [nan, 1.0] }", "impulse.range"),
        (
            "impulse = { range = [0.0, 0.5], seconds = [5.0, 4.0] }",
            "impulse.seconds",
        ),
        (
            "impulse = { range = [0.0, 0.5], seconds = [0.0, 4.0] }",
            "impulse.seconds",
        ),
        (
            "joint_velocity_noise = { range = [1.0, inf] }",
            "joint_velocity_noise.range",
        ),
    ] {
        assert_eq!(refused(text), path, "{text}");
    }
    // Every row has an end on both sides, with a reason.
    for (row, ([least, greatest], why)) in ROWS.into_iter().zip(LIMITS) {
        let at = |range: [f32; 2]| {
            let text = format!("{row} = {{ range = [{:?}, {:?}] }}", range[0], range[1]);
            let config: RandomizationConfig = toml::from_str(&text).unwrap();
            config.validate().map_err(|invalid| invalid.to_string())
        };
        assert_eq!(at([least, greatest]), Ok(()), "{row}");
        for beyond in [
            [least - 0.1, greatest],
            [least, greatest + 0.1],
            [least, 1e30],
        ] {
            let said = at(beyond).unwrap_err();
            let named = said.starts_with(&format!("{row}.range = "));
            assert!(named && said.contains(why), "{said}");
        }
    }
}

#[test]
fn an_empty_table_is_nothing_and_a_row_is_its_range() {
    let read = |text: &str| toml::from_str::<RandomizationConfig>(text);
    assert_eq!(read("").unwrap(), RandomizationConfig::default());
    let friction = read("friction = { range = [0.5, 1.0] }").unwrap();
    assert_eq!(Some(friction), RandomizationConfig::only(["friction"]));
    // The paper gives no times between pushes.
    let push = read("impulse = { range = [0.0, 0.5] }").unwrap();
    assert_eq!(Some(push), RandomizationConfig::only(["impulse"]));
    assert!(read("friction = {}").is_err() && read("friction = true").is_err());
    assert!(read("friction = { range = [0.5, 1.0], on = true }").is_err());
}

#[test]
fn the_table_grows_with_the_samples() {
    let config = RandomizationConfig {
        strength: Ramp::moving(0.0, 1.0, [1e6, 3e6]),
        gravity_noise: None,
        ..RandomizationConfig::table_one()
    };
    config.validate().unwrap();
    assert_eq!(config.at(1e6), RandomizationConfig::default());
    let half = config.at(2e6);
    let range = |row: Option<Row>| row.unwrap().range;
    assert_eq!(range(half.mass_variation), [-0.25, 0.25]);
    assert_eq!(range(half.friction), [0.75, 1.0]); // halfway from 1
    assert_eq!(range(half.joint_velocity_noise), [-0.75, 0.75]);
    assert!(half.impulse.is_some() && half.gravity_noise.is_none());
    let grown = RandomizationConfig {
        strength: 1.0.into(),
        ..config.clone()
    };
    assert_eq!(config.at(9e6), grown);
    let whole = RandomizationConfig::table_one();
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
        let listed = switched.into_iter().filter(|(_, value)| value.is_table());
        let on: Vec<String> = listed.map(|(key, _)| key).collect();
        assert_eq!(on, [row]);
    }
    assert_eq!(
        RandomizationConfig::only([]),
        Some(RandomizationConfig::default())
    );
    assert_eq!(
        RandomizationConfig::only(ROWS),
        Some(RandomizationConfig::table_one())
    );
    assert_eq!(RandomizationConfig::only(["push"]), None);
}
