//! What retargeting did to a clip.
//!
//! Separate because it is for people: they judge from it whether the clip is worth training on.

use g1::{JOINT_TABLE, JOINTS};
use serde::{Deserialize, Serialize};

/// Frames in which a bound held a joint.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Held {
    /// The joint's name.
    pub joint: String,
    /// Frames.
    pub frames: usize,
}

/// The account of a retargeted clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Frames that came out.
    pub frames: usize,
    /// Length of the human's thigh and shin, m.
    pub human_leg: f64,
    /// Robot's legs over human's: what the way over the ground was multiplied by.
    pub scale: f64,
    /// Mean speed of the human along the straight way, times `scale`, m/s.
    pub scaled_speed: f64,
    /// The same of the robot, m/s.
    pub speed: f64,
    /// Angle between bones of the robot and of the human: median over bones and frames, degrees.
    pub direction_error: f64,
    /// Angle that 95 % of bones and frames stay below, degrees.
    pub direction_error_95: f64,
    /// Stances in which a foot was locked.
    pub stances: usize,
    /// Farthest that locking moved a foot over the ground, m.
    pub feet_moved: f64,
    /// Most that the pelvis was lowered because a leg did not reach, m.
    pub lowered: f64,
    /// Most that the robot was lifted at the end because a sole was below the ground, m.
    pub lifted: f64,
    /// Joints that stopped at a limit of position.
    pub at_limit: Vec<Held>,
    /// Joints that were slowed to what the motor can.
    pub at_speed: Vec<Held>,
}

impl Report {
    /// What was done about each defect that directions alone would have had, a sentence each.
    pub fn actions(&self) -> Vec<String> {
        let mut actions = vec![
            format!(
                "scaled the way by {:.3} (legs of {:.3} m to {:.3} m)",
                self.scale,
                self.human_leg,
                self.scale * self.human_leg
            ),
            format!(
                "slip: locked {} stances, moving feet by at most {:.1} cm",
                self.stances,
                100.0 * self.feet_moved
            ),
        ];
        if self.lowered > 5e-4 {
            let most = 100.0 * self.lowered;
            actions.push(format!("reach: lowered the pelvis by at most {most:.1} cm"));
        }
        if self.lifted > 5e-4 {
            let most = 100.0 * self.lifted;
            actions.push(format!(
                "penetration: lifted the robot by at most {most:.1} cm"
            ));
        }
        for (held, what) in [
            (&self.at_limit, "limits: stopped"),
            (&self.at_speed, "speed: slowed"),
        ] {
            for Held { joint, frames } in held {
                actions.push(format!("{what} {joint} in {frames} frames"));
            }
        }
        actions
    }
}

/// The joints that were held at all.
pub(crate) fn held(counts: &[usize; JOINTS]) -> Vec<Held> {
    let counted = JOINT_TABLE
        .iter()
        .zip(counts)
        .filter(|(_, frames)| **frames > 0);
    counted
        .map(|(joint, &frames)| Held {
            joint: joint.name.into(),
            frames,
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actions_say_what_was_done_and_nothing_else() {
        let mut counts = [0; JOINTS];
        counts[4] = 7;
        let report = Report {
            frames: 100,
            human_leg: 0.84,
            scale: 0.75,
            scaled_speed: 0.9,
            speed: 0.9,
            direction_error: 2.0,
            direction_error_95: 6.0,
            stances: 5,
            feet_moved: 0.021,
            lowered: 0.0,
            lifted: 0.002,
            at_limit: held(&counts),
            at_speed: Vec::new(),
        };
        let actions = report.actions();
        assert_eq!(actions.len(), 4, "{actions:?}");
        assert!(actions[0].contains("0.840 m to 0.630 m"));
        assert!(actions[1].contains("5 stances") && actions[1].contains("2.1 cm"));
        assert!(actions[3].contains("left_ankle_pitch_joint in 7 frames"));
    }
}
