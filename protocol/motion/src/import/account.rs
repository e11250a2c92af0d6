//! What whoever imports may say about a file, and the account that is given of it.

use super::format::Format;
use crate::clip::Clip;
use crate::config::QuaternionOrder;
use retarget::{Floor, Report};
use std::path::PathBuf;

/// What a file does not say, or says wrongly.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Frames per second, where the file does not say them; a file that says others is refused.
    pub fps: Option<f64>,
    /// Whether `fps` stands above what the file says.
    pub force_fps: bool,
    /// The format, instead of the one that the content tells.
    pub format: Option<Format>,
    /// Order of the robot's quaternions, instead of what its posture tells.
    pub quaternion: Option<QuaternionOrder>,
    /// Skeleton of an Acclaim motion, instead of the one beside it.
    pub skeleton: Option<PathBuf>,
    /// Whether a robot's motion is moved up or down until the feet are on the ground.
    pub ground: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            fps: None,
            force_fps: false,
            format: None,
            quaternion: None,
            skeleton: None,
            ground: true,
        }
    }
}

/// A clip and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The clip at 50 Hz.
    pub clip: Clip,
    /// The format it was in.
    pub format: Format,
    /// Frames in the file.
    pub frames: usize,
    /// Frames per second of the file.
    pub fps: f64,
    /// What was decided that the file does not say, a sentence each.
    pub decisions: Vec<String>,
    /// The account of retargeting, if a human was in the file.
    pub retargeting: Option<Report>,
    /// What the file's motion was like before it was made one that the robot can do.
    pub source: Source,
}

/// What import mends in a robot's motion, as the source had it: the clip no longer shows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// The joints that were held within limits or speeds.
    pub jumps: Vec<Jump>,
    /// How uneven the ground under the feet was, if the motion was put on the ground.
    pub floor: Option<Floor>,
}

/// The greatest step of a joint of the source, at 50 Hz.
#[derive(Clone, Debug, PartialEq)]
pub struct Jump {
    /// The joint's name.
    pub joint: String,
    /// The frame that the step leads to, counted from 1.
    pub frame: usize,
    /// How far the joint turns in that frame, rad.
    pub angle: f64,
    /// The same over what its motor can turn.
    pub times: f64,
    /// The joint's greatest acceleration anywhere, rad/s².
    pub acceleration: f64,
    /// The greatest of those that another as great or greater follows the other way in the next frame, rad/s².
    pub reversal: f64,
}
