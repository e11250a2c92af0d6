//! Small clips whose joints can be worked out in the head, and broken ones.

use super::*;
use crate::import::human::Joints;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};
use std::fmt::Write as _;
use std::path::Path;

type Reader = fn(&File<'_>, &mut Vec<String>) -> Result<(Motion, Option<f64>), MotionError>;

fn told(reader: Reader, text: &str) -> Result<(Motion, f64, Vec<String>), String> {
    let file = File {
        path: Path::new("walk.txt"),
        bytes: text.as_bytes(),
    };
    let mut decisions = Vec::new();
    let (motion, fps) = reader(&file, &mut decisions).map_err(|e| e.to_string())?;
    Ok((motion, fps.unwrap(), decisions))
}

fn json(head: &str, frames: &[Vec<f64>]) -> String {
    let mut text = format!("{{\n{head}\n\"Frames\":\n[\n");
    for (i, frame) in frames.iter().enumerate() {
        let numbers: Vec<String> = frame.iter().map(f64::to_string).collect();
        let comma = if i + 1 < frames.len() { "," } else { "" };
        let _ = writeln!(text, "[{}]{comma}", numbers.join(", "));
    }
    text + "]\n}"
}

/// DeepMimic's humanoid, y up: the left thigh ahead by 90° about z, its knee bent back by as much; 1 cm
/// a frame along x. The last frame lasts 0 s, as in its own files.
pub(in crate::import) fn deepmimic_clip(frames: usize) -> String {
    let ball = [1.0, 0.0, 0.0, 0.0];
    let frame = |i: usize| {
        let mut frame = vec![
            if i + 1 < frames { 0.02 } else { 0.0 },
            0.01 * i as f64,
            0.9,
            0.0,
        ];
        frame.extend(ball); // root
        frame.extend([ball, ball].concat()); // chest, neck
        frame.extend([&ball[..], &[0.0], &ball].concat()); // right leg
        frame.extend([&ball[..], &[0.0]].concat()); // right arm
        frame.extend([FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]);
        frame.push(-FRAC_PI_2);
        frame.extend(ball); // left ankle
        frame.extend([&ball[..], &[0.0]].concat()); // left arm
        frame
    };
    json(
        "\"Loop\": \"wrap\",",
        &(0..frames).map(frame).collect::<Vec<_>>(),
    )
}

fn place(joints: &Joints, frame: usize, name: &str) -> Vector3<f64> {
    joints.frames[frame][joints.names.iter().position(|n| n == name).unwrap()]
}

#[test]
fn deepmimics_humanoid_is_posed() {
    let (Motion::Human(joints), fps, _) = told(deepmimic, &deepmimic_clip(4)).unwrap() else {
        panic!("it is a humanoid");
    };
    assert!((fps - 50.0).abs() < 1e-9);
    for (name, expected) in [
        ("left_shin", [0.421546, 0.9, -0.084887]),
        ("left_foot", [0.421546, 0.9 - 0.40987, -0.084887]),
        ("left_toe", [0.571546, 0.9 - 0.40987, -0.084887]),
        ("right_foot", [0.0, 0.9 - 0.831416, 0.084887]),
        (
            "right_hand",
            [-0.02405, 0.9 + 0.236151 + 0.2435 - 0.533735, 0.18311],
        ),
    ] {
        let at = place(&joints, 2, name);
        let expected = Vector3::from(expected) + Vector3::new(0.02, 0.0, 0.0);
        assert!((at - expected).norm() < 1e-6, "{name}: {at}");
    }
}

#[test]
fn broken_deepmimic_clips_are_refused() {
    let good = deepmimic_clip(4);
    for (text, parts) in [
        (
            good.replacen("[0.02", "[0.05", 1),
            ["frame 1, Frames[0]", "0.05 s", "evenly"],
        ),
        (
            good.replacen("0.9, 0, 1, 0", "0.9, 0, 2, 0", 1),
            ["frame 1", "length 2.000", "normalise"],
        ),
        (
            good.replacen("[0.02, ", "[", 1),
            ["frame 2", "44 numbers", "43"],
        ),
        (
            json("", &vec![vec![0.0; 43]; 4]),
            ["Frames", "[4, 43]", "44"],
        ),
        (good.replace("0.9", "NaN"), ["line 5", "no clip", "JSON"]),
        (
            good.replace("Frames", "Poses"),
            ["no clip", "Frames", "cut off"],
        ),
        (json("", &[]), ["Frames", "[0, 0]", "44"]),
    ] {
        let message = told(deepmimic, &text).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "{part:?} is not in {message:?}");
        }
    }
    for cut in 0..good.len() {
        if good.is_char_boundary(cut) {
            assert!(told(deepmimic, &good[..cut]).is_err(), "{cut}");
        }
    }
}

