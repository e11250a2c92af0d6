//! What fades and settles, by hand.

use super::*;

#[test]
fn the_mirrored_share_fades() {
    let mut ppo = PpoConfig {
        mirrored_share: Ramp::moving(0.5, 0.0, [1e6, 2e6]),
        ..PpoConfig::default()
    };
    let shares = [0, 1_000_000, 1_500_000, 3_000_000].map(|at| ppo.mirrored_share_at(at));
    assert_eq!(shares, [0.5, 0.5, 0.25, 0.0]);
    // Statistics of observations are of both sides to the end.
    assert!(ppo.mirrors());
    ppo.mirrored_share = Ramp::moving(0.5, 0.0, [2e6, 1e6]);
    let refused = ppo.validate().expect_err("a fall");
    assert_eq!(refused.path, "mirrored_share.samples");
    ppo.mirrored_share = Ramp::moving(0.5, 1.5, [1e6, 2e6]);
    assert_eq!(
        ppo.validate().expect_err("no share").path,
        "mirrored_share.to"
    );
    ppo.mirrored_share = 0.0.into();
    assert!(!ppo.mirrors());
    assert_eq!(PpoConfig::default().mirrored_share_at(u64::MAX), 0.5);
}

#[test]
fn the_kl_target_settles() {
    let mut ppo = PpoConfig {
        kl_target: Ramp::moving(0.04, 0.01, [1e6, 3e6]),
        ..PpoConfig::default()
    };
    // Halfway on the logarithmic line: √(0.04·0.01) = 0.02
    let at = [0, 1_000_000, 2_000_000, 3_000_000, u64::MAX];
    for (samples, expected) in at.into_iter().zip([0.04, 0.04, 0.02, 0.01, 0.01]) {
        let found = ppo.kl_target_at(samples);
        assert!((found - expected).abs() < 1e-7, "{samples}: {found}");
    }
    for (begins, target, wrong) in [
        (4e6, 0.01, "samples"),
        (-1.0, 0.01, "samples"),
        (1e6, 0.0, "to"),
    ] {
        ppo.kl_target = Ramp::moving(0.04, target, [begins, 3e6]);
        let refused = ppo.validate().expect_err("no schedule");
        assert_eq!(refused.path, format!("kl_target.{wrong}"));
    }
    assert_eq!(PpoConfig::default().kl_target_at(u64::MAX), 0.025);
}
