//! Kinds by hand: how robots are dealt to them.

use super::*;

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
fn kinds_without_a_range_are_refused() {
    let backward = KindsConfig {
        backward: 1.0,
        ..KindsConfig::default()
    };
    let error = backward
        .validate([[0.4, 1.2], [0.0; 2], [0.0; 2]])
        .unwrap_err()
        .to_string();
    assert!(error.contains("kinds.backward = 1"), "{error}");
    assert_eq!(backward.validate([[-0.5, 1.2], [0.0; 2], [0.0; 2]]), Ok(()));
    let nobody = KindsConfig::default();
    assert!(
        nobody.validate([[-0.5, 1.2], [0.0; 2], [0.0; 2]]).is_err(),
        "nobody has a share"
    );
}

#[test]
fn robots_are_told_to_step_aside_or_turn_only_where_a_range_has_it() {
    let straight = [[0.4, 1.2], [0.0; 2], [0.0; 2]];
    let every = [[0.4, 1.2], [-0.3, 0.3], [-1.0, 0.0]];
    let lateral = KindsConfig {
        lateral: 1.0,
        ..KindsConfig::default()
    };
    let turning = KindsConfig {
        turning: 1.0,
        ..KindsConfig::default()
    };
    for (kinds, part) in [(lateral, "kinds.lateral"), (turning, "kinds.turning")] {
        let error = kinds.validate(straight).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
        assert_eq!(kinds.validate(every), Ok(()));
    }
}
