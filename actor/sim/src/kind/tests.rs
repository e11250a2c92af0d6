//! Kinds by hand: what each draws, and how robots are dealt to them.

use super::*;
use g1::RobotState;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

fn ranges() -> CommandConfig {
    CommandConfig {
        forward: [-0.5, 1.5].into(),
        lateral: [-0.4, 0.4].into(),
        yaw_rate: [-1.0, 1.0].into(),
        ..CommandConfig::default()
    }
}

#[test]
fn what_a_kind_draws_is_of_that_kind() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    for kind in KINDS {
        for _ in 0..200 {
            let command = kind.draw(&ranges(), &mut rng);
            assert_eq!(Kind::of(command), kind, "{command:?}");
            assert!((-0.5..=1.5).contains(&command[0]) && command[1].abs() <= 0.4);
        }
    }
    // Nothing of the kind in the range: as near as it goes, and no panic.
    let ahead = CommandConfig {
        forward: [0.4, 1.2].into(),
        ..ranges()
    };
    assert_eq!(Kind::Backward.draw(&ahead, &mut rng), [0.4, 0.0, 0.0]);
}

#[test]
fn stepping_aside_and_turning_are_approached_from_walking_on() {
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let config = CommandConfig {
        kinds: Some(KindsConfig {
            approach: 0.4.into(),
            lateral: 1.0,
            ..KindsConfig::default()
        }),
        ..ranges()
    };
    let [ahead, aside, turn] = Kind::Lateral.draw(&config, &mut rng);
    assert!(ahead == 0.4 && aside != 0.0 && turn == 0.0);
    let [ahead, aside, turn] = Kind::Turning.draw(&config, &mut rng);
    assert!(ahead == 0.4 && aside == 0.0 && turn != 0.0);
    assert!(Kind::Backward.draw(&config, &mut rng)[0] < 0.0);
}

#[test]
fn robots_are_dealt_by_weight() {
    let kinds = KindsConfig {
        forward: 3.0,
        lateral: 1.0,
        turning: 4.0,
        ..KindsConfig::default()
    };
    let dealt: Vec<_> = (0..16).map(|i| kinds.of_robot(i, 16)).collect();
    let count = |kind| dealt.iter().filter(|&&k| k == kind).count();
    assert_eq!(
        KINDS.map(count),
        [0, 6, 0, 2, 8, 0],
        "3, 1 and 4 eighths of 16: {dealt:?}"
    );
}

#[test]
fn frames_are_drawn_by_weight_within_their_kind() {
    let frame = |command, weight| (RobotState::standing(), command, weight);
    let starts: Starts = [
        frame([0.8, 0.0, 0.0], 5.0),
        frame([0.0, 0.3, 0.0], 1.0),
        frame([0.0; 3], 2.0),
        frame([0.0, -0.3, 0.0], 3.0),
    ]
    .into_iter()
    .collect();
    let pools = Pools::of(&starts);
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let mut drawn = [0; 4];
    for _ in 0..1_000 {
        drawn[pools.draw(Kind::Lateral, &mut rng).unwrap()] += 1;
    }
    // Weight 3 of 4: Binomial(1000, ¾) is 750 ± 13.7.
    assert!(drawn[0] == 0 && drawn[2] == 0 && (682..818).contains(&drawn[3]));
    assert_eq!(pools.draw(Kind::Standing, &mut rng), Some(2));
    assert_eq!(pools.draw(Kind::Turning, &mut rng), None);
}

#[test]
fn kinds_without_a_range_are_refused() {
    let mut config = ranges();
    config.forward = [0.4, 1.2].into();
    config.kinds = Some(KindsConfig {
        backward: 1.0,
        ..KindsConfig::default()
    });
    let error = config.validate().unwrap_err().to_string();
    assert!(error.contains("kinds.backward = 1"), "{error}");
    config.kinds = Some(KindsConfig::default());
    assert!(config.validate().is_err(), "nobody has a share");
}
