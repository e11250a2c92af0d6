//! Small files whose positions can be worked out in the head, and broken ones.

use super::*;
use crate::import::human::tests::STANDING;
use std::fmt::Write as _;
use std::path::Path;

const ARM: &str = "HIERARCHY
ROOT Hips
{
  OFFSET 1 2 3
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Spine
  {
    OFFSET 0 10 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 5 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 90 0 0 0 0 0 0 0
1 90 2 90 0 0 0 90 0
";

fn positions(text: &str) -> Result<(Joints, f64), String> {
    let file = File {
        path: Path::new("walk.bvh"),
        bytes: text.as_bytes(),
    };
    read(&file).map_err(|e| e.to_string())
}

/// A human that stands and slides 1 cm a frame along z, y up, in cm, every joint placed by itself.
pub(in crate::import) fn sliding(frames: usize) -> String {
    let mut text = String::from(
        "HIERARCHY\nROOT Root\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n",
    );
    for (name, [x, y, z]) in STANDING {
        let (x, y, z) = (100.0 * y, 100.0 * z, 100.0 * x);
        let _ = write!(
            text,
            "JOINT {name}\n{{\nOFFSET {x} {y} {z}\nEnd Site\n{{\nOFFSET 0 1 0\n}}\n}}\n"
        );
    }
    let _ = write!(text, "}}\nMOTION\nFrames: {frames}\nFrame Time: 0.033333\n");
    for i in 0..frames {
        let _ = writeln!(text, "0 0 {i}");
    }
    text
}

#[test]
fn channels_apply_in_the_order_of_the_file() {
    let (joints, fps) = positions(ARM).unwrap();
    assert_eq!(joints.names, ["Hips", "Spine", "SpineEnd"]);
    assert!((fps - 30.0).abs() < 1e-3);
    assert_eq!(joints.frames[0][2], Vector3::new(0.0, 105.0, 0.0));
    // Hips turned by 90° about z: +y becomes −x. The spine then turns about its own x by 90°:
    // its y becomes z, which the hips leave alone.
    let [hips, spine, end] = [0, 1, 2].map(|i| joints.frames[1][i]);
    assert_eq!(hips, Vector3::new(1.0, 90.0, 2.0));
    assert!(
        (spine - Vector3::new(-9.0, 90.0, 2.0)).norm() < 1e-9,
        "{spine}"
    );
    assert!((end - Vector3::new(-9.0, 90.0, 7.0)).norm() < 1e-9, "{end}");
}

#[test]
fn positions_on_any_joint_replace_its_offset() {
    let text = ARM
        .replace(
            "CHANNELS 3 Zrotation Xrotation Yrotation",
            "CHANNELS 4 Yposition Zrotation Xrotation Yrotation",
        )
        .replace("0 90 0 0 0 0 0 0 0", "0 90 0 0 0 0 20 0 0 0")
        .replace("1 90 2 90 0 0 0 90 0", "1 90 2 90 0 0 20 0 90 0");
    let (joints, _) = positions(&text).unwrap();
    assert_eq!(joints.frames[0][1], Vector3::new(0.0, 110.0, 0.0));
}

#[test]
fn a_skeleton_of_fourteen_joints_is_a_capture() {
    let text = sliding(30);
    let (joints, fps) = positions(&text).unwrap();
    let file = File {
        path: Path::new("x"),
        bytes: b"",
    };
    let capture = crate::import::human::capture(&file, &joints, fps, &mut Vec::new()).unwrap();
    assert!((capture.travel_speed() - 0.3).abs() < 1e-3);
}

/// A human that stands, y up and facing z, in inches, with Biped's names, spaces and all, and feet that end
/// straight below their ankles; the left foot turns about y by so many degrees.
fn toeless(degrees: &[f64]) -> String {
    let words = ["Thigh", "Calf", "Foot", "", "UpperArm", "Forearm", "Hand"];
    let mut text = String::from(
        "HIERARCHY\nROOT Bip01\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n",
    );
    for (i, (_, place)) in STANDING.iter().enumerate() {
        if words[i % 7].is_empty() {
            continue;
        }
        let [x, y, z] = place.map(|meters| meters / 0.0254);
        let side = if i < 7 { "L" } else { "R" };
        let _ = write!(
            text,
            "JOINT Bip01 {side} {} {{\nOFFSET {y} {z} {x}\nCHANNELS 3 Zrotation Xrotation Yrotation\n\
             End Site\n{{\nOFFSET 0 -3 0\n}}\n}}\n",
            words[i % 7]
        );
    }
    let _ = write!(
        text,
        "}}\nMOTION\nFrames: {}\nFrame Time: 0.02\n",
        degrees.len()
    );
    for (i, degrees) in degrees.iter().enumerate() {
        // Three channels of the root, then three each of thigh, calf and foot.
        let rest = " 0".repeat(27);
        let _ = writeln!(
            text,
            "0 0 {} 0 0 0 0 0 0 0 0 {degrees}{rest}",
            i as f64 / 2.54
        );
    }
    text
}

#[test]
fn inches_spaces_in_names_and_feet_without_toes_are_read() {
    let text = toeless(&[30.0, -30.0, 30.0, -30.0]);
    let (joints, _) = positions(&text).unwrap();
    assert_eq!(joints.names[1], "Bip01 L Thigh");
    let file = File {
        path: Path::new("x"),
        bytes: b"",
    };
    let mut told = Vec::new();
    let capture = crate::import::human::capture(&file, &joints, 50.0, &mut told).unwrap();
    assert!(told.iter().any(|t| t.contains("no toes")), "{told:?}");
    assert!(
        told.iter()
            .any(|t| t.starts_with("unit inches: legs of 0.82")),
        "{told:?}"
    );
    assert!((capture.travel_speed() - 0.5).abs() < 1e-6); // 1 cm a frame
    // z becomes −y: ahead. A turn to the left about y is one about z.
    for (i, frame) in capture.frames.iter().enumerate() {
        for (side, degrees) in [(retarget::Side::Left, 30.0), (retarget::Side::Right, 0.0)] {
            let toe = frame.of(side, retarget::Landmark::Toe);
            let way = toe - frame.of(side, retarget::Landmark::Ankle);
            let expected = if i % 2 == 0 { degrees } else { -degrees };
            let yaw = way.x.atan2(-way.y).to_degrees();
            assert!(
                (yaw - expected).abs() < 0.01 && way.z.abs() < 1e-6,
                "{i} {side:?}: {way}"
            );
            // 0.18 of the leg of 0.821 m.
            assert!((way.norm() - 0.1478).abs() < 1e-3, "{}", way.norm());
        }
    }
    // Joints that never turn do not say how feet point.
    let still = toeless(&[]).replace("CHANNELS 3 Zrotation Xrotation Yrotation", "CHANNELS 0");
    let still = still.replace("Frames: 0", "Frames: 1") + "0 0 0\n";
    let (joints, _) = positions(&still).unwrap();
    let message = crate::import::human::capture(&file, &joints, 50.0, &mut Vec::new()).unwrap_err();
    assert!(message.to_string().contains("left toe"), "{message}");
}

#[test]
fn errors_name_line_or_frame() {
    for (text, parts) in [
        (
            ARM.replace("Frames: 2", "Frames: 3"),
            ["2 frames", "says 3", "cut off"],
        ),
        (
            ARM.replace("Frames: 2", "Frames: 0")
                .replace("0 90 0 0 0 0 0 0 0\n1 90 2 90 0 0 0 90 0\n", ""),
            ["", "", ""],
        ),
        (
            ARM.replace("1 90 2 90", "1 nan 2 90"),
            ["frame 2", "channel 2", "nan"],
        ),
        (
            ARM.replace("0 90 0 0 0 0 0 0 0", "0 90 0 0 0 0 0 0"),
            ["frame 1", "line 19", "8 numbers"],
        ),
        (
            ARM.replace("Zrotation Xrotation", "Zrotation Wobble"),
            ["line 9", "Wobble", "Zrotation"],
        ),
        (
            ARM.replace("0.0333333", "0"),
            ["line 18", "Frame Time", "seconds"],
        ),
        (
            ARM.replace("OFFSET 0 10 0", "OFFSET 0 ten 0"),
            ["line 8", "ten", "number"],
        ),
        (
            ARM.replace("MOTION", "MOTIONS"),
            ["line 16", "MOTIONS", "MOTION"],
        ),
        (
            ARM.replace("JOINT Spine", "JINT Spine"),
            ["line 6", "JINT", "JOINT"],
        ),
    ] {
        match positions(&text) {
            Ok((joints, _)) => assert!(joints.frames.is_empty()), // refused when it becomes a capture
            Err(message) => {
                for part in parts {
                    assert!(message.contains(part), "{part:?} is not in {message:?}");
                }
            }
        }
    }
}

#[test]
fn a_text_that_ends_in_the_hierarchy_is_cut_off() {
    let begin = ARM.find("MOTION").unwrap();
    for cut in 9..begin {
        let message = positions(&ARM[..cut]).unwrap_err();
        assert!(message.contains("cut off"), "{cut}: {message}");
    }
    let cut = ARM.find("Zrotation").unwrap() + 2;
    let message = positions(&ARM[..cut]).unwrap_err();
    for part in ["line 5", "\"Zr\"", "the text ends", "cut off"] {
        assert!(message.contains(part), "{part:?} is not in {message:?}");
    }
}

#[test]
fn no_cut_panics() {
    for cut in 0..ARM.len() {
        let _ = positions(&ARM[..cut]);
    }
    for text in [
        "",
        "HIERARCHY",
        "HIERARCHY }",
        "HIERARCHY OFFSET 1 2 3",
        "HIERARCHY ROOT a { CHANNELS 9e9",
    ] {
        assert!(positions(text).is_err(), "{text}");
    }
}
