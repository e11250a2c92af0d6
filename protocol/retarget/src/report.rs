//! What retargeting did to a clip.
//!
//! Separate because it is for people: they judge from it whether the clip is worth training on.

use crate::floor::Floor;
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

/// An angle to the human's, degrees, beyond which a bone of the robot no longer does what the human's did.
///
/// At 30° a thigh or shin of 0.3 m ends half its length, 0.15 m, from where it should, and more than the foot is wide
/// and a step high. Captures that retarget well keep 95 % of their bones below 6 to 11°.
pub const BONE_OFF: f64 = 30.0;

/// A bone that points more than [`BONE_OFF`] away from the human's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoneOff {
    /// Side and bone, for example "left shin".
    pub bone: String,
    /// Frames in which it does.
    pub frames: usize,
    /// The first of them, counted from 1.
    pub first: usize,
    /// The last of them.
    pub last: usize,
    /// The one in which the angle is greatest.
    pub worst: usize,
    /// That angle, degrees.
    pub by: f64,
}

/// Where a joint's speed changes most from one frame to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sharpest {
    /// The joint's name.
    pub joint: String,
    /// Frame of the clip (the middle one of three), counted from 1.
    pub frame: usize,
    /// Second difference there, degrees a frame²; 8 are 349 rad/s².
    pub degrees: f64,
}

/// Second difference of a leg's joint above which it snaps, degrees a frame².
pub const SNAP: f64 = 8.0;

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
    /// Bones that are off in any frame, by more than [`BONE_OFF`].
    #[serde(default)]
    pub bones_off: Vec<BoneOff>,
    /// Share of bones and frames that are more than 20° off.
    #[serde(default)]
    pub off_target: f64,
    /// Flexion of the robot's knees less that of the human's: root of the mean square, degrees.
    #[serde(default)]
    pub knee_error: f64,
    /// Greatest second difference of each joint of the legs, in the robot's order.
    #[serde(default)]
    pub sharpest: Vec<Sharpest>,
    /// Stances in which a foot was locked.
    pub stances: usize,
    /// Farthest that locking moved a foot over the ground, m.
    pub feet_moved: f64,
    /// Most that the pelvis was lowered because a leg did not reach, m.
    pub lowered: f64,
    /// Farthest that a standing foot was kept from its place because its leg did not reach it, m.
    #[serde(default)]
    pub unreached: f64,
    /// Farthest that the pelvis was moved over the ground so that knees bend as the human's, m.
    #[serde(default)]
    pub carried: f64,
    /// Most that the robot was lifted at the end because a sole was below the ground, m.
    pub lifted: f64,
    /// How uneven the ground under the human's standing feet is, scaled, before they were put on the ground.
    #[serde(default)]
    pub floor: Option<Floor>,
    /// Joints that stopped at a limit of position.
    pub at_limit: Vec<Held>,
    /// Joints that were slowed to what the motor can.
    pub at_speed: Vec<Held>,
}

impl Report {
    /// What was done about each defect that directions alone would have had, and what is left of it, a
    /// sentence each.
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
        if self.unreached > 5e-4 {
            let most = 100.0 * self.unreached;
            actions.push(format!(
                "reach: kept standing feet up to {most:.1} cm from where they were locked"
            ));
        }
        if self.carried > 5e-4 {
            let most = 100.0 * self.carried;
            actions.push(format!(
                "knees: moved the pelvis by at most {most:.1} cm over the ground"
            ));
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
            if held.is_empty() {
                continue;
            }
            let mut held: Vec<&Held> = held.iter().collect();
            held.sort_by_key(|held| std::cmp::Reverse(held.frames));
            let joints: Vec<String> = held
                .iter()
                .map(|held| format!("{} in {} frames", held.joint, held.frames))
                .collect();
            actions.push(format!("{what} {}", joints.join(", ")));
        }
        for Sharpest {
            joint,
            frame,
            degrees,
        } in &self.sharpest
        {
            if *degrees > SNAP {
                actions.push(format!(
                    "left sharp: the speed of {joint} by {degrees:.1}° at frame {frame} (a frame, in a frame)"
                ));
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

/// What the bones are called, in the order of a side's angles: thigh, shin, upper arm, forearm, foot.
const BONES: [&str; 5] = ["thigh", "shin", "upper arm", "forearm", "foot"];

/// The bones that are off in any frame; `angles` are degrees per frame, five of the left side, then five of the right.
pub(crate) fn bones_off(angles: &[Vec<f64>]) -> Vec<BoneOff> {
    let of = |bone: usize| {
        let off: Vec<usize> = (0..angles.len())
            .filter(|&i| angles[i][bone] > BONE_OFF)
            .collect();
        let worst = *off
            .iter()
            .max_by(|&&i, &&j| angles[i][bone].total_cmp(&angles[j][bone]))?;
        let side = ["left", "right"][bone / BONES.len()];
        Some(BoneOff {
            bone: format!("{side} {}", BONES[bone % BONES.len()]),
            frames: off.len(),
            first: off[0] + 1,
            last: off[off.len() - 1] + 1,
            worst: worst + 1,
            by: angles[worst][bone],
        })
    };
    (0..2 * BONES.len()).filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bones_that_are_off_are_counted_by_frame() {
        let mut angles = vec![vec![5.0; 10]; 4];
        angles[1][1] = 40.0;
        angles[3][1] = 31.0;
        angles[2][9] = 30.0; // not beyond
        angles[2][5] = 90.0;
        let off = bones_off(&angles);
        let told = |i: usize| {
            let o = &off[i];
            (o.bone.as_str(), o.frames, o.first, o.last, o.worst, o.by)
        };
        assert_eq!(off.len(), 2);
        assert_eq!(told(0), ("left shin", 2, 2, 4, 2, 40.0));
        assert_eq!(told(1), ("right thigh", 1, 3, 3, 3, 90.0));
    }

    #[test]
    fn actions_say_what_was_done_and_nothing_else() {
        let mut counts = [0; JOINTS];
        counts[4] = 7;
        counts[5] = 9;
        let report = Report {
            frames: 100,
            human_leg: 0.84,
            scale: 0.75,
            scaled_speed: 0.9,
            speed: 0.9,
            direction_error: 2.0,
            direction_error_95: 6.0,
            bones_off: Vec::new(),
            off_target: 0.031,
            knee_error: 2.0,
            sharpest: vec![
                Sharpest {
                    joint: "left_hip_pitch_joint".into(),
                    frame: 12,
                    degrees: 7.9,
                },
                Sharpest {
                    joint: "left_knee_joint".into(),
                    frame: 17,
                    degrees: 9.04,
                },
            ],
            stances: 5,
            feet_moved: 0.021,
            lowered: 0.0,
            unreached: 0.0,
            carried: 0.004,
            lifted: 0.002,
            floor: None,
            at_limit: held(&counts),
            at_speed: Vec::new(),
        };
        let actions = report.actions();
        assert_eq!(actions.len(), 6, "{actions:?}");
        assert!(actions[0].contains("0.840 m to 0.630 m"));
        assert!(actions[1].contains("5 stances") && actions[1].contains("2.1 cm"));
        assert_eq!(
            actions[4],
            "limits: stopped left_ankle_roll_joint in 9 frames, left_ankle_pitch_joint in 7 frames"
        );
        assert!(actions[2].contains("0.4 cm over the ground"), "{actions:?}");
        assert!(actions[5].contains("left_knee_joint by 9.0° at frame 17"));
    }
}
