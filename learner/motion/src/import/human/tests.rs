//! Skeletons of several makers, turned and scaled.

use super::*;
use std::path::Path;

/// Joints of a human that stands at a place, z up, m: `(name, position)` by the names of LAFAN1.
pub(in crate::import) const STANDING: [(&str, [f64; 3]); 14] = [
    ("LeftUpLeg", [0.0, 0.1, 0.9]),
    ("LeftLeg", [0.02, 0.1, 0.48]),
    ("LeftFoot", [0.0, 0.1, 0.08]),
    ("LeftToe", [0.14, 0.1, 0.02]),
    ("LeftArm", [0.0, 0.2, 1.4]),
    ("LeftForeArm", [0.0, 0.22, 1.12]),
    ("LeftHand", [0.05, 0.22, 0.88]),
    ("RightUpLeg", [0.0, -0.1, 0.9]),
    ("RightLeg", [0.02, -0.1, 0.48]),
    ("RightFoot", [0.0, -0.1, 0.08]),
    ("RightToe", [0.14, -0.1, 0.02]),
    ("RightArm", [0.0, -0.2, 1.4]),
    ("RightForeArm", [0.0, -0.22, 1.12]),
    ("RightHand", [0.05, -0.22, 0.88]),
];

fn standing(turn: impl Fn([f64; 3]) -> [f64; 3]) -> Joints {
    Joints {
        names: STANDING
            .iter()
            .map(|(name, _)| (*name).to_owned())
            .collect(),
        frames: vec![
            STANDING
                .iter()
                .map(|(_, p)| Vector3::from(turn(*p)))
                .collect();
            3
        ],
    }
}

fn read(joints: &Joints) -> Result<(Capture, Vec<String>), String> {
    let file = File {
        path: Path::new("human.bvh"),
        bytes: b"",
    };
    let mut decisions = Vec::new();
    let capture = capture(&file, joints, 30.0, &mut decisions).map_err(|e| e.to_string())?;
    Ok((capture, decisions))
}

#[test]
fn up_and_unit_are_told_from_the_body() {
    let (upright, told) = read(&standing(|p| p)).unwrap();
    assert!(
        told[0].starts_with("z up") && told[1].starts_with("unit m"),
        "{told:?}"
    );
    // y up, z forward… whatever: x stays, y becomes z.
    for (unit, name) in [
        (100.0, "cm"),
        (1000.0, "mm"),
        (0.45 / 0.0254, "inches/0.45"),
    ] {
        let turned = standing(|[x, y, z]| [unit * x, unit * z, -unit * y]);
        let (capture, told) = read(&turned).unwrap();
        assert!(told[0].starts_with("y up"), "{told:?}");
        assert!(told[1].starts_with(&format!("unit {name}")), "{told:?}");
        for (a, b) in capture.frames[0].0.iter().zip(&upright.frames[0].0) {
            assert!((a - b).norm() < 1e-9);
        }
    }
}

#[test]
fn joints_are_found_under_the_names_of_many_skeletons() {
    let names = |list: [&str; 7]| -> Vec<String> {
        let right = |n: &str| {
            n.replace("left", "right")
                .replace("Left", "Right")
                .replace("_L", "_R")
        };
        let first = |n: &str| {
            n.strip_prefix('l')
                .map_or(right(n), |rest| format!("r{rest}"))
        };
        let other = |n: &&str| {
            if n.starts_with("left") {
                right(n)
            } else {
                first(n)
            }
        };
        list.iter()
            .map(|n| (*n).to_owned())
            .chain(list.iter().map(other))
            .collect()
    };
    for list in [
        [
            "LeftUpLeg",
            "LeftLeg",
            "LeftFoot",
            "LeftToeBase",
            "LeftArm",
            "LeftForeArm",
            "LeftHand",
        ],
        [
            "UpperLeg_L",
            "LowerLeg_L",
            "Foot_L",
            "Toes_L",
            "UpperArm_L",
            "LowerArm_L",
            "Hand_L",
        ],
        [
            "LeftLeg",
            "LeftShin",
            "LeftFoot",
            "LeftToeBase",
            "LeftArm",
            "LeftForeArm",
            "LeftHand",
        ],
        [
            "lfemur", "ltibia", "lfoot", "ltoes", "lhumerus", "lradius", "lwrist",
        ],
        [
            "left_thigh",
            "left_shin",
            "left_foot",
            "left_toe",
            "left_upper_arm",
            "left_lower_arm",
            "left_hand",
        ],
    ] {
        let file = File {
            path: Path::new("x"),
            bytes: b"",
        };
        let columns = columns(&file, &names(list)).unwrap();
        assert_eq!(columns, std::array::from_fn(|i| i), "{list:?}");
    }
}

#[test]
fn what_is_no_standing_human_is_refused() {
    let mut missing = standing(|p| p);
    missing.names[3] = "LeftNothing".into();
    let message = read(&missing).unwrap_err();
    assert!(
        message.contains("left toe") && message.contains("LeftUpLeg"),
        "{message}"
    );
    let message = read(&standing(|[x, y, z]| [z, y, x])).unwrap_err();
    assert!(message.contains("does not stand"), "{message}");
    let message = read(&standing(|p| p.map(|x| 4.0 * x))).unwrap_err();
    assert!(
        message.contains("legs 3.2") && message.contains("metres"),
        "{message}"
    );
    let mut broken = standing(|p| p);
    broken.frames[1][2].y = f64::NAN;
    let message = read(&broken).unwrap_err();
    assert!(message.contains("human.bvh frame 2, LeftFoot"), "{message}");
    broken.frames.clear();
    assert!(read(&broken).unwrap_err().contains("no frames"));
}
