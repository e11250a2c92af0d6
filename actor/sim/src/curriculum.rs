//! A task that grows with the samples: easy starts and gentle errors first, all commands later.
//!
//! Separate because a schedule is a choice of its own beside every value that it moves. The recipe
//! that walked began at walking speeds with starts that match them; asked for everything at once, or
//! with a sharp kernel from the start, robots learnt to stand still.

use crate::config::{self, Invalid, range};
use crate::kind::check_approach;
use crate::task::TaskConfig;
use serde::{Deserialize, Serialize};

/// Where values of `[task]` go, in a straight line over the samples. What is not given stays.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CurriculumConfig {
    /// Samples of the whole group until the values begin to move.
    pub from_samples: f64,
    /// Samples at which they have arrived.
    pub to_samples: f64,
    /// `task.kernel` at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kernel: Option<f32>,
    /// `task.effort_weight` at the end, 1/J.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort_weight: Option<f32>,
    /// `task.stray.share` at the end, where there is a `task.stray`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stray_share: Option<f32>,
    /// `task.start.reference_share` at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_share: Option<f32>,
    /// `task.command.matched_share` at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub matched_share: Option<f32>,
    /// `task.command.standing_share` at the end.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub standing_share: Option<f32>,
    /// `task.command.forward` at the end, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forward: Option<[f32; 2]>,
    /// `task.command.kinds.approach` at the end, m/s, where there is a `task.command.kinds`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub approach: Option<f32>,
    /// `task.command.lateral` at the end, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lateral: Option<[f32; 2]>,
    /// `task.command.yaw_rate` at the end, rad/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_rate: Option<[f32; 2]>,
}

impl CurriculumConfig {
    /// Checks every field; names the first bad one, its value and a remedy.
    pub fn validate(&self) -> Result<(), Invalid> {
        config::way(
            "curriculum.from_samples",
            [self.from_samples, self.to_samples],
        )?;
        if let Some(kernel) = self.kernel {
            config::at_least("curriculum.kernel", kernel, 0.0)?;
        }
        if let Some(weight) = self.effort_weight {
            config::at_least("curriculum.effort_weight", weight, 0.0)?;
        }
        if let Some(share) = self.stray_share {
            config::at_least("curriculum.stray_share", share, 0.0)?;
        }
        if let Some(approach) = self.approach {
            check_approach("curriculum.approach", approach)?;
        }
        for (field, share) in [
            ("curriculum.reference_share", self.reference_share),
            ("curriculum.matched_share", self.matched_share),
            ("curriculum.standing_share", self.standing_share),
        ] {
            share.map_or(Ok(()), |share| config::share(field, share))?;
        }
        for (field, ends) in [
            ("curriculum.forward", self.forward),
            ("curriculum.lateral", self.lateral),
            ("curriculum.yaw_rate", self.yaw_rate),
        ] {
            ends.map_or(Ok(()), |ends| range(field, ends))?;
        }
        Ok(())
    }
}

impl TaskConfig {
    /// The task after a number of samples of the whole group.
    pub fn at(&self, samples: f64) -> Self {
        let mut task = self.clone();
        let Some(curriculum) = &self.curriculum else {
            return task;
        };
        let progress = config::progress([curriculum.from_samples, curriculum.to_samples], samples);
        let go = |value: &mut f32, to: Option<f32>| {
            if let Some(to) = to {
                // Exact at both ends.
                *value = *value * (1.0 - progress) + to * progress;
            }
        };
        go(&mut task.kernel, curriculum.kernel);
        go(&mut task.effort_weight, curriculum.effort_weight);
        if let Some(stray) = &mut task.stray {
            go(&mut stray.share, curriculum.stray_share);
        }
        if let Some(kinds) = &mut task.command.kinds {
            go(&mut kinds.approach, curriculum.approach);
        }
        go(&mut task.start.reference_share, curriculum.reference_share);
        go(&mut task.command.matched_share, curriculum.matched_share);
        go(&mut task.command.standing_share, curriculum.standing_share);
        for (value, to) in [
            (&mut task.command.forward, curriculum.forward),
            (&mut task.command.lateral, curriculum.lateral),
            (&mut task.command.yaw_rate, curriculum.yaw_rate),
        ] {
            for end in 0..2 {
                go(&mut value[end], to.map(|ends| ends[end]));
            }
        }
        task
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::CommandConfig;
    use crate::kind::KindsConfig;
    use crate::stray::StrayConfig;

    #[test]
    fn values_go_in_a_straight_line_and_stay_where_they_arrive() {
        let task = TaskConfig {
            kernel: 2.0,
            curriculum: Some(CurriculumConfig {
                from_samples: 1e6,
                to_samples: 3e6,
                kernel: Some(6.0),
                effort_weight: Some(0.1),
                stray_share: Some(0.25),
                forward: Some([-0.4, 2.0]),
                approach: Some(-0.2),
                ..CurriculumConfig::default()
            }),
            stray: Some(StrayConfig::default()),
            command: CommandConfig {
                kinds: Some(KindsConfig {
                    approach: 0.4,
                    lateral: 1.0,
                    ..KindsConfig::default()
                }),
                ..CommandConfig::default()
            },
            ..TaskConfig::default()
        };
        task.validate().unwrap();
        let approach = |samples| task.at(samples).command.kinds.unwrap().approach;
        assert!((approach(2e6) - 0.1).abs() < 1e-6 && approach(9e6) == -0.2);
        assert_eq!(task.at(2e6).stray.unwrap().share, 0.375); // from 0.5
        assert_eq!(task.at(1e6).kernel, 2.0);
        assert_eq!(task.at(2e6).kernel, 4.0);
        assert_eq!(task.at(2e6).effort_weight, 0.05);
        assert_eq!(task.at(2e6).command.forward, [0.0, 1.6]); // from 0.4 and 1.2
        assert_eq!(task.at(9e6).kernel, 6.0);
        assert_eq!(task.at(9e6).command.forward, [-0.4, 2.0]);
        assert_eq!(task.at(9e6).command.lateral, task.command.lateral);
        assert_eq!(TaskConfig::default().at(5e6), TaskConfig::default());
    }

    #[test]
    fn a_way_back_is_refused() {
        let curriculum = CurriculumConfig {
            from_samples: 2.0,
            to_samples: 1.0,
            ..CurriculumConfig::default()
        };
        let error = curriculum.validate().unwrap_err().to_string();
        assert!(error.contains("curriculum.from_samples"), "{error}");
        let curriculum = CurriculumConfig {
            matched_share: Some(2.0),
            ..CurriculumConfig::default()
        };
        assert!(curriculum.validate().is_err());
    }
}
