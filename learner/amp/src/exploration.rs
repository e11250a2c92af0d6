//! How wide actions are drawn around the policy's mean.

use crate::config::{ExplorationConfig, ExplorationKind, LEARNED_SIGMA};
use crate::robot::JointGroup;

/// Standard deviation σ of each joint's action after `samples`.
///
/// Scheduled: the legs' σ by the samples; waist and arms a factor less, since noise there is what the discriminator sees
/// first.
/// Learned: e^`log_sigma`, within its limits.
pub fn sigma(
    config: &ExplorationConfig,
    joints: &[JointGroup],
    log_sigma: &[f32],
    samples: u64,
) -> Vec<f32> {
    match config.kind {
        ExplorationKind::Learned => log_sigma
            .iter()
            .map(|log| log.exp().clamp(LEARNED_SIGMA[0], LEARNED_SIGMA[1]))
            .collect(),
        ExplorationKind::Scheduled => {
            let legs = config.sigma.at_logarithmic(samples as f64);
            joints
                .iter()
                .map(|joint| legs * factor(config, *joint))
                .collect()
        }
    }
}

/// ln σ of each joint that learned exploration begins with.
pub(crate) fn initial_log_sigma(config: &ExplorationConfig, joints: &[JointGroup]) -> Vec<f32> {
    let log = |joint| (config.sigma.now() * factor(config, joint)).ln();
    joints.iter().copied().map(log).collect()
}

fn factor(config: &ExplorationConfig, joint: JointGroup) -> f32 {
    match joint {
        JointGroup::Leg => 1.0,
        JointGroup::Waist => config.waist_factor,
        JointGroup::Arm => config.arm_factor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOINTS: [JointGroup; 3] = [JointGroup::Leg, JointGroup::Waist, JointGroup::Arm];

    #[test]
    fn the_schedule_holds_shrinks_and_stays() {
        let config = ExplorationConfig::default();
        let legs = |samples| sigma(&config, &JOINTS, &[], samples)[0];
        assert_eq!([legs(0), legs(1_000_000)], [0.6; 2]);
        assert_eq!([legs(3_000_000), legs(10_000_000)], [0.2; 2]);
        // halfway on the logarithmic line: √(0.6·0.2) = 0.3464
        assert!((legs(2_000_000) - 0.346_41).abs() < 1e-5);
    }

    #[test]
    fn waist_and_arms_explore_less() {
        let config = ExplorationConfig {
            waist_factor: 0.5,
            arm_factor: 0.25,
            ..Default::default()
        };
        assert_eq!(sigma(&config, &JOINTS, &[], 0), [0.6, 0.3, 0.15]);
    }

    #[test]
    fn learned_widths_stay_within_limits() {
        let config = ExplorationConfig {
            kind: ExplorationKind::Learned,
            ..Default::default()
        };
        let widths = sigma(&config, &JOINTS, &[0.5_f32.ln(), 3.0, -9.0], 0);
        assert!((widths[0] - 0.5).abs() < 1e-6);
        assert_eq!(widths[1..], [1.0, 0.05]);
        let logs = initial_log_sigma(&config, &JOINTS);
        assert!((logs[1] - 0.18_f32.ln()).abs() < 1e-6); // 0.6·0.3
    }
}
