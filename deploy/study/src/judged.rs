//! What a policy did without exploration noise, as `ampco evaluate` found it.

use serde::{Deserialize, Serialize};

use crate::file::Evaluation;

/// What was found of a run, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Judgement {
    /// What was tried.
    pub evaluate: Evaluation,
    /// SHA-256 of the discriminator that judged style, where one was given.
    pub judge_sha256: Option<String>,
    /// A row per command.
    pub rows: Vec<Judged>,
}

/// A command that was tried: a row of `ampco evaluate --json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// vx, vy (m/s), yaw rate (rad/s).
    pub command: [f64; 3],
    /// Share of episodes without a fall.
    pub survival: f64,
    /// Planar, m/s.
    pub rmse: f64,
    /// Of the yaw rate, rad/s.
    pub rmse_yaw_rate: f64,
    /// J per 1,000 control steps.
    pub energy_j: f64,
    /// The gait in words.
    pub gait: String,
    /// Mean rˢ (Eq. 7), of the frozen judge if there is one and of the run's own discriminator if not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub style_reward: Option<f64>,
    /// Strides a second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stride_rate_hz: Option<f64>,
    /// Share of a stride in which a foot is on the ground.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duty_factor: Option<f64>,
    /// Correlation of left and right hip pitch: −1 where they alternate, 1 where both swing at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hip_correlation: Option<f64>,
    /// Mean speed of a sole in stance, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot_slip: Option<f64>,
    /// What the reference motion nearest to the command does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<Reference>,
}

/// The reference motion nearest to a command.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    /// Strides a second.
    pub stride_rate_hz: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_evaluate_is_read_by_its_keys_and_kept_without_the_rest() {
        let row = serde_json::json!({
            "name": "0.5,0,0", "command": [0.5, 0.0, 0.0], "survival": 1.0, "rmse": 0.1, "rmse_yaw_rate": 0.2,
            "energy_j": 9.0, "gait": "walk", "style_reward": 0.5, "stride_rate_hz": null, "duty_factor": 0.6,
            "hip_correlation": -0.9, "foot_slip": 0.03, "reference": { "clip": "walk", "stride_rate_hz": 0.99 },
        });
        let judged: Judged = serde_json::from_value(row).unwrap();
        assert_eq!(
            (judged.stride_rate_hz, judged.duty_factor),
            (None, Some(0.6))
        );
        assert_eq!(
            judged
                .reference
                .as_ref()
                .map(|nearest| nearest.stride_rate_hz),
            Some(0.99)
        );
        let kept = serde_json::to_value(&judged).unwrap();
        assert!(kept.get("name").is_none() && kept["reference"].get("clip").is_none());
        assert_eq!(serde_json::from_value::<Judged>(kept).unwrap(), judged);
    }
}
