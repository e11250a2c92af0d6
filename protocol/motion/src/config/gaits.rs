//! What a configuration may ask of the built-in gaits.
//!
//! Separate because each gait has its own ranges, and a velocity has three parts.

use super::{ClipConfig, Gait, wrong};
use crate::gait::{LATERAL_SPEEDS, RUNNING_SPEEDS, Velocity, WALKING_SPEEDS, YAW_RATES};
use std::ops::RangeInclusive;
use vocabulary::Checked;

impl ClipConfig {
    /// The velocity that a built-in gait is asked for.
    pub(crate) fn velocity(&self) -> Velocity {
        Velocity {
            forward: self.speed.unwrap_or(0.0),
            lateral: self.lateral.unwrap_or(0.0),
            yaw_rate: self.yaw_rate.unwrap_or(0.0),
        }
    }

    pub(super) fn validate_gait(&self, gait: Gait, field: &dyn Fn(&str) -> String) -> Checked {
        for (name, given) in [
            ("fps", self.fps.is_some()),
            ("quaternion", self.quaternion.is_some()),
            ("ground", self.ground.is_some()),
        ] {
            if given {
                let remedy = "it belongs to a file; remove it";
                return Err(wrong(field(name), "given for a gait", remedy));
            }
        }
        let speeds = match gait {
            Gait::Stand => return self.validate_standing(field),
            Gait::Run => RUNNING_SPEEDS,
            Gait::Walk | Gait::Start | Gait::Stop => WALKING_SPEEDS,
        };
        within(field("speed"), self.speed, speeds, "m/s")?;
        let or_none = |value: Option<f64>| Some(value.unwrap_or(0.0));
        within(
            field("lateral"),
            or_none(self.lateral),
            LATERAL_SPEEDS,
            "m/s",
        )?;
        within(
            field("yaw_rate"),
            or_none(self.yaw_rate),
            YAW_RATES,
            "rad/s",
        )
    }

    fn validate_standing(&self, field: &dyn Fn(&str) -> String) -> Checked {
        for (name, given) in [
            ("speed", self.speed),
            ("lateral", self.lateral),
            ("yaw_rate", self.yaw_rate),
        ] {
            if let Some(value) = given.filter(|value| *value != 0.0) {
                return Err(wrong(field(name), value, "remove it: standing has none"));
            }
        }
        Ok(())
    }
}

fn within(field: String, value: Option<f64>, range: RangeInclusive<f64>, unit: &str) -> Checked {
    if value.is_some_and(|value| range.contains(&value)) {
        return Ok(());
    }
    let (low, high) = (range.start(), range.end());
    Err(wrong(
        field,
        value.map_or_else(|| "missing".into(), |value| value.to_string()),
        &format!("write a number from {low} to {high} {unit}"),
    ))
}

#[cfg(test)]
mod tests {
    use crate::{Dataset, MotionConfig};
    use std::path::Path;

    fn load(text: &str) -> Result<Dataset, String> {
        let config: MotionConfig = toml::from_str(text).map_err(|e| e.to_string())?;
        Dataset::load(&config, Path::new("/nowhere")).map_err(|e| e.to_string())
    }

    #[test]
    fn every_frame_has_the_command_that_its_clip_goes_to() {
        let data = load(
            "mirror = false\n\
             [[clips]]\ngait = \"walk\"\nspeed = 0.6\nyaw_rate = 0.5\n\
             [[clips]]\ngait = \"walk\"\nspeed = 0.0\nlateral = -0.3\n\
             [[clips]]\ngait = \"walk\"\nspeed = -0.4\n\
             [[clips]]\ngait = \"start\"\nspeed = 0.8\n\
             [[clips]]\ngait = \"stop\"\nspeed = 0.8\n",
        )
        .unwrap();
        let mut commands: Vec<[f32; 3]> = data.frames().map(|(_, command, _)| command).collect();
        commands.dedup();
        let expected = [
            [0.6, 0.0, 0.5],
            [0.0, -0.3, 0.0],
            [-0.4, 0.0, 0.0],
            [0.8, 0.0, 0.0],
            [0.0, 0.0, 0.0],
        ];
        assert_eq!(commands, expected);
    }

    #[test]
    fn a_mirrored_clip_turns_and_steps_the_other_way_and_says_so() {
        let text = "clips = [{ gait = \"walk\", speed = 0.5, lateral = 0.2, yaw_rate = -0.6 }]";
        let data = load(text).unwrap();
        assert_eq!(data.clips().len(), 2);
        for (clip, side) in data.clips().iter().zip([-1.0, 1.0]) {
            assert_eq!(
                clip.command,
                [0.5, side * 0.2, side * -0.6],
                "{}",
                clip.name
            );
            let n = clip.frames.len() as f32;
            let mean = |value: &dyn Fn(&g1::RobotState) -> f32| {
                clip.frames.iter().map(value).sum::<f32>() / n
            };
            let aside = mean(&|f| f.velocity_in_heading().y);
            let turning = mean(&|f| f.angular_velocity.z);
            assert!((aside - clip.command[1]).abs() < 0.01, "{aside}");
            assert!((turning - clip.command[2]).abs() < 0.01, "{turning}");
        }
    }

    #[test]
    fn errors_name_field_value_and_remedy() {
        for (clip, parts) in [
            (
                "gait = \"walk\"",
                ["clips[0].speed", "missing", "-0.6 to 1.8"],
            ),
            (
                "gait = \"walk\", speed = 3.5",
                ["clips[0].speed", "3.5", "-0.6 to 1.8"],
            ),
            (
                "gait = \"stop\", speed = -0.7",
                ["clips[0].speed", "-0.7", "-0.6 to 1.8"],
            ),
            (
                "gait = \"run\", speed = 1.0",
                ["clips[0].speed", "1", "1.8 to 2.7"],
            ),
            ("gait = \"stand\", speed = 1.0", ["speed", "1", "remove"]),
            (
                "gait = \"stand\", yaw_rate = 0.5",
                ["clips[0].yaw_rate", "0.5", "remove"],
            ),
            (
                "gait = \"walk\", speed = 0.0, lateral = 0.6",
                ["clips[0].lateral", "0.6", "-0.4 to 0.4 m/s"],
            ),
            (
                "gait = \"start\", speed = 0.5, yaw_rate = nan",
                ["clips[0].yaw_rate", "NaN", "-1 to 1 rad/s"],
            ),
            (
                "gait = \"stand\", fps = 30",
                ["clips[0].fps", "gait", "remove"],
            ),
            (
                "file = \"a.csv\", lateral = 0.1",
                ["clips[0].lateral", "0.1", "remove"],
            ),
            (
                "gait = \"walk\", speed = 1.8, lateral = 0.4, yaw_rate = 1.0",
                ["clips[0]", "1.80 m/s, 0.40 m/s left", "lower lateral"],
            ),
        ] {
            let message = load(&format!("clips = [{{ {clip} }}]")).unwrap_err();
            for part in parts {
                assert!(message.contains(part), "{clip}: {message}");
            }
        }
    }
}
