//! The `[motion]` section: which clips the discriminator learns from.
//!
//! Separate because it is what a user writes; what comes of it is [`crate::Dataset`].

mod gaits;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use vocabulary::{Checked, Invalid, Section};

/// Reference motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MotionConfig {
    /// The clips. Default: walking at five speeds from 0.4 to 1.2 m/s, the one of a comfortable
    /// walk (0.98 m/s) with weight 3: the mixture with which the G1 learnt to walk soonest.
    pub clips: Vec<ClipConfig>,
    /// Whether every clip is also shown mirrored, left for right. Default: true.
    pub mirror: bool,
    /// What decides how often motion is shown to the discriminator. Default: the weights of clips.
    pub draw: Draw,
}

/// What decides how often motion is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Draw {
    /// The weights of clips.
    #[default]
    Weights,
    /// Every quarter of a metre per second has the same share, however much motion there is at it.
    Speeds,
    /// What the policy is told at the time: motion of a command is shown as often as robots have that command or one near
    /// it. A discriminator that sees commands would else know reference motion by which commands are rare in it.
    Commands,
}

/// One clip or a folder of them: a built-in gait, a file or a folder, never two of these.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ClipConfig {
    /// A built-in gait.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gait: Option<Gait>,
    /// Forward speed of a built-in gait, m/s: −0.6–1.8 walking, starting and stopping (0 is stepping on
    /// the spot), 1.8–2.7 running; none for standing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Speed to the left of a built-in gait but standing, m/s: −0.4–0.4. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lateral: Option<f64>,
    /// Rate at which a built-in gait but standing turns to the left, rad/s: −1–1. Default: 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub yaw_rate: Option<f64>,
    /// A file in any format that `ampco motions import` reads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// A folder of tables (`*.csv`), as `ampco motions import` writes it; the longer a clip in it, the
    /// greater its share of the weight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub folder: Option<PathBuf>,
    /// Frames per second of the file or of those in the folder, which are refused if they say others.
    /// Default: what they say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fps: Option<f64>,
    /// Order of the quaternion in a file without header. Default: the one in which the robot stands
    /// upright and its feet slip least.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quaternion: Option<QuaternionOrder>,
    /// Whether a file's motion is moved up or down until its feet are on the ground. Default: true.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ground: Option<bool>,
    /// Share of the clip among all, relative to the others. Default: 1.
    pub weight: f32,
}

/// The built-in gaits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Gait {
    /// Standing still.
    Stand,
    /// Walking, or stepping on the spot.
    Walk,
    /// Running.
    Run,
    /// From standing to walking, within about a stride.
    Start,
    /// From walking to standing, within about a stride.
    Stop,
}

/// Order of the numbers of a quaternion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum QuaternionOrder {
    /// w x y z.
    #[default]
    Wxyz,
    /// x y z w.
    Xyzw,
}

impl std::fmt::Display for QuaternionOrder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Wxyz => "wxyz",
            Self::Xyzw => "xyzw",
        })
    }
}

impl std::str::FromStr for QuaternionOrder {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "wxyz" => Ok(Self::Wxyz),
            "xyzw" => Ok(Self::Xyzw),
            _ => Err("give wxyz or xyzw".into()),
        }
    }
}

impl Default for MotionConfig {
    fn default() -> Self {
        let walk = |speed, weight| ClipConfig {
            gait: Some(Gait::Walk),
            speed: Some(speed),
            weight,
            ..ClipConfig::default()
        };
        Self {
            clips: vec![
                walk(0.4, 1.0),
                walk(0.6, 1.0),
                walk(0.8, 1.0),
                walk(0.98, 3.0),
                walk(1.2, 1.0),
            ],
            mirror: true,
            draw: Draw::Weights,
        }
    }
}

impl Default for ClipConfig {
    fn default() -> Self {
        Self {
            gait: None,
            speed: None,
            lateral: None,
            yaw_rate: None,
            file: None,
            folder: None,
            fps: None,
            quaternion: None,
            ground: None,
            weight: 1.0,
        }
    }
}

impl Section for MotionConfig {
    const NAME: &'static str = "motion";

    fn validate(&self) -> Checked {
        if self.clips.is_empty() {
            let remedy = "name at least one clip, for example { gait = \"walk\", speed = 0.8 }";
            return Err(wrong("clips".into(), "[]", remedy));
        }
        self.clips
            .iter()
            .enumerate()
            .try_for_each(|(i, clip)| clip.validate(i))
    }
}

impl ClipConfig {
    /// Whether it is made by the program itself, and needs no file.
    pub fn is_built_in(&self) -> bool {
        self.file.is_none() && self.folder.is_none()
    }

    fn validate(&self, index: usize) -> Checked {
        let field = |name: &str| format!("clips[{index}].{name}");
        if !(self.weight.is_finite() && self.weight > 0.0 && self.weight <= 1e6) {
            let remedy = "write a number above 0, at most 1000000; remove the clip to leave it out";
            return Err(wrong(field("weight"), self.weight, remedy));
        }
        match (self.gait, &self.file, &self.folder) {
            (Some(gait), None, None) => self.validate_gait(gait, &field),
            (None, Some(_), None) | (None, None, Some(_)) => self.validate_file(&field),
            (Some(_), Some(_), _) => Err(wrong(
                field("file"),
                "given beside gait",
                "keep one of the two",
            )),
            (_, _, Some(_)) => Err(wrong(
                field("folder"),
                "given beside gait or file",
                "keep one of the two",
            )),
            (None, None, None) => Err(wrong(
                format!("clips[{index}]"),
                "{}",
                "give gait = \"stand\", \"walk\", \"run\", \"start\" or \"stop\", or file = \"…\", or folder = \"…\"",
            )),
        }
    }

    fn validate_file(&self, field: &dyn Fn(&str) -> String) -> Checked {
        for (name, given) in [
            ("speed", self.speed),
            ("lateral", self.lateral),
            ("yaw_rate", self.yaw_rate),
        ] {
            if let Some(value) = given {
                let remedy = "remove it: a file has its own motion";
                return Err(wrong(field(name), value, remedy));
            }
        }
        match self.fps {
            Some(fps) if !(1.0..=10_000.0).contains(&fps) => Err(wrong(
                field("fps"),
                fps,
                "write the frames per second of the file, from 1 to 10000",
            )),
            _ => Ok(()),
        }
    }
}

pub(crate) fn wrong(path: String, value: impl ToString, remedy: &str) -> Invalid {
    Invalid {
        path,
        value: value.to_string(),
        remedy: remedy.into(),
    }
}

#[cfg(test)]
mod tests;