/// A clip of TienKung-Lab's layout: joint i is 0.01 · (i + 1) rad and moves at 0.05 · i rad/s, the root
/// goes ahead at 0.5 m/s and is turned about x, y and z in turn. Speeds are to the next frame.
pub(in crate::import) fn tienkung_clip(joints: usize, angles: [f64; 3]) -> String {
    let seconds = 0.02;
    let frame = |i: usize| {
        let time = i as f64 * seconds;
        let mut frame = vec![0.5 * time, 0.1, 0.78];
        frame.extend(angles);
        frame.extend((0..joints).map(|j| 0.01 * (j + 1) as f64 + 0.05 * j as f64 * time));
        frame.extend([0.5, 0.0, 0.0, 0.0, 0.0, 0.0]);
        frame.extend((0..joints).map(|j| 0.05 * j as f64));
        frame
    };
    let head = "\"LoopMode\": \"Wrap\",\n\"FrameDuration\": 0.02,\n\"MotionWeight\": 0.5,";
    json(head, &(0..5).map(frame).collect::<Vec<_>>())
}

#[test]
fn tienkungs_layout_of_a_g1_is_read() {
    let (Motion::Robot(rows, Sure::Yes), fps, _) =
        told(tienkung, &tienkung_clip(29, [FRAC_PI_2, 0.0, FRAC_PI_2])).unwrap()
    else {
        panic!("it is a G1");
    };
    assert!((fps - 50.0).abs() < 1e-9);
    // The 20th joint of 29 is the left wrist's roll, our 18th: 0.20 + 0.05 · 19 · 0.02 after a frame.
    assert!((rows[1].joints[17] - 0.219).abs() < 1e-9);
    assert!((rows[1].position - Vector3::new(0.01, 0.1, 0.78)).norm() < 1e-9);
    // About z first in the body's own frame: x goes to y, and that to z.
    assert!((rows[0].orientation * Vector3::x() - Vector3::z()).norm() < 1e-9);
}

#[test]
fn tienkungs_own_robot_is_a_humanoid() {
    let mut clip = tienkung_clip(20, [0.0; 3]);
    // All at rest but the left hip's pitch (2nd) and knee (4th): ahead and back by 90°.
    let mut frame = vec![0.0, 0.0, 0.9, 0.0, 0.0, 0.0];
    let mut joints = [0.0; 20];
    (joints[1], joints[3]) = (-FRAC_PI_2, FRAC_PI_2);
    frame.extend(joints);
    frame.extend([0.0; 26]);
    clip.truncate(clip.find("\"Frames\"").unwrap());
    let head = clip.trim_start_matches('{').to_owned();
    let (Motion::Human(joints), ..) = told(tienkung, &json(&head, &vec![frame; 3])).unwrap() else {
        panic!("it is a humanoid");
    };
    // Hips are at (0, ±0.15, −0.1317), thigh and shin 0.4 m long.
    for (name, expected) in [
        ("left_shin", [0.4, 0.15, 0.9 - 0.1317]),
        ("left_foot", [0.4, 0.15, 0.9 - 0.5317]),
        ("right_foot", [0.0, -0.15, 0.9 - 0.9317]),
    ] {
        let at = place(&joints, 1, name);
        assert!((at - Vector3::from(expected)).norm() < 1e-6, "{name}: {at}");
    }
}

#[test]
fn a_duration_of_three_digits_is_a_usual_rate() {
    for (seconds, expected) in [
        (0.033, 30.0),
        (0.017, 60.0),
        (0.02, 50.0),
        (0.008, 125.0),
        (0.0333, 1.0 / 0.0333),
    ] {
        let mut told = Vec::new();
        assert!((rounded_rate(seconds, &mut told) - expected).abs() < 1e-9);
        assert_eq!(
            told.is_empty(),
            !matches!(expected, 30.0 | 60.0),
            "{told:?}"
        );
    }
}

#[test]
fn what_a_discriminator_is_shown_is_no_motion() {
    // 23 joints, their speeds, and twelve numbers: as many as root, 23 joints, and their speeds.
    let shown = |joints: usize| {
        let frame = |i: usize| {
            let angle = |j: usize| 0.01 * (j + 1) as f64 + 0.001 * (i * j) as f64;
            let mut frame: Vec<f64> = (0..joints).map(angle).collect();
            frame.extend((0..joints).map(|j| 0.05 * j as f64));
            frame.extend((0..12).map(|k| 0.1 * f64::from(k)));
            frame
        };
        json(
            "\"FrameDuration\": 0.02,",
            &(0..5).map(frame).collect::<Vec<_>>(),
        )
    };
    for joints in [20, 23, 29] {
        let message = told(tienkung, &shown(joints)).err().unwrap();
        assert!(
            message.contains("discriminator") && message.contains("motion_visualization"),
            "{message}"
        );
    }
    let slow = tienkung_clip(29, [0.0; 3]).replace("0.02,\n", "0.2,\n");
    let message = told(tienkung, &slow).err().unwrap();
    assert!(
        message.contains("second half") && message.contains("FrameDuration"),
        "{message}"
    );
    let message = told(tienkung, &tienkung_clip(12, [0.0; 3])).err().unwrap();
    assert!(
        message.contains("[5, 36]") && message.contains("70 or 58 or 52"),
        "{message}"
    );
    let timeless = tienkung_clip(29, [0.0; 3]).replace("\"FrameDuration\": 0.02,\n", "");
    assert!(
        told(tienkung, &timeless)
            .err()
            .unwrap()
            .contains("FrameDuration")
    );
}
