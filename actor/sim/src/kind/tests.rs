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
    let error = backward.validate([0.4, 1.2]).unwrap_err().to_string();
    assert!(error.contains("kinds.backward = 1"), "{error}");
    assert_eq!(backward.validate([-0.5, 1.2]), Ok(()));
    let nobody = KindsConfig::default();
    assert!(nobody.validate([-0.5, 1.2]).is_err(), "nobody has a share");
}
