//! Robots' tables and captures whose faults import mends: they are said all the same, then and later.

use super::*;
use crate::export;
use crate::import::{Options, import};
use std::path::Path;

/// The built-in walk as somebody else's table, changed frame by frame.
fn table(seconds: f64, change: impl Fn(usize, &mut RobotState)) -> String {
    let mut clip = walk(0.6, seconds);
    for (i, frame) in clip.frames.iter_mut().enumerate() {
        change(i, frame);
    }
    export::to_csv(&clip, &[]).replacen("# ampco motion", "# a motion", 1)
}

fn examined(path: &Path) -> (Vec<Defect>, Clip) {
    let imported = import(path, &Options::default()).unwrap();
    (Examination::of(&imported, path).defects, imported.clip)
}

fn of_table(text: &str) -> (Vec<Defect>, Clip) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.csv");
    std::fs::write(&path, text).unwrap();
    examined(&path)
}

fn find(defects: &[Defect], kind: Kind) -> &Defect {
    let found = defects.iter().find(|defect| defect.kind == kind);
    found.unwrap_or_else(|| panic!("{kind:?} is not in {defects:?}"))
}

#[test]
fn joints_that_jump_are_unfit_however_far() {
    for (joint, by) in [
        ("left_knee_joint", 0.38),
        ("left_knee_joint", 0.6),
        ("left_knee_joint", 1.4),
        ("left_hip_pitch_joint", -0.5),
        ("left_hip_pitch_joint", -1.4),
    ] {
        let j = index_of(joint).unwrap();
        let text = table(8.0, |i, frame| {
            if i >= 200 {
                frame.joint_positions[j] += by;
            }
        });
        let (defects, _) = of_table(&text);
        let found = |defect: &&Defect| {
            matches!(defect.kind, Kind::Jump | Kind::Acceleration)
                && defect.severity == Severity::Unfit
        };
        let defect = defects.iter().find(found);
        let defect = defect.unwrap_or_else(|| panic!("{joint} by {by}: {defects:?}"));
        assert_eq!(defect.joints[0], joint);
        let at = defect.frames.worst;
        assert!((199..=203).contains(&at), "{joint} by {by}: {at}");
    }
}

#[test]
fn what_import_mended_is_known_later() {
    let knee = index_of("left_knee_joint").unwrap();
    let text = table(4.0, |i, frame| {
        if i >= 100 {
            frame.joint_positions[knee] += 1.4;
        }
    });
    let (defects, clip) = of_table(&text);
    let jump = find(&defects, Kind::Jump).clone();
    assert!(jump.of_source && jump.severity == Severity::Unfit);
    // 1.4 rad are 80.2°, and the walk's own few.
    assert!((jump.value - 1.4).abs() < 0.15, "{jump:?}");
    assert_eq!(jump.frames.worst, 101);
    // The clip as it was written, with its account beside it and without.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.csv");
    std::fs::write(&path, export::to_csv(&clip, &[])).unwrap();
    let (without, _) = examined(&path);
    assert!(without.iter().all(|defect| defect.kind != Kind::Jump));
    let account = serde_json::json!({
        "retargeting": null,
        "quality": Quality::of(&clip),
        "defects": defects,
    });
    std::fs::write(path.with_extension("json"), account.to_string()).unwrap();
    let (with, _) = examined(&path);
    let kept = find(&with, Kind::Jump);
    assert_eq!((&kept.says, kept.severity), (&jump.says, jump.severity));
    assert_eq!((kept.frames, &kept.joints), (jump.frames, &jump.joints));
}

#[test]
fn a_floor_that_rises_under_a_robot_is_said() {
    for (by, severity) in [
        (0.08, Some(Severity::Unfit)),
        (-0.08, Some(Severity::Unfit)),
        (0.04, Some(Severity::Odd)),
        (0.0, None),
    ] {
        let text = table(4.0, |i, frame| {
            frame.position.z += by * i as f32 / 200.0;
        });
        let (defects, _) = of_table(&text);
        let drift = defects.iter().find(|defect| defect.kind == Kind::Drift);
        assert_eq!(drift.map(|drift| drift.severity), severity, "{defects:?}");
    }
}
