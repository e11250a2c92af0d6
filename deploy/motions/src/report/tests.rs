//! Accounts of mirror images.

use super::*;
use crate::output::Output;
use motion::gait;
use std::path::PathBuf;

fn account(frames: usize) -> Report {
    let text = json!({
        "frames": frames, "human_leg": 0.8, "scale": 0.8, "scaled_speed": 1.0, "speed": 1.0,
        "direction_error": 1.0, "direction_error_95": 6.0, "stances": 4, "feet_moved": 0.01,
        "lowered": 0.0, "lifted": 0.0,
        "bones_off": [
            { "bone": "left shin", "frames": 90, "first": 1, "last": 90, "worst": 7, "by": 80.0 },
            { "bone": "right foot", "frames": 1, "first": 2, "last": 2, "worst": 2, "by": 31.0 },
        ],
        "sharpest": [{ "joint": "left_knee_joint", "frame": 3, "degrees": 9.0 }],
        "at_limit": [
            { "joint": "left_knee_joint", "frames": 5 },
            { "joint": "right_hip_yaw_joint", "frames": 6 },
            { "joint": "waist_yaw_joint", "frames": 7 },
        ],
        "at_speed": [{ "joint": "right_elbow_joint", "frames": 8 }],
    });
    serde_json::from_value(text).unwrap()
}

#[test]
fn what_the_left_did_the_right_does_in_the_order_of_the_robot() {
    let before = account(90);
    let image = mirrored(&before);
    let bones: Vec<&str> = image.bones_off.iter().map(|b| b.bone.as_str()).collect();
    assert_eq!(bones, ["left foot", "right shin"]);
    assert_eq!((image.bones_off[1].worst, image.bones_off[1].by), (7, 80.0));
    let held: Vec<(&str, usize)> = image
        .at_limit
        .iter()
        .map(|held| (held.joint.as_str(), held.frames))
        .collect();
    assert_eq!(
        held,
        [
            ("left_hip_yaw_joint", 6),
            ("right_knee_joint", 5),
            ("waist_yaw_joint", 7)
        ]
    );
    assert_eq!(image.sharpest[0].joint, "right_knee_joint");
    assert_eq!(image.at_speed[0].joint, "left_elbow_joint");
    assert_eq!(mirrored(&image), before);
}

#[test]
fn sides_are_words() {
    assert_eq!(
        other_side("left_knee_joint, right shin and upright, leftmost: right"),
        "right_knee_joint, left shin and upright, leftmost: left"
    );
}

/// A table with an account of so many frames beside it, its origin, and the folder of both.
fn table(frames: usize) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let output = Output::new(folder.path(), "walk", "made".into()).with_report();
    let clip = gait::walk(1.0).unwrap().unrolled(2.0);
    output.write(&clip, &[]).unwrap();
    let report = json!({ "retargeting": account(frames) });
    output.write_report(&report).unwrap();
    (folder, output.clip)
}

fn examined(path: &Path) -> (Imported, Examination) {
    let options = motion::import::Options::default();
    let imported = motion::import::import(path, &options).unwrap();
    let found = Examination::of(&imported, path);
    (imported, found)
}

#[test]
fn an_account_of_another_table_stays_one() {
    let (_folder, path) = table(3);
    let (imported, found) = examined(&path);
    assert!(matches!(found.account, Account::Misfit(_)));
    let kept = report(Made::Imported, &path, &imported, &found);
    assert_eq!(kept["retargeting"]["frames"], 3);
    assert_eq!(kept["written_by"], "ampco motions import");
    // One that nobody can read is an account that nobody can read.
    let beside = path.with_extension("json");
    fs::write(&beside, "{broken").unwrap();
    let (imported, found) = examined(&path);
    let kept = report(Made::Mirrored, &path, &imported, &found);
    fs::write(&beside, kept.to_string()).unwrap();
    assert!(matches!(examined(&path).1.account, Account::Misfit(_)));
}

#[test]
fn only_reports_have_an_origin() {
    let report =
        |by: &str| format!("{{\"written_by\": \"ampco motions {by}\", \"source\": \"a.bvh\"}}");
    let origin = |by: &str| origin(report(by).as_bytes());
    assert_eq!(origin("import").as_deref(), Some("from a.bvh"));
    assert_eq!(origin("mirror").as_deref(), Some("mirrored a.bvh"));
    assert_eq!(origin("check"), None);
}
