//! The section read, written and refused.

use super::*;

fn read(text: &str) -> Result<MotionConfig, String> {
    let config: MotionConfig = toml::from_str(text).map_err(|e| e.to_string())?;
    config.validate().map_err(|e| e.to_string())?;
    Ok(config)
}

#[test]
fn the_default_is_valid_and_survives_being_written() {
    let config = MotionConfig::default();
    config.validate().unwrap();
    assert_eq!(read(&toml::to_string(&config).unwrap()).unwrap(), config);
    assert_eq!(read("").unwrap(), config);
}

#[test]
fn clips_are_written_as_tables() {
    let config = read(
            "mirror = false\nclips = [{ gait = \"stand\" }, { gait = \"run\", speed = 2.2, weight = 2.0 },\n\
             { file = \"x.csv\", fps = 60, quaternion = \"xyzw\", ground = false }]",
        )
        .unwrap();
    assert_eq!(config.clips[1].gait, Some(Gait::Run));
    assert_eq!(config.clips[2].quaternion, Some(QuaternionOrder::Xyzw));
    assert!(!config.mirror);
}

#[test]
fn errors_name_field_value_and_remedy() {
    for (text, parts) in [
        ("clips = []", ["clips", "[]", "at least one"]),
        (
            "clips = [{ gait = \"stand\", weight = -1.0 }]",
            ["clips[0].weight", "-1", "above 0"],
        ),
        (
            "clips = [{ gait = \"stand\" }, { file = \"a.csv\", folder = \"b\" }]",
            ["clips[1].folder", "beside", "one of the two"],
        ),
        (
            "clips = [{ file = \"a.csv\", fps = nan }]",
            ["clips[0].fps", "NaN", "1 to 10000"],
        ),
        (
            "clips = [{ file = \"a.csv\", gait = \"stand\" }]",
            ["clips[0].file", "gait", "one of the two"],
        ),
        ("clips = [{}]", ["clips[0]", "{}", "walk"]),
        ("clips = [{ gait = \"hop\" }]", ["hop", "walk", "stand"]),
        ("mirrored = true", ["mirrored", "clips", "mirror"]),
    ] {
        let message = read(text).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
