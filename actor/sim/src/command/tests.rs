//! What is drawn lies where it was asked for, as often as it was asked for.

use super::*;
use crate::kind::KINDS;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

#[test]
fn commands_fill_their_ranges() {
    let config = CommandConfig {
        forward: [-1.0, 2.0].into(),
        lateral: [0.5, 0.5].into(),
        yaw_rate: [-0.3, 0.0].into(),
        standing_share: 0.25.into(),
        ..CommandConfig::default()
    };
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    let draws: Vec<_> = (0..4_000)
        .map(|_| config.draw(Occasion::default(), &mut rng))
        .collect();
    let standing = draws.iter().filter(|c| **c == [0.0; 3]).count();
    // Binomial(4000, ¼): 1000 ± 27, so five deviations are 137.
    assert!(standing.abs_diff(1_000) < 137, "{standing}");
    let moving = draws.iter().filter(|c| **c != [0.0; 3]);
    let (mut least, mut greatest) = (f32::MAX, f32::MIN);
    for [vx, vy, yaw] in moving {
        assert!((-1.0..=2.0).contains(vx) && *vy == 0.5 && (-0.3..=0.0).contains(yaw));
        least = least.min(*vx);
        greatest = greatest.max(*vx);
    }
    assert!(least < -0.95 && greatest > 1.95, "{least} {greatest}");
}

#[test]
fn pure_commands_have_one_part() {
    let config = CommandConfig {
        forward: [0.1, 1.0].into(),
        lateral: [0.1, 0.4].into(),
        yaw_rate: [0.1, 1.0].into(),
        pure_share: 0.6.into(),
        ..CommandConfig::default()
    };
    let mut rng = Pcg64Mcg::seed_from_u64(4);
    let mut counts = [0; 4]; // forward, lateral, yaw rate alone; all
    for _ in 0..4_000 {
        let command = config.draw(Occasion::default(), &mut rng);
        let parts: Vec<_> = (0..3).filter(|&part| command[part] != 0.0).collect();
        counts[if let [part] = parts[..] { part } else { 3 }] += 1;
    }
    // Binomial(4000, 0.2) has a deviation of 25, Binomial(4000, 0.4) of 31.
    for (count, expected) in counts.into_iter().zip([800_i32, 800, 800, 1_600]) {
        assert!((expected - count).abs() < 155, "{counts:?}");
    }
}

#[test]
fn pure_commands_keep_away_from_standing() {
    let config = CommandConfig {
        forward: [-0.6, 2.0].into(),
        lateral: [-0.4, 0.4].into(),
        yaw_rate: [-1.0, 1.0].into(),
        pure_share: 1.0.into(),
        least_share: 0.5,
        ..CommandConfig::default()
    };
    // From the range's end, and from near 0, by hand.
    assert_eq!(config.away(-0.4, [-0.4, 0.4]), -0.4);
    assert!((config.away(0.1, [-0.4, 0.4]) - 0.25).abs() < 1e-6);
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    let mut slow = 0;
    for _ in 0..2_000 {
        let [forward, lateral, yaw_rate] = config.draw(Occasion::default(), &mut rng);
        assert!(forward >= 0.0 || (-0.6..=-0.3).contains(&forward));
        assert!(lateral == 0.0 || (0.2..=0.4).contains(&lateral.abs()));
        assert!(yaw_rate == 0.0 || (0.5..=1.0).contains(&yaw_rate.abs()));
        slow += usize::from(forward > 0.0 && forward < 0.5);
    }
    assert!(slow > 50, "slow walks are kept: {slow}");
}

#[test]
fn starts_match_their_clip_in_the_given_share() {
    let clip = [0.8, 0.0, 0.1];
    let start = Occasion {
        kind: None,
        motion: Some(clip),
    };
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    for (share, expected) in [(0.0, 0), (0.9, 1_800), (1.0, 2_000)] {
        let config = CommandConfig {
            matched_share: Ramp::Constant(share),
            ..CommandConfig::default()
        };
        let matched = (0..2_000)
            .filter(|_| config.draw(start, &mut rng) == clip)
            .count();
        // Binomial(2000, 0.9) has a deviation of 13.4.
        assert!(matched.abs_diff(expected) < 67, "{matched} of {expected}");
    }
}

#[test]
fn intervals_are_seconds_in_steps() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let config = CommandConfig::default();
    for _ in 0..1_000 {
        assert!((150..=500).contains(&config.draw_interval(&mut rng))); // 3 to 10 s at 50 Hz
    }
}

#[test]
fn bad_values_are_named() {
    let refused = |config: CommandConfig| config.validate().unwrap_err().to_string();
    let forward = refused(CommandConfig {
        forward: [1.0, 0.5].into(),
        ..CommandConfig::default()
    });
    assert!(forward.contains("forward"), "{forward}");
    let share = refused(CommandConfig {
        matched_share: 1.5.into(),
        ..CommandConfig::default()
    });
    assert!(share.contains("matched_share"), "{share}");
    CommandConfig::default().validate().unwrap();
}

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
            let command = ranges().draw_of(kind, &mut rng);
            assert_eq!(Kind::of(command), kind, "{command:?}");
            assert!((-0.5..=1.5).contains(&command[0]) && command[1].abs() <= 0.4);
        }
    }
    // Nothing of the kind in the range: as near as it goes, and no panic.
    let ahead = CommandConfig {
        forward: [0.4, 1.2].into(),
        ..ranges()
    };
    assert_eq!(ahead.draw_of(Kind::Backward, &mut rng), [0.4, 0.0, 0.0]);
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
    let [ahead, aside, turn] = config.draw_of(Kind::Lateral, &mut rng);
    assert!(ahead == 0.4 && aside != 0.0 && turn == 0.0);
    let [ahead, aside, turn] = config.draw_of(Kind::Turning, &mut rng);
    assert!(ahead == 0.4 && aside == 0.0 && turn != 0.0);
    assert!(config.draw_of(Kind::Backward, &mut rng)[0] < 0.0);
}

#[test]
fn kinds_are_held_against_all_that_ranges_ever_ask_for() {
    let mut commands: CommandConfig = toml::from_str(
        "forward = { from = [0.4, 1.0], to = [-0.6, 1.0], samples = [0.0, 2.0] }\n[kinds]\nbackward = 1.0",
    )
    .unwrap();
    assert_eq!(commands.validate(), Ok(()));
    // Held before the range has reached back, it is the same configuration.
    commands.set(0.0);
    assert_eq!(commands.validate(), Ok(()));
    assert_eq!(commands.widest()[0], [-0.6, 1.0]);
    let never: CommandConfig =
        toml::from_str("forward = [0.4, 1.0]\n[kinds]\nbackward = 1.0").unwrap();
    assert!(never.validate().is_err());
}
