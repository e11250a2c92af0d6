//! Captures of humans, from a file to their defects: sound, left-handed, cut.

use super::*;
use crate::import::{Options, import};
use g1::joints::{LEFT_ARM, LEFT_LEG, RIGHT_ARM, RIGHT_LEG};
use g1::kinematics::forward_state;
use nalgebra::Point3;
use std::fmt::Write;

/// Joint centres of the robot's own walk as a BVH of y up in cm, every joint placed by itself, at 50 frames a second;
/// `place` may put a point of a frame elsewhere (m, z up).
fn walk(place: impl Fn(usize, Point3<f32>) -> Point3<f32>) -> String {
    const NAMES: [&str; 7] = ["UpLeg", "Leg", "Foot", "ToeBase", "Arm", "ForeArm", "Hand"];
    let frames = gait::walk(0.6).unwrap().unrolled(3.0).frames;
    let mut text = String::from(
        "HIERARCHY\nROOT Root\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n",
    );
    for name in ["Left", "Right"].map(|side| NAMES.map(|n| format!("{side}{n}"))) {
        for name in name {
            let _ = write!(
                text,
                "JOINT {name}\n{{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n"
            );
        }
    }
    let _ = write!(
        text,
        "}}\nMOTION\nFrames: {}\nFrame Time: 0.02\n",
        frames.len()
    );
    for (i, frame) in frames.iter().enumerate() {
        let bodies = forward_state(frame);
        let at = |body: usize| Point3::from(bodies[body].translation.vector);
        text.push_str("0 0 0");
        for (leg, arm) in [(LEFT_LEG, LEFT_ARM), (RIGHT_LEG, RIGHT_ARM)] {
            // Joint i moves body i + 1: hip roll, knee, ankle pitch; the ball of the foot; shoulder roll, elbow, wrist.
            let toe = bodies[leg + 6] * Point3::new(0.12, 0.0, -0.035);
            let points = [
                at(leg + 2),
                at(leg + 4),
                at(leg + 5),
                toe,
                at(arm + 2),
                at(arm + 4),
                at(arm + 5),
            ];
            for point in points {
                let p = place(i, point) * 100.0;
                let _ = write!(text, " {} {} {}", p.y, p.z, p.x);
            }
        }
        text.push('\n');
    }
    text
}

fn examined(text: &str) -> Vec<Defect> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("take.bvh");
    std::fs::write(&path, text).unwrap();
    let imported = import(&path, &Options::default()).unwrap();
    Examination::of(&imported, &path).defects
}

#[test]
fn a_capture_of_the_robots_own_walk_is_sound() {
    let defects = examined(&walk(|_, p| p));
    assert_ne!(severity(&defects), Some(Severity::Unfit), "{defects:?}");
}

#[test]
fn a_left_handed_capture_is_unfit_and_says_why() {
    let defects = examined(&walk(|_, p| Point3::new(p.x, -p.y, p.z)));
    for kind in [Kind::Bones, Kind::Backward] {
        let defect = defects.iter().find(|defect| defect.kind == kind);
        let defect = defect.unwrap_or_else(|| panic!("{kind:?} is not in {defects:?}"));
        assert_eq!(defect.severity, Severity::Unfit);
    }
    let bones = defects
        .iter()
        .find(|defect| defect.kind == Kind::Bones)
        .unwrap();
    assert!(bones.value > 90.0 && !bones.joints.is_empty(), "{bones:?}");
    // Knees bend, hips are lost, feet fly: still a sentence each.
    assert!(defects.len() <= 10, "{}", defects.len());
}

#[test]
fn a_capture_whose_floor_rises_or_sinks_is_unfit() {
    for by in [0.2, -0.2] {
        let defects = examined(&walk(|i, p| p + Vector3::z() * (by * i as f32 / 150.0)));
        let drift = defects.iter().find(|defect| defect.kind == Kind::Drift);
        let drift = drift.unwrap_or_else(|| panic!("{defects:?}"));
        assert_eq!(drift.severity, Severity::Unfit, "{drift:?}");
    }
}

#[test]
fn a_capture_that_is_moved_by_five_metres_teleports() {
    let moved = walk(|i, p| if i < 80 { p } else { p + Vector3::y() * 5.0 });
    let defects = examined(&moved);
    let defect = defects.iter().find(|defect| defect.kind == Kind::Teleport);
    let at = defect.unwrap_or_else(|| panic!("{defects:?}")).frames.worst;
    assert!((80..=83).contains(&at), "{at}"); // the 81st, as near as smoothing leaves it
}
