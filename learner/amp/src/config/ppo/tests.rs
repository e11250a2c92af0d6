//! What fades and settles, by hand.

use super::*;

#[test]
fn the_mirrored_share_fades() {
    let mut ppo = PpoConfig {
        mirrored_fade: Some([1e6, 2e6]),
        ..PpoConfig::default()
    };
    let shares = [0, 1_000_000, 1_500_000, 3_000_000].map(|at| ppo.mirrored_share_at(at));
    assert_eq!(shares, [0.5, 0.5, 0.25, 0.0]);
    ppo.mirrored_fade = Some([2e6, 1e6]);
    let refused = ppo.validate().expect_err("a fall").to_string();
    assert!(refused.contains("mirrored_fade"), "{refused}");
    ppo.mirrored_fade = None;
    assert_eq!(ppo.mirrored_share_at(u64::MAX), 0.5);
}

#[test]
fn the_kl_target_settles() {
    let mut ppo = PpoConfig {
        kl_target: 0.04,
        kl_settle: Some(KlSettle {
            from_samples: 1e6,
            to_samples: 3e6,
            target: 0.01,
        }),
        ..PpoConfig::default()
    };
    // Halfway on the logarithmic line: √(0.04·0.01) = 0.02
    let at = [0, 1_000_000, 2_000_000, 3_000_000, u64::MAX];
    for (samples, expected) in at.into_iter().zip([0.04, 0.04, 0.02, 0.01, 0.01]) {
        let found = ppo.kl_target_at(samples);
        assert!((found - expected).abs() < 1e-7, "{samples}: {found}");
    }
    for (from_samples, target) in [(3e6, 0.01), (-1.0, 0.01), (1e6, 0.0)] {
        ppo.kl_settle = Some(KlSettle {
            from_samples,
            to_samples: 3e6,
            target,
        });
        let refused = ppo.validate().expect_err("no schedule").to_string();
        assert!(refused.contains("kl_settle"), "{refused}");
    }
    ppo.kl_settle = None;
    assert_eq!(ppo.kl_target_at(u64::MAX), 0.04);
}
