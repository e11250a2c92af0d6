//! The kinds of defects and what to do about each.
//!
//! Separate because it is a table.

use serde::{Deserialize, Serialize};

/// What is wrong. One defect of a kind per clip: its joints and frames are in the defect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Next to no frames.
    Short,
    /// The pelvis is elsewhere, or turned, from one frame to the next.
    Teleport,
    /// Joints of the source that outran their motors, before import slowed them.
    Jump,
    /// Joints that accelerate like nothing alive.
    Acceleration,
    /// Joints that outrun their motor.
    Motor,
    /// Joints beyond their range.
    Limits,
    /// Joints that rest against a stop.
    Stops,
    /// Parts of the robot within each other.
    Touch,
    /// Bones that do not do what the human's did.
    Bones,
    /// A robot that faces away from where it goes.
    Backward,
    /// A robot that lies, sits or kneels.
    Lying,
    /// Both feet off the ground for longer than any jump.
    Flight,
    /// A floor that rises or sinks.
    Drift,
    /// A clip too short to fly that never touches the ground.
    Float,
    /// Soles below the ground.
    Penetration,
    /// Standing feet that slide.
    Slip,
    /// The account beside a table is not that of the table.
    Account,
}

impl Kind {
    /// What to do about it.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::Short => "give a longer piece",
            Self::Teleport => {
                "cut the clip there, or repair the frames: two takes in one file, or lost tracking"
            }
            Self::Acceleration => {
                "repair or cut the frames; if there are many, look at the file's rate, units (degrees?) and joint order"
            }
            Self::Jump => {
                "repair or cut the frames, or give the rate at which it was recorded (--fps); if there are many, look at units (degrees?) and joint order"
            }
            Self::Motor => {
                "give the rate at which it was recorded (--fps), or slow the motion down"
            }
            Self::Limits => "look at units (degrees?) and joint order, or clamp the joints",
            Self::Stops => {
                "look at units, signs and joint order: a posture that the robot cannot take, or a pose that was never set"
            }
            Self::Touch => {
                "cut the frames, or leave the clip out: legs that cross are further apart on a human than on the robot"
            }
            Self::Bones => {
                "look at the file: a left-handed one, swapped sides or a broken skeleton; else leave the clip out"
            }
            Self::Backward => {
                "look whether the file is left-handed or its sides are swapped; \
                 if it walks backward, say so in its name (walk_backward)"
            }
            Self::Lying => {
                "cut to where the robot is on its feet; if it is there, look which axis is up"
            }
            Self::Flight => {
                "the ground is flat here: cut stairs, boxes and seats, or mend the floor's height"
            }
            Self::Drift => {
                "take the drift out of the heights, or cut slopes and stairs: the ground is flat here"
            }
            Self::Float => "leave grounding on, or lower the motion",
            Self::Penetration => "leave grounding on, or raise the motion",
            Self::Slip => {
                "look at rate and scale; retargeting from the human's capture plants the feet"
            }
            Self::Account => "import the motion again",
        }
    }
}
